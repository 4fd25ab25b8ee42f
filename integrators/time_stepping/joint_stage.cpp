// Problem: end a step on the joints, with velocities that they allow, in contact too.

#include <carom/core/dynamics/body_response.h>
#include <carom/integrators/time_stepping/joint_stage.h>

#include <algorithm>
#include <cmath>

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
    stages_[component] = std::make_unique<JointStage>(assembly, component, *arrays_);
  }
}

JointStage::JointStage(const Assembly& assembly, Index component, JointArrays& arrays)
    : assembly_(&assembly),
      component_(component),
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

void JointStage::start(const StepInput& in, JointContacts& contacts, StepTrial& trial) {
  JointArrays& arrays = *arrays_;
  const Range q = assembly_->components()[component_].q;
  const Range v = assembly_->components()[component_].v;
  rows_.start();
  std::fill(impulse_.begin(), impulse_.end(), 0.0);
  for (Constraint& constraint : contacts.constraints) constraint.friction_bound *= in.step;
  trial.expect_impulses();
  for (std::vector<double>* const numbers :
       {&trial.dv_impulses, &arrays.dv_joints, &arrays.dv_contact, &arrays.displacement}) {
    clear(*numbers);
  }
  std::copy(in.start.q.begin() + q.begin, in.start.q.begin() + q.end, trial.end.q.begin() + q.begin);
  std::copy(in.start.v.begin() + v.begin, in.start.v.begin() + v.end, trial.end.v.begin() + v.begin);
  for (Index i = v.begin; i < v.end; ++i) arrays.scratch[i] = in.step * in.start.v[i];
  move(arrays.scratch, trial.end);
  struck_ = std::any_of(contacts.constraints.begin(), contacts.constraints.end(),
                        [](const Constraint& constraint) { return !constraint.has_dry_friction(); });
  if (!struck_ && !rows_.at_start().depends_on_time()) return;
  rows_.place_start(in, trial);
  if (!struck_) return;
  rows_.at_start().factor();
  JointResponse response(rows_.at_start());
  contacts.problem->respond(response);
}

bool JointStage::sweep(const StepInput& in, const StepRule& rule, JointContacts& contacts, StepTrial& trial) {
  JointArrays& arrays = *arrays_;
  const Component& all = assembly_->components()[component_];
  const Range q = all.q, v = all.v;
  std::copy(trial.end.q.begin() + q.begin, trial.end.q.begin() + q.end, arrays.before_q.begin() + q.begin);
  std::copy(trial.end.v.begin() + v.begin, trial.end.v.begin() + v.end, arrays.before_v.begin() + v.begin);

  rows_.place(in, trial);
  // Choosing factors the rows at the end.
  if (!trial.account.swept) rows_.choose(in, trial, left_);
  if (trial.account.swept || rows_.is_mixed()) rows_.factor();
  if (contacts.problem != nullptr && !struck_) rows_.at_midpoint().factor();

  const double half = 0.5 * in.step;
  const double* const load0 = rule.start_of_sum(in, trial);
  for (Index i = v.begin; i < v.end; ++i) trial.free[i] = half * (load0[i] + trial.loads_guess[i]);
  rows_.at_end().apply_inverse_mass(trial.free.data());
  for (Index i = v.begin; i < v.end; ++i) {
    trial.free[i] += static_cast<double>(in.companion.rounding[i]) + in.start.v[i];
  }
  correct_impulses(trial);
  if (contacts.problem != nullptr) {
    if (!react_to_contact(in, contacts, trial)) return false;
    correct_impulses(trial);  // for what contact changed
  }
  for (Index i = v.begin; i < v.end; ++i) trial.dv_impulses[i] = arrays.dv_joints[i] + arrays.dv_contact[i];
  rule.move(in, all.bodies, true, trial);
  trial.account.swept = true;
  return_to_joints(in, trial);
  return true;
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

/// One step of Newton's method for g(q_{j+1}, t_{j+1}) = 0 from the displacement of the sweep before, with
/// the rows there; several with rows of their own near a singular position, where rows change much from one
/// iterate to the next.
void JointStage::return_to_joints(const StepInput& in, StepTrial& trial) {
  constexpr int most_near_singular = 6;
  JointArrays& arrays = *arrays_;
  const Range v = assembly_->components()[component_].v;
  const bool near_singular = rows_.is_singular();
  move(arrays.displacement, trial.end);
  for (int turn = 0; turn < (near_singular ? most_near_singular : 1); ++turn) {
    if (near_singular) {
      rows_.place_end(in, trial);
      rows_.factor();
    } else {
      rows_.place_gaps(in, trial);
    }
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

SweepChange JointStage::change(const StepInput& in, const StepTrial& trial) const {
  SweepChange change;
  const JointArrays& arrays = *arrays_;
  assembly_->for_bodies(component_, [&](const BodyKind& kind, Range slots, Index q, Index v, Index) {
    for (Index slot = slots.begin; slot < slots.end; ++slot, q += kind.q_size(), v += kind.v_size()) {
      for (Index i = 0; i < kind.v_size(); ++i) {
        const double weight = in.step * arrays.lengths[v + i];
        change.take(weight * (trial.end.v[v + i] - arrays.before_v[v + i]), weight * trial.end.v[v + i]);
      }
      for (Index i = 0; i < kind.q_size(); ++i) {
        // Coordinates without a velocity of their own (unit quaternions) are judged as they are.
        const double weight = i < kind.v_size() ? arrays.lengths[v + i] : 1.0;
        change.take(weight * (trial.end.q[q + i] - arrays.before_q[q + i]), trial.end.q[q + i]);
      }
    }
  });
  return change;
}

void JointStage::settle_velocities(const StepInput& in, StepTrial& trial) {
  if (!rows_.correct_velocities(in, trial, left_)) return;
  for (std::size_t row = 0; row < left_.size(); ++row) impulse_[row] += left_[row];
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

double JointStage::violation(const StepInput& in, StepTrial& trial) {
  // Roundings of the numbers that a row is made of, some room for those of the factors included.
  constexpr double rounding = 1e-13;
  rows_.place_end(in, trial);
  const JointConstraints& end = rows_.at_end();
  const Range q = assembly_->components()[component_].q;
  double extent = 0.0, largest = 0.0;
  for (Index i = q.begin; i < q.end; ++i) extent = std::max(extent, std::abs(trial.end.q[i]));
  for (std::size_t i = 0; i < end.size(); ++i) {
    const JointRow row = end.row(i);
    double speed = std::abs(row.rate);
    for (int b = 0; b < row.bodies; ++b) {
      const JointRow::Block& block = row.blocks[static_cast<std::size_t>(b)];
      for (int c = 0; c < block.columns; ++c) {
        speed += std::abs(block.jacobian[static_cast<std::size_t>(c)] *
                          trial.end.v[block.v + static_cast<Index>(c)]);
      }
    }
    const double left = std::abs(residual(JointLevel::velocity, row, trial.end.v.data()));
    if (extent > 0.0) largest = std::max(largest, std::abs(row.gap) / (rounding * extent));
    if (speed > 0.0) largest = std::max(largest, left / (rounding * speed));
  }
  return largest;
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
