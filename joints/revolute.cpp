#include <carom/joints/revolute.h>

#include <cmath>

namespace carom::planar {

namespace {

double relative_angle(const PartCheck& check, double given, BodyId from, BodyId to,
                      std::string_view quantity) {
  if (std::isinf(given)) check.finite(given, quantity, "rad");
  if (!std::isnan(given)) return given;
  return described_place(check.system(), to).angle - described_place(check.system(), from).angle;
}

}  // namespace

std::vector<ConstraintPart> point_constraints(const End<2>& from, const End<2>& to) {
  std::vector<ConstraintPart> constraints(2);
  for (int i = 0; i < 2; ++i) {
    ConstraintPart& constraint = constraints[static_cast<std::size_t>(i)];
    constraint.form = ConstraintPart::Form::fixed_axis;
    constraint.from = from;
    constraint.to = to;
    constraint.axis = Vec<2>::Unit(i);
  }
  return constraints;
}

ConstraintPart angle_constraint(BodyId from, BodyId to, double offset) {
  ConstraintPart constraint;
  constraint.form = ConstraintPart::Form::angles;
  constraint.from = End<2>(from);
  constraint.to = End<2>(to);
  constraint.turn_from = -1.0;
  constraint.turn_to = 1.0;
  constraint.offset = offset;
  return constraint;
}

std::vector<ConstraintPart> Revolute::constraints(const PartCheck& check) const {
  check_joint_ends(check, from, to);
  const JointEnds ends = ends_of_point(check, from, to);
  if (std::isinf(zero_angle)) check.finite(zero_angle, "zero_angle", "rad");
  return point_constraints(ends.from, ends.to);
}

ConstraintPart Revolute::coordinate(const PartCheck& check) const {
  return angle_constraint(from.body, to.body,
                          relative_angle(check, zero_angle, from.body, to.body, "zero_angle"));
}

std::vector<ConstraintPart> Weld::constraints(const PartCheck& check) const {
  check_joint_ends(check, from, to);
  const JointEnds ends = ends_of_point(check, from, to);
  check_turning_end(check, from.body, "from");
  check_turning_end(check, to.body, "to");
  std::vector<ConstraintPart> constraints = point_constraints(ends.from, ends.to);
  constraints.push_back(
      angle_constraint(from.body, to.body, relative_angle(check, angle, from.body, to.body, "angle")));
  return constraints;
}

PartType<JointKind> Revolute::part_type() {
  return PartType<JointKind>::of<CompositeJointKind<Revolute>, Revolute>();
}
PartType<JointKind> Weld::part_type() { return PartType<JointKind>::of<CompositeJointKind<Weld>, Weld>(); }

}  // namespace carom::planar
