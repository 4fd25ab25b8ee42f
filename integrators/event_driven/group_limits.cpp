// Problem: a run that gets nowhere ends, and its error names the cause.

#include <carom/core/dynamics/coupling_rating.h>
#include <carom/core/dynamics/force_directions.h>
#include <carom/integrators/event_driven/group_limits.h>
#include <carom/integrators/run/time_resolution.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace carom {

namespace {

/// Names of the joints that almost follow from others where joints were last evaluated: near a singular
/// position, which the motion passes within some 0.01 rad; empty elsewhere.
std::vector<std::string> nearly_singular(const JointConstraints& joints, const System& system) {
  constexpr double near_pivot = 1e-4;  // the square of an angle
  std::vector<std::string> names;
  for (std::size_t joint = 0; joint < joints.pattern().size(); ++joint) {
    for (Index row = joints.pattern().first_row(joint); row < joints.pattern().first_row(joint + 1); ++row) {
      const double pivot = joints.factors().pivot(row);
      if (!(pivot > dependent_pivot && pivot < near_pivot)) continue;
      names.push_back(system.name(joints.joint(row)));
      break;
    }
  }
  return names;
}

const Constraint& contact_of(const ActiveContact& closed) { return closed.at; }

}  // namespace

void GroupLimits::start(double time) {
  for (const MotionUnknowns::Part& part : motion_->model().parts()) {
    counts_->events[part.component].start(time);
    counts_->steps[part.component].start(time);
  }
}

/// Counts one more of each component; true if that of any is too often.
bool GroupLimits::exceeds(std::vector<RateLimit>& counts, double most, double time) {
  bool too_often = false;
  for (const MotionUnknowns::Part& part : motion_->model().parts())
    too_often = counts[part.component].exceeds(most, time) || too_often;
  return too_often;
}

double GroupLimits::longest_step() const {
  // Free flight would allow steps of any length; gaps would then be small differences of large numbers.
  constexpr double longest_flight = 1.0;
  const bool foreseeable = !motion_->model().loads.depends_on_time && motion_->guards().all_have_motion();
  return foreseeable ? longest_flight : motion_->model().options->longest_step;
}

/// The gaps of a body that flies turn with it, and a step is halved so often only until they are searched:
/// what turns many times more within one step would hide a closing.
double GroupLimits::longest_step(std::span<const double> y) const {
  // [rad]; FallRule::deepest halvings leave 0.06 rad.
  constexpr double most_turning = 1000.0;
  double longest = longest_step();
  if (!motion_->is_ballistic()) return longest;
  const GroupModel& model = motion_->model();
  for (const MotionUnknowns::Part& part : model.parts()) {
    for (Index body = part.ranges.bodies.begin; body < part.ranges.bodies.end; ++body) {
      const BodySlot& slot = model.assembly->layout()->bodies()[body];
      if (slot.rotation == none) continue;
      const double spin = y[part.v + (slot.v + 2 - part.ranges.v.begin)];
      longest = std::min(longest, most_turning / std::abs(spin));
    }
  }
  return longest;
}

void GroupLimits::demand_reachable(double target) const {
  if (longest_step() >= shortest_step_at(target)) return;
  failure_->fail("steps of at most " + to_text(longest_step()) +
                     " s are lost in the rounding of times around " + to_text(target) + " s, the end",
                 {});
}

void GroupLimits::count_step(double time, const double* y, MotionSample& memory) {
  const GroupModel& model = motion_->model();
  const double limit = model.options->step_limit;
  if (!exceeds(counts_->steps, limit, time)) return;
  const std::string what = "more than " + to_text(limit) + " steps of the integrator per second (step_limit)";
  const System& system = model.assembly->system();
  motion_->sample(time, y, Forces::all, memory);
  for (const GroupJoints::Part& part : motion_->joints().rows().parts()) {
    std::vector<std::string> singular = nearly_singular(*part.joints, system);
    if (!singular.empty())
      failure_->fail(what + "; near a singular position of the joints", std::move(singular));
  }
  for (const auto& part : model.parts()) {
    const CouplingRating rating =
        rate_couplings(*model.assembly, part.component, memory.view(), memory.evaluation, 1.0 / limit);
    if (rating.worst.valid()) failure_->fail(what + ", stiffest is", {system.name(rating.worst)});
  }
  failure_->fail(what, {});
}

/// The event_limit that the last events would need, with twice their rate in two digits.
std::string GroupLimits::allowed_events(double time) const {
  double rate = 0.0;
  for (const MotionUnknowns::Part& part : motion_->model().parts()) {
    rate = std::max(rate, counts_->events[part.component].excessive_rate(time));
  }
  if (!std::isfinite(rate)) return "; the last ones are all at one instant";
  const double digit = std::pow(10.0, std::floor(std::log10(rate)) - 1.0);
  return "; allowed: " + to_text(digit * std::ceil(2.0 * rate / digit)) + " 1/s for those at hand";
}

void GroupLimits::count_event(const Event& event, const double* y, MotionSample& memory) {
  const GroupModel& model = motion_->model();
  if (!exceeds(counts_->events, model.options->event_limit, event.time)) return;
  motion_->sample(event.time, y, Forces::all, memory);
  std::string what = "more than " + to_text(model.options->event_limit) + " events per second (event_limit" +
                     allowed_events(event.time) + ")";
  // Where two ends have met, their line turns round by rounding, and with it the force, at one event after
  // the other.
  const ElementId lost = model.find_without_direction(memory, std::numeric_limits<double>::infinity());
  if (lost.valid()) what += "; " + tell_without_direction(*model.assembly, lost);
  failure_->fail(what, parts_of(event, memory));
}

/// Names of the contacts of bodies that touch, those whose forces are nearest to the end of their modes
/// first. \param island of the active set
std::vector<std::string> GroupLimits::names_by_margin(std::size_t island) const {
  ActiveSet& active = motion_->active();
  std::vector<ForceMargin> margins;
  active.margins(margins);
  std::vector<ActiveContact> closed = active.list();
  if (island < margins.size()) {
    const auto first = closed.begin() + static_cast<std::ptrdiff_t>(margins[island].first);
    closed = {first, closed.begin() + static_cast<std::ptrdiff_t>(margins[island].last)};
  }
  std::stable_sort(closed.begin(), closed.end(),
                   [](const ActiveContact& a, const ActiveContact& b) { return a.margin() < b.margin(); });
  return failure_->names(closed, contact_of);
}

/// Names of the parts of an event; empty where it is of no part, or of nothing that touches.
std::vector<std::string> GroupLimits::parts_of(const Event& event, const MotionSample& at) const {
  const System& system = motion_->model().assembly->system();
  if (event.guard == Guard::switching_point) return {system.name(motion_->guards().element(event.which))};
  const std::vector<ActiveContact>& closed = motion_->active().list();
  if (event.guard == Guard::slip || event.guard == Guard::feature)
    return {failure_->name(closed[event.which].at)};
  if (event.guard == Guard::gap) {
    SingleConstraint contact;
    motion_->contact(event.which, at, contact);
    return {failure_->name(contact)};
  }
  std::vector<std::string> names;
  if (event.guard == Guard::meeting) {
    SingleConstraint contact;
    for (std::size_t i = 0; i < motion_->model().pairs.size(); ++i) {
      if (motion_->model().pairs[i].rolling) continue;
      motion_->contact(i, at, contact);
      if (contact.gap <= motion_->model().options->gap_tolerance) names.push_back(failure_->name(contact));
    }
    return names;
  }
  return event.guard == Guard::force ? names_by_margin(event.which) : failure_->names(closed, contact_of);
}

void GroupLimits::fail_evaluations() const {
  failure_->fail("more than " + std::to_string(motion_->model().options->evaluation_limit) +
                     " evaluations within one step or event (evaluation_limit)",
                 {});
}

}  // namespace carom
