// Problem: a state of time stepping that the event-driven mode accepts.

#include <carom/contact/assembly_gaps.h>
#include <carom/contact/detection/contact_look.h>
#include <carom/contact/detection/rolling_resistance.h>
#include <carom/contact/island_partition.h>
#include <carom/contact/island_problem.h>
#include <carom/contact/separation.h>
#include <carom/core/dynamics/answering_bodies.h>
#include <carom/core/dynamics/components_response.h>
#include <carom/core/dynamics/joint_closure.h>
#include <carom/core/dynamics/joint_constraints.h>
#include <carom/core/listed.h>
#include <carom/integrators/event_driven/event_balance.h>
#include <carom/integrators/mode_switch.h>

#include <algorithm>
#include <string>
#include <utility>

namespace carom {

namespace {

/// Names all contacts that leave no room between them, the deepest first.
[[noreturn]] void fail_wedged(const Detector& detector, const Separation& result, double time) {
  ConstraintSet contacts;
  contacts.assign(result.together);
  std::stable_sort(contacts.begin(), contacts.end(),
                   [](const Constraint& a, const Constraint& b) { return a.gap < b.gap; });
  SolverFailure failure;
  failure.time = time;
  failure.residual = -result.left->gap;
  for (const Constraint& contact : contacts) failure.parts.push_back(detector.name(contact.key));
  const std::string message = "change to the event-driven mode at t = " + to_text(time) +
                              " s: no displacement opens the gaps of " + listed(failure.parts) +
                              " together; left is " + to_text(result.left->gap) +
                              " m; allowed: bodies that have room";
  throw SolverError(message, std::move(failure));
}

[[noreturn]] void fail(const Detector& detector, const Constraint& contact, double time, const char* what) {
  SolverFailure failure;
  failure.time = time;
  failure.parts.push_back(detector.name(contact.key));
  const std::string message = "change to the event-driven mode at t = " + to_text(time) + " s: " + what +
                              " of " + failure.parts.front();
  throw SolverError(message, std::move(failure));
}

/// Applies the answer of an island, and records its contacts.
void apply(const Assembly& assembly, const IslandProblem& island, State& trial, EventBalance& balance) {
  SolvedImpact impact{
      .kind = EventKind::mode_switch, .time = trial.time, .problem = island, .velocity = trial.v.data()};
  impact.energy_before = kinetic_energy_of_answering(assembly, island.constraints(), trial.v.data());
  balance.note_before(island, trial.view(), assembly);
  island.map().add_velocities(trial.v.data());
  impact.energy_after = kinetic_energy_of_answering(assembly, island.constraints(), trial.v.data());
  balance.book(impact, assembly);
}

/// Lists the closed contacts of a component, behind each its rolling resistance.
void find_closed(const Detector& detector, const GroundPlaces& places, Index component, const State& state,
                 const Evaluation& evaluation, ConstraintSet& contacts) {
  contacts.clear();
  detector.find(component, state.view(), evaluation, places, nullptr, 0.0, contacts);
  if (!resists_rolling(detector)) return;
  ConstraintSet with_rolling;
  for (const Constraint& contact : contacts) {
    with_rolling.add(contact);
    if (!contact.law.resists_rolling()) continue;
    write_rolling_resistance(contact, ground_motion_of(detector, contact, places), with_rolling.add());
  }
  std::swap(contacts, with_rolling);
}

/// Gaps of contacts, ascending by key.
using Gaps = std::vector<std::pair<ConstraintKey, double>>;

Gaps gaps_within(double reach, ContactLook& look, const State& state) {
  ConstraintSet contacts;
  look.find(state.view(), reach, contacts);
  Gaps gaps;
  gaps.reserve(contacts.size());
  for (const Constraint& contact : contacts) gaps.emplace_back(contact.key, contact.gap);
  std::sort(gaps.begin(), gaps.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  return gaps;
}

/// Drops the modes of contacts that a displacement has opened: they are closed no more, though they were in
/// the step before.
void forget_opened(const Assembly& assembly, const Detector& detector, const State& before,
                   const State& after, const Separation& result, Companion& companion) {
  // Both bodies of a contact are moved, and turned.
  const double reach = 4.0 * result.shift;
  ContactLook look(assembly, detector);
  const Gaps closed = gaps_within(reach, look, before), now = gaps_within(reach, look, after);
  const auto find = [](const Gaps& gaps, const ConstraintKey& key) {
    const auto at =
        std::lower_bound(gaps.begin(), gaps.end(), key,
                         [](const auto& entry, const ConstraintKey& of) { return entry.first < of; });
    return at != gaps.end() && at->first == key ? &at->second : nullptr;
  };
  std::erase_if(companion.modes, [&](const auto& entry) {
    const double* const gap_before = find(closed, entry.first);
    const double* const gap = find(now, entry.first);
    if (gap_before == nullptr) return false;  // not by the displacement
    return gap == nullptr || *gap > std::max(*gap_before, 0.0) + 4.0 * result.depth;
  });
}

/// Books the energy of the change, and what solvers counted.
void book(const StoredEnergies& stored, const ChainStatistics& solved, std::size_t contacts,
          Companion& companion) {
  companion.ledger.book(EnergyFlow::mode_switch, companion.ledger.total() - stored.total(), stored);
  companion.contact_statistics += solved;
  companion.statistics.events[static_cast<std::size_t>(EventKind::mode_switch)] +=
      static_cast<std::int64_t>(contacts);
}

/// Moves bodies out of all shapes on ground, for out of one they may come into another, and apart.
Separation move_apart(const Assembly& assembly, const Detector& detector, const GroundPlaces& places,
                      SolverChain& chain, State& trial, Evaluation& evaluation) {
  AssemblyGaps gaps;
  Separation result = separate_all(assembly, detector, places, gaps, chain, trial, evaluation);
  if (result.left != nullptr) fail_wedged(detector, result, trial.time);
  result.together = {};  // of the gaps, which end here
  return result;
}

}  // namespace

void prepare_for_events(const Assembly& assembly, EventDriver& driver, State& state, Companion& companion,
                        StepReport& report, RecordedEvents& events) {
  const Detector& detector = driver.detector();
  State trial = state;
  Evaluation evaluation = make_evaluation(assembly);
  SolverChain chain;
  IslandProblem problem;
  IslandPartition partition;
  const auto bodies = static_cast<Index>(assembly.layout()->bodies().size());
  GroundPlaces places;
  detector.place(state.time, places);
  ConstraintSet contacts;
  EventBalance balance;
  for (Index component = 0; component < assembly.components().size(); ++component) {
    evaluate_positions(assembly, component, trial.view(), evaluation);
    find_closed(detector, places, component, trial, evaluation, contacts);
    JointConstraints joints(assembly, component);
    joints.update_and_factor({trial.view(), evaluation.rotation.data()});
    MassResponse masses(assembly);
    JointResponse with_joints(joints);
    const auto islands =
        partition.arrange(std::span(contacts), bodies, [&](Index body) { return assembly.mechanism(body); });
    for (const Range island : islands) {
      const auto of_body = std::span<const Constraint>(contacts).subspan(island.begin, island.size());
      const bool approaches = std::any_of(of_body.begin(), of_body.end(), [&](const Constraint& contact) {
        return contact.normal_velocity(trial.v.data()) < 0.0;
      });
      if (!approaches) continue;
      problem.build(of_body, trial.v.data());
      problem.respond(joints.empty() ? static_cast<BodyResponse&>(masses) : with_joints);
      problem.set_free_velocity(trial.v.data());
      if (!problem.solve(chain).usable()) fail(detector, of_body.front(), state.time, "no impact is found");
      apply(assembly, problem, trial, balance);
    }
  }
  const Separation moved = move_apart(assembly, detector, places, chain, trial, evaluation);
  // Where bodies were moved their joints stand elsewhere.
  const double shift = std::max(moved.shift, close_joints(assembly, trial).shift);
  driver.demand_start(trial);
  const StoredEnergies stored = stored_energies(assembly, trial.view(), evaluation);
  if (moved.moved) forget_opened(assembly, detector, state, trial, moved, companion);
  book(stored, chain.statistics(), balance.fresh.size(), companion);
  state = std::move(trial);
  report = {};
  report.time = state.time;
  report.projected = shift;
  events.append(std::move(balance.fresh));
}

}  // namespace carom
