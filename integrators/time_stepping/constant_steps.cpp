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
  parts_.constraints.begin(in, parts_.parting());
  parts_.located.clear();
  for (LooseBatch& batch : uncoupled_->batches()) {
    trial.account.swept = false;
    for (const LoosePiece& piece : batch.pieces) {
      const bool by_part =
          flown_ == Flight::not_free &&
          (piece.parts.size() == 1 || parts_.constraints.may_touch(in, piece.all.components, trial));
      advance_loose(by_part ? std::span(piece.parts) : std::span(&piece.all, 1), in);
    }
    trial.account.swept = true;
    LooseAccount account = uncoupled_->account(in, batch);
    if (!parts_.located.empty())
      account.works.total += parts_.located.work_of_flights(in, parts_.rule, batch.all.bodies, trial);
    if (!balance_.book_loads(account.works, account.potentials))
      parts_.errors(in, batch.all.components.begin).fail_account(batch.all.components);
    if (!parts_.located.empty()) book_located(batch.all.bodies, in);
  }
  balance_.report().sweeps = 1;
  balance_.report().iteration = uncoupled_->iteration();
  return balance_.finish(in);
}

/// One piece after the other. Nothing touches bodies that have flown, at the start.
void TimeStepper::advance_loose(std::span<const LooseBodies> pieces, const StepInput& in) {
  const bool flown = flown_ == Flight::moved;
  StepIsland part;
  for (const LooseBodies& piece : pieces) {
    if (!flown) part.constraints = parts_.constraints.find_part(in, piece.components, parts_.trial);
    solve_part(part, in);
    if (!flown) uncoupled_->move(in, piece);
    if (parts_.located.on()) locate_under_constant_loads(piece.components, part.constraints, in, parts_);
    book_part(in);
  }
}

/// Contacts of bodies that nothing couples.
void TimeStepper::solve_part(const StepIsland& part, const StepInput& in) {
  // The problem of a gain that is refused is to be told: each contact has its own.
  const bool refuses = parts_.options.impact_rules.energy_gain == EnergyGain::refuse;
  const auto alone = refuses ? ContactStage::Alone::as_problems : ContactStage::Alone::from_numbers;
  const IslandProblem* const failed = parts_.contacts.solve_constant(in, part, alone, parts_.trial);
  if (failed != nullptr) parts_.errors(in, *failed).fail_contact(*failed);
}

/// Their account, at the end of the step, but for bodies that are hit within it.
void TimeStepper::book_part(const StepInput& in) {
  const double* const after = parts_.trial.end.v.data();
  const auto is_hit = [&](Index body) { return parts_.located.contains_any({body, body + 1}); };
  FunctionRef<bool(Index)> leaves_out;
  if (!parts_.located.empty()) leaves_out = is_hit;
  balance_.book_lone(parts_.contacts.lone(), after, in, parts_.trial, leaves_out);
  for (const IslandProblem& problem : parts_.contacts.problems()) {
    if (leaves_out && leaves_out(problem.constraints().front().body())) continue;
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
  if (failed != nullptr) parts_.errors(in, *failed).fail_contact(*failed);
  for (const Range components : island.batches) {
    const bool locates = parts_.located.on();
    const ConstantStages stages{in, parts_.rule, components, parts_.contacts, parts_.trial, locates};
    const auto move_on = [&](Range) {
      locate_under_constant_loads(components, island.constraints, in, parts_);
    };
    parts_.schedule.run(stages, {}, locates ? SweepSchedule::BodyTask(move_on) : SweepSchedule::BodyTask());
    parts_.trial.account.swept = true;
    add_work_of_flights(components, in, parts_);
    if (!balance_.book_couplings(in, components.begin, parts_.trial))
      parts_.errors(in, components.begin).fail_account(components);
  }
  book_contacts(island, in);
  if (parts_.options.project_gaps) projection_.apply(island, in, balance_);
}

/// Advances a batch of many bodies under constant loads, part by part.
void TimeStepper::advance_part_by_part(const StepIsland& island, const StepInput& in) {
  const Range components = island.batches.front();
  const bool locates = parts_.located.on();
  const ConstantStages stages{in, parts_.rule, components, parts_.contacts, parts_.trial, locates};
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
  const auto book = [&](Range bodies) {
    parts_.trial.account.swept = true;
    if (locates) locate_under_constant_loads(components_of(bodies), part.constraints, in, parts_);
    book_part(in);
  };
  parts_.schedule.run(stages, react, book, touch);
  if (!parts_.located.empty()) book_located(stages.bodies(), in);
  add_work_of_flights(components, in, parts_);
  if (!balance_.book_couplings(in, components.begin, parts_.trial))
    parts_.errors(in, components.begin).fail_account(components);
}

}  // namespace carom
