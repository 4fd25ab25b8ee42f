#include <carom/contact/impact_restitution.h>

#include <carom/contact/impulse_map.h>

namespace carom {

namespace {

// Where contact and friction move together (a mechanism of one degree of freedom), both mean velocities
// vanish and every friction impulse within its bound leads to the same motion. A restitution that is
// less by ten times what answers are certified to (1e-12) chooses the one against the rate after the impact.
constexpr double chooses_rate_after = 1.0 - ImpulseWork::joint_restitution_lack;

}  // namespace

void share_impact_restitution(std::span<Constraint> contacts, const double* velocities, double least_speed) {
  double fastest = least_speed, restitution = 0.0;
  for (const Constraint& contact : contacts) {
    const double approach = -contact.normal_velocity(velocities);
    if (!(approach > fastest)) continue;
    fastest = approach;
    restitution = contact.law.normal_restitution;
  }
  for (Constraint& contact : contacts) {
    if (contact.has_given_bound()) contact.law.tangential_restitution = chooses_rate_after * restitution;
  }
}

}  // namespace carom
