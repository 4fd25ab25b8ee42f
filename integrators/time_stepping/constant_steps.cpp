// Problem: the step of bodies whose loads at its end are those at its start, which is one sweep: contacts,
// bodies, account. Where nothing asks for all contacts at once, those of some bodies are found, solved and
// booked while they and their problems, which are large, are at hand.

#include <carom/integrators/time_stepping/located_account.h>
#include <carom/integrators/time_stepping/time_stepper.h>

namespace carom {

/// The stages of make_step(), of bodies that nothing couples, over ground at rest.
StepResult& TimeStepper::make_uncoupled_step(const StepInput& in) {
  StepTrial& trial = parts_.trial;
  balance_.begin(in);
  capped_.begin();
  if (trial.needs.start_rotations) evaluate_positions(in.assembly, in.start.view(), trial.at_start);
  parts_.constraints.begin(in);
  for (LooseBatch& batch : uncoupled_->batches()) {
    trial.account.swept = false;
    for (const LoosePiece& piece : batch.pieces) {
      const bool by_part =
          piece.parts.size() == 1 || parts_.constraints.may_touch(in, piece.all.components, trial);
      advance_loose(by_part ? std::span(piece.parts) : std::span(&piece.all, 1), in);
    }
    trial.account.swept = true;
    const LooseAccount account = uncoupled_->account(in, batch);
    if (!balance_.book_loads(account.works, account.potentials))
      parts_.errors(in, batch.all.components.begin).fail_account(batch.all.components);
  }
  balance_.report().sweeps = 1;
  balance_.report().iteration = uncoupled_->iteration();
  return balance_.finish(in);
}

/// One piece after the other.
void TimeStepper::advance_loose(std::span<const LooseBodies> pieces, const StepInput& in) {
  StepTrial& trial = parts_.trial;
  StepIsland part;
  for (const LooseBodies& piece : pieces) {
    part.constraints = parts_.constraints.find_part(in, piece.components, trial);
    solve_part(part, in);
    uncoupled_->move(in, piece);
    book_part(in);
  }
}

/// Contacts of bodies that nothing couples.
void TimeStepper::solve_part(const StepIsland& part, const StepInput& in) {
  // The problem of a gain that is refused is to be told: each contact has its own.
  const bool refuses = parts_.options.impact_rules.energy_gain == EnergyGain::refuse;
  const auto alone = refuses ? ContactStage::Alone::as_problems : ContactStage::Alone::from_numbers;
  const IslandProblem* const failed = parts_.contacts.solve_constant(in, part, alone, parts_.trial);
  if (failed != nullptr) fail_contact(*failed, in);
}

/// Their account, at the end of the step.
void TimeStepper::book_part(const StepInput& in) {
  const double* const after = parts_.trial.end.v.data();
  balance_.book_lone(parts_.contacts.lone(), after, in, parts_.trial);
  for (const IslandProblem& problem : parts_.contacts.problems()) {
    book_contact_problem(problem, after, in.end_time, in);
  }
}

/// The step whose loads at its end are those at its start, of which none is dissipative or external.
void TimeStepper::advance_under_constant_loads(const StepIsland& island, const StepInput& in) {
  parts_.trial.account.swept = false;
  parts_.located.clear();
  parts_.trial.jumps.on = false;
  if (parts_.constraints.finds_in_parts(island)) return advance_part_by_part(island, in);
  const IslandProblem* const failed =
      parts_.contacts.solve_constant(in, island, ContactStage::Alone::as_problems, parts_.trial);
  if (failed != nullptr) fail_contact(*failed, in);
  for (const Range components : island.batches) {
    parts_.schedule.run(
        ConstantStages{in, parts_.rule, components, parts_.contacts, parts_.trial, flown_ == Flight::moved});
    parts_.trial.account.swept = true;
    if (parts_.located.on()) locate_under_constant_loads(components, island, in, parts_);
    if (!balance_.book_couplings(in, components.begin, parts_.trial))
      parts_.errors(in, components.begin).fail_account(components);
  }
  book_contacts(island, in);
  if (parts_.options.project_gaps) projection_.apply(island, in, balance_);
}

/// Likewise of a batch of many bodies, part by part.
void TimeStepper::advance_part_by_part(const StepIsland& island, const StepInput& in) {
  const Range components = island.batches.front();
  const ConstantStages stages{in, parts_.rule, components, parts_.contacts, parts_.trial};
  StepIsland part;
  const auto components_of = [&](Range bodies) {  // each is one body
    const Index begin = components.begin + (bodies.begin - stages.bodies().begin);
    return Range{begin, begin + bodies.size()};
  };
  const auto touch = [&](Range bodies) {
    return parts_.constraints.may_touch(in, components_of(bodies), parts_.trial);
  };
  const auto react = [&](Range bodies) {
    const Range own = components_of(bodies);
    part.components = island.components.subspan(own.begin - components.begin, own.size());
    part.constraints = parts_.constraints.find_part(in, own, parts_.trial);
    parts_.trial.account.swept = false;
    solve_part(part, in);
  };
  const auto book = [&](Range) {
    parts_.trial.account.swept = true;
    book_part(in);
  };
  parts_.schedule.run(stages, react, book, touch);
  if (!balance_.book_couplings(in, components.begin, parts_.trial))
    parts_.errors(in, components.begin).fail_account(components);
}

}  // namespace carom
