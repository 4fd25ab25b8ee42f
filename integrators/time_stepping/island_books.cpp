// Problem: the account of a step whose stages keep what they did only until the next island.

#include <carom/integrators/time_stepping/island_books.h>

namespace carom {

IslandBooks::IslandBooks(const StepModel& model, const StepConstraints& constraints, ContactStage& contacts,
                         LocatedImpacts& located, JointStages& joints, StepTrial& trial)
    : model_(&model),
      constraints_(&constraints),
      contacts_(&contacts),
      located_(&located),
      joints_(&joints),
      trial_(&trial),
      balance_(model.assembly, model.options),
      capped_(model.options.failure_directory) {}

void IslandBooks::begin(const StepInput& in, const StepResult* impacts) {
  balance_.begin(in);
  balance_.use_jumps(constraints_->jumps_within(in.start.time, in.end_time));
  capped_.begin();
  flights_.clear();
  if (impacts != nullptr) balance_.add(*impacts);
}

void IslandBooks::book_component(const StepInput& in, Index component) {
  if (!located_->empty())
    located_->correct_works(in, model_->rule, in.assembly.components()[component].bodies, *trial_);
  if (!balance_.book_couplings(in, component, *trial_))
    model_->errors(in, component, *trial_).fail_account({component, component + 1});
  if (JointStage* const joints = joints_->of(component))
    balance_.book_joints(in, component, *joints, contacts_->together(), *trial_);
}

void IslandBooks::book_constant(const StepInput& in, Range components) {
  trial_->account.works.front().total +=
      located_->work_of_flights(in, model_->rule, in.assembly.bodies_of(components), *trial_);
  if (!balance_.book_couplings(in, components.begin, *trial_))
    model_->errors(in, components.begin, *trial_).fail_account(components);
}

void IslandBooks::book_loads(const StepInput& in, Range components, const BlockWorks& works,
                             const StoredEnergies& potentials) {
  if (!balance_.book_loads(works, potentials))
    model_->errors(in, components.begin, *trial_).fail_account(components);
}

void IslandBooks::book_contacts(const StepIsland& island, const StepInput& in) {
  const double* const after = contacts_->problems().empty()
                                  ? trial_->end.v.data()
                                  : joints_->velocities_of_contact(island.components, *trial_);
  const bool all = located_->empty();
  for (const IslandProblem& problem : contacts_->problems()) {
    const Index body = problem.constraints().front().body();
    if (!all && located_->contains_any({body, body + 1})) continue;
    book_contact_problem(problem, after, in.end_time, in);
    if (turning_ != nullptr) balance_.book_turning(turning_->work(problem));
  }
  if (!all) book_located({0, none}, in);
}

void IslandBooks::book_lone_contacts(const StepInput& in) {
  const double* const after = trial_->end.v.data();
  const auto is_hit = [&](Index body) { return located_->contains_any({body, body + 1}); };
  FunctionRef<bool(Index)> leaves_out;
  if (!located_->empty()) leaves_out = is_hit;
  balance_.book_lone(contacts_->lone(), after, in, *trial_, leaves_out);
  for (const IslandProblem& problem : contacts_->problems()) {
    if (leaves_out && leaves_out(problem.constraints().front().body())) continue;
    book_contact_problem(problem, after, in.end_time, in);
  }
}

void IslandBooks::book_located(Range bodies, const StepInput& in) {
  const double* const after = trial_->end.v.data();
  for (const LocatedMotion* motion : located_->motions_of(bodies)) {
    flights_.add(in, *motion);
    for (const MotionPhase& phase : motion->phases()) {
      motion->show_end(in, phase, *trial_);
      if (phase.constraints.empty()) continue;
      const double begin = in.start.time + phase.begin * in.step;
      const double time = phase.end < 1.0 ? in.start.time + phase.end * in.step : in.end_time;
      balance_.use_jumps(phase.is_impact() ? std::span<const GroundJump>()
                                           : constraints_->jumps_within(begin, time));
      book_contact_problem(phase.problem, after, time, in);
      if (phase.cut) balance_.tell_cut(phase.constraints.size());
      balance_.book_turning(phase.turning_work);
    }
  }
  balance_.use_jumps(constraints_->jumps_within(in.start.time, in.end_time));
}

/// \param after velocities after it, as contact sees them \param time when it ends [s]
void IslandBooks::book_contact_problem(const IslandProblem& problem, const double* after, double time,
                                       const StepInput& in) {
  const double gain = balance_.book_contacts(problem, after, time, in, *trial_);
  const bool refused = gain > 0.0 && model_->options.impact_rules.energy_gain == EnergyGain::refuse;
  const bool kept = capped_.wants(problem);
  if (!refused && !kept) return;
  const StepErrors errors = model_->errors(in, problem, *trial_);
  if (refused) errors.refuse_gain(problem, gain);
  capped_.keep(errors.failure_of(problem));
}

}  // namespace carom
