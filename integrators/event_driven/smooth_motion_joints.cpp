// Problem: what joints add to the motion of a component: their reactions, friction in them, jumps of what
// drives them.

#include <carom/core/numerics/bound_iteration.h>
#include <carom/integrators/event_driven/smooth_motion.h>

#include <algorithm>
#include <cmath>

namespace carom {

/// Forces of contacts, with friction in joints bound by the forces that follow.
bool SmoothMotion::add_friction_bound_reactions() {
  MotionWorkspace& work = *work_;
  const Range v = assembly_->components()[component_].v;
  work.free.resize(work.acceleration.size());
  std::copy(work.acceleration.begin() + v.begin, work.acceleration.begin() + v.end,
            work.free.begin() + v.begin);
  BoundIteration iteration;
  for (int i = 0; i < BoundIteration::most_repetitions; ++i) {
    std::copy(work.free.begin() + v.begin, work.free.begin() + v.end, work.acceleration.begin() + v.begin);
    double change = 0.0;
    iteration.begin();
    if (!press_once(iteration, change)) return false;
    if (iteration.settled(change)) return true;
    if (!iteration.accelerates()) continue;
    std::size_t bound = 0;
    for (ActiveContact& contact : active_.list()) {
      if (pressure_.depends_on_joint_force(contact.at)) contact.at.friction_bound = iteration.guess(bound++);
    }
  }
  return false;
}

/// Forces of contacts at given bounds of friction in joints, and the bounds that follow from them.
bool SmoothMotion::press_once(BoundIteration& iteration, double& change) {
  if (!active_.add_reactions(*assembly_, work_->acceleration.data())) return false;
  const JointView at{work_->trial.view(), work_->evaluation.rotation.data()};
  const std::span<const double> multipliers = joint_multipliers();
  pressure_.take(multipliers.data(), 1.0, largest_load());
  for (ActiveContact& contact : active_.list()) {
    if (!pressure_.depends_on_joint_force(contact.at)) continue;
    const double before = contact.at.friction_bound;
    change = std::max(change, pressure_.press(contact.at, at));
    iteration.add(before, contact.at.friction_bound);
  }
  return true;
}

bool SmoothMotion::update_bounds(std::vector<ActiveContact>& contacts, std::vector<ForceMargin>& margins,
                                 BoundIteration& iteration, double& change) {
  MotionWorkspace& work = *work_;
  const Range v = assembly_->components()[component_].v;
  work.free.resize(work.acceleration.size());
  std::copy(work.acceleration.begin() + v.begin, work.acceleration.begin() + v.end,
            work.free.begin() + v.begin);
  active_.list().swap(contacts);
  const bool found = press_once(iteration, change);
  std::copy(work.free.begin() + v.begin, work.free.begin() + v.end, work.acceleration.begin() + v.begin);
  active_.margins(margins);
  active_.list().swap(contacts);
  return found;
}

/// Loads without reactions: forces small against them are rounding.
double SmoothMotion::largest_load() const {
  const Range v = assembly_->components()[component_].v;
  double largest = 0.0;
  for (Index i = v.begin; i < v.end; ++i) largest = std::max(largest, std::abs(work_->momentum[i]));
  return largest;
}

bool SmoothMotion::solve(IslandProblem& cluster, std::span<Constraint> contacts, SolverChain& chain) {
  MotionWorkspace& work = *work_;
  work.multipliers.resize(joints_.size());
  // Little is captured, so that nothing is allocated.
  const auto multipliers = [this, &cluster] {
    MotionWorkspace& at = *work_;
    const Range v = assembly_->components()[component_].v;
    std::fill(at.of_velocity.begin() + v.begin, at.of_velocity.begin() + v.end, 0.0);
    cluster.map().add_loads(1.0, at.of_velocity.data());
    joints_.apply_inverse_mass(at.of_velocity.data());
    joints_.project(JointLevel::change, at.of_velocity.data(), at.multipliers.data());
    return static_cast<const double*>(at.multipliers.data());
  };
  return work.friction_bound.solve({.cluster = cluster,
                                    .contacts = contacts,
                                    .pressure = pressure_,
                                    .at = {work.trial.view(), work.evaluation.rotation.data()},
                                    .duration = 0.0,
                                    .multipliers = multipliers},
                                   chain);
}

std::span<const double> SmoothMotion::joint_multipliers() {
  MotionWorkspace& work = *work_;
  std::vector<double>& answer = work.of_velocity;
  const Range v = assembly_->components()[component_].v;
  std::copy(work.momentum.begin() + v.begin, work.momentum.begin() + v.end, answer.begin() + v.begin);
  for (const ActiveContact& contact : active_.list()) {
    contact.at.add_force(contact.normal, contact.tangential, answer.data());
  }
  assembly_->for_bodies(component_, [&](const BodyKind& kind, Range slots, Index, Index at, Index) {
    kind.apply_inverse_mass(slots, answer.data() + at, answer.data() + at);
  });
  work.multipliers.resize(joints_.size());
  joints_.project(JointLevel::acceleration, answer.data(), work.multipliers.data());
  return work.multipliers;
}

void SmoothMotion::respond(IslandProblem& problem) {
  MassResponse masses(*assembly_);
  JointResponse with_joints(joints_);
  problem.respond(joints_.empty() ? static_cast<BodyResponse&>(masses) : with_joints);
}

bool SmoothMotion::follow_jump(std::span<double> y, double noise, double& work) {
  if (!joints_.depends_on_time()) return false;
  MotionWorkspace& space = *work_;
  const Range v = assembly_->components()[component_].v;
  std::vector<double>& change = space.of_velocity;
  std::copy(space.trial.v.begin() + v.begin, space.trial.v.begin() + v.end, change.begin() + v.begin);
  space.multipliers.resize(joints_.size());
  joints_.project(JointLevel::velocity, change.data(), space.multipliers.data());
  double largest = 0.0;
  for (Index i = v.begin; i < v.end; ++i) {
    change[i] -= space.trial.v[i];
    largest = std::max(largest, std::abs(change[i]) * space.lengths[i]);
  }
  if (!(largest > noise)) return false;
  assembly_->for_bodies(component_, [&](const BodyKind& kind, Range slots, Index, Index at, Index) {
    kind.apply_mass(slots, change.data() + at, space.momentum.data() + at);
  });
  for (Index i = v.begin; i < v.end; ++i) {
    work += (space.trial.v[i] + 0.5 * change[i]) * space.momentum[i];
    y[q_size_ + (i - v.begin)] += change[i];
  }
  return true;
}

std::vector<std::string> SmoothMotion::projected_by() {
  // Of the largest impulse: less is what others cause.
  constexpr double considerable = 0.1;
  MotionWorkspace& work = *work_;
  const Range v = assembly_->components()[component_].v;
  std::copy(work.trial.v.begin() + v.begin, work.trial.v.begin() + v.end, work.of_velocity.begin() + v.begin);
  work.multipliers.assign(joints_.size(), 0.0);
  joints_.project(JointLevel::velocity, work.of_velocity.data(), work.multipliers.data());
  double largest = 0.0;
  for (const double impulse : work.multipliers) largest = std::max(largest, std::abs(impulse));
  std::vector<std::string> names;
  for (std::size_t joint = 0; joint < joints_.joints(); ++joint) {
    bool takes_part = false;
    for (Index row = joints_.first_row(joint); row < joints_.first_row(joint + 1); ++row) {
      takes_part = takes_part || (largest > 0.0 && std::abs(work.multipliers[row]) >= considerable * largest);
    }
    if (takes_part) names.push_back(assembly_->system().name(joints_.joint(joints_.first_row(joint))));
  }
  if (!names.empty()) return names;
  for (const ActiveContact& contact : active_.list()) names.push_back(detector_->name(contact.at.key));
  return names;
}

}  // namespace carom
