// Problem: a sweep of mechanisms, of which contact may join several with each other and with single bodies.

#include <carom/integrators/time_stepping/island_joints.h>

#include <algorithm>
#include <cstddef>

namespace carom {

namespace {

/// The kind of touch of an island whose problem is given.
JointsTouch touch_of(const IslandContact& contact) {
  if (contact.problem == nullptr) return JointsTouch::nothing;
  const bool struck = std::any_of(contact.constraints.begin(), contact.constraints.end(),
                                  [](const Constraint& constraint) { return constraint.normals > 0; });
  return struck ? JointsTouch::contact : JointsTouch::friction;
}

}  // namespace

IslandJoints::IslandJoints(const Assembly& assembly, const JointRows& joints, JointStages& stages)
    : assembly_(&assembly), rows_of_joints_(&joints), stages_(&stages), response_(assembly) {}

void IslandJoints::bind(const StepIsland& island) {
  components_ = island.components;
  jointed_.clear();
  bounds_.clear();
  if (!stages_->any()) return;
  for (const Index component : components_) {
    JointStage* const joints = stages_->of(component);
    if (joints == nullptr) continue;
    jointed_.push_back(joints);
    bounds_.push_back(&joints->friction_bounds());
  }
}

void IslandJoints::start(const StepInput& in, const StepRule& rule, Iteration iteration,
                         const IslandContact& contact, StepTrial& trial) {
  trial.expect_impulses();
  touch_ = touch_of(contact);
  if (touch_ != JointsTouch::nothing) {
    velocity_.resize(in.start.v.size());
    change_.resize(in.start.v.size());
  }
  for (JointStage* const joints : jointed_) joints->start(in, rule, iteration, touch_, trial);
  if (touch_ == JointsTouch::contact) respond(*contact.problem, touch_);
}

/// Makes the matrix of the problem by what answers along the rows at hand.
void IslandJoints::respond(IslandProblem& problem, JointsTouch touch) {
  rows_.clear();
  for (JointStage* const joints : jointed_) rows_.push_back(&joints->answering(touch));
  response_.bind(rows_);
  problem.respond(response_);
}

bool IslandJoints::sweep(const StepInput& in, const StepRule& rule, const IslandContact& contact,
                         StepTrial& trial) {
  if (looks_ahead()) {
    alone()->sweep_guessed(in, rule, trial);
    return true;
  }
  for (const Index component : components_) {
    if (JointStage* const joints = stages_->of(component)) {
      joints->approach(in, rule, trial, velocity_.data());
    } else {
      free_component(in, rule, component, trial);
    }
  }
  if (contact.problem != nullptr && !react(in, contact, trial)) return false;
  for (const Index component : components_) {
    if (JointStage* const joints = stages_->of(component)) {
      joints->leave(in, rule, contact.problem != nullptr ? change_.data() : nullptr, trial);
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

/// Impulses of contact, and friction in joints that the forces of these bound.
bool IslandJoints::react(const StepInput& in, const IslandContact& contact, StepTrial& trial) {
  IslandProblem& problem = *contact.problem;
  if (touch_ == JointsTouch::friction) {
    for (JointStage* const joints : jointed_)
      joints->turn_friction(contact.constraints, *rows_of_joints_, velocity_.data(), trial);
  }
  for (std::size_t c = 0; c < contact.constraints.size(); ++c) problem.update_bound(c);
  // The guess of Newton's method couples bodies by more than their joints.
  if (touch_ == JointsTouch::friction || contact.stale_matrix) respond(problem, touch_);
  problem.set_free_velocity(velocity_.data());
  const auto multipliers = [this, &problem](std::size_t i) { return jointed_[i]->multipliers(&problem); };
  const FrictionBoundProblem bounded{.problem = problem,
                                     .contacts = contact.constraints,
                                     .bounds = bounds_,
                                     .at = {trial.midpoint.view(), trial.at_midpoint.rotation.data()},
                                     .duration = in.step,
                                     .multipliers = multipliers};
  if (!bound_solver_.solve(bounded, contact.chain)) return false;
  for (const Index component : components_) {
    const Range v = assembly_->components()[component].v;
    std::fill(change_.begin() + v.begin, change_.begin() + v.end, 0.0);
  }
  problem.map().add_velocities(change_.data());
  return true;
}

/// Velocities at the end of a component without joints if nothing touched: v_j + M^-1 h (F_j + F_{j+1})/2.
void IslandJoints::free_component(const StepInput& in, const StepRule& rule, Index component,
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

void IslandJoints::take_change(const StepInput& in, const StepTrial& trial, SweepChange& change) {
  double growth = 1.0;
  for (JointStage* const joints : jointed_) {
    change.take(joints->change(in, trial));
    growth = std::max(growth, joints->rows().roundoff_growth());
  }
  change.size *= growth;
}

bool IslandJoints::looks_ahead() const {
  const JointStage* const joints = alone();
  return joints != nullptr && joints->looks_ahead();
}

double IslandJoints::violation(const StepInput& in, StepTrial& trial) {
  double largest = 0.0;
  for (JointStage* const joints : jointed_) largest = std::max(largest, joints->violation(in, trial));
  return largest;
}

bool IslandJoints::is_near_singular() const {
  return std::any_of(jointed_.begin(), jointed_.end(),
                     [](JointStage* joints) { return joints->rows().is_near_singular(); });
}

}  // namespace carom
