// Problem: take what is left against the constraints out of an island's motion, and no more than that.

#include <carom/integrators/event_driven/island_driver.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace carom {

/// Projects a state that the workspace holds an evaluation of; returns the energy taken out. What tolerances
/// leave is small, and near singular positions magnified by up to 1/sqrt(dependent_pivot).
double IslandDriver::project(std::span<double> y, bool& changed, DriverNews& news) {
  const double lost = motion_.project(y, changed, news.shift);
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

bool IslandDriver::settle(DriverNews& news) {
  bool changed = false;
  news.flows[EnergyFlow::projection] += project(y_, changed, news);
  return changed;
}

/// A run that goes on from a state within a phase takes out what the tolerances left of the contacts known to
/// be closed there; a lift-off or an impact would be made of it. The workspace holds an evaluation.
void IslandDriver::settle_known(DriverNews& news) {
  constexpr double left_by_tolerances = 1e3;
  std::vector<ClosedContact>& list = motion_.closed().list();
  const std::vector<ClosedContact> known = list;
  const double* const velocity = work_->motion.trial.v.data();
  std::erase_if(list, [&](ClosedContact& closed) {
    const auto pair = std::find(motion_.pairs().begin(), motion_.pairs().end(), closed.pair);
    closed.at = work_->contacts[static_cast<std::size_t>(pair - motion_.pairs().begin())];
    return closed.at.gap > options_.gap_tolerance ||
           std::abs(closed.at.velocity(0, velocity)) > left_by_tolerances * speed_noise();
  });
  if (!list.empty() && motion_.evaluate(time_, y_.data(), true)) settle(news);
  list = known;
  motion_.evaluate(time_, y_.data(), false);
  locate_contacts();
}

/// Contacts that have just stopped slipping are projected as sticking, with all that can only move with them.
void IslandDriver::settle_stopped(DriverNews& news) {
  ContactMode& mode = motion_.closed().list()[next_.which].mode;
  const ContactMode before = std::exchange(mode, ContactMode::stick);
  settle(news);
  mode = before;
}

}  // namespace carom
