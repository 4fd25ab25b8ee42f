#include <carom/joints/prismatic.h>
#include <carom/joints/revolute.h>

#include <array>
#include <cmath>

namespace carom::planar {

namespace {

ConstraintPart line_constraint(const JointEnds& ends, const Vec<2>& axis) {
  ConstraintPart constraint;
  constraint.form = ConstraintPart::Form::axis_of_from;
  constraint.from = ends.from;
  constraint.to = ends.to;
  constraint.axis = axis;
  return constraint;
}

/// The vector between the ends as described, in the frame of `from` [m].
Vec<2> described_distance(const System& system, const JointEnds& ends) {
  const DescribedPlace a = described_place(system, ends.from.body), b = described_place(system, ends.to.body);
  const Vec<2> between = b.point(ends.to.point) - a.point(ends.from.point);
  const std::array<double, 2> back{std::cos(a.angle), -std::sin(a.angle)};
  return Space<2>::rotate(back.data(), between);
}

/// The distance along an axis, less `zero` or, if that is not given, what it is as described.
ConstraintPart along(const PartCheck& check, const JointEnds& ends, const Vec<2>& axis, double zero) {
  ConstraintPart constraint = line_constraint(ends, axis);
  constraint.offset = std::isnan(zero) ? described_distance(check.system(), ends).dot(axis) : zero;
  return constraint;
}

Vec<2> across(const Vec<2>& axis) { return {-axis[1], axis[0]}; }

/// The direction of a line with that normal: the normal turned clockwise.
Vec<2> along_line(const Vec<2>& normal) { return {normal[1], -normal[0]}; }

void check_zero(const PartCheck& check, double zero) {
  if (std::isinf(zero)) check.finite(zero, "zero_distance", "m");
}

}  // namespace

std::vector<ConstraintPart> Prismatic::constraints(const PartCheck& check) const {
  check_joint_ends(check, from, to);
  check_turning_end(check, from.body, "from");
  check_turning_end(check, to.body, "to");
  const Vec<2> unit = checked_axis(check, axis, "axis");
  if (std::isinf(angle)) check.finite(angle, "angle", "rad");
  check_zero(check, zero_distance);
  double turn = angle;
  if (std::isnan(angle)) {
    turn = described_place(check.system(), to.body).angle - described_place(check.system(), from.body).angle;
  }
  return {line_constraint(ends_of_line(check, from, to, unit, 0.0), across(unit)),
          angle_constraint(from.body, to.body, turn)};
}

ConstraintPart Prismatic::coordinate(const PartCheck& check) const {
  const Vec<2> unit = checked_axis(check, axis, "axis");
  return along(check, ends_of_line(check, from, to, unit, 0.0), unit, zero_distance);
}

std::vector<ConstraintPart> PointOnLine::constraints(const PartCheck& check) const {
  check_joint_ends(check, from, to);
  // A line must be held at its angle: a particle cannot take the moment.
  check_turning_end(check, from.body, "from");
  check_zero(check, zero_distance);
  const Vec<2> unit = checked_axis(check, axis, "axis");
  return {line_constraint(ends_of_line(check, from, to, unit, 0.0), across(unit))};
}

ConstraintPart PointOnLine::coordinate(const PartCheck& check) const {
  const Vec<2> unit = checked_axis(check, axis, "axis");
  return along(check, ends_of_line(check, from, to, unit, 0.0), unit, zero_distance);
}

std::vector<ConstraintPart> Rolling::constraints(const PartCheck& check) const {
  check_joint_ends(check, from, to);
  check_turning_end(check, from.body, "from");
  check.oriented_body(to.body, "to");
  const Vec<2> unit = checked_axis(check, normal, "normal");
  check.positive(radius, "radius", "m");
  ConstraintPart apart = line_constraint(ends_of_line(check, from, to, along_line(unit), radius), unit);
  apart.offset = radius;
  // The place where the disc touches stands still on the line: turned clockwise it goes along the tangent.
  ConstraintPart roll = coordinate(check);
  roll.turn_to = radius;
  roll.turn_from = -radius;
  const System& system = check.system();
  roll.offset += radius * (described_place(system, to.body).angle - described_place(system, from.body).angle);
  return {apart, roll};
}

ConstraintPart Rolling::coordinate(const PartCheck& check) const {
  const Vec<2> unit = checked_axis(check, normal, "normal");
  return along(check, ends_of_line(check, from, to, along_line(unit), radius), along_line(unit),
               std::numeric_limits<double>::quiet_NaN());
}

PartType<JointKind> Prismatic::part_type() {
  return PartType<JointKind>::of<CompositeJointKind<Prismatic>, Prismatic>();
}
PartType<JointKind> PointOnLine::part_type() {
  return PartType<JointKind>::of<CompositeJointKind<PointOnLine>, PointOnLine>();
}
PartType<JointKind> Rolling::part_type() {
  return PartType<JointKind>::of<CompositeJointKind<Rolling>, Rolling>();
}

}  // namespace carom::planar
