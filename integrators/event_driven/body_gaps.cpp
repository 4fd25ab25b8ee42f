// Problem: many pairs of bodies, few of which come near each other in a step.

#include <carom/contact/detection/first_closing.h>
#include <carom/core/numerics/never.h>
#include <carom/integrators/event_driven/body_gaps.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace carom {

namespace {

/// The bodies of a step of their group.
class StepPath final : public PairPath {
public:
  explicit StepPath(SearchedStep& step) : step_(&step) {}
  [[nodiscard]] PathSample sample(double time, PathLook /*how*/) override {
    return step_->sample_for_gaps(time).on_path();
  }

private:
  SearchedStep* step_;
};

PairGap gap_of(const GroupModel& model, std::size_t place) {
  return {*model.detector, model.pairs[model.bounds[place].pair], model.bounds[place]};
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
    out.gaps[pair] = {known ? gap_in(gap_of(model, place), at.on_path())
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

Event predict_body_gap(SearchedStep& step, std::span<const double> from, Event before) {
  const GroupModel& model = step.motion.model();
  const StepEnd &start = step.ends.start(), &end = step.ends.end();
  const double length = step.end() - step.begin();
  StepPath path(step);
  Event found = before;
  for (std::size_t place = 0; place < model.bounds.size(); ++place) {
    const std::size_t pair = model.bounds[place].pair;
    if (step.is_active[pair] != 0 || from[pair] >= step.end()) continue;
    ClosingRule rule;
    rule.noise = step.scales.gap_noise;
    rule.fine = std::max(fine_gap(*model.options), rule.noise);  // far away gaps are not known better
    rule.level = step.ends.gap_level(pair);
    rule.fastest = fastest_in(step, place);
    if (start.gaps[pair].value + end.gaps[pair].value - rule.fastest * length > 2.0 * rule.noise) continue;
    rule.flies_freely = step.motion.is_ballistic();
    rule.until = found.guard == Guard::nothing ? std::numeric_limits<double>::infinity() : found.time;
    const PairGap gap = gap_of(model, place);
    GapLook first{step.begin(), start.body_gaps[place].known, start.gaps[pair]};
    if (from[pair] > step.begin())
      first = {from[pair], true, gap_in(gap, path.sample(from[pair], PathLook::between))};
    const double time =
        predict_closing(path, gap, rule, first, {step.end(), end.body_gaps[place].known, end.gaps[pair]});
    if (time < rule.until) found = {time, Guard::gap, pair};
  }
  return found;
}

}  // namespace carom
