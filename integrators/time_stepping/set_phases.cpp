// Problem: a step in which nothing passes through anything, or bodies are hit when they meet.

#include <carom/core/numerics/never.h>
#include <carom/core/run_error.h>
#include <carom/integrators/time_stepping/added_reports.h>
#include <carom/integrators/time_stepping/phase_ends.h>
#include <carom/integrators/time_stepping/set_phases.h>

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

bool SetPhases::needed(const Assembly& assembly, const TimeStepper& stepper) {
  return make_closings(assembly, stepper) != nullptr;
}

SetPhases::SetPhases(const Assembly& assembly, TimeStepper& stepper)
    : stepper_(&stepper),
      closings_(make_closings(assembly, stepper)),
      bodies_(static_cast<Index>(assembly.layout()->bodies().size())) {
  if (contacts_looked_for(assembly, stepper) != StepContacts::nothing)
    counts_ = std::make_unique<ClosingCounts>(assembly, stepper.detector(), stepper.options());
}

/// Tries a phase. False if it was ended by `stops`.
bool SetPhases::try_phase(const WholeStep& whole, double end, Stops stops) {
  trial_.state = *start_;
  trial_.companion = *companion_;
  const bool is_whole = start_->time == whole.start && end == whole.end;
  const double length = is_whole ? whole.step : end - start_->time;
  const bool repeats = std::exchange(repeats_, false);  // not after an error
  const bool is_made = stepper_->step(trial_.state, trial_.companion, length, end, trial_.report,
                                      {length / whole.step, repeats, scope_, stops});
  repeats_ = true;
  made_ += std::int64_t{stepper_->last().passes} * count();
  return is_made;
}

std::span<const StepClosing> SetPhases::try_whole(const State& state, const Companion& companion,
                                                  const WholeStep& whole) {
  begin(nullptr, state, companion);
  std::span<const StepClosing> closings;
  const auto closes = [searches = counts_ != nullptr](const SweptPair&) { return searches; };
  const auto stops = [&](const State& end, const ContactModes& modes) {
    closings = closings_->all(way_to(end, modes), closes);
    return !closings.empty();
  };
  if (!try_phase(whole, whole.end, stops)) {
    // The way of the pass that was made.
    trial_.state = stepper_->last().end;
    trial_.companion.modes.clear();
    return closings;
  }
  return closings_->all(way(), closes);
}

/// Begins a step. \param scope bodies that are advanced; null: all \param state,companion where phases begin
void SetPhases::begin(const StepScope* scope, const State& state, const Companion& companion) {
  scope_ = scope;
  start_ = &state;
  companion_ = &companion;
  repeats_ = false;
  phases_ = 0;
  closings_->begin_step();
  closings_->begin_phase();
  if (counts_) counts_->begin_step();
}

void SetPhases::take_whole(State& state, Companion& companion, StepReport& report) {
  if (counts_) note_closings(nullptr);
  std::swap(state, trial_.state);
  std::swap(companion, trial_.companion);
  trial_.report.findings.swap(report.findings);
  std::swap(report, trial_.report);
}

/// Contacts that may end phases of the bodies at hand.
int SetPhases::most_hits() const {
  constexpr int least = 1;
  const auto bodies = static_cast<int>(count());
  return bodies < hits_of_bodies ? std::max(least, hits_of_bodies / (bodies * bodies)) : least;
}

/// The state behind the impacts at the start of the phase.
const State& SetPhases::after_impacts() const {
  const TimeStepper::LastStep last = stepper_->last();
  return last.after_impacts != nullptr ? *last.after_impacts : *start_;
}

/// The way of a phase to some end. Bodies that are moved out of something there are not looked at on that
/// way: it does not grow shorter with the phase. \param modes of the contacts that acted
StepWay SetPhases::way_to(const State& end, const ContactModes& modes) {
  const TimeStepper::LastStep last = stepper_->last();
  const bool moves_out = stepper_->options().project_gaps;
  if (moves_out) {
    came_ = end;
    last.projection->take_back(came_);
  }
  return {*start_, moves_out ? came_ : end, after_impacts().v, *last.flights, modes, bodies_of(scope_)};
}

/// Takes note of the contacts that close at the end of a phase. \param hit at which it ends; null where it
/// ends elsewhere
void SetPhases::note_closings(const StepClosing* hit) {
  bool known = false;
  const auto accelerations = [&]() -> const std::vector<double>& {
    if (std::exchange(known, true)) return accelerations_;
    stepper_->last().flights->write_accelerations(after_impacts().v, trial_.state,
                                                  trial_.state.time - start_->time, accelerations_);
    return accelerations_;
  };
  counts_->find(trial_.state, trial_.companion.modes, bodies_of(scope_));
  // A body that was moved out of something else may be open where it has been hit, and close again.
  const bool may_have_opened = stepper_->options().project_gaps;
  if (hit != nullptr && !may_have_opened && !counts_->lists_parts_of(hit->key))
    closings_->leave_aside(hit->pair.pair);
  if (!stepper_->ends_at_closings()) return;
  counts_->note(trial_.state, hit == nullptr ? nullptr : &hit->key, accelerations, trial_.companion.closings);
}

/// True where a phase may end whatever the gap is then: where something comes deep, and where the body of a
/// closing is hit and flies on within the phase.
bool SetPhases::is_followed(const StepClosing& closing) const {
  return closing.is_passage || stepper_->last().flights->follow(closing.pair.pair);
}

/// A phase up to the end of the step, or to the first closing. What would leave a thing on its far side by
/// the end of a phase is in it at an earlier end. \param first closing on the way to the end of the step,
/// where that was tried; null: it is to be tried
void SetPhases::make_phase(const WholeStep& whole, const StepClosing* first) {
  constexpr int most_tries = 1000;
  closings_->begin_phase();
  const bool searches = counts_ && hits_ == Hits::end_phases && phases_ < most_hits();
  PhaseEnds ends(start_->time, whole.end);
  double end = whole.end;
  StepClosing found;  // the one that is headed for
  const auto closes = [&](const SweptPair& pair) { return searches && !counts_->is_given_up(pair.key); };
  const auto stops = [&](const State& at, const ContactModes& modes) {
    found = closings_->first(way_to(at, modes), closes);
    if (found.time < end) end = ends.between(found.time);
    return found.time < never;
  };
  if (first != nullptr) {
    found = *first;
    end = ends.between(found.time);
  }
  bool may_stop = first == nullptr;
  for (int tries = 0;; ++tries) {
    if (tries > most_tries) fail(found.key, whole, most_tries);
    const bool is_made = try_phase(whole, end, may_stop ? Stops(stops) : Stops());
    may_stop = false;
    if (!is_made) continue;
    const StepClosing now = closings_->first(way(), closes);
    const bool is_late = now.time < end;
    if (is_late) found = now;
    const bool heads_for_contact = end < whole.end && !is_followed(found);
    if (heads_for_contact) closings_->look_at_end(found);
    ends.take(heads_for_contact ? EndGap{found.pair.pair, end, found.gap, found.rate} : EndGap{}, end,
              is_late);
    // A body may be hit on one way and not on another that is hardly longer.
    if (is_late && is_followed(now) && !(now.time > ends.open())) ends.reopen();
    if (heads_for_contact && !is_late && found.is_refuted()) {
      closings_->refute(found.pair.pair);
      ends.restart();
      end = whole.end;
      continue;
    }
    const bool ends_late = heads_for_contact && ends.are_as_near_as_can_be(found);
    if (ends_late && is_late) break;
    if (!is_late && (end == whole.end || found.is_reached() || is_followed(found))) break;
    const double guess = is_late ? now.time : found.time_by_rate(end);
    const double next = ends_late ? ends.closed() : ends.next(found, guess);
    if (next == end) break;  // as near as times can be told apart
    end = next;
  }
  finish_phase(whole, found);
}

/// Takes note of what a phase ends with.
void SetPhases::finish_phase(const WholeStep& whole, StepClosing& found) {
  const bool early = trial_.state.time < whole.end;
  if (early && ++phases_ > most_phases) fail(found.key, whole, most_phases);
  if (!counts_) return;
  // A closing that is not looked for any more is told.
  if (closings_->any_left_out()) ++trial_.companion.statistics.cut_sequences;
  const bool hits = early && !is_followed(found);
  if (hits) closings_->look_at_end(found);
  note_closings(hits ? &found : nullptr);
}

[[noreturn]] void SetPhases::fail(const ConstraintKey& key, const WholeStep& whole, int allowed) const {
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

void SetPhases::make(SetRun& run, const WholeStep& whole, const StepClosing* first, Hits hits,
                     std::vector<Box<2>>& boxes) {
  constexpr double much = 0.5;
  begin(&run.scope, run.state, run.companion);
  hits_ = hits;
  for (bool is_first = true; run.state.time < whole.end; is_first = false) {
    make_phase(whole, is_first ? first : nullptr);
    closings_->add_boxes(way(), boxes);
    if (is_first) {
      std::swap(run.report, trial_.report);
    } else {
      add(trial_.report, run.report);
    }
    std::swap(run.state, trial_.state);
    std::swap(run.companion, trial_.companion);
    repeats_ = false;
    // Impulses of a short phase say less of the next one than those of a longer phase before it.
    ContactHistory &now = run.companion.contacts, &before = trial_.companion.contacts;
    if (!before.empty() && now.step < much * before.step) std::swap(now, before);
  }
}

}  // namespace carom
