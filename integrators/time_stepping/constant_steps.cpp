// Problem: the step of bodies whose loads at its end are those at its start, which is one sweep: contacts,
// bodies, account. Where nothing asks for all contacts at once, those of some bodies are found, solved and
// booked while they and their problems, which are large, are at hand.

#include <carom/integrators/time_stepping/island_steps.h>

namespace carom {

void IslandSteps::advance(UncoupledStep& uncoupled, Flight flown, const StepInput& in) {
  StepTrial& trial = *trial_;
  if (trial.needs.start_rotations) evaluate_positions(in.assembly, in.start.view(), trial.at_start);
  constraints_->begin(in, model_->parting());
  located_.clear();
  for (LooseBatch& batch : uncoupled.batches()) {
    trial.account.swept = false;
    for (const LoosePiece& piece : batch.pieces) {
      const bool by_part =
          flown != Flight::not_free &&
          (piece.parts.size() == 1 || constraints_->may_touch(in, piece.all.components, trial));
      advance_loose(uncoupled, by_part ? std::span(piece.parts) : std::span(&piece.all, 1),
                    flown == Flight::moved, in);
    }
    trial.account.swept = true;
    LooseAccount account = uncoupled.account(in, batch);
    if (!located_.empty())
      account.works.total += located_.work_of_flights(in, model_->rule, batch.all.bodies, trial);
    books_.book_loads(in, batch.all.components, account.works, account.potentials);
    if (!located_.empty()) books_.book_located(batch.all.bodies, in);
  }
  StepReport& report = books_.balance().report();
  report.sweeps = 1;
  report.iteration = uncoupled.iteration();
}

/// One piece after the other. Nothing touches bodies that have flown, at the start.
void IslandSteps::advance_loose(UncoupledStep& uncoupled, std::span<const LooseBodies> pieces, bool flown,
                                const StepInput& in) {
  StepIsland part;
  for (const LooseBodies& piece : pieces) {
    if (!flown) part.constraints = constraints_->find_part(in, piece.components, *trial_);
    solve_part(part, in);
    if (!flown) uncoupled.move(in, piece);
    if (located_.on()) locate(piece.components, part.constraints, in);
    books_.book_lone_contacts(in);
  }
}

/// Contacts of bodies that nothing couples.
void IslandSteps::solve_part(const StepIsland& part, const StepInput& in) {
  // The problem of a gain that is refused is to be told: each contact has its own.
  const bool refuses = model_->options.impact_rules.energy_gain == EnergyGain::refuse;
  const auto alone = refuses ? ContactStage::Alone::as_problems : ContactStage::Alone::from_numbers;
  const IslandProblem* const failed = contacts_.solve_constant(in, part, alone, *trial_);
  if (failed != nullptr) model_->errors(in, *failed, *trial_).fail_contact(*failed);
}

/// Moves on bodies that are hit within the step. \param components which have moved as if nothing were hit
/// \param contacts of theirs at the start
void IslandSteps::locate(Range components, std::span<const Constraint> contacts, const StepInput& in) {
  if (!located_.take_up(in, components, contacts, constraints_->places(true), *trial_)) return;
  const double* const total = in.companion.loads.total.data();
  const Range bodies = in.assembly.bodies_of(components);
  located_.advance(in, model_->rule, {total, total}, bodies, *trial_);
  for (const LocatedMotion* motion : located_.motions_of(bodies)) {
    const IslandProblem* const failed = motion->failed();
    if (failed != nullptr) model_->errors(in, *failed, *trial_).fail_contact(*failed);
  }
}

/// The step whose loads at its end are those at its start, of which none is dissipative or external.
void IslandSteps::advance_under_constant_loads(const StepIsland& island, const StepInput& in) {
  trial_->account.swept = false;
  located_.clear();
  trial_->jumps.on = false;
  if (constraints_->finds_in_parts(island)) return advance_part_by_part(island, in);
  const IslandProblem* const failed =
      contacts_.solve_constant(in, island, ContactStage::Alone::as_problems, *trial_);
  if (failed != nullptr) model_->errors(in, *failed, *trial_).fail_contact(*failed);
  for (const Range components : island.batches) {
    const bool locates = located_.on();
    const ConstantStages stages{in, model_->rule, components, contacts_, *trial_, locates};
    const auto move_on = [&](Range) { locate(components, island.constraints, in); };
    schedule_.run(stages, {}, locates ? SweepSchedule::BodyTask(move_on) : SweepSchedule::BodyTask());
    trial_->account.swept = true;
    books_.book_constant(in, components);
  }
  books_.book_contacts(island, in);
  move_apart(island, in);
}

/// Advances a batch of many bodies under constant loads, part by part.
void IslandSteps::advance_part_by_part(const StepIsland& island, const StepInput& in) {
  const Range components = island.batches.front();
  const bool locates = located_.on();
  const ConstantStages stages{in, model_->rule, components, contacts_, *trial_, locates};
  StepIsland part;
  const auto components_of = [&](Range bodies) {  // each is one body
    const Index begin = components.begin + (bodies.begin - stages.bodies().begin);
    return Range{begin, begin + bodies.size()};
  };
  const auto touch = [&](Range bodies) {
    return constraints_->may_touch(in, components_of(bodies), *trial_);
  };
  const auto react = [&](Range bodies) {
    const Range own = components_of(bodies);
    part.components = island.components.subspan(own.begin - components.begin, own.size());
    part.constraints = constraints_->find_part(in, own, *trial_);
    trial_->account.swept = false;
    solve_part(part, in);
  };
  const auto book = [&](Range bodies) {
    trial_->account.swept = true;
    if (locates) locate(components_of(bodies), part.constraints, in);
    books_.book_lone_contacts(in);
  };
  schedule_.run(stages, react, book, touch);
  if (!located_.empty()) books_.book_located(stages.bodies(), in);
  books_.book_constant(in, components);
}

}  // namespace carom
