// Problem: a step in which nothing passes through anything, or bodies are hit when they meet.

#include <carom/core/run_error.h>
#include <carom/integrators/time_stepping/added_reports.h>
#include <carom/integrators/time_stepping/parted_steps.h>

#include <algorithm>
#include <limits>
#include <utility>

namespace carom {

namespace {

/// Searches for what passes through anything; null where nothing does.
std::unique_ptr<PassageSearch> make_passages(const Assembly& assembly, const TimeStepper& stepper) {
  const TimeStepping& options = stepper.options();
  const bool located = options.impacts == ImpactTimes::located;
  if (assembly.layout()->dimension() != 2 || !(located || options.overlaps.never_tunnel)) return nullptr;
  auto passages = std::make_unique<PassageSearch>(assembly, stepper.detector(), options,
                                                  located ? Passages::of_far_sides : Passages::all);
  return passages->finds_any() ? std::move(passages) : nullptr;
}

}  // namespace

bool PartedSteps::needed(const Assembly& assembly, const TimeStepper& stepper) {
  return stepper.ends_at_closings() || make_passages(assembly, stepper) != nullptr;
}

PartedSteps::PartedSteps(const Assembly& assembly, TimeStepper& stepper)
    : stepper_(&stepper), passages_(make_passages(assembly, stepper)) {
  if (stepper.ends_at_closings()) {
    closings_ = std::make_unique<ClosingSearch>(assembly, stepper.detector(), stepper.options());
  }
}

void PartedSteps::make_part(double length, double end) {
  trial_.state = done_.state;
  trial_.companion = done_.companion;
  stepper_->step(trial_.state, trial_.companion, length, end, part_);
  made_ += stepper_->last().passes;
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
  return done_.companion.closings.steps_owed + made_ < most;
}

/// The first pair that comes deep on the way of the part. Bodies that are moved out of something at its end
/// are not looked at on that way: it does not grow shorter with the part.
PassageSearch::Passage PartedSteps::first_passage() {
  if (!passages_) return {};
  const TimeStepper::LastStep last = stepper_->last();
  if (!stepper_->options().project_gaps) return passages_->first(done_.state, trial_.state, *last.flights);
  came_ = trial_.state;
  last.projection->take_back(came_);
  return passages_->first(done_.state, came_, *last.flights);
}

/// Takes note of what closes at the end of a part. \param hit at which it ends; null where it ends elsewhere
void PartedSteps::note_closings(const ClosingSearch::Closing* hit) {
  bool known = false;
  const auto accelerations = [&]() -> const std::vector<double>& {
    if (std::exchange(known, true)) return accelerations_;
    const TimeStepper::LastStep last = stepper_->last();
    const State& begin = last.after_impacts != nullptr ? *last.after_impacts : done_.state;
    last.flights->write_accelerations(begin.v, trial_.state, trial_.state.time - done_.state.time,
                                      accelerations_);
    return accelerations_;
  };
  closings_->note(trial_.state, hit, accelerations, trial_.companion.closings);
}

/// A part up to the end of the step, or to the first closing: the root of a gap over the length of the part,
/// by Newton's method, kept between an end at which all is open and one at which it is not. What would leave
/// a thing on its far side by the end of a part is in it at an earlier end.
void PartedSteps::make_part_up_to(const Whole& whole, double length) {
  const double aim = closings_ ? 0.5 * closings_->rounding() : 0.0, begin = done_.state.time;
  const bool searches = closings_ && may_search();
  double open = begin, closed = std::numeric_limits<double>::infinity();
  ClosingSearch::Closing found;
  PassageSearch::Passage passage;  // the last one found
  bool hits = false;               // the part ends where a contact closes
  for (double end = whole.end;;) {
    make_part(length, end);
    if (closings_) found = closings_->look(done_.state, trial_.state, trial_.companion.modes);
    const bool is_late = searches && closings_->is_late(found);
    const PassageSearch::Passage first = first_passage();
    const bool passes = first.time < end;
    if (passes) passage = first;
    (is_late || passes ? closed : open) = end;
    // A body may be hit on one way and not on another that is hardly longer.
    if (passes && !(first.time > open)) open = begin;
    hits = !passes && (is_late || (searches && closings_->is_now(found)));
    if (open == end && (end == whole.end || hits || end == passage.time)) break;
    double next = passes ? first.time : end - (found.gap + aim) / found.rate;
    if (!(next > open && next < closed)) next = 0.5 * (open + closed);
    const bool is_between = next > open && next < closed;
    if (!is_between && end == closed) break;  // as near as times can be told apart
    end = is_between ? next : closed;
    length = end - begin;
  }
  const bool early = trial_.state.time < whole.end;
  if (early && ++parts_ > most_parts) fail(hits ? found.key : passage.key, whole);
  if (!closings_) return;
  // What is not searched for any more is told.
  if ((!searches && closings_->is_late(found)) || closings_->any_given_up())
    ++trial_.companion.statistics.cut_sequences;
  note_closings(early && hits ? &found : nullptr);
}

[[noreturn]] void PartedSteps::fail(const ConstraintKey& key, const Whole& whole) const {
  const char* const option = stepper_->options().overlaps.never_tunnel ? "overlaps.never_tunnel" : "impacts";
  SolverFailure failure;
  failure.time = whole.start;
  failure.step = whole.step;
  failure.parts.push_back(stepper_->detector().name(key));
  const std::string message =
      "time stepping at t = " + to_text(whole.start) + " s, step " + to_text(whole.step) + " s: " + option +
      ": the step ends again and again where " + failure.parts.front() + " meet; allowed: at most " +
      std::to_string(most_parts) + " times (a shorter step, or e < 1)";
  throw RunError(message, std::move(failure));
}

void PartedSteps::step(State& state, Companion& companion, double step, double end_time, StepReport& report) {
  done_.state = state;
  done_.companion = companion;
  parts_ = made_ = 0;
  if (closings_) closings_->begin_step();
  const Whole whole{state.time, step, end_time};
  for (double length = step; done_.state.time < end_time; length = end_time - done_.state.time) {
    make_part_up_to(whole, length);
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
  std::int64_t& owed = done_.companion.closings.steps_owed;
  owed = std::max(owed + made_ - steps_per_step, std::int64_t{0});
  sum_.findings.swap(report.findings);
  std::swap(report, sum_);
  std::swap(state, done_.state);
  std::swap(companion, done_.companion);
}

}  // namespace carom
