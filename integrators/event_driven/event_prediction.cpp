// Problem: when does a gap close, a force come to its end, sliding stop or a guard of an element change its
// sign first?

#include <carom/core/numerics/fall_search.h>
#include <carom/core/numerics/never.h>
#include <carom/integrators/event_driven/event_prediction.h>
#include <carom/integrators/event_driven/group_gaps.h>

#include <algorithm>

namespace carom {

namespace {

/// Time before which an event must be to come before one found.
double until(const Event& found) { return found.guard == Guard::nothing ? never : found.time; }

/// Guards by interpolation of the flow.
class StepSampler final : public GuardSampler {
public:
  explicit StepSampler(SearchedStep& step) : step_(&step) {}

  void sample(double time, GuardSample& out) override {
    read_guard_sample(step_->motion, step_->sample(time), step_->memory.margins, out);
  }

private:
  SearchedStep* step_;
};

/// Guards of elements along the path between the ends of the step.
class PathSampler final : public GuardSampler {
public:
  explicit PathSampler(SearchedStep& step) : step_(&step) {}

  void sample(double time, GuardSample& out) override {
    SmoothMotion& motion = step_->motion;
    DetectionMemory& memory = step_->memory;
    const std::size_t count = motion.model().unknowns.q_size();
    memory.y.resize(motion.size());
    memory.path_acceleration.resize(count);
    follow_path(*step_->ends.start().path, *step_->ends.end().path, count, time, memory.y,
                memory.path_acceleration.data());
    motion.read_guards(time, memory.y.data(), memory.path_acceleration.data(), memory.within, out.guards);
  }

private:
  SearchedStep* step_;
};

/// A guard with one number, or a number and its rate, in a sample. Behind a gap that closes, the end of a
/// feature or of sliding, forces are not looked at: the motion goes on there as it does not, and they may
/// pass a pole (contacts that meet at the end of an edge) or come back, which a polynomial over the whole
/// step would not show.
template <class F>
void search(SearchedStep& step, GuardSampler& sampler, const FallRule& rule, const F& read, Event candidate,
            Event& found) {
  QuantityOf quantity([&](double time) { return read(step.memory.samples.at(time, sampler)); });
  const bool cut = rule.derivatives == 0 && until(found) < step.end();
  candidate.time =
      FallSearch(quantity, rule, until(found))
          .first(read(step.ends.start().sample),
                 read(cut ? step.memory.samples.at(found.time, sampler) : step.ends.end().sample));
  if (candidate.time < until(found)) found = candidate;
}

constexpr int deepest = 6;  // bisections: forces without bound have no end of their own

void predict_slips(SearchedStep& step, GuardSampler& sampler, Event& found) {
  const std::vector<ActiveContact>& closed = step.motion.active().list();
  for (std::size_t i = 0; i < closed.size(); ++i) {
    if (closed[i].sticks() || closed[i].frictionless) continue;
    FallRule rule;
    rule.derivatives = 1;
    rule.fine = step.scales.noise_of(step.motion, closed[i].at);
    rule.raise = rule.fine - step.ends.slip_level(i);
    rule.deepest = deepest;
    const auto read = [i](const GuardSample& at) -> QuantityLook { return {at.time, at.slips[i], 0.0}; };
    search(step, sampler, rule, read, {never, Guard::slip, i}, found);
  }
}

void predict_features(SearchedStep& step, GuardSampler& sampler, Event& found) {
  const double fine = step.motion.model().options->gap_tolerance;
  const std::vector<ActiveContact>& closed = step.motion.active().list();
  for (std::size_t i = 0; i < closed.size(); ++i) {
    if (closed[i].feature == none) continue;
    FallRule rule;
    rule.derivatives = 1;
    rule.fine = fine;
    rule.raise = step.scales.gap_noise - step.ends.feature_level(i);
    rule.deepest = deepest;
    const auto read = [i](const GuardSample& at) -> QuantityLook { return {at.time, at.features[i], 0.0}; };
    search(step, sampler, rule, read, {never, Guard::feature, i}, found);
  }
}

void predict_forces(SearchedStep& step, GuardSampler& sampler, const FalseAlarms& passed_over, Event& found) {
  for (std::size_t i = 0; i < step.ends.end().sample.margins.size(); ++i) {
    if (passed_over.forces[i] != 0) continue;
    FallRule rule;
    rule.derivatives = 0;
    rule.fine = step.ends.force_noise(i);
    rule.raise = rule.fine - step.ends.force_level(i);
    rule.deepest = deepest;
    const auto read = [i](const GuardSample& at) -> QuantityLook {
      return {at.time, {at.margins[i], 0.0, 0.0}, 0.0};
    };
    search(step, sampler, rule, read, {never, Guard::force, i}, found);
  }
}

void predict_switching_points(SearchedStep& step, GuardSampler& sampler, Event& found) {
  PathSampler along(step);
  const bool path = step.motion.guards_follow_path();
  const GuardSearch::Passage passage = step.guards.first(
      step.motion.guards(), step.ends.start().sample, step.ends.end().sample,
      path ? step.memory.path_samples : step.memory.samples,
      path ? static_cast<GuardSampler&>(along) : sampler, step.scales.guard_noise, until(found));
  if (passage.time < until(found))
    found = {passage.time, Guard::switching_point, passage.guard, passage.sign};
}

}  // namespace

Event predict_event(SearchedStep& step, const FalseAlarms& passed_over) {
  Event found = predict_gap(step, passed_over, {step.end()});
  const GuardSample& end = step.ends.end().sample;
  if (end.margins.empty() && end.guards.empty()) return found;
  StepSampler sampler(step);
  predict_slips(step, sampler, found);
  predict_features(step, sampler, found);
  predict_forces(step, sampler, passed_over, found);
  if (!end.guards.empty()) predict_switching_points(step, sampler, found);
  return found;
}

}  // namespace carom
