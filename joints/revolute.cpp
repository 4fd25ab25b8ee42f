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

std::vector<Binding> point_bindings(const End<2>& from, const End<2>& to) {
  std::vector<Binding> bindings(2);
  for (int i = 0; i < 2; ++i) {
    Binding& binding = bindings[static_cast<std::size_t>(i)];
    binding.form = Binding::Form::fixed_axis;
    binding.from = from;
    binding.to = to;
    binding.axis = Vec<2>::Unit(i);
  }
  return bindings;
}

Binding angle_binding(BodyId from, BodyId to, double offset) {
  Binding binding;
  binding.form = Binding::Form::angles;
  binding.from = End<2>(from);
  binding.to = End<2>(to);
  binding.turn_from = -1.0;
  binding.turn_to = 1.0;
  binding.offset = offset;
  return binding;
}

std::vector<Binding> Revolute::bindings(const PartCheck& check) const {
  check_joint_ends(check, from, to);
  if (std::isinf(zero_angle)) check.finite(zero_angle, "zero_angle", "rad");
  return point_bindings(from, to);
}

Binding Revolute::coordinate(const PartCheck& check) const {
  return angle_binding(from.body, to.body,
                       relative_angle(check, zero_angle, from.body, to.body, "zero_angle"));
}

std::vector<Binding> Weld::bindings(const PartCheck& check) const {
  check_joint_ends(check, from, to);
  check_turning_end(check, from.body, "from");
  check_turning_end(check, to.body, "to");
  std::vector<Binding> bindings = point_bindings(from, to);
  bindings.push_back(
      angle_binding(from.body, to.body, relative_angle(check, angle, from.body, to.body, "angle")));
  return bindings;
}

}  // namespace carom::planar
