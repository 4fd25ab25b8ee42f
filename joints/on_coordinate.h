#pragma once

/// \file
/// Common base of the kinds of parts that act on the coordinate of a joint.

#include <carom/core/layout.h>
#include <carom/core/part.h>

#include <memory>
#include <span>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

namespace carom {

/// Demands a joint with a coordinate, of the system that the part is added to. Throws ModelError.
CAROM_API void check_coordinate(const PartCheck& check, JointId joint);

/// Bodies that a joint of the system connects. Throws ModelError for a joint that is not of this system.
[[nodiscard]] CAROM_API std::vector<BodyId> bodies_of(const System& system, JointId joint);

/// The coordinate of a joint of an assembly. Throws ModelError for a joint that is not in it.
[[nodiscard]] CAROM_API JointRow coordinate_row(const Layout& layout, JointId joint, const JointView& at);

/// Stores all parts `P` of a system, each with a member `joint`, of the kind `Self`. \tparam Base JointKind
/// or ForceKind
template <class P, class Self, class Base>
class OnCoordinate : public Base {
public:
  static constexpr int part_dimension() { return 0; }  ///< fits both dimensions

  /// A copy of all parts.
  [[nodiscard]] std::unique_ptr<Base> clone() const override {
    return std::make_unique<Self>(static_cast<const Self&>(*this));
  }
  /// A copy with the parts in this order, for an assembly with this layout, which must outlive it.
  [[nodiscard]] std::unique_ptr<Base> arranged(std::span<const Index> order,
                                               const Layout& layout) const override {
    auto copy = std::make_unique<Self>();
    for (const Index slot : order) copy->parts_.push_back(parts_[slot]);
    copy->layout_ = &layout;
    return copy;
  }
  /// Removes a part; later ones move up.
  void remove(Index slot) override {
    parts_.erase(parts_.begin() + slot);
    slots_.clear();
    for (Index at = 0; at < parts_.size(); ++at) slots_[parts_[at].part.joint.serial] = at;
  }
  [[nodiscard]] int dimension() const override { return 0; }  ///< 0: fits both dimensions
  [[nodiscard]] Index size() const override {
    return static_cast<Index>(parts_.size());
  }  ///< number of parts
  /// Appends the bodies of a part's joint.
  void ends(Index slot, std::vector<BodyId>& out) const override {
    out.insert(out.end(), parts_[slot].ends.begin(), parts_[slot].ends.end());
  }
  /// The joint that a part acts on.
  [[nodiscard]] JointId on_joint(Index slot) const override { return parts_[slot].part.joint; }

protected:
  /// A part, the bodies of its joint, its name in messages.
  struct Stored {
    P part;                    ///< as described
    std::vector<BodyId> ends;  ///< of its joint
    std::string name;          ///< in messages
  };
  /// Slot of the (last) part that acts on a joint, `none` if there is none.
  [[nodiscard]] Index slot_on(JointId joint) const {
    const auto found = slots_.find(joint.serial);
    return found == slots_.end() ? none : found->second;
  }
  /// Stores a part that has been checked.
  void store(const P& part, const PartCheck& check) {
    slots_[part.joint.serial] = static_cast<Index>(parts_.size());
    parts_.push_back({part, bodies_of(check.system(), part.joint), check.part()});
  }

  std::vector<Stored> parts_;       ///< in the order of slots
  const Layout* layout_ = nullptr;  ///< of an arranged kind

private:
  std::unordered_map<Index, Index> slots_;  // by serial number of the joint; not of an arranged kind
};

}  // namespace carom
