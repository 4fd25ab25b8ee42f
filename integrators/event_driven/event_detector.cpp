// Problem: no event of a step is missed, and none is made of rounding.

#include <carom/core/discontinuity.h>
#include <carom/core/numerics/never.h>
#include <carom/integrators/event_driven/event_detector.h>
#include <carom/integrators/event_driven/event_location.h>
#include <carom/integrators/event_driven/group_gaps.h>
#include <carom/integrators/event_driven/path_check.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace carom {

namespace {

/// The first discontinuity after a time; infinity if there is none.
double next_discontinuity(const std::vector<Discontinuity>& all, double time) {
  const auto next = std::upper_bound(all.begin(), all.end(), time,
                                     [](double t, const Discontinuity& at) { return t < at.time; });
  return next == all.end() ? never : next->time;
}

/// Steps end this far in front of a discontinuity, in rounding of times: laws of time, and what these round,
/// are in all of the step what they are before it [s].
double distance_in_front(double discontinuity, double time) {
  constexpr double roundings = 4.0;
  return roundings * std::numeric_limits<double>::epsilon() *
         std::max(std::abs(discontinuity), std::abs(time));
}

/// True of a false alarm from which nothing is gained by going on anew.
bool makes_no_progress(const SearchedStep& step, const Event& event) {
  constexpr double no_progress = 0.01;  // of the step
  return event.guard == Guard::restart &&
         event.time - step.begin() <= no_progress * (step.end() - step.begin());
}

}  // namespace

void EventDetector::start() {
  guards_.forget(motion_->guards().count());
  landing_.time = never;
}

void EventDetector::begin_phase(double time, const double* y, const EventScales& scales) {
  scales_ = scales;
  list_active();
  take_features(time, y);
  if (!sample_step_end(*motion_, time, y, memory_->is_active, scales_, *memory_, start_)) {
    failure_->fail_loads(memory_->within);
  }
  guards_.update(start_.sample.guards, scales_.guard_noise);
}

void EventDetector::list_active() {
  memory_->is_active.assign(motion_->model().pairs.size(), 0);
  for (const ActiveContact& contact : motion_->active().list()) memory_->is_active[contact.place] = 1;
  // Rolling resistance has no gap of its own, and a point none at a corner.
  for (std::size_t i = 0; i < memory_->is_active.size(); ++i) {
    if (motion_->model().pairs[i].rolling) memory_->is_active[i] = 1;
  }
  for (const BodyPairBound& bound : motion_->model().bounds) {
    if (!bound.closes_alone()) memory_->is_active[bound.pair] = 1;
  }
}

/// Takes the features that vertices touch for those of the phase.
void EventDetector::take_features(double time, const double* y) {
  bool sampled = false;
  for (ActiveContact& closed : motion_->active().list()) {
    closed.feature = none;
    if (!closed.pair.has_outline()) continue;
    if (!sampled) motion_->sample(time, y, Forces::without_contact, memory_->within);
    sampled = true;
    const FeatureRegions regions = motion_->regions(closed.pair, memory_->within);
    if (!regions.has_several()) continue;
    closed.feature = regions.coming(scales_.speed_noise, margin_noise(scales_));
  }
}

/// Between its steps a group has one end: where there is no event, that of the last step.
Event EventDetector::step(Flow& flow, double time, std::span<const double> y, double longest) {
  StepEnds& ends = memory_->ends;
  std::swap(start_, ends.start());
  list_active();
  longest = std::min(longest, longest_searched(*motion_, memory_->is_active, ends.start()));
  const Event event = search(flow, time, y, longest);
  force_noise_ = event.guard == Guard::force ? ends.force_noise(event.which) : 0.0;
  std::swap(start_, event.guard == Guard::nothing ? ends.end() : ends.start());
  return event;
}

Event EventDetector::search(Flow& flow, double time, std::span<const double> y, double longest) {
  const double discontinuity = next_discontinuity(motion_->model().discontinuities, time);
  const bool is_ahead = discontinuity < never;
  const double in_front = is_ahead ? distance_in_front(discontinuity, time) : 0.0;
  const double until = is_ahead ? discontinuity - time - in_front : never;
  if (until <= in_front) return discontinuity_at(discontinuity, y);
  SearchedStep step{*motion_, flow, memory_->ends, scales_, guards_, memory_->is_active, *memory_};
  for (;;) {
    try {
      flow.advance(std::min(longest, until));
    } catch (const RunError& error) {
      if (!finds_unbounded_force(flow.end(), flow.state().data(), UnboundedForces::least_growth))
        failure_->fail_flow(error, *motion_, y.data(), memory_->within);
      return unbounded_at(time, y, error.what());
    }
    if (!sample_step_end(*motion_, flow.end(), flow.state().data(), memory_->is_active, scales_, *memory_,
                         memory_->ends.end())) {
      failure_->fail_loads(memory_->within);
    }
    if (comes_to_pole(time, y))
      return unbounded_at(time, y, "closed contacts come to follow from each other");
    memory_->samples.forget();
    memory_->path_samples.forget();
    memory_->accelerations.forget();
    landing_.time = never;
    const Event event = first(step);
    if (makes_no_progress(step, event) && finds_unbounded_force(flow.end(), flow.state().data())) {
      return unbounded_at(time, y, "steps have no length any more");
    }
    if (repeat_shorter(step, event, time, y)) continue;
    if (event.guard != Guard::nothing || flow.end() < discontinuity - 2.0 * in_front) return event;
    return discontinuity_at(discontinuity, flow.state());
  }
}

/// True if the flow was started anew, for a shorter step.
bool EventDetector::repeat_shorter(SearchedStep& step, const Event& event, double time,
                                   std::span<const double> y) {
  // Forces that were infinite within the step: steps nearer to there sample their growth.
  constexpr double nearer = 0.25, shorter = 0.5;
  if (event.guard == Guard::painleve) {
    step.flow.start(time, y, nearer * (event.time - time));
    return true;
  }
  // A false alarm at the start of a step, as beside a force that is nothing over nothing: a new start from
  // there would have the same, without end. Shorter steps sample what made it.
  if (makes_no_progress(step, event)) {
    step.flow.start(time, y, nearer * (step.end() - step.begin()));
    return true;
  }
  if (event.guard != Guard::missed_loads && !lands_off_path(step, event, landing_)) return false;
  step.flow.start(time, y, shorter * (event.time - time));
  return true;
}

/// The event of a discontinuity, behind the end of a step, or behind another one, by the rounding of times.
Event EventDetector::discontinuity_at(double time, std::span<const double> y) {
  landing_.time = time;
  landing_.y.assign(y.begin(), y.end());
  return {time, Guard::discontinuity, 0};
}

/// The event of a flow that cannot go on before forces without bound: where it stands.
Event EventDetector::unbounded_at(double time, std::span<const double> y, std::string reason) {
  unbounded_->set_reason(std::move(reason));
  landing_.time = time;
  landing_.y.assign(y.begin(), y.end());
  return {time, Guard::painleve, 0};
}

/// \param growth of forces, against those of the neighbourhood
bool EventDetector::finds_unbounded_force(double time, const double* y, double growth) {
  motion_->sample(time, y, Forces::all, memory_->within);
  return unbounded_->find(motion_->active().list(), growth * scales_.force);
}

/// True if forces without bound come to an end within the step because closed contacts follow from each other
/// there, to rounding: the forces that are found then are small, but keep no contact.
bool EventDetector::comes_to_pole(double time, std::span<const double> y) {
  return memory_->ends.end().independent < memory_->ends.start().independent &&
         finds_unbounded_force(time, y.data());
}

Event EventDetector::first(SearchedStep& step) {
  FalseAlarms& passed_over = memory_->passed_over;
  passed_over.gaps.assign(step.ends.end().gaps.size(), step.begin());
  passed_over.forces.assign(step.ends.end().sample.margins.size(), 0);
  for (;;) {
    const Event predicted = predict_event(step, passed_over);
    if (step.has_guards() && misses_loads(step, predicted.time)) {
      return {predicted.time, Guard::missed_loads, 0};
    }
    if (predicted.guard == Guard::nothing) return predicted;
    const Event located = locate_event(step, predicted, landing_);
    if (located.guard != Guard::restart) return first_of(step, predicted, located);
    if (lowers_level(step, predicted)) continue;
    if (!is_false_alarm(step, predicted, located)) return located;
    pass_over(step, predicted);
  }
}

/// A gap that is open at the begin of a step is looked at from a little later on, at ever larger distances:
/// it may open and close again, within the step too.
void EventDetector::pass_over(const SearchedStep& step, const Event& predicted) {
  if (predicted.guard == Guard::force) {
    memory_->passed_over.forces[predicted.which] = 1;
    return;
  }
  constexpr double shortest = 1e-9, growth = 4.0;  // of the step
  const double length = step.end() - step.begin();
  double& from = memory_->passed_over.gaps[predicted.which];
  from = std::min(step.begin() + std::max(shortest * length, growth * (from - step.begin())), step.end());
}

/// True if the step can be kept although a predicted event is not there.
bool EventDetector::is_false_alarm(SearchedStep& step, const Event& predicted, const Event& located) {
  // A force at the very start: within such a step p = W_nn - s mu W_nt passes zero together with the load,
  // and the flow does not know the force in between.
  if (predicted.guard == Guard::force && !(located.time > step.begin()) &&
      !finds_unbounded_force(step.flow.end(), step.flow.state().data()))
    return true;
  // A gap with an outline may open and close again where the nearest feature changes.
  return predicted.guard == Guard::gap && !(located.time > step.begin());
}

/// True of a gap that does not close although its value falls: within steps of low order values and rates
/// contradict each other by up to the tolerance. The step is searched once more for what is deeper than that.
bool EventDetector::lowers_level(const SearchedStep& step, const Event& predicted) {
  constexpr double growth = 4.0;
  if (predicted.guard != Guard::gap || step.is_exact(predicted.which)) return false;
  if (step.ends.start().gaps[predicted.which].first < -scales_.speed_noise) return false;
  double& drift = memory_->ends.end().gaps[predicted.which].drift;
  const double deepest = motion_->model().options->gap_tolerance;
  if (drift >= deepest) return false;
  drift = std::min(growth * std::max(drift, scales_.gap_noise), deepest);
  return true;
}

/// Gaps that move are predicted to rounding, other guards to a part of a step, and so are gaps that hardly
/// move, as of a contact that opens beside one that stays closed: an event that is located later than it was
/// predicted may lie behind the closing of another gap.
Event EventDetector::first_of(SearchedStep& step, const Event& predicted, const Event& located) {
  constexpr double as_predicted = 1e-9;  // of the step
  const double length = step.end() - step.begin();
  if (located.time - predicted.time <= as_predicted * length) return located;
  std::vector<double>& from = memory_->passed_over.gaps;  // of no use behind the first event
  Event first = located, known = predicted;
  for (;;) {
    if (known.guard == Guard::gap) from[known.which] = step.end();
    known = predict_gap(step, memory_->passed_over, first);
    if (!(known.time < first.time)) return first;
    const Event closing = locate_event(step, known, landing_);
    if (closing.guard == Guard::gap && closing.time < first.time) first = closing;
  }
}

void EventDetector::accept() { guards_.update(start_.sample.guards, scales_.guard_noise); }

void EventDetector::land(Flow& flow, const Event& event, std::span<double> y) const {
  if (landing_.time == event.time) {
    std::copy(landing_.y.begin(), landing_.y.end(), y.begin());
  } else {
    flow.land(event.time, y);
  }
}

void EventDetector::pass(const Event& event) { guards_.pass({event.time, event.which, event.sign}); }

double EventDetector::force_noise(const Event& event) const {
  return event.guard == Guard::force ? force_noise_ : 0.0;
}

}  // namespace carom
