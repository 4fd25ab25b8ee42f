// Problem: steps in which bodies fly, without anything that only contact, couplings, joints need.

#include <carom/core/numerics/compensated_sum.h>
#include <carom/integrators/time_stepping/free_flight.h>
#include <carom/integrators/time_stepping/step_commit.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

namespace carom {

namespace {

/// True if surely nothing touches where bodies are.
bool is_free(const State& state, const Detector& detector, std::span<const CentreRow> rows) {
  const double* const q = state.q.data();
  return std::none_of(rows.begin(), rows.end(),
                      [&](const CentreRow& row) { return detector.ground().may_touch(row, q); });
}

/// True if nothing has touched in the step before and surely nothing does at the start of this one.
bool starts_free(const StepInput& in, const Detector& detector, std::span<const CentreRow> rows) {
  return in.companion.modes.empty() && in.companion.contacts.empty() && is_free(in.start, detector, rows);
}

/// Work of the loads of all bodies, which have moved [J]. \param stored energies at the end, to be added to
double work_of(const StepInput& in, const StepRule& rule, std::span<FlyingBodies> batches,
               const StepTrial& trial, StoredEnergies& stored) {
  CompensatedSum work;
  for (FlyingBodies& batch : batches) {
    const double* const v = trial.end.v.data() + batch.place.v;
    stored[StoredEnergy::kinetic] += batch.place.kind->kinetic_energy(batch.place.slots, v);
    work.add(rule.work_constant(in, batch.v, trial));
    batch.end.state = trial.end.view();
    StoredEnergies potentials;
    for (const FlyingBodies::Potential& of : batch.potentials) {
      potentials[of.form] += of.kind->potential(batch.end, of.elements);
    }
    for (std::size_t i = 0; i < stored_energy_count; ++i) stored.values[i] += potentials.values[i];
  }
  return work.value();
}

}  // namespace

bool FreeFlight::fits(const StepParts& parts) {
  const auto is_small = [&](Range batch) {
    const Range bodies = parts.assembly->bodies_of(batch);
    const BodySlots& slots = parts.assembly->layout()->bodies();
    return bodies.size() <= BlockTable::block_size &&
           slots[bodies.begin].kind == slots[bodies.end - 1].kind && (batch.size() > 1 || bodies.size() == 1);
  };
  const auto& batches = parts.schedule.batches();
  return !parts.schedule.any_iterated() && centres_tell(parts.constraints.detector()) &&
         std::all_of(batches.begin(), batches.end(), is_small);
}

FreeFlight::FreeFlight(StepParts& parts)
    : parts_(&parts), rows_(parts.constraints.detector().ground().centre_rows()) {
  for (const Range batch : parts.schedule.batches()) {
    // As in every step: components that are taken in one loop are swept.
    const bool alone = batch.size() == 1 && parts.options.iteration != Iteration::automatic;
    if (alone) iteration_ = parts.options.iteration;
    add_batch(batch);
  }
}

void FreeFlight::add_batch(Range components) {
  const Assembly& assembly = *parts_->assembly;
  const Index component = components.begin;
  const Range bodies = assembly.bodies_of(components);
  const auto& all = assembly.components();
  const StepTrial& trial = parts_->trial;
  const Range together = components.size() > 1 ? bodies : Range{};
  FlyingBodies batch{.end = {assembly, trial.end.view(), trial.at_end, component, together},
                     .v = {all[component].v.begin, all[components.end - 1].v.end}};
  assembly.for_bodies(bodies, [&](const BodyKind& kind, Range slots, Index q, Index v, Index) {
    batch.place = {&kind, slots, q, v};
    batch.masses = kind.masses(slots.begin);
  });
  for (Index kind = 0; kind < assembly.force_kinds().size(); ++kind) {
    const ForceKind& elements = *assembly.force_kinds()[kind];
    const Range range = assembly.elements(component, kind);
    if (!range.empty()) batch.potentials.push_back({&elements, range, elements.stored_as()});
  }
  batches_.push_back(std::move(batch));
}

Flight FreeFlight::step(const StepInput& in, State& state, Companion& companion, StepReport& report) {
  if (!starts_free(in, parts_->constraints.detector(), rows_)) return Flight::refused;
  StepTrial& trial = parts_->trial;
  trial.end.time = in.end_time;
  for (const FlyingBodies& batch : batches_) parts_->rule.fly(in, batch.place, batch.masses, trial);
  // What touches at the end hits within the step.
  if (parts_->located.on() && !is_free(trial.end, parts_->constraints.detector(), rows_))
    return Flight::moved;
  StoredEnergies stored;
  const double work = work_of(in, parts_->rule, batches_, trial, stored);
  if (!std::isfinite(stored.total())) return Flight::moved;
  flows_[EnergyFlow::coupling_discretisation] =
      discretisation_loss(stored.potential(), companion.ledger.potential(), work);
  companion.ledger.book(flows_, stored);
  take_end(in, parts_->rule.is_mean(), trial, state, companion);
  companion.iterations.clear();
  StepNumbers& numbers = report;
  numbers = {};
  numbers.time = in.end_time;
  numbers.step = in.step;
  numbers.sweeps = 1;
  numbers.iteration = iteration_;
  report.contacts.clear();
  report.joint_impulses.clear();
  report.capped_problem.clear();
  count_step(numbers, companion.statistics);
  return Flight::made;
}

}  // namespace carom
