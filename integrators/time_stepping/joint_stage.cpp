// Problem: end a step on the joints, with velocities that they allow, in contact too.

#include <carom/core/dynamics/body_response.h>
#include <carom/integrators/time_stepping/joint_stage.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace carom {

JointArrays::JointArrays(const Assembly& assembly) : lengths(assembly.length_scales()) {
  for (std::vector<double>* const numbers :
       {&dv_joints, &dv_contact, &displacement, &scratch, &before_v, &allowed}) {
    numbers->resize(assembly.layout()->v_size());
  }
  before_q.resize(assembly.layout()->q_size());
}

JointStages::JointStages(const Assembly& assembly) {
  const auto components = static_cast<Index>(assembly.components().size());
  for (Index component = 0; component < components; ++component) {
    if (!assembly.has_joints(component)) continue;
    if (!arrays_) arrays_ = std::make_unique<JointArrays>(assembly);
    stages_.resize(components);
    stages_[component] = std::make_unique<JointStage>(assembly, component, rows_, *arrays_);
    rows_ += static_cast<Index>(stages_[component]->rows().at_end().size());
  }
}

void JointStages::record(double step, JointHistory& history) const {
  if (stages_.empty()) return;
  history.go_on(step, stages_.size(), rows_, arrays_->displacement.size());
  for (const auto& stage : stages_) {
    if (stage != nullptr) stage->record(history);
  }
}

JointStage::JointStage(const Assembly& assembly, Index component, Index first_row, JointArrays& arrays)
    : assembly_(&assembly),
      component_(component),
      first_row_(first_row),
      arrays_(&arrays),
      rows_(assembly, component),
      impulse_(rows_.at_end().size()),
      total_(impulse_),
      left_(impulse_),
      bounds_(assembly, component, rows_.at_end()) {}

void JointStage::clear(std::vector<double>& numbers) const {
  const Range v = assembly_->components()[component_].v;
  std::fill(numbers.begin() + v.begin, numbers.begin() + v.end, 0.0);
}

/// Reactions and the displacement as after the steps before. False if none are remembered.
bool JointStage::guess(const StepInput& in) {
  const JointHistory& history = in.companion.joints;
  const int known = history.usable(component_, in.step);
  if (known == 0) return false;
  const Range v = assembly_->components()[component_].v;
  const auto rows = static_cast<Index>(impulse_.size());
  history.impulses.guess({first_row_, first_row_ + rows}, known, impulse_.data() - first_row_);
  history.velocities.guess(v, known, arrays_->dv_joints.data());
  history.displacements.guess(v, known, arrays_->displacement.data());
  return true;
}

/// What contact did is of its own step: a guess follows it only where it did nothing.
void JointStage::record(JointHistory& history) const {
  int& known = history.known[component_];
  known = struck_ ? 1 : std::min(known + 1, StepCourse::most + 1);
  const Range v = assembly_->components()[component_].v;
  const auto rows = static_cast<Index>(impulse_.size());
  history.impulses.record({first_row_, first_row_ + rows}, impulse_.data() - first_row_);
  history.velocities.record(v, arrays_->dv_joints.data());
  history.displacements.record(v, arrays_->displacement.data());
}

void JointStage::start(const StepInput& in, const StepRule& rule, bool guesses, JointContacts& contacts,
                       StepTrial& trial) {
  sweeps_ = 0;
  for (Constraint& constraint : contacts.constraints) constraint.friction_bound *= in.step;
  trial.expect_impulses();
  clear(arrays_->dv_contact);
  struck_ = std::any_of(contacts.constraints.begin(), contacts.constraints.end(),
                        [](const Constraint& constraint) { return !constraint.has_dry_friction(); });
  if (struck_ || rows_.at_start().depends_on_time()) rows_.place_start(in, trial);
  if (struck_) {
    rows_.at_start().factor();
    { rows_.at_start().residuals(JointLevel::change, in.start.v.data(), left_.data());
      double m=0; for(double l:left_) m=std::max(m,std::abs(l)); std::fprintf(stderr,"t %g G0v0 %.2e last violation %.2e sing %d near %d\n",in.end_time,m,violation_,(int)rows_.is_singular(),(int)rows_.is_near_singular()); }
    JointResponse response(rows_.at_start());
    contacts.problem->respond(response);
  }
  guessed_ = guesses && contacts.problem == nullptr && guess(in);
  if (guessed_) {
    find_free_velocities(in, rule, trial);
    move_bodies(in, rule, trial);
    move(arrays_->displacement, trial.end);
    rows_.begin(in, trial, left_);
    // There rows turn too much for what was before to be of use.
    guessed_ = !rows_.is_near_singular();
  }
  if (!guessed_) {
    move_by_start(in, trial);
    rows_.begin(in, trial, left_);
  }
  judge(trial);
}

/// The first iterate where nothing is guessed.
void JointStage::move_by_start(const StepInput& in, StepTrial& trial) {
  JointArrays& arrays = *arrays_;
  const Range q = assembly_->components()[component_].q;
  const Range v = assembly_->components()[component_].v;
  std::fill(impulse_.begin(), impulse_.end(), 0.0);
  for (std::vector<double>* const numbers : {&trial.dv_impulses, &arrays.dv_joints, &arrays.displacement}) {
    clear(*numbers);
  }
  std::copy(in.start.q.begin() + q.begin, in.start.q.begin() + q.end, trial.end.q.begin() + q.begin);
  std::copy(in.start.v.begin() + v.begin, in.start.v.begin() + v.end, trial.end.v.begin() + v.begin);
  for (Index i = v.begin; i < v.end; ++i) arrays.scratch[i] = in.step * in.start.v[i];
  move(arrays.scratch, trial.end);
}

void JointStage::find_free_velocities(const StepInput& in, const StepRule& rule, StepTrial& trial) const {
  const Range v = assembly_->components()[component_].v;
  const double half = 0.5 * in.step;
  const double* const load0 = rule.start_of_sum(in, trial);
  for (Index i = v.begin; i < v.end; ++i) trial.free[i] = half * (load0[i] + trial.loads_guess[i]);
  rows_.at_end().apply_inverse_mass(trial.free.data());
  for (Index i = v.begin; i < v.end; ++i) {
    trial.free[i] += static_cast<double>(in.companion.rounding[i]) + in.start.v[i];
  }
}

/// Without the displacement back onto the joints.
void JointStage::move_bodies(const StepInput& in, const StepRule& rule, StepTrial& trial) const {
  const Component& all = assembly_->components()[component_];
  for (Index i = all.v.begin; i < all.v.end; ++i) {
    trial.dv_impulses[i] = arrays_->dv_joints[i] + arrays_->dv_contact[i];
  }
  rule.move(in, all.bodies, true, trial);
}

/// Factors of the first iterate serve all, as they change by what rows turn between two iterates; of the
/// second where the first was far away, and of each where that does not help.
bool JointStage::needs_factors(const JointContacts& contacts) const {
  constexpr int patience = 4;
  return sweeps_ > 0 && (contacts.problem != nullptr || rows_.is_near_singular() ||
                         (sweeps_ == 1 && !guessed_) || sweeps_ >= patience);
}

bool JointStage::sweep(const StepInput& in, const StepRule& rule, JointContacts& contacts, StepTrial& trial) {
  JointArrays& arrays = *arrays_;
  const Component& all = assembly_->components()[component_];
  const Range q = all.q, v = all.v;
  std::copy(trial.end.q.begin() + q.begin, trial.end.q.begin() + q.end, arrays.before_q.begin() + q.begin);
  std::copy(trial.end.v.begin() + v.begin, trial.end.v.begin() + v.end, arrays.before_v.begin() + v.begin);

  if (needs_factors(contacts)) rows_.factor();
  if (contacts.problem != nullptr && !struck_) rows_.at_midpoint().factor();
  find_free_velocities(in, rule, trial);
  if (guessed_ && sweeps_ == 0 && rows_.has_dependent()) drop_dependent();
  correct_impulses(trial);
  // Once more with the same rows costs less than another sweep.
  if (guessed_ && contacts.problem == nullptr) correct_impulses(trial);
  if (contacts.problem != nullptr) {
    if (!react_to_contact(in, contacts, trial)) return false;
    correct_impulses(trial);  // for what contact changed
  }
  move_bodies(in, rule, trial);
  return_to_joints(in, contacts.problem != nullptr, trial);
  rows_.place(in, trial);
  judge(trial);
  ++sweeps_;
  trial.account.swept = true;
  return true;
}

/// Impulses that cancel each other, along rows that follow from others, would go on from guess to guess.
void JointStage::drop_dependent() {
  JointArrays& arrays = *arrays_;
  clear(arrays.scratch);
  rows_.at_end().add_response(impulse_.data(), arrays.scratch.data());
  rows_.at_end().residuals(JointLevel::change, arrays.scratch.data(), left_.data());
  rows_.solve(left_);
  for (std::size_t row = 0; row < left_.size(); ++row) impulse_[row] = -left_[row];
  clear(arrays.dv_joints);
  rows_.at_midpoint().add_response(impulse_.data(), arrays.dv_joints.data());
}

/// One step of Newton's method for G1 v_{j+1} + rate = 0. With G1 on both sides, instead of Gm on one, the
/// matrix is symmetric and its range is that of G1, where rows depend on each other too.
void JointStage::correct_impulses(const StepTrial& trial) {
  JointArrays& arrays = *arrays_;
  const Range v = assembly_->components()[component_].v;
  for (Index i = v.begin; i < v.end; ++i) {
    arrays.scratch[i] = trial.free[i] + arrays.dv_joints[i] + arrays.dv_contact[i];
  }
  rows_.at_end().residuals(JointLevel::velocity, arrays.scratch.data(), left_.data());
  rows_.solve(left_);
  clear(arrays.dv_joints);
  for (std::size_t row = 0; row < left_.size(); ++row) impulse_[row] += left_[row];
  rows_.at_midpoint().add_transposed(impulse_.data(), arrays.dv_joints.data());
  rows_.at_end().apply_inverse_mass(arrays.dv_joints.data());
}

/// One step of Newton's method for g(q_{j+1}, t_{j+1}) = 0, with the rows and gaps of the iterate before. The
/// displacement is made anew, so that nothing across the joints goes on from guess to guess.
void JointStage::return_to_joints(const StepInput& in, bool touches, StepTrial& trial) {
  if (rows_.is_singular()) return return_near_singular(in, trial);
  JointArrays& arrays = *arrays_;
  const Range v = assembly_->components()[component_].v;
  const double half = 0.5 * in.step;
  // An impact moves bodies too far for a prediction.
  if (touches) rows_.place_end(in, trial);
  for (Index i = v.begin; i < v.end; ++i) {
    const double moved = half * (trial.end.v[i] - arrays.before_v[i]) - arrays.displacement[i];
    arrays.scratch[i] = touches ? 0.0 : moved;
  }
  rows_.at_end().residuals(JointLevel::displacement, arrays.scratch.data(), left_.data());
  rows_.solve(left_);
  clear(arrays.displacement);
  rows_.pushing().add_response(left_.data(), arrays.displacement.data());
  move(arrays.displacement, trial.end);
}

/// Several steps from the displacement of the sweep before, with rows of their own, which change much from
/// one iterate to the next.
void JointStage::return_near_singular(const StepInput& in, StepTrial& trial) {
  constexpr int turns = 6;
  JointArrays& arrays = *arrays_;
  const Range v = assembly_->components()[component_].v;
  move(arrays.displacement, trial.end);
  for (int turn = 0; turn < turns; ++turn) {
    rows_.place_end(in, trial);
    rows_.factor();
    for (std::size_t row = 0; row < left_.size(); ++row) left_[row] = rows_.at_end().gap(row);
    rows_.solve(left_);
    clear(arrays.scratch);
    rows_.pushing().add_response(left_.data(), arrays.scratch.data());
    for (Index i = v.begin; i < v.end; ++i) arrays.displacement[i] += arrays.scratch[i];
    move(arrays.scratch, trial.end);
  }
}

void JointStage::move(const std::vector<double>& displacement, State& state) const {
  assembly_->for_bodies(component_, [&](const BodyKind& kind, Range slots, Index q, Index v, Index) {
    kind.advance(slots, state.q.data() + q, displacement.data() + v, state.q.data() + q);
  });
}

bool JointStage::react_to_contact(const StepInput& in, JointContacts& contacts, StepTrial& trial) {
  JointArrays& arrays = *arrays_;
  IslandProblem& problem = *contacts.problem;
  if (struck_) {
    // The guess of Newton's method couples bodies by more than their joints.
    if (contacts.stale_matrix) {
      JointResponse response(rows_.at_start());
      problem.respond(response);
    }
    for (std::size_t c = 0; c < contacts.constraints.size(); ++c) {
      if (contacts.constraints[c].has_dry_friction()) problem.update_bound(c);
    }
  } else {
    update_friction_rows(contacts, trial);
    JointResponse response(rows_.at_midpoint());
    problem.respond(response);
  }
  const Range v = assembly_->components()[component_].v;
  for (Index i = v.begin; i < v.end; ++i) arrays.scratch[i] = trial.free[i] + arrays.dv_joints[i];
  if (struck_) allow_at_start(arrays.scratch.data());
  problem.set_free_velocity(arrays.scratch.data());
  const FrictionBoundProblem bounded{.problem = problem,
                                     .contacts = contacts.constraints,
                                     .bounds = bounds_,
                                     .at = {trial.midpoint.view(), trial.at_midpoint.rotation.data()},
                                     .duration = in.step,
                                     .multipliers = [this, &problem] { return multipliers(&problem); }};
  if (!bound_solver_.solve(bounded, contacts.chain)) return false;
  clear(arrays.dv_contact);
  problem.map().add_velocities(arrays.dv_contact.data());
  return true;
}

void JointStage::allow_at_start(double* velocity) {
  JointConstraints& start = rows_.at_start();
  start.residuals(JointLevel::change, velocity, left_.data());
  for (std::size_t row = 0; row < left_.size(); ++row) left_[row] += rows_.at_end().rate(row);
  start.solve(left_.data());
  start.add_response(left_.data(), velocity);
}

const double* JointStage::velocities_of_contact(StepTrial& trial) {
  if (!struck_) return trial.end.v.data();
  const Range v = assembly_->components()[component_].v;
  std::vector<double>& allowed = arrays_->allowed;
  std::copy(trial.end.v.begin() + v.begin, trial.end.v.begin() + v.end, allowed.begin() + v.begin);
  allow_at_start(allowed.data());
  return allowed.data();
}

/// Friction in joints alone acts halfway, against the rates that coordinates have at the end.
void JointStage::update_friction_rows(JointContacts& contacts, StepTrial& trial) {
  JointArrays& arrays = *arrays_;
  const Range v = assembly_->components()[component_].v;
  for (Index i = v.begin; i < v.end; ++i) {
    arrays.scratch[i] = trial.free[i] + arrays.dv_joints[i] + arrays.dv_contact[i];
  }
  const JointView halfway{trial.midpoint.view(), trial.at_midpoint.rotation.data()};
  const JointView end{trial.end.view(), trial.at_end.rotation.data()};
  for (std::size_t c = 0; c < contacts.constraints.size(); ++c) {
    Constraint& friction = contacts.constraints[c];
    contacts.detector.update_friction_rows(end, friction);
    const double at_end = friction.times(0, arrays.scratch.data());
    contacts.detector.update_friction_rows(halfway, friction);
    friction.surface_velocity_after[0] = friction.times(0, arrays.scratch.data()) - at_end;
    contacts.problem->update_bound(c);
  }
}

const double* JointStage::multipliers(const IslandProblem* problem) {
  total_ = impulse_;
  if (problem == nullptr) return total_.data();
  JointConstraints& answering = struck_ ? rows_.at_start() : rows_.at_midpoint();
  std::vector<double>& loads = arrays_->scratch;
  clear(loads);
  problem->map().add_loads(1.0, loads.data());
  answering.apply_inverse_mass(loads.data());
  answering.project(JointLevel::change, loads.data(), left_.data());
  for (std::size_t row = 0; row < total_.size(); ++row) total_[row] += left_[row];
  return total_.data();
}

SweepChange JointStage::change(const StepInput& in, const JointContacts& contacts, const StepTrial& trial) {
  SweepChange change;
  JointArrays& arrays = *arrays_;
  // An impact multiplies what a step before it has left by its impulse.
  constexpr double accepted = 0.05;
  const bool obeyed = contacts.problem == nullptr && violation_ <= accepted && !rows_.is_near_singular();
  if (obeyed) {
    clear(arrays.scratch);
    rows_.at_midpoint().add_response(impulse_.data(), arrays.scratch.data());
  }
  assembly_->for_bodies(component_, [&](const BodyKind& kind, Range slots, Index q, Index v, Index) {
    const Index q_size = kind.q_size(), v_size = kind.v_size();
    for (Index slot = slots.begin; slot < slots.end; ++slot, q += q_size, v += v_size) {
      for (Index i = 0; i < v_size; ++i) {
        const double weight = in.step * arrays.lengths[v + i];
        const double difference = obeyed ? arrays.scratch[v + i] - arrays.dv_joints[v + i]
                                         : trial.end.v[v + i] - arrays.before_v[v + i];
        change.take(weight * difference, weight * trial.end.v[v + i]);
      }
      for (Index i = 0; i < q_size; ++i) {
        // Coordinates without a velocity of their own (unit quaternions) are judged as they are.
        const double weight = i < v_size ? arrays.lengths[v + i] : 1.0;
        const double difference = obeyed ? 0.0 : trial.end.q[q + i] - arrays.before_q[q + i];
        change.take(weight * difference, trial.end.q[q + i]);
      }
    }
  });
  return change;
}

double JointStage::work_of_reactions(const StepTrial& trial) {
  std::vector<double>& masses = arrays_->scratch;
  const Range v = assembly_->components()[component_].v;
  std::fill(masses.begin() + v.begin, masses.begin() + v.end, 1.0);
  rows_.at_end().apply_inverse_mass(masses.data());
  double sum = 0.0;
  for (Index i = v.begin; i < v.end; ++i) sum += trial.midpoint.v[i] * (arrays_->dv_joints[i] / masses[i]);
  return sum;
}

void JointStage::settle_velocities(const StepInput& in, StepTrial& trial) {
  if (!rows_.correct_velocities(in, trial, left_)) return;
  for (std::size_t row = 0; row < left_.size(); ++row) impulse_[row] += left_[row];
  rows_.at_midpoint().add_response(left_.data(), arrays_->dv_joints.data());
  trial.place_midpoint(in, component_);
}

double JointStage::project_velocities(StepTrial& trial) {
  const auto kinetic = [&] {
    double sum = 0.0;
    assembly_->for_bodies(component_, [&](const BodyKind& kind, Range slots, Index, Index v, Index) {
      sum += kind.kinetic_energy(slots, trial.end.v.data() + v);
    });
    return sum;
  };
  JointConstraints& joints = rows_.at_end();
  const double before = kinetic();
  joints.update_and_factor({trial.end.view(), trial.at_end.rotation.data()});
  joints.project(JointLevel::velocity, trial.end.v.data());
  joints.project(JointLevel::velocity, trial.end.v.data());  // what rounding left
  return before - kinetic();
}

/// Measures the violation, with the rows at the iterate.
void JointStage::judge(const StepTrial& trial) {
  // Roundings of the numbers that a row is made of, some room for those of the factors included.
  constexpr double rounding = 1e-13;
  const JointConstraints& end = rows_.at_end();
  const Range q = assembly_->components()[component_].q;
  double extent = 0.0;
  for (Index i = q.begin; i < q.end; ++i) extent = std::max(extent, std::abs(trial.end.q[i]));
  end.residuals_and_sizes(trial.end.v.data(), left_.data(), total_.data());
  violation_ = 0.0;
  for (std::size_t row = 0; row < end.size(); ++row) {
    if (extent > 0.0) violation_ = std::max(violation_, std::abs(end.gap(row)) / (rounding * extent));
    const double speed = total_[row];
    if (speed > 0.0) violation_ = std::max(violation_, std::abs(left_[row]) / (rounding * speed));
  }
}

JointId JointStage::worst_joint(double& violation) const {
  const JointConstraints& end = rows_.at_end();
  JointId worst;
  violation = 0.0;
  for (std::size_t row = 0; row < end.size(); ++row) {
    const double gap = std::abs(end.gap(row));
    if (!(gap > violation)) continue;
    violation = gap;
    worst = end.joint(row);
  }
  return worst;
}

}  // namespace carom
