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
