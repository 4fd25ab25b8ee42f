// Problem: steps of bodies that nothing couples, without anything that only couplings, joints or moving
// ground need.

#include <carom/core/numerics/compensated_sum.h>
#include <carom/integrators/time_stepping/step_commit.h>
#include <carom/integrators/time_stepping/sweep_schedule.h>
#include <carom/integrators/time_stepping/uncoupled_step.h>

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
                      [&](const CentreRow& row) { return detector.points().may_touch(row, q); });
}

/// True if nothing has touched in the step before and surely nothing does at the start of this one.
bool starts_free(const StepInput& in, const Detector& detector, std::span<const CentreRow> rows) {
  return in.companion.modes.empty() && in.companion.contacts.empty() && is_free(in.start, detector, rows);
}

/// Works of the loads of a batch, and energies at the end of the step.
LooseAccount account_of(const StepInput& in, const StepRule& rule, LooseBatch& batch,
                        const StepTrial& trial) {
  LooseAccount account;
  const LooseBodies& all = batch.all;
  account.works.kinetic = all.place.kind->kinetic_energy(all.place.slots, trial.end.v.data() + all.place.v);
  account.works.total = rule.work_constant(in, batch.v, trial);
  batch.end.state = trial.end.view();
  for (const LooseBatch::Potential& of : batch.potentials) {
    account.potentials[of.form] += of.kind->potential(batch.end, of.elements);
  }
  return account;
}

/// Work of the loads of all bodies, which have moved [J]. \param stored energies at the end, to be added to
double work_of(const StepInput& in, const StepRule& rule, std::span<LooseBatch> batches,
               const StepTrial& trial, StoredEnergies& stored) {
  CompensatedSum work;
  for (LooseBatch& batch : batches) {
    const LooseAccount account = account_of(in, rule, batch, trial);
    stored[StoredEnergy::kinetic] += account.works.kinetic;
    work.add(account.works.total);
    for (std::size_t i = 0; i < stored_energy_count; ++i) stored.values[i] += account.potentials.values[i];
  }
  return work.value();
}

}  // namespace

bool UncoupledStep::fits(const StepModel& model) {
  const auto is_small = [&](Range batch) {
    const Range bodies = model.assembly.bodies_of(batch);
    const BodySlots& slots = model.assembly.layout()->bodies();
    return bodies.size() <= BlockTable::block_size &&
           slots[bodies.begin].kind == slots[bodies.end - 1].kind && (batch.size() > 1 || bodies.size() == 1);
  };
  const std::span<const Range> batches = model.batches.all();
  return !model.batches.any_iterated() && centres_tell(model.detector) &&
         std::all_of(batches.begin(), batches.end(), is_small);
}

UncoupledStep::UncoupledStep(const StepModel& model, const ContactStage& contacts, StepTrial& trial,
                             double margin)
    : model_(&model),
      contacts_(&contacts),
      trial_(&trial),
      rows_(model.detector.points().centre_rows(margin)) {
  for (const Range batch : model.batches.all()) {
    // As in every step: components that are taken in one loop are swept.
    const bool alone = batch.size() == 1 && model.options.iteration != Iteration::automatic;
    if (alone) iteration_ = model.options.iteration;
    add_batch(batch);
  }
}

void UncoupledStep::add_batch(Range components) {
  const Assembly& assembly = model_->assembly;
  const Index component = components.begin;
  const Range bodies = assembly.bodies_of(components);
  const auto& all = assembly.components();
  const StepTrial& trial = *trial_;
  const Range together = components.size() > 1 ? bodies : Range{};
  const auto loose = [&](Range some) {
    LooseBodies found{some, assembly.bodies_of(some)};
    assembly.for_bodies(found.bodies, [&](const BodyKind& kind, Range slots, Index q, Index v, Index) {
      found.place = {&kind, slots, q, v};
      found.masses = kind.masses(slots.begin);
    });
    return found;
  };
  LooseBatch batch{.end = {assembly, trial.end.view(), trial.at_end, component, together},
                   .v = {all[component].v.begin, all[components.end - 1].v.end},
                   .all = loose(components)};
  SweepSchedule::for_pieces(components, SweepSchedule::piece_size, [&](Range some) {
    LoosePiece& piece = batch.pieces.emplace_back(LoosePiece{.all = loose(some)});
    SweepSchedule::for_pieces(some, SweepSchedule::touching_size,
                              [&](Range few) { piece.parts.push_back(loose(few)); });
  });
  for (Index kind = 0; kind < assembly.force_kinds().size(); ++kind) {
    const ForceKind& elements = *assembly.force_kinds()[kind];
    const Range range = assembly.elements(component, kind);
    if (!range.empty()) batch.potentials.push_back({&elements, range, elements.stored_as()});
  }
  batches_.push_back(std::move(batch));
}

void UncoupledStep::move(const StepInput& in, const LooseBodies& bodies) const {
  const std::span<const Index> struck = contacts_->struck(bodies.bodies);
  const bool all = struck.size() == bodies.bodies.size();
  model_->rule.move_constant(in, bodies.place, bodies.masses, all, *trial_);
  if (all) return;
  for (const Index body : struck) model_->rule.move_constant(in, {body, body + 1}, true, *trial_);
}

LooseAccount UncoupledStep::account(const StepInput& in, LooseBatch& batch) const {
  return account_of(in, model_->rule, batch, *trial_);
}

Flight UncoupledStep::fly(const StepInput& in, State& state, Companion& companion, StepReport& report) {
  if (!starts_free(in, model_->detector, rows_)) return Flight::not_free;
  StepTrial& trial = *trial_;
  trial.end.time = in.end_time;
  for (const LooseBatch& batch : batches_)
    model_->rule.move_constant(in, batch.all.place, batch.all.masses, false, trial);
  // Bodies that touch at the end hit within the step.
  if (model_->follows_bodies && !is_free(trial.end, model_->detector, rows_)) return Flight::moved;
  StoredEnergies stored;
  const double work = work_of(in, model_->rule, batches_, trial, stored);
  if (!std::isfinite(stored.total())) return Flight::moved;
  const double lost = discretisation_loss(stored.potential(), companion.ledger.potential(), work);
  companion.ledger.book(EnergyFlow::coupling_discretisation, lost, stored);
  take_end(in, model_->rule.is_mean(), trial, state, companion);
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
