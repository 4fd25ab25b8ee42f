// Problem: the zero of a guard of forces, sliding, features or elements, each value of which costs a step.

#include <carom/integrators/event_driven/event_location.h>
#include <carom/integrators/event_driven/group_gaps.h>
#include <carom/integrators/event_driven/unbounded_forces.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace carom {

namespace {

/// Guard of a predicted event where a step ended.
struct Remainder {
  double value, rate, noise;
  bool has_rate;
};

/// The zero, between two times of the step.
struct Bracket {
  double low, high;
  double scale;  // of times: what is narrow against it is rounding [s]
  double reach;  // from the last time tried to the next, until times on both sides of the zero were [s]
  double f_low = 0.0, f_high = 0.0;
  bool below = false;  // a value below zero was found
  bool rises = false;  // at the high end it has turned: a zero may be before that
  bool low_is_tried = false, high_is_tried = false;  // else they are ends of the step
  // Illinois rule: the value of an end that stays counts half as much each time. A margin has kinks, beside
  // which a plain secant moves one end only, ever more slowly.
  double low_weight = 1.0, high_weight = 1.0;
  bool took_low = false;

  void take(double time, double value, bool as_low) {
    (as_low ? low : high) = time;
    (as_low ? f_low : f_high) = value;
    const bool again = as_low == took_low && (as_low ? low_is_tried : high_is_tried);
    (as_low ? low_weight : high_weight) = 1.0;
    if (again) (as_low ? high_weight : low_weight) *= 0.5;
    took_low = as_low;
    (as_low ? low_is_tried : high_is_tried) = true;
    below = below || !as_low;
    rises = rises && as_low;
  }
  void take_rising(double time, double value) {
    high = time;
    f_high = value;
    rises = true;
  }
};

Bracket bracket_of(const SearchedStep& step, const Event& predicted) {
  constexpr double near = 1e-3;  // of the step
  const double length = step.end() - step.begin();
  Bracket bracket{step.begin(), step.end(), std::max(std::abs(step.end()), length), near * length};
  const GuardSample &start = step.ends.start().sample, &end = step.ends.end().sample;
  if (predicted.guard == Guard::force) {
    const double level = step.ends.force_level(predicted.which);
    bracket.f_low = start.margins[predicted.which] - level;
    bracket.f_high = end.margins[predicted.which] - level;
    bracket.below = bracket.f_high < 0.0;
  } else if (predicted.guard == Guard::switching_point) {
    bracket.f_low = predicted.sign * start.guards[predicted.which].value;
    bracket.f_high = predicted.sign * end.guards[predicted.which].value;
    bracket.below = bracket.f_high < 0.0;
  }
  return bracket;
}

/// The guard in a sample, and the size below which it counts as zero.
Remainder remainder_of(SearchedStep& step, const MotionSample& at, const Event& predicted,
                       GuardSample& memory) {
  const double* const velocity = at.state.v.data();
  SmoothMotion& motion = step.motion;
  if (predicted.guard == Guard::slip) {
    const ActiveContact& closed = motion.active().list()[predicted.which];
    const TangentDirection slip = closed.slip_direction();
    return {velocity_along(closed.at, slip, velocity) - step.ends.slip_level(predicted.which),
            acceleration_along(closed.at, slip, at.acceleration.data()),
            step.scales.noise_of(motion, closed.at) / 16.0, true};
  }
  if (predicted.guard == Guard::feature) {
    const ActiveContact& closed = motion.active().list()[predicted.which];
    const FeatureRegions regions = motion.regions(closed.pair, at);
    const FeatureMargin margin = regions.margin(closed.feature);
    return {margin.value + regions.border() - step.ends.feature_level(predicted.which), margin.rate,
            margin_noise(step.scales), true};
  }
  if (predicted.guard == Guard::switching_point) {
    motion.read_guards(at, memory.guards);
    const GuardMotion& guard = memory.guards[predicted.which];
    return {predicted.sign * guard.value, predicted.sign * guard.first, step.scales.gap_noise / 4.0,
            motion.guards().has_motion(predicted.which)};
  }
  motion.active().margins(step.memory.margins);
  return {step.memory.margins[predicted.which].margin - step.ends.force_level(predicted.which), 0.0,
          step.ends.force_noise(predicted.which), false};
}

/// The next time to try: by the rate, by the secant, or the middle. Without a rate the zero is enclosed near
/// the time predicted first: a force may fall, rise and fall again within a step, and a secant to the end of
/// the step leads to any of its zeros.
double next_time(Bracket& at, double time, const Remainder& rest, bool halve) {
  constexpr double growth = 4.0;
  if (!rest.has_rate && !(at.low_is_tried && at.high_is_tried)) {
    const double across = at.low_is_tried ? time + at.reach : time - at.reach;
    at.reach *= growth;
    if (across > at.low && across < at.high) return across;
  }
  const double low = at.low_weight * at.f_low, high = at.high_weight * at.f_high;
  double next =
      rest.has_rate ? time - rest.value / rest.rate : at.low + (at.high - at.low) * low / (low - high);
  // Nearer than the clock can tell: halfway to the far end the guard may be beyond another zero.
  if (rest.has_rate && next == time) next = std::nextafter(time, time == at.low ? at.high : at.low);
  if (!(next > at.low && next < at.high) || halve) return 0.5 * (at.low + at.high);
  return next;
}

}  // namespace

Event locate_event(SearchedStep& step, const Event& predicted, Landing& landing) {
  if (predicted.guard == Guard::gap) return locate_gap(step, predicted, landing);
  constexpr int most_landings = 60;
  std::vector<double>& y = step.memory.y;
  y.resize(step.motion.size());
  Bracket at = bracket_of(step, predicted);
  double time = std::clamp(predicted.time, at.low, at.high);
  if (predicted.guard == Guard::switching_point &&
      step.guards.passes_at_once({at.low, predicted.which, predicted.sign},
                                 step.ends.start().sample.guards[predicted.which],
                                 step.scales.gap_noise / 4.0)) {
    time = at.high = at.low;
  }
  const double predicted_time = time;
  for (int i = 0; i < most_landings; ++i) {
    step.flow.land(time, y);
    step.motion.sample(time, y.data(), Forces::all, step.memory.within);
    const Remainder rest = remainder_of(step, step.memory.within, predicted, step.memory.located);
    if (std::abs(rest.value) <= rest.noise || at.low == at.high) {
      landing.time = time;
      landing.y.assign(y.begin(), y.end());
      return {time, predicted.guard, predicted.which, predicted.sign};
    }
    const bool rises = rest.has_rate && rest.value > 0.0 && rest.rate >= 0.0;
    if (rises && time <= predicted_time) return {time, Guard::restart, 0};
    if (rises) {
      at.take_rising(time, rest.value);
    } else {
      at.take(time, rest.value, rest.value > 0.0);
    }
    if (at.high - at.low <= 2.0 * std::numeric_limits<double>::epsilon() * at.scale) break;
    time = next_time(at, time, rest, at.rises || i % 8 == 7);
  }
  // From large to large of the other sign: no zero of the forces but a pole.
  const double large = UnboundedForces::growth * step.scales.force;
  if (predicted.guard == Guard::force && at.f_low > large && at.f_high < -large) {
    return {at.low, Guard::painleve, predicted.which};
  }
  // Nothing there: go on from where it was predicted, for behind it others may have been.
  if (!at.below) return {predicted_time, Guard::restart, 0};
  return {at.high, predicted.guard, predicted.which, predicted.sign};
}

}  // namespace carom
