#include <carom/core/registry.h>
#include <carom/core/system.h>
#include <carom/joints/on_coordinate.h>
#include <carom/joints/revolute.h>

#include <algorithm>

namespace carom {

JointRow coordinate_row(const Layout& layout, JointId joint, const JointView& at) {
  const JointTable* const joints = joint.token == layout.token() ? layout.joints() : nullptr;
  const JointTable::Place place = joints != nullptr ? joints->place(joint.serial) : JointTable::Place{};
  if (place.slot == none) {
    throw ModelError("coordinate of a joint: it is not in this model; allowed: a joint of this model");
  }
  const JointTable& table = *joints;
  JointRow row;
  table.kinds[place.kind]->coordinate(at, place.slot, row);
  return row;
}

std::vector<BodyId> bodies_of(const System& system, JointId joint) {
  if (!system.contains(joint)) {
    throw ModelError("bodies of a joint: joint is " + refused_name(system, joint) +
                     "; allowed: a joint of this system");
  }
  std::vector<BodyId> ends;
  const auto place = system.joint_kinds().place(joint.serial);
  system.joint_kinds().entries()[place.entry].kind->ends(place.slot, ends);
  return ends;
}

void check_coordinate(const PartCheck& check, JointId joint) {
  const System& system = check.system();
  if (!joint.valid()) check.refuse("joint", "not given", "a joint of this system");
  if (!system.contains(joint)) check.refuse("joint", refused_name(system, joint), "a joint of this system");
  const JointKind& kind = system.joint_kinds().kind_of(joint.serial);
  constexpr std::string_view allowed =
      "a joint with a coordinate (revolute, prismatic, point on line, rolling)";
  if (!kind.has_coordinate()) check.refuse("joint", system.name(joint), allowed);
  // Nothing that turns, nothing to push.
  if (dynamic_cast<const planar::CompositeJointKind<planar::Revolute>*>(&kind) == nullptr) return;
  const std::vector<BodyId> ends = bodies_of(system, joint);
  if (std::none_of(ends.begin(), ends.end(), [&](BodyId body) { return system.has_orientation(body); })) {
    check.refuse("joint", system.name(joint) + ", of particles, which do not turn", allowed);
  }
}

}  // namespace carom
