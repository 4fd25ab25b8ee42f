// Problem: read off a state all that may end a smooth phase, with its rounding.

#include <carom/integrators/event_driven/detection_memory.h>
#include <carom/integrators/event_driven/group_closure.h>
#include <carom/integrators/event_driven/group_gaps.h>
#include <carom/integrators/event_driven/step_ends.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace carom {

namespace {

// Where closed contacts follow from each other, forces just decided may lie this many times their rounding
// below zero.
constexpr double roundoff_growth = 16.0;

/// Samples the gaps of open pairs. False if one is not finite.
bool sample_gaps(const SmoothMotion& motion, std::span<const char> is_active, const MotionSample& at,
                 StepEnd& out) {
  out.gaps.resize(motion.model().pairs.size());
  const StateView state = at.view();
  bool finite = true;
  SingleConstraint contact;
  for (std::size_t i = 0; i < motion.model().pairs.size(); ++i) {
    if (is_active[i] != 0 || motion.model().bound_of(i) != none) continue;
    motion.contact(i, at, contact);
    const Constraint::Block& body = contact.blocks[0];
    const double spin = body.columns > 2 ? state.v[body.v + 2] : 0.0;
    // A point on an arm r that turns at w: its place has the sixth derivative w^6 r, its drift is w^2 r.
    out.gaps[i] = {
        {contact.gap, contact.normal_velocity(state.v), contact.normal_acceleration(at.acceleration.data())},
        spin * spin * spin * spin * std::hypot(contact.drift[0], contact.drift[1])};
    finite = finite && std::isfinite(out.gaps[i].second);
  }
  return sample_body_gaps(motion, is_active, at, out) && finite;
}

/// Finds what the projection at the end of a step will raise gaps by that the flow has let fall below zero.
/// Two corners, or two round ends, that touch each other have several gaps that are the same: one of them is
/// closed and carries the force, and would seem to be hit by the others with each step of low order. A gap
/// that still approaches once the velocities are projected too does close, and is met where it does.
void find_drifts(SmoothMotion& motion, std::span<const char> is_active, const MotionSample& at,
                 StepEnd& out) {
  const GroupModel& model = motion.model();
  if (motion.active().list().empty() && motion.joints().rows().empty()) return;
  bool known = false;
  SingleConstraint contact;
  for (std::size_t i = 0; i < out.gaps.size(); ++i) {
    if (is_active[i] != 0 || !(out.gaps[i].value < 0.0)) continue;
    const Index bound = model.bound_of(i);
    if (bound != none && !out.body_gaps[bound].known) continue;
    if (!known && !find_closure(motion, at)) return;
    known = true;
    motion.contact(i, at, contact);
    const double rate = out.gaps[i].first + contact.times(0, motion.memory().closure.of_velocity.data());
    if (rate < -speed_noise_of(contact.speed(0, at.state.v.data()), model.options->absolute_tolerance))
      continue;
    const double raised = contact.times(0, motion.memory().closure.of_position.data());
    out.gaps[i].drift = std::clamp(raised, 0.0, model.options->gap_tolerance);
  }
}

}  // namespace

double StepEnds::gap_level(std::size_t pair) const {
  return std::min(0.0, start().gaps[pair].value) - end().gaps[pair].drift;
}

double StepEnds::closing_level(std::size_t pair, double slowest, double deepest) const {
  constexpr double well_above = 4.0;  // of its depth
  const GapEnd& at = start().gaps[pair];
  const double depth = -at.value, fall = std::max(0.0, -at.second);
  const bool leaves =
      at.first > slowest && depth <= deepest && 0.5 * at.first * at.first > well_above * depth * fall;
  return leaves ? 0.0 : gap_level(pair);
}

double StepEnds::slip_level(std::size_t contact) const {
  return std::min(0.0, start().sample.slips[contact].value);
}

double StepEnds::feature_level(std::size_t contact) const {
  return std::min(0.0, start().sample.features[contact].value);
}

double StepEnds::force_level(std::size_t island) const {
  return std::clamp(start().sample.margins[island], -roundoff_growth * start().noises[island], 0.0);
}

double StepEnds::force_noise(std::size_t island) const {
  return std::max(start().noises[island], end().noises[island]);
}

namespace {

/// Margins of the features that closed contacts of two bodies are in; far of contacts with one feature.
void read_features(const SmoothMotion& motion, const MotionSample& at, GuardSample& out) {
  constexpr StepPolynomial::End far{std::numeric_limits<double>::max(), 0.0, 0.0};
  const std::vector<ActiveContact>& closed = motion.active().list();
  out.features.clear();
  if (motion.model().bounds.empty()) return;
  out.features.resize(closed.size());
  for (std::size_t i = 0; i < closed.size(); ++i) {
    out.features[i] = far;
    if (closed[i].feature == none) continue;
    const FeatureRegions regions = motion.regions(closed[i].pair, at);
    const FeatureMargin margin = regions.margin(closed[i].feature);
    out.features[i] = {margin.value + regions.border(), margin.rate, 0.0};
  }
}

}  // namespace

void read_guard_sample(SmoothMotion& motion, const MotionSample& at, std::vector<ForceMargin>& margins,
                       GuardSample& out) {
  const std::vector<ActiveContact>& closed = motion.active().list();
  out.slips.resize(closed.size());
  for (std::size_t i = 0; i < closed.size(); ++i) {
    const TangentDirection slip = closed[i].slip_direction();
    out.slips[i] = {velocity_along(closed[i].at, slip, at.state.v.data()),
                    acceleration_along(closed[i].at, slip, at.acceleration.data()), 0.0};
  }
  read_features(motion, at, out);
  motion.active().margins(margins);
  out.margins.resize(margins.size());
  for (std::size_t i = 0; i < out.margins.size(); ++i) out.margins[i] = margins[i].margin;
  out.guards.clear();
  if (motion.guards().count() != 0) motion.read_guards(at, out.guards);
}

bool sample_step_end(SmoothMotion& motion, double time, const double* y, std::span<const char> is_active,
                     const EventScales& scales, DetectionMemory& memory, StepEnd& out) {
  MotionSample& at = memory.within;
  motion.sample(time, y, Forces::all, at);
  out.independent = motion.active().pivots().size();
  bool finite = sample_gaps(motion, is_active, at, out) && at.has_forces;
  out.sample.time = time;
  if (motion.guards().count() != 0) {
    if (!out.path) out.path = std::make_unique<PathEnd>();
    out.path->time = time;
    out.path->y.assign(y, y + motion.size());
    out.path->acceleration.resize(motion.model().unknowns.v_size());
    motion.model().unknowns.for_velocities([&](Range v, std::size_t place) {
      std::copy_n(at.acceleration.begin() + v.begin, v.size(), out.path->acceleration.data() + place);
    });
  }
  read_guard_sample(motion, at, memory.margins, out.sample);
  for (const StepPolynomial::End& slip : out.sample.slips) finite = finite && std::isfinite(slip.first);
  out.noises.clear();
  // Where there are no loads all forces are rounding: of the mass times the tolerance of accelerations.
  const double no_force = 0.1 * motion.absolute_tolerances().back();
  for (const ForceMargin& margin : memory.margins) {
    double size = 0.0;
    for (std::size_t i = margin.first; i < margin.last; ++i) {
      const ActiveContact& closed = motion.active().list()[i];
      size += std::abs(closed.normal) + closed.tangential_force();
    }
    out.noises.push_back(scales.force_rounding * std::max(size, scales.force) + no_force);
  }
  if (finite) find_drifts(motion, is_active, at, out);
  return finite;
}

}  // namespace carom
