// Problem: clock groups at their own pace, one state for everybody else.

#include <carom/core/dynamics/coupling_rating.h>
#include <carom/core/run_error.h>
#include <carom/integrators/event_driven/event_driver.h>
#include <carom/integrators/run/failure_file.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace carom {

void check_options(const EventDriven& options) {
  const auto positive = [](const char* option, double value, const char* unit) {
    if (is_admissible(value) && value > 0.0) return;
    throw ModelError(std::string("event-driven mode: ") + option + " is " + to_text(value) +
                     "; allowed: " + allowed_instead(value, std::string("finite and > 0") + unit));
  };
  positive("relative_tolerance", options.relative_tolerance, "");
  positive("absolute_tolerance", options.absolute_tolerance, " m");
  positive("interval", options.interval, " s");
  positive("longest_step", options.longest_step, " s");
  positive("gap_tolerance", options.gap_tolerance, " m");
  positive("capture_speed", options.capture_speed, " m/s");
  positive("largest_projection", options.largest_projection, "");
  positive("event_limit", options.event_limit, " 1/s");
  positive("step_limit", options.step_limit, " 1/s");
  if (options.evaluation_limit < 1) {
    throw ModelError("event-driven mode: evaluation_limit is " + std::to_string(options.evaluation_limit) +
                     "; allowed: at least 1");
  }
  if (options.record_limit < 0) {
    throw ModelError("event-driven mode: record_limit is " + std::to_string(options.record_limit) +
                     "; allowed: at least 0, which keeps all records");
  }
  if (options.method > FlowMethod::one_step) {
    throw ModelError("event-driven mode: method is " + std::to_string(static_cast<int>(options.method)) +
                     "; allowed: one of FlowMethod, explicit_runge_kutta (0) to one_step (3)");
  }
  check_rules(options.impact_rules, "event-driven mode");
  check_failure_directory(options.failure_directory, "event-driven mode");
}

EventDriver::EventDriver(const Assembly& assembly, const EventDriven& options, const StopRequest* stop)
    : assembly_(&assembly),
      options_((check_options(options), options)),
      detector_(assembly, {.corner = options.gap_tolerance}),
      laws_(assembly, detector_),
      overlaps_(assembly, detector_, options_),
      memory_(assembly, options, stop),
      groups_(assembly, detector_, options_, memory_),
      trial_(assembly.layout()),
      balance_({.records = options.record_events.choice() != EventRecords::nothing,
                .limit = static_cast<std::size_t>(options.record_limit),
                .zero_impulses = options.record_events.choice() == EventRecords::all}),
      stop_(stop) {
  constexpr std::size_t few = 8;
  modes_.reserve(few);
  if (!detector_.bodies_touch()) return;
  for (MotionSample* sample : {&memory_.instant.now, &memory_.motion.flow})
    sample->note_places(assembly.components().size());
  meetings_ = std::make_unique<GroupMeetings>(assembly, detector_, options_, memory_, groups_);
}

/// Evaluates a state outside of any step or event, whose group would fail for too many evaluations.
template <class F>
auto EventDriver::within_limit(double time, F&& evaluate) const {
  try {
    return evaluate();
  } catch (const EvaluationLimit::Reached&) {
    SolverFailure failure;
    failure.time = time;
    throw RunError("event-driven at t = " + to_text(time) + " s: more than " +
                       std::to_string(options_.evaluation_limit) +
                       " evaluations to look at a state (evaluation_limit)",
                   std::move(failure));
  }
}

void EventDriver::demand_start(const State& state) {
  within_limit(state.time, [&] {
    if (meetings_) meetings_->regroup(state), started_ = false;
    groups_.for_each([&](ClockGroup& group) { group.demand_start(state); });
    Evaluation& evaluation = memory_.instant.now.evaluation;
    evaluate_positions(*assembly_, state.view(), evaluation);
    overlaps_.demand_start(state, evaluation);
  });
}

void EventDriver::start(const State& state, const Companion& companion) {
  ContactModes present = companion.modes;
  std::sort(present.begin(), present.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  within_limit(state.time, [&] {
    if (meetings_) meetings_->regroup(state);
    groups_.for_each([&](ClockGroup& group) { group.start(state, present); });
    if (meetings_) meetings_->start(state.time);
  });
  counted_ = memory_.flows.counts();
  started_ = true;
}

std::size_t EventDriver::advance(State& state, Companion& companion, double target, StepReport& report,
                                 RecordedEvents& events, bool may_be_interrupted) {
  demand_laws(state.time, target);
  reached_.good_until = state.time;
  StoredEnergies stored;
  try {
    if (!started_) start(state, companion);
    advance_groups(state.time, target, may_be_interrupted && stop_ != nullptr && stop_->may_interrupt());
    reached_.good_until = target;
    modes_.clear();
    groups_.for_each([&](const ClockGroup& group) { group.write(trial_, modes_); });
    stored = account(state.time, target);
  } catch (...) {
    // Steps of groups ahead of the state are of no use after an error.
    started_ = false;
    memory_.chain.reset_statistics();
    throw;
  }
  return commit(state, companion, stored, report, events);
}

std::size_t EventDriver::stand_where_reached(State& state, Companion& companion, StepReport& report,
                                             RecordedEvents& events) {
  if (!reached_.is_known) return 0;
  balance_.return_to(reached_.balance, reached_.state.time);
  trial_ = reached_.state;
  modes_.swap(reached_.modes);
  reached_.is_known = false;
  const std::size_t count = commit(state, companion, account(state.time, trial_.time), report, events);
  if (reached_.solved.problems > 0) count_solved(companion, reached_.solved);
  return count;
}

/// Energies of the trial state, which groups have reached. No event is looked at any more.
StoredEnergies EventDriver::account(double from, double target) {
  trial_.time = target;
  const StoredEnergies stored = stored_energies(*assembly_, trial_.view(), memory_.instant.now.evaluation);
  if (!std::isfinite(stored.total())) fail_energy(from, target);
  overlaps_.demand_apart(trial_, memory_.instant.now.evaluation, memory_.motion.closure.lengths, from);
  balance_.finish();
  return stored;
}

/// Makes the trial state the state.
std::size_t EventDriver::commit(State& state, Companion& companion, const StoredEnergies& stored,
                                StepReport& report, RecordedEvents& events) {
  const double target = trial_.time;
  write_report(state.time, target, report);
  companion.ledger.book(balance_.flows, stored);
  companion.modes.swap(modes_);
  count(companion);
  state.q.swap(trial_.q);
  state.v.swap(trial_.v);
  state.z.swap(trial_.z);
  state.time = target;
  const std::size_t count = balance_.events.size();
  events.append(balance_.events, balance_.keeping.limit);
  return count;
}

/// Demands laws of time that do not jump, before anything moves.
void EventDriver::demand_laws(double from, double to) {
  try {
    laws_.demand(from, to, options_.interval);
  } catch (...) {
    reached_.good_until = laws_.good_until();
    throw;
  }
}

/// Groups that may meet go on together, others each to the end of a stretch; one stretch, unless somebody
/// waits.
void EventDriver::advance_groups(double from, double to, bool keeps_reached) {
  balance_.clear();
  reached_.is_known = false;
  reached_.books.assign(keeps_reached && !meetings_ ? assembly_->components().size() : 0, {});
  if (meetings_) meetings_->aim_at(to);
  try {
    if (keeps_reached) {
      constexpr auto pause = std::chrono::milliseconds(50);
      constexpr double first = 1.0 / 16.0;  // of the advance, at most
      Stretches stretches(std::min(options_.interval, first * (to - from)));
      reached_.taken = std::chrono::steady_clock::now();
      for (double at = stretches.end(from, to); at < to; at = stretches.end(at, to)) {
        move_groups(at, false);
        if (std::chrono::steady_clock::now() - reached_.taken < pause) continue;
        look_around(at);
        stop_->tell(at);
      }
    }
    move_groups(to, true);
  } catch (const RunError& error) {
    // Steps go ahead of `to`, where laws may jump that were not looked at yet: that is the cause then.
    laws_.demand(to, to + options_.longest_step, options_.interval);
    if (std::string_view(error.what()).starts_with("event-driven")) throw;  // it says where
    SolverFailure failure = error.failure();
    failure.time = trial_.time;
    throw RunError("event-driven at t = " + to_text(trial_.time) + " s: " + error.what(), failure);
  }
}

/// \param is_end their output states are those then
void EventDriver::move_groups(double to, bool is_end) {
  if (meetings_) {
    meetings_->advance(to, balance_, reached_.good_until);
    if (is_end) meetings_->output(to, balance_);
    return;
  }
  std::size_t place = 0;
  groups_.for_each([&](ClockGroup& group) {
    // Without stretches before the end a group has no sums yet.
    GroupBooks none_yet;
    GroupBooks& books = reached_.books.empty() ? none_yet : reached_.books[place++];
    balance_.exchange(books);
    try {
      group.advance(to, is_end, balance_);
    } catch (...) {
      reached_.good_until = group.now();
      throw;
    }
    balance_.exchange(books);
    if (is_end) balance_.add(books);
  });
}

/// Keeps what is reached, should the advance be interrupted before its end.
void EventDriver::look_around(double time) {
  reached_.is_known = false;
  reached_.balance.copy_totals(balance_);
  for (const GroupBooks& books : reached_.books) reached_.balance.add(books);
  reached_.state = trial_;
  reached_.state.time = time;
  reached_.modes.clear();
  reached_.solved = memory_.chain.statistics();
  groups_.for_each(
      [&](ClockGroup& group) { group.look_at(time, reached_.state, reached_.modes, reached_.balance); });
  reached_.taken = std::chrono::steady_clock::now();
  reached_.is_known = true;
}

/// Writes the report of an advance, but for its contacts; findings stay, and memory.
void EventDriver::write_report(double from, double to, StepReport& out) const {
  std::vector<ContactRecord> contacts = std::move(out.contacts);
  contacts.clear();
  std::vector<JointImpulse> joints = std::move(out.joint_impulses);
  std::vector<ModelFinding> findings = std::move(out.findings);
  out = {};
  out.findings = std::move(findings);
  out.contacts = std::move(contacts);
  out.joint_impulses = std::move(joints);
  out.joint_impulses.assign(balance_.joint_impulses.begin(), balance_.joint_impulses.end());
  out.time = to;
  out.step = to - from;
  out.energy_gain = balance_.energy_gain;
  out.projected = balance_.shift;
}

void EventDriver::fail_energy(double from, double to) {
  SolverFailure failure;
  failure.time = from;
  failure.step = to - from;
  std::string message = "event-driven at t = " + to_text(to) + " s: ";
  Evaluation& evaluation = memory_.instant.now.evaluation;
  for (Index component = 0; component < assembly_->components().size(); ++component) {
    evaluate_positions(*assembly_, component, trial_.view(), evaluation);
    const ElementId cause = find_non_finite_potential(*assembly_, component, trial_.view(), evaluation);
    if (cause.valid()) failure.parts.push_back(assembly_->system().name(cause));
  }
  message += failure.parts.empty() ? "an energy is too large to be counted"
                                   : "the potential of " + failure.parts.front() + " is not finite";
  throw RunError(message, std::move(failure));
}

JointReaction EventDriver::reaction(const State& state, const Companion& companion, JointId joint) {
  if (!started_) start(state, companion);
  const JointTable::Place place = assembly_->layout()->joints()->place(joint.serial);
  Index component = 0;
  const auto within = [&](Index i) {
    const Range range = assembly_->joints(i, place.kind);
    return place.slot >= range.begin && place.slot < range.end;
  };
  while (!within(component)) ++component;
  return within_limit(state.time, [&] {
    return groups_.of(component).reaction(*assembly_->joint_kinds()[place.kind], place.slot, joint);
  });
}

std::vector<LastingContact> EventDriver::contact_forces(const State& state, const Companion& companion) {
  if (!started_) start(state, companion);
  std::vector<LastingContact> forces;
  within_limit(state.time, [&] { groups_.for_each([&](ClockGroup& group) { group.list_forces(forces); }); });
  std::sort(forces.begin(), forces.end(),
            [](const LastingContact& a, const LastingContact& b) { return a.key < b.key; });
  return forces;
}

void EventDriver::count_solved(Companion& companion, const ChainStatistics& solved) {
  companion.statistics.count_step(solved.worst_residual);
  companion.contact_statistics += solved;
}

void EventDriver::count(Companion& companion) {
  Statistics& statistics = companion.statistics;
  ++statistics.steps;
  for (std::size_t kind = 0; kind < event_kind_count; ++kind)
    statistics.events[kind] += balance_.counts[kind];
  statistics.impacts += balance_.tally.impacts;
  statistics.cut_sequences += balance_.tally.cut_sequences;
  statistics.scaled_impacts += balance_.tally.scaled_impacts;
  statistics.plastic_jams += balance_.tally.plastic_jams;
  statistics.several_solutions += balance_.tally.several_solutions;
  statistics.forces_not_unique += balance_.tally.forces_not_unique;
  statistics.worst_residual = std::max(statistics.worst_residual, balance_.tally.worst_residual);
  if (balance_.energy_gain > 0.0) {
    ++statistics.energy_gains;
    statistics.energy_gained += balance_.energy_gain;
  }
  const FlowCounts now = memory_.flows.counts();
  statistics.flow_steps += now.steps - counted_.steps;
  statistics.flow_evaluations += now.evaluations - counted_.evaluations;
  statistics.flow_restarts += now.restarts - counted_.restarts;
  counted_ = now;
  if (memory_.chain.statistics().problems > 0) {
    count_solved(companion, memory_.chain.statistics());
    memory_.chain.reset_statistics();
  }
}

}  // namespace carom
