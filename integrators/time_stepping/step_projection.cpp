// Problem: end a step with bodies side by side, as far as contacts took part.

#include <carom/integrators/time_stepping/returning_contacts.h>
#include <carom/integrators/time_stepping/step_projection.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace carom {

namespace {

/// Depth to which gaps are projected: nothing that closed within a step [m].
constexpr double at_rest = 1e-14;

/// Velocities that the joints of a component allow where its bodies have been moved to. Returns the kinetic
/// energy lost [J].
double project_velocities(const Assembly& assembly, JointStage& stage, StepTrial& trial) {
  JointConstraints& joints = stage.rows().at_end();
  const Range bodies = assembly.components()[stage.iterate().component].bodies;
  const double before = kinetic_energy(assembly, bodies, trial.end.v.data());
  joints.update_and_factor({trial.end.view(), trial.at_end.rotation.data()});
  joints.project(JointLevel::velocity, trial.end.v.data());
  joints.project(JointLevel::velocity, trial.end.v.data());  // what rounding left
  return before - kinetic_energy(assembly, bodies, trial.end.v.data());
}

}  // namespace

void StepProjection::lower_rebounds(const StepInput& in, std::span<const StepIsland> islands,
                                    StepTrial& trial) {
  const TimeStepping& options = model_->options;
  if (!options.project_gaps || options.impacts == ImpactTimes::located) return;
  by_loads_.resize(in.start.v.size());
  for (const StepIsland& island : islands) {
    for (Constraint& at : island.constraints) {
      const double rate = at.normal_velocity(in.start.v.data());
      if (rate > 0.0) allow_return(in, {&at, 1});
      if (!(rate < 0.0) || !(at.gap < -at_rest) || at.law.normal_restitution == 0.0) continue;
      for (int b = 0; b < at.bodies; ++b)
        change_by_loads(in, at.blocks[static_cast<std::size_t>(b)].body, trial);
      // Of the velocity against the obstacle, which may be accelerated too.
      const double change =
          at.times(0, by_loads_.data()) - (at.surface_velocity_after[0] - at.surface_velocity[0]);
      if (!(change < 0.0)) continue;
      const double square = rate * rate - 2.0 * (-change / in.step) * -at.gap;
      at.allowed_approach += at.law.normal_restitution * (-rate - std::sqrt(std::max(0.0, square)));
    }
  }
}

/// Changes of velocities by loads within the step, h M^-1 F, of one body or of all that joints bind to it.
void StepProjection::change_by_loads(const StepInput& in, Index body, StepTrial& trial) {
  const Assembly& assembly = in.assembly;
  const double* const loads = in.companion.loads.total.data();
  if (!assembly.is_jointed(body)) {
    const BodySlot slot = assembly.layout()->bodies()[body];
    for (Index v = slot.v; v < slot.v + slot.v_size; ++v) by_loads_[v] = in.step * loads[v];
    assembly.body_kinds()[slot.kind]->apply_inverse_mass({slot.slot, slot.slot + 1}, &by_loads_[slot.v],
                                                         &by_loads_[slot.v]);
    return;
  }
  const Index component = assembly.component_of(body);
  JointConstraints& joints = stages_->of(component)->answer().rows();
  evaluate_positions(assembly, component, in.start.view(), trial.at_start);
  joints.update_and_factor({in.start.view(), trial.at_start.rotation.data()});
  const Range v = joints.velocities();
  for (Index i = v.begin; i < v.end; ++i) by_loads_[i] = in.step * loads[i];
  joints.apply_inverse_mass(by_loads_.data());
  joints.project(JointLevel::change, by_loads_.data());
}

std::span<const Index> StepProjection::apply(const StepIsland& island, const StepInput& in,
                                             const GroundPlaces& places, SolverChain& chain, StepTrial& trial,
                                             StepBalance& balance) {
  const std::size_t before = moved_.size();
  const Means means{places, chain};
  const std::span<const Constraint> all = island.constraints;
  const bool joined = std::any_of(all.begin(), all.end(), [](const Constraint& constraint) {
    return constraint.bodies > 1 && !constraint.key.is_of_joint();
  });
  if (joined) {
    project({island.components, island.batches, all, true}, in, means, trial, balance);
    return std::span(moved_).subspan(before);
  }
  const auto component_of = [&](const Constraint& at) { return in.assembly.component_of(at.body()); };
  for (std::size_t first = 0, last = 0; first < all.size(); first = last) {
    const Index component = component_of(all[first]);
    while (last < all.size() && component_of(all[last]) == component) ++last;
    const Range alone{component, component + 1};
    project({{&component, 1}, {&alone, 1}, all.subspan(first, last - first), false}, in, means, trial,
            balance);
  }
  return std::span(moved_).subspan(before);
}

void StepProjection::take_back(State& end) const {
  for (const Index component : moved_) {
    const Range q = model_->assembly.components()[component].q;
    std::copy(came_.begin() + q.begin, came_.begin() + q.end, end.q.begin() + q.begin);
  }
}

StoredEnergies StepProjection::potentials(std::span<const Index> components, StepTrial& trial) const {
  StoredEnergies sum;
  for (const Index component : components) {
    add_potentials(model_->assembly, component, trial.end.view(), trial.at_end, sum);
  }
  return sum;
}

void StepProjection::project(const Part& part, const StepInput& in, const Means& means, StepTrial& trial,
                             StepBalance& balance) {
  const Assembly& assembly = model_->assembly;
  joints_.clear();
  came_.resize(trial.end.q.size());
  for (const Index component : part.components) {
    const Range q = assembly.components()[component].q;
    std::copy(trial.end.q.begin() + q.begin, trial.end.q.begin() + q.end, came_.begin() + q.begin);
    evaluate_positions(assembly, component, trial.end.view(), trial.at_end);
    if (JointStage* const stage = stages_->of(component)) joints_.push_back(&stage->rows().at_end());
  }
  const StoredEnergies before = potentials(part.components, trial);
  gaps_.bind({.assembly = assembly,
              .detector = model_->detector,
              .places = means.places,
              .components = part.ranges,
              .joints = joints_,
              .taking_part = part.constraints,
              .touch = part.joined},
             trial.end, trial.at_end);
  const Separation result = separator_.separate(gaps_, means.chain);
  if (result.left != nullptr)
    model_->errors(in, part.components.front(), trial).fail_projection(*result.left);
  if (!result.moved) return;
  moved_.insert(moved_.end(), part.components.begin(), part.components.end());
  for (const Index component : part.components) {
    JointStage* const stage = stages_->of(component);
    if (stage != nullptr) balance.book_velocity_projection(project_velocities(assembly, *stage, trial));
  }
  balance.book_projection(result, before, potentials(part.components, trial));
}

}  // namespace carom
