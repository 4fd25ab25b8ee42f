// Problem: a step in which nothing passes through anything.

#include <carom/core/errors.h>
#include <carom/integrators/time_stepping/added_reports.h>
#include <carom/integrators/time_stepping/parted_steps.h>

#include <utility>

namespace carom {

namespace {

[[noreturn]] void fail(const Detector& detector, const ConstraintKey& key, double time, double step) {
  SolverFailure failure;
  failure.time = time;
  failure.step = step;
  failure.parts.push_back(detector.name(key));
  const std::string message = "time stepping at t = " + to_text(time) + " s, step " + to_text(step) +
                              " s: overlaps.never_tunnel: the step ends again and again where " +
                              failure.parts.front() + " meet; allowed: at most " +
                              std::to_string(PartedSteps::most_parts) + " times (a shorter step, or e < 1)";
  throw SolverError(message, std::move(failure));
}

}  // namespace

void PartedSteps::step(TimeStepper& stepper, State& state, Companion& companion, double step, double end_time,
                       StepReport& report) {
  done_.state = state;
  done_.companion = companion;
  double length = step;  // of the next part
  for (int parts = 0; done_.state.time < end_time;) {
    double end = end_time;
    for (;;) {
      trial_.state = done_.state;
      trial_.companion = done_.companion;
      stepper.step(trial_.state, trial_.companion, length, end, part_);
      const PassageSearch::Passage passage = search_.first(done_.state, trial_.state);
      if (!(passage.share < 1.0)) break;
      const double earlier = done_.state.time + passage.share * (end - done_.state.time);
      if (earlier == end) break;
      if (++parts > most_parts || !(earlier > done_.state.time)) {
        fail(stepper.detector(), passage.key, state.time, step);
      }
      end = earlier;
      length = end - done_.state.time;
    }
    if (done_.state.time == state.time) {
      std::swap(sum_, part_);
    } else {
      add(part_, sum_);
    }
    std::swap(done_, trial_);
    length = end_time - done_.state.time;
  }
  sum_.step = step;
  sum_.findings.swap(report.findings);
  std::swap(report, sum_);
  std::swap(state, done_.state);
  std::swap(companion, done_.companion);
}

}  // namespace carom
