// Problem: end a step with bodies side by side, as far as contacts took part.

#include <carom/integrators/time_stepping/step_projection.h>

#include <algorithm>

namespace carom {

void StepProjection::apply(const StepIsland& island, const StepInput& in, StepBalance& balance) {
  const std::span<const Constraint> all = island.constraints;
  const bool joined = std::any_of(all.begin(), all.end(), [](const Constraint& constraint) {
    return constraint.type == ConstraintType::contact && constraint.bodies > 1;
  });
  if (joined) return project({island.components, all, true}, in, balance);
  const auto component_of = [&](const Constraint& at) { return in.assembly.component_of(at.body()); };
  for (std::size_t first = 0, last = 0; first < all.size(); first = last) {
    const Index component = component_of(all[first]);
    while (last < all.size() && component_of(all[last]) == component) ++last;
    project({{&component, 1}, all.subspan(first, last - first), false}, in, balance);
  }
}

StoredEnergies StepProjection::potentials(std::span<const Index> components) {
  StoredEnergies sum;
  for (const Index component : components) {
    add_potentials(*parts_->assembly, component, parts_->trial.end.view(), parts_->trial.at_end, sum);
  }
  return sum;
}

void StepProjection::project(const Part& part, const StepInput& in, StepBalance& balance) {
  const Assembly& assembly = *parts_->assembly;
  StepTrial& trial = parts_->trial;
  joints_.clear();
  for (const Index component : part.components) {
    evaluate_positions(assembly, component, trial.end.view(), trial.at_end);
    if (JointStage* const stage = parts_->joints.of(component)) joints_.push_back(&stage->rows().at_end());
  }
  const StoredEnergies before = potentials(part.components);
  // Components that contacts join need not follow one another.
  const Range components{part.components.front(), part.components.back() + 1};
  const GapProjection::Result result = projection_.project(
      {assembly, parts_->constraints.detector(), parts_->constraints.places_at_end(), components, joints_},
      {.taking_part = part.constraints, .of_bodies = part.joined}, parts_->contacts.chain(), trial.end,
      trial.at_end);
  if (result.left != nullptr) parts_->errors(in, part.components.front()).fail_projection(*result.left);
  if (!result.moved) return;
  for (const Index component : part.components) {
    JointStage* const stage = parts_->joints.of(component);
    if (stage != nullptr) balance.book_velocity_projection(stage->project_velocities(trial));
    // Mean loads are those that acted.
    if (parts_->rule.is_mean()) continue;
    parts_->schedule.evaluate(parts_->stages(in, component), LoadsKnown::by_cause, false);
  }
  balance.book_projection(result, before, potentials(part.components));
}

}  // namespace carom
