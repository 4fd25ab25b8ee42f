// Problem: what joints add to the motion of a component: their reactions, friction in them, jumps of what
// drives them.

#include <carom/core/dynamics/body_response.h>
#include <carom/integrators/event_driven/joint_reactions.h>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace carom {

JointReactions::JointReactions(const Assembly& assembly, Index component, MotionMemory& memory)
    : assembly_(&assembly), component_(component), memory_(&memory), joints_(assembly, component) {
  if (joints_.empty()) return;
  joints_.factors().reveal_rank(true);
  bounds_ = FrictionBounds(assembly, component, joints_);
}

void JointReactions::react(MotionSample& at) {
  sample_ = &at;
  if (joints_.empty()) return;
  joints_.update_and_factor(at.joint_view());
  joints_.project(JointLevel::acceleration, at.acceleration.data());
}

std::span<const double> JointReactions::multipliers(const MotionSample& at,
                                                    std::span<const ActiveContact> contacts) {
  assert(is_at(at));
  std::vector<double>& answer = memory_->of_velocity;
  const Range v = assembly_->components()[component_].v;
  std::copy(at.loads.begin() + v.begin, at.loads.begin() + v.end, answer.begin() + v.begin);
  for (const ActiveContact& contact : contacts) {
    contact.at.add_force(contact.normal, contact.tangential, answer.data());
  }
  assembly_->for_bodies(component_, [&](const BodyKind& kind, Range slots, Index, Index first, Index) {
    kind.apply_inverse_mass(slots, answer.data() + first, answer.data() + first);
  });
  memory_->multipliers.resize(joints_.size());
  joints_.project(JointLevel::acceleration, answer.data(), memory_->multipliers.data());
  return memory_->multipliers;
}

bool JointReactions::add_contact_forces(ActiveSet& active, MotionSample& at) {
  if (bounds_.empty()) return active.add_reactions(*assembly_, at.acceleration.data());
  const Range v = assembly_->components()[component_].v;
  std::vector<double>& free = memory_->free;
  std::copy(at.acceleration.begin() + v.begin, at.acceleration.begin() + v.end, free.begin() + v.begin);
  BoundIteration iteration;
  for (int i = 0; i < BoundIteration::most_repetitions; ++i) {
    std::copy(free.begin() + v.begin, free.begin() + v.end, at.acceleration.begin() + v.begin);
    double change = 0.0;
    iteration.begin();
    if (!update_bounds_once(active, at, iteration, change)) return false;
    if (iteration.converged(change)) return true;
    if (!iteration.accelerates()) continue;
    std::size_t bound = 0;
    for (ActiveContact& contact : active.list()) {
      if (bounds_.depends_on_joint_force(contact.at)) contact.at.friction_bound = iteration.guess(bound++);
    }
  }
  return false;
}

/// Forces of contacts at given bounds of friction in joints, and the bounds that follow from them.
bool JointReactions::update_bounds_once(ActiveSet& active, MotionSample& at, BoundIteration& iteration,
                                        double& change) {
  if (!active.add_reactions(*assembly_, at.acceleration.data())) return false;
  const std::span<const double> forces = multipliers(at, active.list());
  bounds_.take(forces.data(), 1.0, largest_load(at));
  for (ActiveContact& contact : active.list()) {
    if (!bounds_.depends_on_joint_force(contact.at)) continue;
    const double before = contact.at.friction_bound;
    change = std::max(change, bounds_.update(contact.at, at.joint_view()));
    iteration.add(before, contact.at.friction_bound);
  }
  return true;
}

bool JointReactions::update_friction_bounds(ActiveSet& active, MotionSample& at,
                                            std::vector<ActiveContact>& contacts,
                                            std::vector<ForceMargin>& margins, BoundIteration& iteration,
                                            double& change) {
  assert(is_at(at));
  const Range v = assembly_->components()[component_].v;
  std::vector<double>& free = memory_->free;
  std::copy(at.acceleration.begin() + v.begin, at.acceleration.begin() + v.end, free.begin() + v.begin);
  active.list().swap(contacts);
  const bool found = update_bounds_once(active, at, iteration, change);
  std::copy(free.begin() + v.begin, free.begin() + v.end, at.acceleration.begin() + v.begin);
  active.margins(margins);
  active.list().swap(contacts);
  return found;
}

/// Loads without reactions: forces small against them are rounding.
double JointReactions::largest_load(const MotionSample& at) const {
  const Range v = assembly_->components()[component_].v;
  double largest = 0.0;
  for (Index i = v.begin; i < v.end; ++i) largest = std::max(largest, std::abs(at.loads[i]));
  return largest;
}

void JointReactions::build(IslandProblem& problem, std::span<const Constraint> contacts,
                           const double* velocity_before) {
  problem.build(contacts, velocity_before);
  MassResponse masses(*assembly_);
  JointResponse with_joints(joints_);
  problem.respond(joints_.empty() ? static_cast<BodyResponse&>(masses) : with_joints);
}

bool JointReactions::solve(IslandProblem& problem, std::span<Constraint> contacts, const MotionSample& at,
                           SolverChain& chain) {
  assert(is_at(at));
  // Little is captured, so that nothing is allocated.
  const auto multipliers = [this, &problem] { return impulses(problem).data(); };
  return memory_->friction_bound.solve({.problem = problem,
                                        .contacts = contacts,
                                        .bounds = bounds_,
                                        .at = at.joint_view(),
                                        .duration = 0.0,
                                        .multipliers = multipliers},
                                       chain);
}

std::span<const double> JointReactions::impulses(const IslandProblem& problem) {
  std::vector<double>& change = memory_->of_velocity;
  const Range v = assembly_->components()[component_].v;
  std::fill(change.begin() + v.begin, change.begin() + v.end, 0.0);
  problem.map().add_loads(1.0, change.data());
  joints_.apply_inverse_mass(change.data());
  memory_->multipliers.resize(joints_.size());
  joints_.project(JointLevel::change, change.data(), memory_->multipliers.data());
  return memory_->multipliers;
}

std::span<const double> JointReactions::follow_jump(const MotionSample& at, std::span<double> velocities,
                                                    double noise, double& work) {
  assert(is_at(at));
  if (!joints_.depends_on_time()) return {};
  const Range v = assembly_->components()[component_].v;
  std::vector<double>&change = memory_->of_velocity, &impulse = memory_->impulse;
  std::copy(at.state.v.begin() + v.begin, at.state.v.begin() + v.end, change.begin() + v.begin);
  memory_->multipliers.resize(joints_.size());
  joints_.project(JointLevel::velocity, change.data(), memory_->multipliers.data());
  double largest = 0.0;
  for (Index i = v.begin; i < v.end; ++i) {
    change[i] -= at.state.v[i];
    largest = std::max(largest, std::abs(change[i]) * memory_->lengths[i]);
  }
  if (!(largest > noise)) return {};
  assembly_->for_bodies(component_, [&](const BodyKind& kind, Range slots, Index, Index first, Index) {
    kind.apply_mass(slots, change.data() + first, impulse.data() + first);
  });
  for (Index i = v.begin; i < v.end; ++i) {
    work += (at.state.v[i] + 0.5 * change[i]) * impulse[i];
    velocities[i - v.begin] += change[i];
  }
  return memory_->multipliers;
}

}  // namespace carom
