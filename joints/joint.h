#pragma once

/// \file
/// Kinds of planar joints that are sums of constraint parts. A joint is described by
///
///     std::vector<ConstraintPart> constraints(const PartCheck& check) const;  // checks (joint_ends.h), then
///                                                                             // lists its parts, always the
///                                                                             // same two ends
///     ConstraintPart coordinate(const PartCheck& check) const;  // optional: its gap is the coordinate
///
/// and by the number of rows, `static constexpr Index row_count`.

#include <carom/core/export.h>
#include <carom/core/joint_kind.h>
#include <carom/core/owner.h>
#include <carom/core/part.h>
#include <carom/joints/constraint_part.h>
#include <carom/joints/joint_ends.h>

#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

namespace carom::planar {

class ConstraintPartTable;

/// Joints that are sums of constraint parts, whatever their kind: all that does not depend on its type.
class CAROM_API CompositeJoints : public JointKind {
public:
  ~CompositeJoints() override;
  CompositeJoints& operator=(const CompositeJoints&) = delete;

  void remove(Index slot) override;
  [[nodiscard]] std::string_view label() const override { return label_; }
  [[nodiscard]] int dimension() const override { return 2; }
  [[nodiscard]] Index size() const override;
  [[nodiscard]] Index rows() const override { return row_count_; }
  void ends(Index joint, std::vector<BodyId>& out) const override;
  void pattern(Index joint, JointRow* out) const override;
  void evaluate(const JointView& at, Index joint, JointRow* out) const override;
  void evaluate_all(const JointView& at, Range joints, JointNumbers out) const override;
  void derivatives(const JointView& at, Index joint, JointRowDerivative* out) const override;
  [[nodiscard]] bool has_coordinate() const override { return with_coordinate_; }
  void coordinate(const JointView& at, Index joint, JointRow& out) const override;
  void coordinate_derivatives(const JointView& at, Index joint, JointRowDerivative& out) const override;
  void coordinate_pattern(Index joint, JointRow& out) const override;
  [[nodiscard]] JointReaction reaction(const JointView& at, Index joint,
                                       const double* multipliers) const override;
  [[nodiscard]] std::optional<JointPlaces> places(const JointView& at, Index joint) const override;
  void fingerprint(Fingerprint& print) const override;

protected:
  /// \param label of a joint in messages
  /// \param row_count rows of a joint
  /// \param with_coordinate joints have a coordinate, the gap of one more part behind the rows
  CompositeJoints(std::string_view label, Index row_count, bool with_coordinate);
  CompositeJoints(const CompositeJoints&);

  /// Checks and stores the parts of a joint. Throws ModelError.
  void store(const PartCheck& check, const std::vector<ConstraintPart>& constraints);
  /// Takes the joints of others that `order` names, in that order, with their places in the arrays.
  void take(const CompositeJoints& from, std::span<const Index> order, const Layout& layout);

private:
  std::string_view label_;
  Index row_count_;
  bool with_coordinate_;
  Owner<ConstraintPartTable> table_;  // the coordinate behind the rows
};

/// All joints of one kind that is a sum of constraint parts.
template <class P>
class CompositeJointKind final : public CompositeJoints {
public:
  static constexpr bool with_coordinate = requires(const P& part, const PartCheck& check) {
    part.coordinate(check);
  };
  static constexpr Index row_count = P::row_count;

  CompositeJointKind() : CompositeJoints(P::label, row_count, with_coordinate) {}

  /// Members that a System needs of every kind (part.h).
  static constexpr int part_dimension() { return 2; }
  static constexpr std::string_view part_label() { return P::label; }

  /// Checks and stores a joint. Throws ModelError.
  void add(const P& part, const PartCheck& check) {
    auto constraints = part.constraints(check);
    if constexpr (with_coordinate) constraints.push_back(part.coordinate(check));
    store(check, constraints);
  }

  [[nodiscard]] std::unique_ptr<JointKind> clone() const override {
    return std::make_unique<CompositeJointKind>(*this);
  }
  [[nodiscard]] std::unique_ptr<JointKind> arranged(std::span<const Index> order,
                                                    const Layout& layout) const override {
    auto copy = std::make_unique<CompositeJointKind>();
    copy->take(*this, order, layout);
    return copy;
  }
};

}  // namespace carom::planar

namespace carom {

/// A joint without its own kind is a sum of constraint parts.
template <class P>
  requires(P::role == Role::joint && !requires { typename P::Kind; })
struct KindOf<P> {
  using type = planar::CompositeJointKind<P>;
};

}  // namespace carom
