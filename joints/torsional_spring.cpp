#include <carom/joints/mean_line.h>
#include <carom/joints/torsional_spring.h>

namespace carom::planar {

std::vector<BodyId> TorsionalSpring::bodies() const { return {from, to}; }

void TorsionalSpring::check(const PartCheck& check) const {
  check_angular_ends(check, from, to);
  check.non_negative(stiffness, "stiffness", "N m/rad");
  check.non_negative(damping, "damping", "N m s/rad");
  check.finite(free_angle, "free_angle", "rad");
}

void TorsionalSpring::loads(const ElementView<2>& at, ElementLoads<2>& out) const {
  const RelativeAngle relative(at, from, to);
  const double elastic = stiffness * (relative.angle - free_angle);
  const double viscous = damping * relative.rate;
  out.conservative_torque(from, elastic);
  out.conservative_torque(to, -elastic);
  out.dissipative_torque(from, viscous);
  out.dissipative_torque(to, -viscous);
}

void TorsionalSpring::mean_loads(const ElementStep<2>& step, ElementLoads<2>& out) const {
  const MeanAngle mean(step, from, to);
  const double elastic = stiffness * (0.5 * (mean.start + mean.end) - free_angle) * mean.ratio;
  const double viscous = damping * mean.rate;
  out.conservative_torque(from, elastic);
  out.conservative_torque(to, -elastic);
  out.dissipative_torque(from, viscous);
  out.dissipative_torque(to, -viscous);
}

void TorsionalSpring::derivatives(const ElementView<2>&, ElementDerivatives<2>& out) const {
  out.opposite_torques(from, to, -stiffness, -damping);
}

double TorsionalSpring::potential(const ElementView<2>& at) const {
  const double twist = RelativeAngle(at, from, to).angle - free_angle;
  return 0.5 * stiffness * twist * twist;
}

void TorsionalSpring::fingerprint(Fingerprint& print) const {
  print.add(stiffness);
  print.add(damping);
  print.add(free_angle);
}

PartType<ForceKind> TorsionalSpring::part_type() {
  return PartType<ForceKind>::of<ForceElementKind<TorsionalSpring>, TorsionalSpring>();
}

}  // namespace carom::planar
