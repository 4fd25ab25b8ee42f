// Problem: a step in which nothing passes through anything, or bodies are hit when they meet.

#include <carom/core/numerics/never.h>
#include <carom/core/run_error.h>
#include <carom/integrators/time_stepping/added_reports.h>
#include <carom/integrators/time_stepping/parted_steps.h>

#include <algorithm>
#include <limits>
#include <utility>

namespace carom {

namespace {

/// Contacts that are looked for. Where bodies that ground hits are followed by themselves others are only
/// found if they close on the way and are open at its end.
StepContacts contacts_looked_for(const Assembly& assembly, const TimeStepper& stepper) {
  if (stepper.ends_at_closings()) return StepContacts::all;
  const Detector& detector = stepper.detector();
  const bool located = stepper.options().impacts == ImpactTimes::located;
  const bool any = detector.outlines().ground_touches() || detector.points().needs_rotations();
  return located && any && assembly.layout()->dimension() == 2 ? StepContacts::of_turns
                                                               : StepContacts::nothing;
}

/// Searches for closings; null where there are none to be found.
std::unique_ptr<StepClosings> make_closings(const Assembly& assembly, const TimeStepper& stepper) {
  const StepContacts contacts = contacts_looked_for(assembly, stepper);
  const bool of_passages = assembly.layout()->dimension() == 2 && stepper.options().overlaps.never_tunnel;
  if (contacts == StepContacts::nothing && !of_passages) return nullptr;
  auto closings = std::make_unique<StepClosings>(assembly, stepper.detector(), stepper.options(), contacts);
  return closings->finds_any() ? std::move(closings) : nullptr;
}

}  // namespace

bool PartedSteps::needed(const Assembly& assembly, const TimeStepper& stepper) {
  return make_closings(assembly, stepper) != nullptr;
}

PartedSteps::PartedSteps(const Assembly& assembly, TimeStepper& stepper)
    : stepper_(&stepper), closings_(make_closings(assembly, stepper)) {
  if (contacts_looked_for(assembly, stepper) != StepContacts::nothing)
    counts_ = std::make_unique<ClosingCounts>(assembly, stepper.detector(), stepper.options());
}

void PartedSteps::make_part(const Whole& whole, double length, double end) {
  is_parted_ = is_parted_ || length < whole.step;
  trial_.state = done_.state;
  trial_.companion = done_.companion;
  const bool repeats = std::exchange(repeats_, false);  // not after an error
  stepper_->step(trial_.state, trial_.companion, length, end, part_, {length / whole.step, repeats});
  repeats_ = true;
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

/// The state behind the impacts at the start of the part.
const State& PartedSteps::after_impacts() const {
  const TimeStepper::LastStep last = stepper_->last();
  return last.after_impacts != nullptr ? *last.after_impacts : done_.state;
}

/// The first closing on the way of the part. Bodies that are moved out of something at its end are not looked
/// at on that way: it does not grow shorter with the part.
StepClosing PartedSteps::first_closing(bool searches) {
  const TimeStepper::LastStep last = stepper_->last();
  const bool moves_out = stepper_->options().project_gaps;
  if (moves_out) {
    came_ = trial_.state;
    last.projection->take_back(came_);
  }
  const auto closes = [&](const SweptPair& pair) { return searches && !counts_->is_given_up(pair.key); };
  return closings_->first({done_.state, moves_out ? came_ : trial_.state, after_impacts().v, *last.flights,
                           trial_.companion.modes},
                          closes);
}

/// Takes note of the contacts that close at the end of a part. \param hit at which it ends; null where it
/// ends elsewhere
void PartedSteps::note_closings(const StepClosing* hit) {
  bool known = false;
  const auto accelerations = [&]() -> const std::vector<double>& {
    if (std::exchange(known, true)) return accelerations_;
    stepper_->last().flights->write_accelerations(after_impacts().v, trial_.state,
                                                  trial_.state.time - done_.state.time, accelerations_);
    return accelerations_;
  };
  counts_->find(trial_.state, trial_.companion.modes);
  if (hit != nullptr && !counts_->lists_parts_of(hit->key)) closings_->leave_aside(hit->pair.pair);
  if (!stepper_->ends_at_closings()) return;
  counts_->note(trial_.state, hit == nullptr ? nullptr : &hit->key, accelerations, trial_.companion.closings);
}

/// True where a part may end whatever the gap is then: where something comes deep, and where the body of a
/// closing is hit and flies on within the part.
bool PartedSteps::is_followed(const StepClosing& closing) const {
  return closing.is_passage || stepper_->last().flights->follow(closing.pair.pair);
}

/// A part up to the end of the step, or to the first closing: the root of a gap over the length of the part,
/// by Newton's method, kept between an end at which all is open and one at which it is not. What would leave
/// a thing on its far side by the end of a part is in it at an earlier end.
void PartedSteps::make_part_up_to(const Whole& whole, double length) {
  // What is found may lie just before each end that is tried: then the bracket is halved.
  constexpr int most_idle = 5, most_tries = 1000;
  const double begin = done_.state.time;
  closings_->begin_part();
  const bool searches = counts_ && searches_ && may_search();
  double open = begin, closed = never, width = never;
  int idle = 0, tries = 0;
  StepClosing found;  // the one that is headed for
  bool ends_there = false;
  for (double end = whole.end;;) {
    make_part(whole, length, end);
    const StepClosing first = first_closing(searches);
    const bool is_late = first.time < end;
    if (is_late) found = first;
    (is_late ? closed : open) = end;
    // A body may be hit on one way and not on another that is hardly longer.
    if (is_late && is_followed(first) && !(first.time > open)) open = begin;
    if (!is_late && end < whole.end && !is_followed(found)) {
      closings_->look_at_end(found);
      if (found.is_refuted()) {
        closings_->refute(found.pair.pair);
        open = begin, closed = never;
        end = whole.end;
        length = end - begin;
        continue;
      }
    }
    ends_there = !is_late && end < whole.end && (found.gap <= found.shallow || is_followed(found));
    if (open == end && (end == whole.end || ends_there)) break;
    double next = is_late ? first.time : end - (found.gap - found.aim()) / found.rate;
    const bool shrinks = closed - open <= 0.5 * width;
    idle = shrinks ? 0 : idle + 1;
    if (shrinks) width = closed - open;
    if (idle > most_idle || !(next > open && next < closed)) {
      next = 0.5 * (open + closed);
      idle = 0;
    }
    if (++tries > most_tries) fail(found.key, whole, most_tries);
    const bool is_between = next > open && next < closed;
    if (!is_between && end == closed) break;  // as near as times can be told apart
    end = is_between ? next : closed;
    length = end - begin;
  }
  const bool early = trial_.state.time < whole.end;
  if (early && ++parts_ > most_parts) fail(found.key, whole, most_parts);
  if (!counts_) return;
  // A closing that is not looked for any more is told.
  if (closings_->any_left_out()) ++trial_.companion.statistics.cut_sequences;
  const bool hits = early && !is_followed(found);
  if (hits) closings_->look_at_end(found);
  note_closings(hits ? &found : nullptr);
}

[[noreturn]] void PartedSteps::fail(const ConstraintKey& key, const Whole& whole, int allowed) const {
  const char* const option = stepper_->options().overlaps.never_tunnel ? "overlaps.never_tunnel" : "impacts";
  SolverFailure failure;
  failure.time = whole.start;
  failure.step = whole.step;
  failure.parts.push_back(stepper_->detector().name(key));
  const std::string message =
      "time stepping at t = " + to_text(whole.start) + " s, step " + to_text(whole.step) + " s: " + option +
      ": the step ends again and again where " + failure.parts.front() + " meet; allowed: at most " +
      std::to_string(allowed) + " times (a shorter step, or e < 1)";
  throw RunError(message, std::move(failure));
}

/// Makes a step, part by part. \param searches for closings
void PartedSteps::make_parts(const State& state, const Companion& companion, const Whole& whole,
                             bool searches) {
  done_.state = state;
  done_.companion = companion;
  repeats_ = false;
  parts_ = 0;
  searches_ = searches;
  closings_->begin_step();
  if (counts_) counts_->begin_step();
  for (double length = whole.step; done_.state.time < whole.end; length = whole.end - done_.state.time) {
    make_part_up_to(whole, length);
    if (done_.state.time == whole.start) {
      std::swap(sum_, part_);
    } else {
      add(part_, sum_);
    }
    std::swap(done_, trial_);
    repeats_ = false;
    keep_impulses();
  }
}

void PartedSteps::step(State& state, Companion& companion, double step, double end_time, StepReport& report) {
  const Whole whole{state.time, step, end_time};
  made_ = 0;
  is_parted_ = false;
  try {
    make_parts(state, companion, whole, true);
  } catch (const SolverError&) {
    const ImpactRules& rules = stepper_->options().impact_rules;
    const bool refuses = rules.refuse_jams || rules.energy_gain == EnergyGain::refuse;
    if (!is_parted_ || parts_ > most_parts || refuses) throw;
    make_parts(state, companion, whole, false);
    if (sum_.energy_gain > sum_.lasting_gain) throw;  // an answer that is worse than none
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
