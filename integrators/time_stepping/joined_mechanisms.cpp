// Problem: contact between mechanisms, and between them and single bodies, within a step.

#include <carom/integrators/time_stepping/joined_mechanisms.h>

#include <algorithm>

namespace carom {

JoinedMechanisms::JoinedMechanisms(const Assembly& assembly, JointStages& stages)
    : assembly_(&assembly), stages_(&stages), response_(assembly) {}

bool JoinedMechanisms::takes(const StepIsland& island) const {
  return island.components.size() > 1 &&
         std::any_of(island.components.begin(), island.components.end(),
                     [this](Index component) { return stages_->of(component) != nullptr; });
}

void JoinedMechanisms::start(const StepInput& in, const StepIsland& island, IslandProblem& problem,
                             StepTrial& trial) {
  velocity_.resize(in.start.v.size());
  change_.resize(in.start.v.size());
  joints_.clear();
  for (const Index component : island.components) {
    JointStage* const joints = stages_->of(component);
    if (joints == nullptr) continue;
    joints->start_joined(in, trial);
    joints_.push_back(&joints->answer().rows());
  }
  response_.bind(joints_);
  respond(problem);
}

bool JoinedMechanisms::sweep(const StepInput& in, const StepRule& rule, const StepIsland& island,
                             IslandProblem& problem, SolverChain& chain, StepTrial& trial) {
  for (const Index component : island.components) {
    if (JointStage* const joints = stages_->of(component)) {
      joints->approach(in, rule, trial, velocity_.data());
    } else {
      free_component(in, rule, component, trial);
    }
    const Range v = assembly_->components()[component].v;
    std::fill(change_.begin() + v.begin, change_.begin() + v.end, 0.0);
  }
  problem.set_free_velocity(velocity_.data());
  if (!problem.solve(chain).usable()) return false;
  problem.map().add_velocities(change_.data());
  for (const Index component : island.components) {
    if (JointStage* const joints = stages_->of(component)) {
      joints->leave(in, rule, change_.data(), trial);
      continue;
    }
    const Component& all = assembly_->components()[component];
    std::copy(change_.begin() + all.v.begin, change_.begin() + all.v.end,
              trial.dv_impulses.begin() + all.v.begin);
    rule.move(in, all.bodies, true, trial);
  }
  trial.account.swept = true;
  return true;
}

/// Velocities at the end of a component without joints if nothing touched: v_j + M^-1 h (F_j + F_{j+1})/2.
void JoinedMechanisms::free_component(const StepInput& in, const StepRule& rule, Index component,
                                      StepTrial& trial) {
  const Range v = assembly_->components()[component].v;
  const double half = 0.5 * in.step;
  const double* const load0 = rule.start_of_sum(in, trial);
  for (Index i = v.begin; i < v.end; ++i) change_[i] = half * (load0[i] + trial.loads_guess[i]);
  assembly_->for_bodies(component, [&](const BodyKind& kind, Range slots, Index, Index first, Index) {
    kind.apply_inverse_mass(slots, change_.data() + first, velocity_.data() + first);
  });
  for (Index i = v.begin; i < v.end; ++i) {
    velocity_[i] += static_cast<double>(in.companion.rounding[i]) + in.start.v[i];
  }
}

void JoinedMechanisms::take_change(const StepInput& in, const StepIsland& island, const StepTrial& trial,
                                   SweepChange& change) {
  double growth = 1.0;
  for (const Index component : island.components) {
    JointStage* const joints = stages_->of(component);
    if (joints == nullptr) continue;
    change.take(joints->change(in, trial));
    growth = std::max(growth, joints->rows().roundoff_growth());
  }
  change.size *= growth;
}

double JoinedMechanisms::violation(const StepInput& in, const StepIsland& island, StepTrial& trial) {
  double largest = 0.0;
  for (const Index component : island.components) {
    JointStage* const joints = stages_->of(component);
    if (joints != nullptr) largest = std::max(largest, joints->violation(in, trial));
  }
  return largest;
}

}  // namespace carom
