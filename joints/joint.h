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

#include <carom/core/joint_kind.h>
#include <carom/core/part.h>
#include <carom/joints/constraint_part.h>
#include <carom/joints/joint_ends.h>

#include <memory>
#include <span>
#include <string_view>
#include <vector>

namespace carom::planar {

/// All joints of one kind that is a sum of constraint parts.
template <class P>
class CompositeJointKind final : public JointKind {
public:
  static constexpr bool with_coordinate = requires(const P& part, const PartCheck& check) {
    part.coordinate(check);
  };
  static constexpr Index row_count = P::row_count;

  /// Members that a System needs of every kind (part.h).
  static constexpr int part_dimension() { return 2; }
  static constexpr std::string_view part_label() { return P::label; }

  /// Checks and stores a joint. Throws ModelError.
  void add(const P& part, const PartCheck& check) {
    std::vector<ConstraintPart> constraints = part.constraints(check);
    if constexpr (with_coordinate) constraints.push_back(part.coordinate(check));
    check_constraint_parts(check, constraints, stored);
    table_.add(constraints);
  }

  [[nodiscard]] std::unique_ptr<JointKind> clone() const override {
    return std::make_unique<CompositeJointKind>(*this);
  }
  [[nodiscard]] std::unique_ptr<JointKind> arranged(std::span<const Index> order,
                                                    const Layout& layout) const override {
    auto copy = std::make_unique<CompositeJointKind>();
    copy->table_ = table_.arranged(order, layout);
    return copy;
  }
  void remove(Index slot) override { table_.erase(slot); }
  [[nodiscard]] std::string_view label() const override { return part_label(); }
  [[nodiscard]] int dimension() const override { return 2; }
  [[nodiscard]] Index size() const override { return table_.size(); }
  [[nodiscard]] Index rows() const override { return row_count; }
  void ends(Index joint, std::vector<BodyId>& out) const override { table_.ends(joint, out); }
  void pattern(Index joint, JointRow* out) const override {
    for (Index row = 0; row < row_count; ++row) table_.pattern(joint, out[row]);
  }
  void evaluate(const JointView& at, Index joint, JointRow* out) const override {
    for (Index row = 0; row < row_count; ++row) table_.evaluate(at, joint, row, out[row]);
  }
  void evaluate_all(const JointView& at, Range joints, JointNumbers out) const override {
    table_.evaluate(at, joints, row_count, out);
  }
  void derivatives(const JointView& at, Index joint, JointRowDerivative* out) const override {
    for (Index row = 0; row < row_count; ++row) table_.derivatives(at, joint, row, out[row]);
  }
  [[nodiscard]] bool has_coordinate() const override { return with_coordinate; }
  void coordinate(const JointView& at, Index joint, JointRow& out) const override {
    if constexpr (with_coordinate) table_.evaluate(at, joint, row_count, out);
  }
  void coordinate_derivatives(const JointView& at, Index joint, JointRowDerivative& out) const override {
    if constexpr (with_coordinate) table_.derivatives(at, joint, row_count, out);
  }
  void coordinate_pattern(Index joint, JointRow& out) const override {
    if constexpr (with_coordinate) table_.pattern(joint, out);
  }
  [[nodiscard]] JointReaction reaction(const JointView& at, Index joint,
                                       const double* multipliers) const override {
    return table_.reaction(at, joint, row_count, multipliers);
  }
  void fingerprint(Fingerprint& print) const override { table_.fingerprint(print); }

private:
  static constexpr Index stored = row_count + (with_coordinate ? 1 : 0);
  ConstraintPartTable table_;  // the coordinate behind the rows
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
