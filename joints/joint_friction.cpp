#include <carom/core/system.h>
#include <carom/joints/joint_friction_kind.h>

namespace carom {

void JointFrictionKind::add(const JointFriction& part, const PartCheck& check) {
  check_coordinate(check, part.joint);
  check.non_negative(part.bound, "bound", "N m or N");
  check.non_negative(part.coefficient, "coefficient", "");
  if (part.bound == 0.0 && part.coefficient == 0.0) {
    check.refuse("bound", "0, and coefficient too", "one of them > 0");
  }
  if (!(part.static_factor >= 1.0 && is_admissible(part.static_factor))) {
    check.refuse("static_factor", to_text(part.static_factor),
                 allowed_instead(part.static_factor, "a finite number >= 1"));
  }
  if (const Index other = slot_on(part.joint); other != none) {
    check.refuse("joint", check.system().name(part.joint) + ", which has " + parts_[other].name + " already",
                 "a joint without friction");
  }
  store(part, check);
}

JointDryFriction JointFrictionKind::dry_friction(Index joint) const {
  const JointFriction& friction = parts_[joint].part;
  return {friction.bound, friction.static_factor, friction.coefficient};
}

JointReaction JointFrictionKind::reaction(const JointView&, Index, const double* multipliers) const {
  JointReaction reaction;
  reaction.moment = multipliers[0];
  return reaction;
}

void JointFrictionKind::fingerprint(Fingerprint& print) const {
  for (const Stored& stored : parts_) {
    print.add(std::uint64_t{stored.part.joint.serial});
    print.add(stored.part.bound);
    print.add(stored.part.coefficient);
    print.add(stored.part.static_factor);
  }
}

PartType<JointKind> JointFriction::part_type() {
  return PartType<JointKind>::of<JointFrictionKind, JointFriction>();
}

}  // namespace carom
