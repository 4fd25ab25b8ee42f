#include <carom/core/difference_derivatives.h>
#include <carom/joints/actuator.h>

#include <algorithm>
#include <cmath>

namespace carom {

ActuatorSlopes::ActuatorSlopes(const ActuatorLaw& law, const ActuatorLaw& by_coordinate,
                               const ActuatorLaw& by_rate, double time, double x, double rate, double size)
    : by_x(by_coordinate
               ? by_coordinate(time, x, rate)
               : difference_quotient([&](double moved) { return law(time, moved, rate); }, x, size)),
      by_speed(by_rate ? by_rate(time, x, rate)
                       : difference_quotient([&](double faster) { return law(time, x, faster); }, rate,
                                             std::max(1.0, std::abs(rate)))) {}

void check_actuator_law(const PartCheck& check, const ActuatorLaw& law, const std::string& name,
                        const std::string& unit, const std::string& place, double x, double rate) {
  if (law) check.finite(law(0.0, x, rate), name + " at time 0, " + place, unit);
}

namespace generic {

template <int D>
PartType<ForceKind> LinearActuator<D>::part_type() {
  return PartType<ForceKind>::of<ForceElementKind<LinearActuator>, LinearActuator>();
}

template PartType<ForceKind> LinearActuator<2>::part_type();
template PartType<ForceKind> LinearActuator<3>::part_type();

}  // namespace generic

namespace planar {

std::vector<BodyId> RotaryActuator::bodies() const { return {from, to}; }

void RotaryActuator::check(const PartCheck& check) const {
  check_angular_ends(check, from, to);
  if (!torque) check.refuse("torque", "not given", "a function of time, angle and rate");
  const RelativeAngle start(check.system(), from, to);
  const std::string place = "angle " + to_text(start.angle) + " rad, rate " + to_text(start.rate) + " rad/s";
  const auto try_law = [&](const ActuatorLaw& law, const char* name, const char* unit) {
    check_actuator_law(check, law, name, unit, place, start.angle, start.rate);
  };
  try_law(torque, "torque", "N m");
  try_law(torque_by_angle, "torque_by_angle", "N m/rad");
  try_law(torque_by_rate, "torque_by_rate", "N m s/rad");
}

void RotaryActuator::loads(const ElementView<2>& at, ElementLoads<2>& out) const {
  const RelativeAngle relative(at, from, to);
  const double turn = torque(at.time(), relative.angle, relative.rate);
  out.external_torque(from, -turn);
  out.external_torque(to, turn);
}

void RotaryActuator::derivatives(const ElementView<2>& at, ElementDerivatives<2>& out) const {
  const RelativeAngle now(at, from, to);
  const ActuatorSlopes slopes(torque, torque_by_angle, torque_by_rate, at.time(), now.angle, now.rate,
                              std::max(1.0, std::abs(now.angle)));
  out.opposite_torques(from, to, slopes.by_x, slopes.by_speed);
}

void RotaryActuator::fingerprint(Fingerprint&) const {}

PartType<ForceKind> RotaryActuator::part_type() {
  return PartType<ForceKind>::of<ForceElementKind<RotaryActuator>, RotaryActuator>();
}

}  // namespace planar

}  // namespace carom
