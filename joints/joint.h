#pragma once

/// \file
/// Kinds of planar joints that are sums of bindings. A joint describes itself by
///
///     std::vector<Binding> bindings(const PartCheck& check) const;    // checks, then says what it binds
///     Binding coordinate(const PartCheck& check) const;               // optional: its gap is the coordinate
///
/// and by the number of rows, `static constexpr Index row_count`.

#include <carom/core/joint_kind.h>
#include <carom/core/part.h>
#include <carom/joints/binding.h>

#include <array>
#include <cstddef>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

namespace carom::planar {

/// All joints of one kind that is a sum of bindings.
template <class P>
class BindingKind final : public JointKind {
public:
  static constexpr bool with_coordinate = requires(const P& part, const PartCheck& check) {
    part.coordinate(check);
  };
  static constexpr Index row_count = P::row_count;

  static constexpr int part_dimension() { return 2; }
  static constexpr std::string_view part_label() { return P::label; }

  /// Checks and stores a joint. Throws ModelError.
  void add(const P& part, const PartCheck& check) {
    Described described;
    const std::vector<Binding> bindings = part.bindings(check);
    for (Index row = 0; row < row_count; ++row) described.bindings[row] = bindings[row];
    if constexpr (with_coordinate) described.bindings[row_count] = part.coordinate(check);
    described_.push_back(described);
  }

  [[nodiscard]] std::unique_ptr<JointKind> clone() const override {
    return std::make_unique<BindingKind>(*this);
  }
  [[nodiscard]] std::unique_ptr<JointKind> arranged(std::span<const Index> order,
                                                    const Layout& layout) const override {
    auto copy = std::make_unique<BindingKind>();
    copy->described_.reserve(order.size());
    copy->located_.reserve(order.size() * stored);
    for (const Index slot : order) {
      copy->described_.push_back(described_[slot]);
      for (const Binding& binding : described_[slot].bindings) copy->located_.emplace_back(binding, layout);
    }
    return copy;
  }
  void remove(Index slot) override { described_.erase(described_.begin() + slot); }
  [[nodiscard]] std::string_view label() const override { return part_label(); }
  [[nodiscard]] int dimension() const override { return 2; }
  [[nodiscard]] Index size() const override { return static_cast<Index>(described_.size()); }
  [[nodiscard]] Index rows() const override { return row_count; }
  void ends(Index joint, std::vector<BodyId>& out) const override {
    const Binding& first = described_[joint].bindings[0];
    out.push_back(first.from.body);
    out.push_back(first.to.body);
    if (first.carrier != ground) out.push_back(first.carrier);
  }
  void pattern(Index joint, JointRow* out) const override {
    for (Index row = 0; row < row_count; ++row) located_[joint * stored + row].pattern(out[row]);
  }
  void evaluate(const JointView& at, Index joint, JointRow* out) const override {
    for (Index row = 0; row < row_count; ++row) located_[joint * stored + row].evaluate(at, out[row]);
  }
  [[nodiscard]] bool has_coordinate() const override { return with_coordinate; }
  void coordinate(const JointView& at, Index joint, JointRow& out) const override {
    if constexpr (with_coordinate) located_[joint * stored + row_count].evaluate(at, out);
  }
  void coordinate_pattern(Index joint, JointRow& out) const override {
    if constexpr (with_coordinate) located_[joint * stored + row_count].pattern(out);
  }
  [[nodiscard]] JointReaction reaction(const JointView& at, Index joint,
                                       const double* multipliers) const override {
    JointReaction reaction;
    for (Index row = 0; row < row_count; ++row) {
      located_[joint * stored + row].add_reaction(at, multipliers[row], reaction);
    }
    return reaction;
  }
  void fingerprint(Fingerprint& print) const override {
    for (const Described& joint : described_) {
      for (const Binding& binding : joint.bindings) {
        add_to(print, binding.from);
        add_to(print, binding.to);
        print.add(std::uint64_t{binding.carrier.serial});
        print.add({binding.axis.data(), 2});
        for (const double number : {binding.turn_from, binding.turn_to, binding.turn_carrier, binding.offset})
          print.add(number);
      }
    }
  }

private:
  static constexpr Index stored = row_count + (with_coordinate ? 1 : 0);
  struct Described {
    std::array<Binding, static_cast<std::size_t>(stored)> bindings{};
  };
  std::vector<Described> described_;
  std::vector<LocatedBinding> located_;  // `stored` for each joint; empty in a described kind
};

}  // namespace carom::planar

namespace carom {

/// A joint without a kind of its own is a sum of bindings.
template <class P>
  requires(P::role == Role::joint && !requires { typename P::Kind; })
struct KindOf<P> {
  using type = planar::BindingKind<P>;
};

}  // namespace carom
