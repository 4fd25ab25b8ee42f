// Problem: projections take out what tolerances leave, and nothing else.

#include <carom/integrators/event_driven/constraint_projection.h>
#include <carom/integrators/event_driven/projection_stage.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace carom {

/// Errors within the tolerances are small, and near singular positions magnified by up to
/// 1/sqrt(dependent_pivot).
double ProjectionStage::project(const MotionSample& at, std::span<double> y, bool& changed,
                                EventBalance& balance) {
  const ConstraintProjection result = project_onto_constraints(*motion_, at, y);
  changed = result.changed;
  balance.shift = std::max(balance.shift, result.shift);
  const EventDriven& options = *motion_->model().options;
  const double tolerated = 0.5 * motion_->absolute_tolerances().back() * options.absolute_tolerance;
  if (!(result.velocity_energy > tolerated / dependent_pivot)) return result.lost;
  const double present = motion_->model().kinetic_energy(at.state.v.data());
  if (result.velocity_energy <= options.largest_projection * present) return result.lost;
  failure_->fail("projecting velocities onto the constraints changes " + to_text(result.velocity_energy) +
                     " J of " + to_text(present) + " J kinetic energy; allowed: up to largest_projection, " +
                     to_text(options.largest_projection) +
                     " of it. The position is singular, or too near one",
                 causes_of_projection(*motion_, at));
}

double ProjectionStage::apply_to_output(const MotionSample& at, std::span<double> y, EventBalance& balance) {
  bool changed = false;
  return project(at, y, changed, balance);
}

bool ProjectionStage::apply(const MotionSample& at, std::span<double> y, EventBalance& balance) {
  bool changed = false;
  balance.flows[EnergyFlow::projection] += project(at, y, changed, balance);
  return changed;
}

void ProjectionStage::apply_with_contact_stuck(std::size_t contact, const MotionSample& at,
                                               std::span<double> y, EventBalance& balance) {
  ContactMode& mode = motion_->active().list()[contact].mode;
  const ContactMode before = std::exchange(mode, ContactMode::stick);
  apply(at, y, balance);
  mode = before;
}

void ProjectionStage::apply_to_known_contacts(EventInstant& at) {
  constexpr double left_by_tolerances = 1e3;
  std::vector<ActiveContact>& list = motion_->active().list();
  const std::vector<ActiveContact> known = list;
  bool erased = false;  // the contact that rolling resistance belongs to
  std::erase_if(list, [&](ActiveContact& closed) {
    closed.at = at.contacts[closed.place];
    // Time stepping gives what sticks its tangential restitution.
    const double noise = left_by_tolerances * at.scales.noise_of(*motion_, closed.at);
    const bool slips = closed.sticks() && std::abs(closed.at.tangential_velocity(at.velocities())) > noise;
    if (closed.rolls()) return erased || slips;
    erased =
        slips || closed.at.gap > motion_->model().options->gap_tolerance ||
        std::abs(closed.at.normal_velocity(at.velocities())) > left_by_tolerances * at.scales.speed_noise;
    return erased;
  });
  if (!list.empty()) {
    motion_->sample(at.time, at.y.data(), Forces::all, at.now);
    if (at.now.has_forces) apply(at.now, at.y, at.balance);
  }
  list = known;
  at.update();
}

}  // namespace carom
