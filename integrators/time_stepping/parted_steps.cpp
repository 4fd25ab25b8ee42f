// Problem: a step in which nothing passes through anything, or bodies are hit when they meet.

#include <carom/core/run_error.h>
#include <carom/integrators/time_stepping/added_reports.h>
#include <carom/integrators/time_stepping/parted_steps.h>

#include <algorithm>
#include <limits>
#include <utility>

namespace carom {

namespace {

[[noreturn]] void fail(const Detector& detector, const ConstraintKey& key, const char* option, double time,
                       double step) {
  SolverFailure failure;
  failure.time = time;
  failure.step = step;
  failure.parts.push_back(detector.name(key));
  const std::string message = "time stepping at t = " + to_text(time) + " s, step " + to_text(step) +
                              " s: " + option + ": the step ends again and again where " +
                              failure.parts.front() + " meet; allowed: at most " +
                              std::to_string(PartedSteps::most_parts) + " times (a shorter step, or e < 1)";
  throw RunError(message, std::move(failure));
}

}  // namespace

bool PartedSteps::needed(const Assembly& assembly, const TimeStepper& stepper) {
  return stepper.ends_at_closings() ||
         (stepper.options().overlaps.never_tunnel && assembly.layout()->dimension() == 2);
}

PartedSteps::PartedSteps(const Assembly& assembly, TimeStepper& stepper) : stepper_(&stepper) {
  if (stepper.ends_at_closings()) {
    closings_ = std::make_unique<ClosingSearch>(assembly, stepper.detector(), stepper.options());
  } else {
    passages_ = std::make_unique<PassageSearch>(assembly, stepper.detector(), stepper.options());
  }
}

void PartedSteps::make_part(double length, double end) {
  trial_.state = done_.state;
  trial_.companion = done_.companion;
  stepper_->step(trial_.state, trial_.companion, length, end, part_);
  made_ += stepper_->passes();
}

/// Impulses of a short part say less of the next one than those of a longer part before it.
void PartedSteps::keep_impulses() {
  constexpr double much = 0.5;
  ContactHistory &now = done_.companion.contacts, &before = trial_.companion.contacts;
  if (!before.empty() && now.step < much * before.step) std::swap(now, before);
}

/// True if closings are looked for in what is left of the step.
bool PartedSteps::may_search() const {
  const std::int64_t most = steps_per_step * std::int64_t{saved_steps};
  return done_.companion.steps_owed + made_ < most;
}

/// A part up to the end of the step, or to where something is deep enough. Bodies that are moved out of
/// something at its end are not looked at on that way: it does not grow shorter with the part.
void PartedSteps::part_before_passage(const Whole& whole, double length) {
  for (double end = whole.end;;) {
    make_part(length, end);
    const bool moves = stepper_->options().project_gaps;
    if (moves) {
      came_ = trial_.state;
      stepper_->take_back_projection(came_);
    }
    const PassageSearch::Passage passage = passages_->first(done_.state, moves ? came_ : trial_.state);
    if (!(passage.share < 1.0)) return;
    const double earlier = done_.state.time + passage.share * (end - done_.state.time);
    if (earlier == end) return;
    if (++parts_ > most_parts || !(earlier > done_.state.time)) {
      fail(stepper_->detector(), passage.key, "overlaps.never_tunnel", whole.start, whole.step);
    }
    end = earlier;
    length = end - done_.state.time;
  }
}

/// A part up to the end of the step, or to the first closing: the root of a gap over the length of the part,
/// by Newton's method, kept between an end at which all is open and one at which it is not.
void PartedSteps::part_at_closing(const Whole& whole, double length) {
  const double aim = 0.5 * closings_->rounding();
  const double begin = done_.state.time;
  if (!may_search()) return make_part(length, whole.end);
  double open = begin, closed = std::numeric_limits<double>::infinity();
  ClosingSearch::Closing hit;  // the last one found
  for (double end = whole.end;;) {
    make_part(length, end);
    const ClosingSearch::Closing found = closings_->look(done_.state, trial_.state, trial_.companion.modes);
    (closings_->is_late(found) ? closed : open) = end;
    if (open == whole.end) return;
    if (found.gap <= 0.0) hit = found;
    if (closings_->is_now(found)) break;
    double next = end - (found.gap + aim) / found.rate;
    if (!(next > open && next < closed)) next = 0.5 * (open + closed);
    const bool is_between = next > open && next < closed;
    if (!is_between && end == closed) break;  // as near as times can be told apart
    end = is_between ? next : closed;
    length = end - begin;
  }
  if (++parts_ > most_parts) fail(stepper_->detector(), hit.key, "impacts", whole.start, whole.step);
  closings_->count(hit);
}

void PartedSteps::step(State& state, Companion& companion, double step, double end_time, StepReport& report) {
  done_.state = state;
  done_.companion = companion;
  parts_ = made_ = 0;
  if (closings_) closings_->begin_step();
  const Whole whole{state.time, step, end_time};
  for (double length = step; done_.state.time < end_time; length = end_time - done_.state.time) {
    closings_ ? part_at_closing(whole, length) : part_before_passage(whole, length);
    if (done_.state.time == state.time) {
      std::swap(sum_, part_);
    } else {
      add(part_, sum_);
    }
    std::swap(done_, trial_);
    keep_impulses();
  }
  sum_.step = step;
  sum_.steps_made = made_;
  std::int64_t& owed = done_.companion.steps_owed;
  owed = std::max(owed + made_ - steps_per_step, std::int64_t{0});
  sum_.findings.swap(report.findings);
  std::swap(report, sum_);
  std::swap(state, done_.state);
  std::swap(companion, done_.companion);
}

}  // namespace carom
