// Problem: what joints add to the motion of a clock group: their reactions, friction in them, jumps of what
// drives them.

#include <carom/integrators/event_driven/joint_reactions.h>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace carom {

namespace {

void copy(const std::vector<Range>& ranges, const std::vector<double>& from, std::vector<double>& to) {
  for (const Range v : ranges) std::copy(from.begin() + v.begin, from.begin() + v.end, to.begin() + v.begin);
}

}  // namespace

JointReactions::JointReactions(const Assembly& assembly, std::span<const Index> components,
                               MotionMemory& memory)
    : assembly_(&assembly), memory_(&memory), joints_(&memory.no_joints) {
  // Neighbours are one range.
  for (const Index component : components) {
    const Range v = assembly.components()[component].v;
    if (!velocities_.empty() && velocities_.back().end == v.begin) {
      velocities_.back().end = v.end;
    } else {
      velocities_.push_back(v);
    }
  }
  if (!has_joints(assembly, components)) return;
  own_ = std::make_unique<BoundComponents>(assembly, components);
  joints_ = own_.get();
}

void JointReactions::react(MotionSample& at) {
  sample_ = &at;
  if (joints_->rows.empty()) return;
  joints_->rows.update_and_factor(at.joint_view());
  joints_->rows.project(JointLevel::acceleration, at.acceleration.data());
}

std::span<const double> JointReactions::multipliers(const MotionSample& at,
                                                    std::span<const ActiveContact> contacts) {
  assert(is_at(at));
  std::vector<double>& answer = memory_->closure.of_velocity;
  copy(velocities_, at.loads(), answer);
  for (const ActiveContact& contact : contacts) {
    contact.add_force(answer.data());
  }
  for (const GroupJoints::Part& part : joints_->rows.parts()) {
    assembly_->for_bodies(part.component, [&](const BodyKind& kind, Range slots, Index, Index first, Index) {
      kind.apply_inverse_mass(slots, answer.data() + first, answer.data() + first);
    });
  }
  memory_->multipliers.resize(joints_->rows.size());
  joints_->rows.project(JointLevel::acceleration, answer.data(), memory_->multipliers.data());
  return memory_->multipliers;
}

bool JointReactions::add_contact_forces(ActiveSet& active, MotionSample& at) {
  if (joints_->bounds.empty()) return active.add_reactions(*assembly_, at.acceleration.data());
  std::vector<double>& free = memory_->closure.momentum;
  copy(velocities_, at.acceleration, free);
  BoundIteration iteration;
  for (int i = 0; i < BoundIteration::most_repetitions; ++i) {
    copy(velocities_, free, at.acceleration);
    double change = 0.0;
    iteration.begin();
    if (!update_bounds_once(active, at, iteration, change)) return false;
    if (iteration.converged(change)) return true;
    if (!iteration.accelerates()) continue;
    std::size_t bound = 0;
    for (ActiveContact& contact : active.list()) {
      if (joints_->bounds.depends_on_joint_force(contact.at))
        contact.at.of_joint.friction_bound = iteration.guess(bound++);
    }
  }
  return false;
}

/// Forces of contacts at given bounds of friction in joints, and the bounds that follow from them.
bool JointReactions::update_bounds_once(ActiveSet& active, MotionSample& at, BoundIteration& iteration,
                                        double& change) {
  if (!active.add_reactions(*assembly_, at.acceleration.data())) return false;
  const std::span<const double> forces = multipliers(at, active.list());
  joints_->bounds.take(forces.data(), 1.0, largest_load(at));
  for (ActiveContact& contact : active.list()) {
    if (!joints_->bounds.depends_on_joint_force(contact.at)) continue;
    const double before = contact.at.of_joint.friction_bound;
    change = std::max(change, joints_->bounds.update(contact.at, at.joint_view()));
    iteration.add(before, contact.at.of_joint.friction_bound);
  }
  return true;
}

bool JointReactions::update_friction_bounds(ActiveSet& active, MotionSample& at,
                                            std::vector<ActiveContact>& contacts,
                                            std::vector<ForceMargin>& margins, BoundIteration& iteration,
                                            double& change) {
  assert(is_at(at));
  std::vector<double>& free = memory_->closure.momentum;
  copy(velocities_, at.acceleration, free);
  active.list().swap(contacts);
  const bool found = update_bounds_once(active, at, iteration, change);
  copy(velocities_, free, at.acceleration);
  active.margins(margins);
  active.list().swap(contacts);
  return found;
}

/// Loads without reactions: forces small against them are rounding.
double JointReactions::largest_load(const MotionSample& at) const {
  double largest = 0.0;
  for (const Range v : velocities_) {
    for (Index i = v.begin; i < v.end; ++i) largest = std::max(largest, std::abs(at.loads()[i]));
  }
  return largest;
}

void JointReactions::build(IslandProblem& problem, std::span<const Constraint> contacts,
                           const double* velocity_before) {
  problem.build(contacts, velocity_before);
  problem.respond(joints_->rows.response());
}

bool JointReactions::solve(IslandProblem& problem, std::span<Constraint> contacts, const MotionSample& at,
                           SolverChain& chain) {
  assert(is_at(at));
  // Little is captured, so that nothing is allocated.
  const auto multipliers = [this, &problem](std::size_t) { return impulses(problem).data(); };
  FrictionBounds* const bounds = &joints_->bounds;
  return memory_->friction_bound.solve({.problem = problem,
                                        .contacts = contacts,
                                        .bounds = {&bounds, 1},
                                        .at = at.joint_view(),
                                        .duration = 0.0,
                                        .multipliers = multipliers},
                                       chain);
}

std::span<const double> JointReactions::impulses(const IslandProblem& problem) {
  std::vector<double>& change = memory_->closure.of_velocity;
  for (const Range v : velocities_) std::fill(change.begin() + v.begin, change.begin() + v.end, 0.0);
  problem.map().add_loads(1.0, change.data());
  joints_->rows.apply_inverse_mass(change.data());
  memory_->multipliers.resize(joints_->rows.size());
  joints_->rows.project(JointLevel::change, change.data(), memory_->multipliers.data());
  return memory_->multipliers;
}

std::span<const double> JointReactions::follow_jump(const MotionSample& at, std::span<double> velocities,
                                                    double noise, double& work) {
  assert(is_at(at));
  if (!joints_->rows.depends_on_time()) return {};
  std::vector<double>&change = memory_->closure.of_velocity, &impulse = memory_->closure.momentum;
  copy(velocities_, at.state.v, change);
  memory_->multipliers.resize(joints_->rows.size());
  joints_->rows.project(JointLevel::velocity, change.data(), memory_->multipliers.data());
  double largest = 0.0;
  for (const Range v : velocities_) {
    for (Index i = v.begin; i < v.end; ++i) {
      change[i] -= at.state.v[i];
      largest = std::max(largest, std::abs(change[i]) * memory_->closure.lengths[i]);
    }
  }
  if (!(largest > noise)) return {};
  std::size_t place = 0;
  for (const Index component : joints_->components) {
    assembly_->for_bodies(component, [&](const BodyKind& kind, Range slots, Index, Index first, Index) {
      kind.apply_mass(slots, change.data() + first, impulse.data() + first);
    });
  }
  for (const Range v : velocities_) {
    for (Index i = v.begin; i < v.end; ++i, ++place) {
      work += (at.state.v[i] + 0.5 * change[i]) * impulse[i];
      velocities[place] += change[i];
    }
  }
  return memory_->multipliers;
}

}  // namespace carom
