#include <carom/joints/rod.h>

#include <cmath>

namespace carom::planar {

std::vector<Binding> Rod::bindings(const PartCheck& check) const {
  check_joint_ends(check, from, to);
  Binding binding;
  binding.form = Binding::Form::distance;
  binding.from = from;
  binding.to = to;
  const System& system = check.system();
  const double described = (described_place(system, to.body).point(to.point) -
                            described_place(system, from.body).point(from.point))
                               .norm();
  binding.offset = std::isnan(length) ? described : length;
  check.positive(binding.offset, "length", "m");
  // Without a distance there is no direction to push in.
  if (!(described > 0.0)) check.refuse("distance of the ends as described", "0 m", "a distance > 0");
  return {binding};
}

std::vector<Binding> Gear::bindings(const PartCheck& check) const {
  check.oriented_body(from, "from");
  check.oriented_body(to, "to");
  check.different_ends(from, to);
  check_turning_end(check, carrier, "carrier");
  if (carrier == from || carrier == to)
    check.refuse("carrier", check.system().name(carrier), "another body than from and to");
  check.finite(ratio, "ratio", "");
  if (ratio == 0.0) check.refuse("ratio", "0", "a ratio that is not 0");
  Binding binding;
  binding.from = End<2>(from);
  binding.to = End<2>(to);
  binding.carrier = carrier;
  binding.turn_from = ratio;
  binding.turn_to = 1.0;
  binding.turn_carrier = -(1.0 + ratio);
  const System& system = check.system();
  binding.offset = binding.turn_to * described_place(system, to).angle +
                   binding.turn_from * described_place(system, from).angle +
                   binding.turn_carrier * described_place(system, carrier).angle;
  return {binding};
}

}  // namespace carom::planar
