// Problem: take what is left against the constraints out of a component's motion, and no more than that.

#include <carom/integrators/event_driven/clock_group.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace carom {

/// Projects a state that the workspace holds an evaluation of; returns the energy taken out. What tolerances
/// leave is small, and near singular positions magnified by up to 1/sqrt(dependent_pivot).
double ClockGroup::project(std::span<double> y, bool& changed, EventBalance& balance) {
  const double lost = motion_.project(y, changed, balance.shift);
  const double taken = motion_.projection_energy();
  const double tolerated = 0.5 * motion_.absolute_tolerances().back() * options_.absolute_tolerance;
  if (!(taken > tolerated / dependent_pivot)) return lost;
  const double present = motion_.total_kinetic_energy();
  if (taken <= options_.largest_projection * present) return lost;
  fail("projecting velocities onto the constraints changes " + to_text(taken) + " J of " + to_text(present) +
           " J kinetic energy; allowed: up to largest_projection, " + to_text(options_.largest_projection) +
           " of it. The position is singular, or too near one",
       motion_.projected_by());
}

bool ClockGroup::project_onto_constraints(EventBalance& balance) {
  bool changed = false;
  balance.flows[EnergyFlow::projection] += project(y_, changed, balance);
  return changed;
}

/// A run that goes on from a state within a phase takes out what the tolerances left of the contacts known to
/// be closed there; a lift-off or an impact would be made of it. The workspace holds an evaluation.
void ClockGroup::project_known_contacts(EventBalance& balance) {
  constexpr double left_by_tolerances = 1e3;
  std::vector<ActiveContact>& list = motion_.active().list();
  const std::vector<ActiveContact> known = list;
  const double* const velocity = work_->motion.trial.v.data();
  std::erase_if(list, [&](ActiveContact& closed) {
    closed.at = work_->contacts[closed.place];
    return closed.at.gap > options_.gap_tolerance ||
           std::abs(closed.at.normal_velocity(velocity)) > left_by_tolerances * speed_noise();
  });
  if (!list.empty() && motion_.evaluate(time_, y_.data(), true)) project_onto_constraints(balance);
  list = known;
  motion_.evaluate(time_, y_.data(), false);
  locate_contacts();
}

/// Contacts that have just stopped slipping are projected as sticking, with all that can only move with them.
void ClockGroup::project_with_contact_stuck(EventBalance& balance) {
  ContactMode& mode = motion_.active().list()[next_.which].mode;
  const ContactMode before = std::exchange(mode, ContactMode::stick);
  project_onto_constraints(balance);
  mode = before;
}

}  // namespace carom
