#include <carom/joints/applied_load.h>

namespace carom {

namespace generic {

template <int D>
PartType<ForceKind> AppliedForce<D>::part_type() {
  return PartType<ForceKind>::of<ForceElementKind<AppliedForce>, AppliedForce>();
}

template PartType<ForceKind> AppliedForce<2>::part_type();
template PartType<ForceKind> AppliedForce<3>::part_type();

}  // namespace generic

namespace planar {

std::vector<BodyId> AppliedTorque::bodies() const { return {on}; }

void AppliedTorque::check(const PartCheck& check) const {
  check.oriented_body(on, "on");
  if (!torque) check.refuse("torque", "not given", "a function of time");
  check.finite(torque(0.0), "torque at time 0", "N m");
}

void AppliedTorque::loads(const ElementView<2>& at, ElementLoads<2>& out) const {
  out.external_torque(on, torque(at.time()));
}

void AppliedTorque::derivatives(const ElementView<2>&, ElementDerivatives<2>&) const {}

void AppliedTorque::fingerprint(Fingerprint&) const {}

PartType<ForceKind> AppliedTorque::part_type() {
  return PartType<ForceKind>::of<ForceElementKind<AppliedTorque>, AppliedTorque>();
}

}  // namespace planar

}  // namespace carom
