// Problem: many pairs of bodies, few of which come near each other in a step.

#include <carom/core/numerics/fall_search.h>
#include <carom/integrators/event_driven/body_gaps.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace carom {

namespace {

/// Of two discs around their centres of mass without a contact: d = |c_a - c_b|.
StepPolynomial::End gap_of_discs(const BodyPairBound& bound, const MotionSample& at) {
  const std::vector<double>&q = at.state.q, &v = at.state.v, &a = at.acceleration;
  const double x = q[bound.a.q] - q[bound.b.q], y = q[bound.a.q + 1] - q[bound.b.q + 1];
  const double u = v[bound.a.v] - v[bound.b.v], w = v[bound.a.v + 1] - v[bound.b.v + 1];
  const double b = a[bound.a.v] - a[bound.b.v], c = a[bound.a.v + 1] - a[bound.b.v + 1];
  const double distance = std::sqrt(x * x + y * y), rate = (x * u + y * w) / distance;
  const double across = (x * w - y * u) / distance;
  return {distance - bound.rounding, rate, (across * across + x * b + y * c) / distance};
}

/// (d^2 - rho^2)/(2 rho) by d - rho.
StepPolynomial::End smooth_of(const StepPolynomial::End& gap, double rho) {
  const double part = (gap.value + rho) / rho;
  return {gap.value * (gap.value + 2.0 * rho) / (2.0 * rho), part * gap.first,
          part * gap.second + gap.first * gap.first / rho};
}

/// The largest speed of a gap in a step.
double fastest_in(const SearchedStep& step, std::size_t bound) {
  const StepEnd &start = step.ends.start, &end = step.ends.end;
  const double speed = std::max(start.gap_speeds[bound], end.gap_speeds[bound]);
  const GroupModel& model = step.motion.model();
  // The flow does not know the motion of shapes on ground.
  if (step.motion.flies_freely() && !moves(*model.detector, model.pairs[model.bounds[bound].pair]))
    return speed;
  // Loads within the step are as at its ends, but for what steps may be wrong by.
  constexpr double unseen = 2.0;
  return speed + unseen * (step.end() - step.begin()) *
                     std::max(start.gap_accelerations[bound], end.gap_accelerations[bound]);
}

/// The gap of a vertex and an outline of several features, smooth as long as the nearest feature stays the
/// same.
struct FeatureLook {
  QuantityLook gap;
  Index feature = none;
  double margin = 0.0;  // of the feature [m]
};

/// The first closing of such a gap: intervals in which the nearest feature may change are halved, unless a
/// bound of the rate, which holds for the margins too, shows that the gap does not close in them.
class KinkedSearch {
public:
  KinkedSearch(SearchedStep& step, std::size_t pair, const FallRule& rule, double until)
      : step_(&step), pair_(pair), rule_(rule), until_(until) {}

  [[nodiscard]] double first() { return between(look(step_->begin()), look(step_->end()), 0); }

private:
  [[nodiscard]] FeatureLook look(double time) {
    const SmoothMotion& motion = step_->motion;
    const MotionSample& at = step_->sample(time);
    const FeatureRegions regions = motion.regions(motion.model().pairs[pair_], at);
    FeatureLook out;
    out.gap = {time, body_gap(motion, pair_, at), 0.0};
    out.feature = regions.nearest();
    out.margin = regions.margin(out.feature).value;
    return out;
  }
  [[nodiscard]] double between(const FeatureLook& from, const FeatureLook& to, int depth) {
    constexpr double never = std::numeric_limits<double>::infinity();
    constexpr int deepest = 30;
    const double begin = from.gap.time, end = to.gap.time, way = rule_.fastest * (end - begin);
    if (!(begin < until_) || from.gap.at.value + to.gap.at.value - way > -2.0 * rule_.raise) return never;
    const bool smooth = from.feature == to.feature && from.margin + to.margin > way;
    if (smooth || depth == deepest) {
      QuantityOf gap([&](double time) -> QuantityLook {
        return {time, body_gap(step_->motion, pair_, step_->sample(time)), 0.0};
      });
      return FallSearch(gap, rule_, until_).first(from.gap, to.gap);
    }
    const FeatureLook middle = look(begin + 0.5 * (end - begin));
    const double first = between(from, middle, depth + 1);
    return first < never ? first : between(middle, to, depth + 1);
  }

  SearchedStep* step_;
  std::size_t pair_;
  FallRule rule_;
  double until_;
};

/// About the first time at which a gap closes.
double first_closing(SearchedStep& step, std::size_t pair, double fastest, double until) {
  constexpr double fine = 1e-10;  // a gap this far off the polynomial still counts as found [m]
  const SmoothMotion& motion = step.motion;
  const Index place = motion.model().bound_of[pair];
  const BodyPairBound& bound = motion.model().bounds[place];
  FallRule rule;
  rule.raise = step.scales.gap_noise - step.ends.gap_level(pair);
  rule.fine = fine;
  rule.clear_falls = false;  // of several gaps the first is wanted
  constexpr int least_of_moving = 2;
  if (moves(*motion.model().detector, motion.model().pairs[pair])) rule.least_depth = least_of_moving;
  if (!bound.round) {
    rule.fastest = fastest;
    return KinkedSearch(step, pair, rule, until).first();
  }
  // Two points without rounding have a kink where they meet, and do not touch.
  const bool smooth = bound.rounding > 0.0;
  rule.measured = !(bound.central && smooth && motion.flies_freely());
  const auto look = [&](double time, const StepPolynomial::End& gap) -> QuantityLook {
    return {time, smooth ? smooth_of(gap, bound.rounding) : gap, 0.0};
  };
  QuantityOf gap([&](double time) { return look(time, body_gap(motion, pair, step.sample(time))); });
  const auto at_end = [&](double time, const StepEnd& end) {
    return end.gap_known[place] != 0 ? look(time, end.gaps[pair]) : gap.look(time);
  };
  const QuantityLook from = at_end(step.begin(), step.ends.start), to = at_end(step.end(), step.ends.end);
  return FallSearch(gap, rule, until).first(from, to);
}

}  // namespace

StepPolynomial::End body_gap(const SmoothMotion& motion, std::size_t pair, const MotionSample& at) {
  const BodyPairBound& bound = motion.model().bounds[motion.model().bound_of[pair]];
  if (bound.central) return gap_of_discs(bound, at);
  Constraint contact;
  motion.contact(pair, at, contact);
  return {contact.gap, contact.normal_velocity(at.state.v.data()),
          contact.normal_acceleration(at.acceleration.data())};
}

bool sample_body_gaps(const SmoothMotion& motion, std::span<const char> is_active, const MotionSample& at,
                      StepEnd& out) {
  constexpr double soon = 0.1;  // bodies that may meet within this are looked at closely [s]
  const GroupModel& model = motion.model();
  out.gap_speeds.resize(model.bounds.size());
  out.gap_accelerations.resize(model.bounds.size());
  out.gap_known.resize(model.bounds.size());
  bool finite = true;
  for (std::size_t place = 0; place < model.bounds.size(); ++place) {
    const BodyPairBound& bound = model.bounds[place];
    const std::size_t pair = bound.pair;
    if (is_active[pair] != 0) continue;
    const GroundMotion* const of_ground = motion_of(*model.detector, model.pairs[pair], at.places);
    const double least = bound.least_gap(at.view(), of_ground),
                 speed = bound.most_speed(at.state.v.data(), of_ground);
    out.gap_speeds[place] = speed;
    out.gap_accelerations[place] = bound.most_acceleration(at.acceleration.data(), of_ground);
    const bool known = bound.central || least <= soon * speed;
    out.gap_known[place] = known ? 1 : 0;
    out.gaps[pair] = known ? body_gap(motion, pair, at) : StepPolynomial::End{least, -speed, 0.0};
    finite = finite && std::isfinite(out.gaps[pair].value) && std::isfinite(out.gap_accelerations[place]);
  }
  return finite;
}

Event predict_body_gap(SearchedStep& step, std::span<const char> passed_over, Event before) {
  const GroupModel& model = step.motion.model();
  const StepEnd &start = step.ends.start, &end = step.ends.end;
  const double length = step.end() - step.begin();
  Event found = before;
  for (std::size_t place = 0; place < model.bounds.size(); ++place) {
    const std::size_t pair = model.bounds[place].pair;
    if (step.is_active[pair] != 0 || passed_over[pair] != 0) continue;
    const double fastest = fastest_in(step, place);
    if (start.gaps[pair].value + end.gaps[pair].value - fastest * length > 2.0 * step.scales.gap_noise)
      continue;
    const double until = found.guard == Guard::nothing ? std::numeric_limits<double>::infinity() : found.time;
    const double time = first_closing(step, pair, fastest, until);
    if (time < until) found = {time, Guard::gap, pair};
  }
  return found;
}

}  // namespace carom
