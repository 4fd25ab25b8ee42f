#include <carom/joints/rod.h>

#include <cmath>

namespace carom::planar {

std::vector<ConstraintPart> Rod::constraints(const PartCheck& check) const {
  check_joint_ends(check, from, to);
  ConstraintPart constraint;
  constraint.form = ConstraintPart::Form::distance;
  constraint.from = from;
  constraint.to = to;
  const System& system = check.system();
  const double described = (described_place(system, to.body).point(to.point) -
                            described_place(system, from.body).point(from.point))
                               .norm();
  constraint.offset = std::isnan(length) ? described : length;
  check.positive(constraint.offset, "length", "m");
  // Without a distance there is no direction to push in.
  if (!(described > 0.0)) check.refuse("distance of the ends as described", "0 m", "a distance > 0");
  return {constraint};
}

std::vector<ConstraintPart> Gear::constraints(const PartCheck& check) const {
  check.oriented_body(from, "from");
  check.oriented_body(to, "to");
  check.different_ends(from, to);
  check_turning_end(check, carrier, "carrier");
  if (carrier == from || carrier == to)
    check.refuse("carrier", check.system().name(carrier), "another body than from and to");
  check.finite(ratio, "ratio", "");
  if (ratio == 0.0) check.refuse("ratio", "0", "a ratio that is not 0");
  ConstraintPart constraint;
  constraint.from = End<2>(from);
  constraint.to = End<2>(to);
  constraint.carrier = carrier;
  constraint.turn_from = ratio;
  constraint.turn_to = 1.0;
  constraint.turn_carrier = -(1.0 + ratio);
  const System& system = check.system();
  constraint.offset = constraint.turn_to * described_place(system, to).angle +
                      constraint.turn_from * described_place(system, from).angle +
                      constraint.turn_carrier * described_place(system, carrier).angle;
  return {constraint};
}

PartType<JointKind> Rod::part_type() { return PartType<JointKind>::of<CompositeJointKind<Rod>, Rod>(); }
PartType<JointKind> Gear::part_type() { return PartType<JointKind>::of<CompositeJointKind<Gear>, Gear>(); }

}  // namespace carom::planar
