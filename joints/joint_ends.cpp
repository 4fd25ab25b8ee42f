#include <carom/core/body_kind.h>
#include <carom/core/registry.h>
#include <carom/core/vector_length.h>
#include <carom/joints/joint_ends.h>

#include <array>
#include <cmath>

namespace carom::planar {

Vec<2> DescribedPlace::point(const Vec<2>& local) const {
  const std::array<double, 2> rotation{std::cos(angle), std::sin(angle)};
  return position + Space<2>::rotate(rotation.data(), local);
}

DescribedPlace described_place(const System& system, BodyId body) {
  DescribedPlace place;
  if (body == ground) return place;
  const Registry<BodyKind>& registry = system.body_kinds();
  const BodyKind& kind = registry.kind_of(body.serial);
  std::array<double, 3> q{}, v{};
  kind.initial(registry.place(body.serial).slot, q.data(), v.data());
  place.position = {q[0], q[1]};
  if (kind.has_orientation()) place.angle = q[2];
  return place;
}

void check_joint_ends(const PartCheck& check, const End<2>& from, const End<2>& to) {
  check_end(check, from, "from");
  check_end(check, to, "to");
  check.different_ends(from.body, to.body);
}

namespace {

/// True of an end on ground that was given without a point.
bool is_unplaced(const End<2>& end) { return end.body == ground && !end.has_point && end.point.isZero(0.0); }

/// An end as described, in the fixed frame [m].
Vec<2> described_point(const PartCheck& check, const End<2>& end) {
  return described_place(check.system(), end.body).point(end.point);
}

}  // namespace

JointEnds ends_of_point(const PartCheck& check, const End<2>& from, const End<2>& to) {
  if (is_unplaced(from)) return {End<2>(ground, described_point(check, to)), to};
  if (is_unplaced(to)) return {from, End<2>(ground, described_point(check, from))};
  return {from, to};
}

JointEnds ends_of_line(const PartCheck& check, const End<2>& from, const End<2>& to, const Vec<2>& axis,
                       double distance) {
  const Vec<2> along = DescribedPlace{.angle = described_place(check.system(), from.body).angle}.point(axis);
  const Vec<2> across(-along[1], along[0]);
  const auto nearest = [&](const Vec<2>& of, double off) {
    return End<2>(ground, across * (across.dot(of) + off));
  };
  if (is_unplaced(from)) return {nearest(described_point(check, to), -distance), to};
  if (is_unplaced(to)) return {from, nearest(described_point(check, from), distance)};
  return {from, to};
}

Vec<2> checked_axis(const PartCheck& check, const Vec<2>& axis, std::string_view quantity) {
  check.direction({axis.data(), 2}, quantity);
  const double length = length_of<2>(axis);  // squares of what is far from 1 over- or underflow
  if (!(length > 0.0)) check.refuse(quantity, "(0, 0)", "an axis of any length > 0");
  return axis / length;
}

void check_turning_end(const PartCheck& check, BodyId body, std::string_view quantity) {
  if (body != ground) check.oriented_body(body, quantity);
}

}  // namespace carom::planar
