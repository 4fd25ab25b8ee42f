// Problem: many pairs, few of which come near each other in a step.

#include <carom/contact/detection/first_closing.h>
#include <carom/core/numerics/never.h>
#include <carom/integrators/event_driven/group_gaps.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace carom {

namespace {

/// The bodies of a step of their group.
class StepPath final : public PairPath {
public:
  explicit StepPath(SearchedStep& step) : step_(&step) {}
  [[nodiscard]] PathSample sample(double time, PathLook how) override {
    if (how == PathLook::between) return step_->sample_for_gaps(time).on_path();
    DetectionMemory& memory = step_->memory;
    memory.y.resize(step_->motion.size());
    step_->flow.land(time, memory.y);
    landed_ = time;
    step_->motion.sample(time, memory.y.data(), Forces::all, memory.within);
    return memory.within.on_path();
  }
  /// When the flow landed last, on the state in the memory of the step [s].
  [[nodiscard]] double landed() const { return landed_; }

private:
  SearchedStep* step_;
  double landed_ = never;
};

PairGap gap_of(const GroupModel& model, std::size_t pair) {
  const Index bound = model.bound_of(pair);
  return {*model.detector, model.pairs[pair], bound == none ? nullptr : &model.bounds[bound]};
}

/// The largest speed of a gap in a step.
double fastest_in(const SearchedStep& step, std::size_t bound) {
  const StepEnd &start = step.ends.start(), &end = step.ends.end();
  const double speed = std::max(start.body_gaps[bound].speed, end.body_gaps[bound].speed);
  const GroupModel& model = step.motion.model();
  // The flow does not know the motion of shapes on ground.
  if (step.motion.is_ballistic() && !moves(*model.detector, model.pairs[model.bounds[bound].pair]))
    return speed;
  // Loads within the step are as at its ends, but for what steps may be wrong by.
  constexpr double unseen = 2.0;
  return speed + unseen * (step.end() - step.begin()) *
                     std::max(start.body_gaps[bound].acceleration, end.body_gaps[bound].acceleration);
}

/// True if a bound of the rate excludes that a gap closes in the step.
bool stays_open(const SearchedStep& step, std::size_t pair, const ClosingRule& rule) {
  const double way = rule.fastest * (step.end() - step.begin());
  return step.ends.start().gaps[pair].value + step.ends.end().gaps[pair].value - way > 2.0 * rule.noise;
}

/// Level through which a gap closes [m].
double closing_level(const SearchedStep& step, std::size_t pair) {
  if (!step.is_exact(pair)) return step.ends.gap_level(pair);
  return step.ends.closing_level(pair, step.scales.speed_noise, step.motion.model().options->gap_tolerance);
}

}  // namespace

bool sample_body_gaps(const SmoothMotion& motion, std::span<const char> is_active, const MotionSample& at,
                      StepEnd& out) {
  const GroupModel& model = motion.model();
  const double soon = model.options->longest_step;  // bodies that may meet within this are looked at closely
  out.body_gaps.resize(model.bounds.size());
  bool finite = true;
  for (std::size_t place = 0; place < model.bounds.size(); ++place) {
    const BodyPairBound& bound = model.bounds[place];
    const std::size_t pair = bound.pair;
    if (is_active[pair] != 0) continue;
    const GroundMotion* const of_ground = motion_of(*model.detector, model.pairs[pair], at.places);
    const double least = bound.least_gap(at.view(), of_ground),
                 speed = bound.most_speed(at.state.v.data(), of_ground);
    const bool known = bound.central || least <= soon * speed;
    BodyGapEnd& gap = out.body_gaps[place];
    gap = {speed, bound.most_acceleration(at.acceleration.data(), of_ground), known};
    out.gaps[pair] = {known ? gap_in(gap_of(model, pair), at.on_path())
                            : StepPolynomial::End{least, -speed, 0.0}};
    finite = finite && std::isfinite(out.gaps[pair].value) && std::isfinite(gap.acceleration);
  }
  return finite;
}

double longest_searched(const SmoothMotion& motion, std::span<const char> is_active, const StepEnd& start) {
  constexpr double falls = 16.0;  // times in which a body falls by its own size: some 500 looks at most
  const GroupModel& model = motion.model();
  double most = 0.0;  // acceleration over size [1/s^2]
  for (std::size_t place = 0; place < model.bounds.size(); ++place) {
    const BodyPairBound& bound = model.bounds[place];
    const double size = bound.lever + bound.radius + bound.reach;
    if (is_active[bound.pair] != 0 || !has_kinks(bound) || !(size > 0.0)) continue;
    most = std::max(most, start.body_gaps[place].acceleration / size);
  }
  return most > 0.0 ? falls / std::sqrt(most) : never;
}

Event predict_gap(SearchedStep& step, const FalseAlarms& passed_over, Event before) {
  const GroupModel& model = step.motion.model();
  const StepEnd &start = step.ends.start(), &end = step.ends.end();
  StepPath path(step);
  Event found = before;
  ClosingRule rule;
  rule.noise = step.scales.gap_noise;
  rule.fine = std::max(fine_gap(*model.options), rule.noise);  // far away gaps are not known better
  rule.flies_freely = step.motion.is_ballistic();
  for (std::size_t pair = 0; pair < model.pairs.size(); ++pair) {
    const double begin = passed_over.gaps[pair];
    if (step.is_active[pair] != 0 || begin >= step.end()) continue;
    const Index bound = model.bound_of(pair);
    rule.fastest = bound == none ? never : fastest_in(step, bound);
    if (bound != none && stays_open(step, pair, rule)) continue;
    rule.level = step.ends.gap_level(pair);
    rule.sixth =
        bound == none ? std::max(start.gaps[pair].curvature_bound, end.gaps[pair].curvature_bound) : 0.0;
    rule.until = found.guard == Guard::nothing ? never : found.time;
    const PairGap gap = gap_of(model, pair);
    const auto is_known = [&](const StepEnd& at) { return bound == none || at.body_gaps[bound].known; };
    GapLook first{step.begin(), is_known(start), start.gaps[pair]};
    if (begin > step.begin()) first = {begin, true, gap_in(gap, path.sample(begin, PathLook::between))};
    const double time = predict_closing(path, gap, rule, first, {step.end(), is_known(end), end.gaps[pair]});
    if (time < rule.until) found = {time, Guard::gap, pair};
  }
  return found;
}

Event locate_gap(SearchedStep& step, const Event& predicted, Landing& landing) {
  constexpr double of_noise = 1.0 / 16.0;
  const std::size_t pair = predicted.which;
  ClosingRule rule;
  rule.level = closing_level(step, pair);
  rule.found = of_noise * step.scales.gap_noise;
  rule.slow = step.scales.speed_noise;
  // It may be between the last time before the end of the step and that end.
  const bool is_below = step.is_exact(pair) && step.ends.end().gaps[pair].value < rule.level;
  const GapLook from{step.begin(), true, step.ends.start().gaps[pair]};
  StepPath path(step);
  const ClosingRoot root = locate_closing(path, gap_of(step.motion.model(), pair), rule, from, step.end(),
                                          is_below, predicted.time);
  if (root.kind != ClosingRoot::Kind::closes) return {root.time, Guard::restart, 0};
  if (path.landed() == root.time) {
    landing.time = root.time;
    landing.y.assign(step.memory.y.begin(), step.memory.y.end());
  }
  return {root.time, Guard::gap, pair};
}

}  // namespace carom
