// Problem: components at their own pace, one state for everybody else.

#include <carom/core/dynamics/coupling_rating.h>
#include <carom/integrators/event_driven/event_driver.h>
#include <carom/integrators/run/failure_file.h>

#include <algorithm>
#include <cmath>
#include <numeric>
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
  if (options.method > FlowMethod::one_step) {
    throw ModelError("event-driven mode: method is " + std::to_string(static_cast<int>(options.method)) +
                     "; allowed: one of FlowMethod, explicit_runge_kutta (0) to one_step (3)");
  }
  check_failure_directory(options.failure_directory, "event-driven mode");
}

EventDriver::EventDriver(const Assembly& assembly, const EventDriven& options, const StopRequest* stop)
    : assembly_(&assembly),
      options_((check_options(options), options)),
      detector_(assembly),
      prescribed_(assembly),
      memory_(assembly, options, stop),
      evaluation_(make_evaluation(assembly)),
      trial_(assembly.layout()) {
  for (Index component = 0; component < assembly.components().size(); ++component) {
    components_.push_back(std::make_unique<ClockGroup>(assembly, detector_, options_, component, memory_));
  }
}

/// Looks at a state, where no step or event is at hand that could tell of too many evaluations.
template <class F>
auto EventDriver::within_limit(double time, F&& look) const {
  try {
    return look();
  } catch (const EvaluationLimit::Reached&) {
    SolverFailure failure;
    failure.time = time;
    throw SolverError("event-driven at t = " + to_text(time) + " s: more than " +
                          std::to_string(options_.evaluation_limit) +
                          " evaluations to look at a state (evaluation_limit)",
                      std::move(failure));
  }
}

void EventDriver::demand_start(const State& state) {
  within_limit(state.time, [&] {
    for (auto& component : components_) component->demand_start(state);
  });
}

void EventDriver::start(const State& state, const Companion& companion) {
  ContactModes present = companion.modes;
  std::sort(present.begin(), present.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  within_limit(state.time, [&] {
    for (auto& component : components_) component->start(state, present);
  });
  counted_ = memory_.flows.counts();
  started_ = true;
}

void EventDriver::advance(State& state, Companion& companion, double target, StepReport& report,
                          std::vector<EventRecord>& events) {
  demand_continuous_laws(state.time, target);
  if (!started_) start(state, companion);
  balance_.flows = {};
  balance_.events.clear();
  balance_.joint_impulses.clear();
  balance_.counts = {};
  balance_.energy_gain = balance_.shift = 0.0;
  try {
    for (auto& component : components_) component->advance(target, balance_);
  } catch (...) {
    started_ = false;
    memory_.chain.reset_statistics();
    throw;
  }
  trial_.time = target;
  modes_.clear();
  for (auto& component : components_) component->write(trial_, modes_);
  const StoredEnergies stored = stored_energies(*assembly_, trial_.view(), evaluation_);
  if (!std::isfinite(stored.total())) fail_energy(state.time, target);
  order_events();
  std::vector<ContactRecord> contacts = std::move(report.contacts);
  contacts.clear();
  std::vector<JointImpulse> joints = std::move(report.joint_impulses);
  std::vector<ModelFinding> findings = std::move(report.findings);
  report = {};
  report.findings = std::move(findings);
  report.contacts = std::move(contacts);
  report.joint_impulses = std::move(joints);
  report.joint_impulses.assign(balance_.joint_impulses.begin(), balance_.joint_impulses.end());
  report.time = target;
  report.step = target - state.time;
  report.energy_gain = balance_.energy_gain;
  report.projected = balance_.shift;
  report_contacts(balance_, report);
  companion.ledger.book(balance_.flows, stored);
  companion.modes.swap(modes_);
  count(companion);
  state.q.swap(trial_.q);
  state.v.swap(trial_.v);
  state.z.swap(trial_.z);
  state.time = target;
  if (options_.record_events) events.insert(events.end(), balance_.events.begin(), balance_.events.end());
}

void EventDriver::demand_continuous_laws(double from, double to) {
  try {
    if (!prescribed_.empty()) prescribed_.demand_continuous(from, to);
    if (!detector_.has_moving_obstacles()) return;
    if (places_after_.time() == from) std::swap(places_, places_after_);
    detector_.place(from, places_);
    detector_.place(to, places_after_);
    detector_.demand_continuous(places_, places_after_);
  } catch (const SolverError& error) {
    SolverFailure failure = error.failure();
    failure.time = from;
    failure.step = to - from;
    throw SolverError("event-driven at t = " + to_text(from) + " s: " + error.what(), std::move(failure));
  }
}

void EventDriver::fail_energy(double from, double to) {
  started_ = false;
  memory_.chain.reset_statistics();
  SolverFailure failure;
  failure.time = from;
  failure.step = to - from;
  std::string message = "event-driven at t = " + to_text(to) + " s: ";
  for (Index component = 0; component < assembly_->components().size(); ++component) {
    evaluate_positions(*assembly_, component, trial_.view(), evaluation_);
    const ElementId cause = find_non_finite_potential(*assembly_, component, trial_.view(), evaluation_);
    if (cause.valid()) failure.parts.push_back(assembly_->system().name(cause));
  }
  message += failure.parts.empty() ? "an energy is too large to be counted"
                                   : "the potential of " + failure.parts.front() + " is not finite";
  throw SolverError(message, std::move(failure));
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
    return components_[component]->reaction(*assembly_->joint_kinds()[place.kind], place.slot, joint);
  });
}

/// Components were gone through one after the other; their events are told in time, then by component.
void EventDriver::order_events() {
  const auto earlier = [](const EventRecord& a, const EventRecord& b) { return a.time < b.time; };
  if (std::is_sorted(balance_.events.begin(), balance_.events.end(), earlier)) return;
  order_.resize(balance_.events.size());
  std::iota(order_.begin(), order_.end(), std::size_t{0});
  std::sort(order_.begin(), order_.end(), [&](std::size_t a, std::size_t b) {
    const double first = balance_.events[a].time, second = balance_.events[b].time;
    return first < second || (first == second && a < b);
  });
  ordered_.clear();
  for (const std::size_t place : order_) ordered_.push_back(balance_.events[place]);
  balance_.events.swap(ordered_);
}

void EventDriver::report_contacts(const EventBalance& balance, StepReport& report) const {
  for (const EventRecord& event : balance.events) {
    const bool impulsive = event.kind == EventKind::impact || event.kind == EventKind::accumulation ||
                           event.kind == EventKind::impact_without_collision;
    if (!impulsive) continue;
    ContactRecord& entry = report.contacts.emplace_back();
    entry.key = event.contact;
    entry.body = event.body;
    entry.obstacle = event.obstacle;
    const bool stop = event.contact.a.owner == FeatureKey::Owner::joint;
    entry.directions = stop ? 1 : assembly_->layout()->dimension();
    entry.velocity_before = event.velocity_before;
    entry.velocity_after = event.velocity_after;
    entry.impulse = event.impulse;
    for (std::size_t i = 0; i < 3; ++i) {
      entry.work[i] = 0.5 * event.impulse[i] * (event.velocity_before[i] + event.velocity_after[i]);
    }
    entry.mode = event.mode;
    entry.impact = true;
    entry.outcome = event.outcome;
    entry.residual = event.residual;
    entry.solver = event.solver;
  }
}

void EventDriver::count(Companion& companion) {
  Statistics& statistics = companion.statistics;
  ++statistics.steps;
  for (std::size_t kind = 0; kind < event_kind_count; ++kind)
    statistics.events[kind] += balance_.counts[kind];
  for (const EventRecord& event : balance_.events) {
    if (event.kind == EventKind::impact && event.impulse[0] > 0.0) ++statistics.impacts;
    if (event.outcome == Outcome::several_solutions) ++statistics.several_solutions;
    if (event.outcome == Outcome::forces_not_unique) ++statistics.forces_not_unique;
    statistics.worst_residual = std::max(statistics.worst_residual, event.residual);
  }
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
    companion.contact_statistics += memory_.chain.statistics();
    memory_.chain.reset_statistics();
  }
}

}  // namespace carom
