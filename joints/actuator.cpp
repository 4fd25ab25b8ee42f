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

void ActuatorLaws::demand_given(const PartCheck& check) const {
  if (!law) check.refuse(name, "not given", "a function of time, " + coordinate + " and rate");
}

void ActuatorLaws::demand_finite(const PartCheck& check, double x, double rate) const {
  const std::string& per = unit_of_coordinate;
  const std::string place = " at time 0, " + coordinate + " " + to_text(x) + " " + per + ", rate " +
                            to_text(rate) + " " + per + "/s";
  const auto demand = [&](const ActuatorLaw& one, const std::string& of, const std::string& its_unit) {
    if (one) check.finite(one(0.0, x, rate), of + place, its_unit);
  };
  demand(law, name, unit);
  demand(by_coordinate, name + "_by_" + coordinate, unit + "/" + per);
  demand(by_rate, name + "_by_rate", unit + " s/" + per);
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
  const ActuatorLaws laws{torque, torque_by_angle, torque_by_rate, "torque", "N m", "angle", "rad"};
  laws.demand_given(check);
  const RelativeAngle start(check.system(), from, to);
  laws.demand_finite(check, start.angle, start.rate);
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
