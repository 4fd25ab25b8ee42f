// Problem: end a step on the joints, with velocities that they allow, and say what they did.

#include <carom/integrators/time_stepping/time_stepper.h>

#include <algorithm>
#include <cmath>

namespace carom {

namespace {

JointView view_of(const State& state, const Evaluation& evaluation) {
  return {state.view(), evaluation.rotation.data()};
}

void clear(std::vector<double>& numbers, Range range) {
  std::fill(numbers.begin() + range.begin, numbers.begin() + range.end, 0.0);
}

}  // namespace

void TimeStepper::prepare_joints() {
  const Assembly& assembly = *assembly_;
  const auto components = static_cast<Index>(assembly.components().size());
  for (Index component = 0; component < components; ++component) {
    if (!assembly.has_joints(component)) continue;
    joints_.resize(components);
    JointWork& work = joints_[component];
    work.end = JointConstraints(assembly, component);
    work.start = work.mean = work.end;
    work.impulse.resize(work.end.size());
    work.total.resize(work.end.size());
    work.left.resize(work.end.size());
    work.pressure = FrictionBounds(assembly, component, work.end);
  }
  if (joints_.empty()) return;
  const std::size_t size = assembly.layout()->v_size();
  for (std::vector<double>* const numbers :
       {&dv_impulses_, &reaction_, &dv_contact_, &free_, &displacement_, &scratch_, &before_v_, &allowed_}) {
    numbers->resize(size);
  }
  before_q_.resize(assembly.layout()->q_size());
  lengths_ = assembly.length_scales();
}

/// The first guess: no reactions, and the positions that the present velocities lead to.
void TimeStepper::start_joints(Index component, const State& state, double step) {
  JointWork& work = joints_[component];
  const Range q = assembly_->components()[component].q;
  const Range v = assembly_->components()[component].v;
  work.reactions = Reactions::halfway;
  std::fill(work.impulse.begin(), work.impulse.end(), 0.0);
  for (Constraint& contact : contacts_) contact.friction_bound *= step;
  for (std::vector<double>* const numbers : {&dv_impulses_, &reaction_, &dv_contact_, &displacement_}) {
    clear(*numbers, v);
  }
  std::copy(state.q.begin() + q.begin, state.q.begin() + q.end, trial_.q.begin() + q.begin);
  std::copy(state.v.begin() + v.begin, state.v.begin() + v.end, trial_.v.begin() + v.begin);
  for (Index i = v.begin; i < v.end; ++i) scratch_[i] = step * state.v[i];
  move(component, scratch_, trial_);
  work.struck = strikes();
  if (!work.struck && !work.start.depends_on_time()) return;
  evaluate_positions(*assembly_, component, state.view(), start_);
  place_rows(work.start, view_of(state, start_), state, step);
  if (!work.struck) return;
  work.start.factor();
  JointResponse response(work.start);
  clusters_.front().respond(response);
}

void TimeStepper::sweep_joints(Index component, const State& state, const Companion& companion, double step) {
  JointWork& work = joints_[component];
  const Range q = assembly_->components()[component].q;
  const Range v = assembly_->components()[component].v;
  std::copy(trial_.q.begin() + q.begin, trial_.q.begin() + q.end, before_q_.begin() + q.begin);
  std::copy(trial_.v.begin() + v.begin, trial_.v.begin() + v.end, before_v_.begin() + v.begin);

  place_joints(component, state, step);
  // Choosing factors the rows at the end.
  if (!swept_) choose_reactions(component, state, step);
  if (swept_ || work.reactions == Reactions::crossed) factor_joints(work);
  if (clusters_in_use_ > 0 && !work.struck) work.mean.factor();

  const double half = 0.5 * step;
  const double* const load0 = start_of_sum(companion);
  for (Index i = v.begin; i < v.end; ++i) free_[i] = half * (load0[i] + evaluation_.force[i]);
  work.end.apply_inverse_mass(free_.data());
  for (Index i = v.begin; i < v.end; ++i) free_[i] += static_cast<double>(companion.rounding[i]) + state.v[i];
  correct_joint_impulses(component);
  if (clusters_in_use_ > 0) {
    solve_joint_contacts(component, state, step);
    correct_joint_impulses(component);  // for what contact changed
  }
  for (Index i = v.begin; i < v.end; ++i) dv_impulses_[i] = reaction_[i] + dv_contact_[i];
  sweep(component, state, companion, step);
  return_to_joints(component, state, step);
}

/// Brings the rows of joints, and of their reactions, to the iterate.
void TimeStepper::place_joints(Index component, const State& state, double step) {
  JointWork& work = joints_[component];
  place_middle(component, state, step);
  evaluate_positions(*assembly_, component, midpoint_.view(), middle_evaluation_);
  evaluate_positions(*assembly_, component, trial_.view(), evaluation_);
  const JointView at_end = view_of(trial_, evaluation_);
  place_rows(work.end, at_end, state, step);
  const bool halfway = work.reactions != Reactions::at_end;
  place_rows(work.mean, halfway ? view_of(midpoint_, middle_evaluation_) : at_end, state, step);
}

/// One step of Newton's method for G1 v_{j+1} + rate = 0. With G1 on both sides, instead of Gm on one, the
/// matrix is symmetric and its range is that of G1, where rows depend on each other too.
void TimeStepper::correct_joint_impulses(Index component) {
  JointWork& work = joints_[component];
  const Range v = assembly_->components()[component].v;
  for (Index i = v.begin; i < v.end; ++i) scratch_[i] = free_[i] + reaction_[i] + dv_contact_[i];
  work.end.residuals(JointLevel::velocity, scratch_.data(), work.left.data());
  solve_joints(work);
  clear(reaction_, v);
  for (std::size_t row = 0; row < work.left.size(); ++row) work.impulse[row] += work.left[row];
  work.mean.add_transposed(work.impulse.data(), reaction_.data());
  work.end.apply_inverse_mass(reaction_.data());
}

/// One step of Newton's method for g(q_{j+1}, t_{j+1}) = 0 from the displacement of the sweep before, with
/// the rows there; several with rows of their own near a singular position, where rows change much from one
/// iterate to the next.
void TimeStepper::return_to_joints(Index component, const State& state, double step) {
  constexpr int most_near_singular = 6;
  JointWork& work = joints_[component];
  const Range v = assembly_->components()[component].v;
  const bool near_singular = work.reactions != Reactions::halfway;
  move(component, displacement_, trial_);
  for (int turn = 0; turn < (near_singular ? most_near_singular : 1); ++turn) {
    evaluate_positions(*assembly_, component, trial_.view(), evaluation_);
    const JointView at = view_of(trial_, evaluation_);
    if (near_singular) {
      place_rows(work.end, at, state, step);
      factor_joints(work);
    } else {
      work.end.update_gaps(at);
    }
    for (std::size_t row = 0; row < work.left.size(); ++row) work.left[row] = work.end.gap(row);
    solve_joints(work);
    clear(scratch_, v);
    (work.reactions == Reactions::crossed ? work.mean : work.end)
        .add_response(work.left.data(), scratch_.data());
    for (Index i = v.begin; i < v.end; ++i) displacement_[i] += scratch_[i];
    move(component, scratch_, trial_);
  }
}

void TimeStepper::place_rows(JointConstraints& joints, const JointView& at, const State& state, double step) {
  try {
    joints.update(at);
  } catch (const SolverError& error) {
    fail_motion(error, state, step);
  }
}

void TimeStepper::move(Index component, const std::vector<double>& displacement, State& state) const {
  assembly_->for_bodies(component, [&](const BodyKind& kind, Range slots, Index q, Index v, Index) {
    kind.advance(slots, state.q.data() + q, displacement.data() + v, state.q.data() + q);
  });
}

/// What the sweep has changed.
SweepChange TimeStepper::joint_change(Index component, double step) const {
  SweepChange change;
  assembly_->for_bodies(component, [&](const BodyKind& kind, Range slots, Index q, Index v, Index) {
    for (Index slot = slots.begin; slot < slots.end; ++slot, q += kind.q_size(), v += kind.v_size()) {
      for (Index i = 0; i < kind.v_size(); ++i) {
        const double weight = step * lengths_[v + i];
        change.take(weight * (trial_.v[v + i] - before_v_[v + i]), weight * trial_.v[v + i]);
      }
      for (Index i = 0; i < kind.q_size(); ++i) {
        // Coordinates without a velocity of their own (unit quaternions) are judged as they are.
        const double weight = i < kind.v_size() ? lengths_[v + i] : 1.0;
        change.take(weight * (trial_.q[q + i] - before_q_[q + i]), trial_.q[q + i]);
      }
    }
  });
  return change;
}

/// A change below the tolerance may leave the constraints above their rounding. Sweeps under the same loads
/// bring the joints there however badly couplings contract. True if there were any.
bool TimeStepper::converge_joints(Index component, const State& state, const Companion& companion,
                                  double step) {
  constexpr double improved = 0.8;
  JointWork& work = joints_[component];
  double left = joint_violation(component);
  if (!work.near_singular && !(left > 1.0)) return false;
  for (int sweeps = 0; sweeps < options_.max_sweeps && left > 1.0; ++sweeps) {
    sweep_joints(component, state, companion, step);
    const double now = joint_violation(component);
    if (!(now < improved * left)) break;
    left = now;
  }
  if (work.near_singular) {
    // There the rounding of positions turns rows too much: velocities once more, where bodies are now.
    place_rows(work.end, view_of(trial_, evaluation_), state, step);
    work.end.residuals(JointLevel::velocity, trial_.v.data(), work.left.data());
    if (!work.crossed.factor(work.end, work.mean)) return true;
    work.crossed.solve(work.left.data());
    for (std::size_t row = 0; row < work.left.size(); ++row) work.impulse[row] += work.left[row];
    work.mean.add_response(work.left.data(), trial_.v.data());
  }
  return true;
}

/// How far positions and velocities are from obeying the joints, in units of what rounding lets them.
double TimeStepper::joint_violation(Index component) {
  // Roundings of the numbers that a row is made of, some room for those of the factors included.
  constexpr double rounding = 1e-13;
  JointWork& work = joints_[component];
  evaluate_positions(*assembly_, component, trial_.view(), evaluation_);
  work.end.update(view_of(trial_, evaluation_));
  const Range q = assembly_->components()[component].q;
  double extent = 0.0, largest = 0.0;
  for (Index i = q.begin; i < q.end; ++i) extent = std::max(extent, std::abs(trial_.q[i]));
  for (std::size_t i = 0; i < work.end.size(); ++i) {
    const JointRow row = work.end.row(i);
    double speed = std::abs(row.rate);
    for (int b = 0; b < row.bodies; ++b) {
      const JointRow::Block& block = row.blocks[static_cast<std::size_t>(b)];
      for (int c = 0; c < block.columns; ++c) {
        speed +=
            std::abs(block.jacobian[static_cast<std::size_t>(c)] * trial_.v[block.v + static_cast<Index>(c)]);
      }
    }
    const double left = std::abs(JointConstraints::residual(JointLevel::velocity, row, trial_.v.data()));
    if (extent > 0.0) largest = std::max(largest, std::abs(row.gap) / (rounding * extent));
    if (speed > 0.0) largest = std::max(largest, left / (rounding * speed));
  }
  return largest;
}

/// The work of reactions and of the way back onto the joints; impulses for the report.
void TimeStepper::book_joints(Index component, const State& state, double step) {
  const Assembly& assembly = *assembly_;
  JointWork& work = joints_[component];
  const Range v = assembly.components()[component].v;
  work.total = work.impulse;
  if (clusters_in_use_ > 0) add_contacts_to_joints(component);
  place_middle(component, state, step);
  work.mean.residuals(JointLevel::change, midpoint_.v.data(), work.left.data());
  // Reactions do no work on the constraints but that of drivers: the rest is an error of the step. Answers
  // along the rows at the start have none.
  for (std::size_t row = 0; row < work.total.size(); ++row) {
    double rate = 0.0;
    if (work.start.depends_on_time()) rate = 0.5 * (work.start.rate(row) + work.end.rate(row));
    flows_[EnergyFlow::external] -= work.total[row] * rate;
    coupling_work_.add((work.struck ? work.impulse : work.total)[row] * (work.left[row] + rate));
  }
  // Work of the conservative loads along the displacement, where that is not below the last digit of the
  // coordinates: at rest it would add up, although nothing moves.
  double taken = 0.0;
  const Range q = assembly.components()[component].q;
  for (Index i = v.begin; i < v.end; ++i) {
    double load = loads_end_[i];
    if (!dissipative_.empty()) load -= dissipative_[i];
    if (!external_.empty()) load -= external_[i];
    // Coordinates and velocities of the plane correspond one to one.
    const double at = trial_.q[q.begin + (i - v.begin)];
    taken += load * (at - (at - displacement_[i]));
  }
  energy_position_projection_ += taken;

  evaluate_positions(assembly, component, midpoint_.view(), middle_evaluation_);
  const JointView halfway = view_of(midpoint_, middle_evaluation_);
  Index row = 0;
  for (Index kind = 0; kind < assembly.joint_kinds().size(); ++kind) {
    const JointKind& joints = *assembly.joint_kinds()[kind];
    const Range range = assembly.joints(component, kind);
    for (Index joint = range.begin; joint < range.end; ++joint, row += joints.rows()) {
      if (joints.rows() == 0) continue;
      const JointReaction impulse = joints.reaction(halfway, joint, work.total.data() + row);
      report_.joint_impulses.push_back({assembly.joint_id(kind, joint), impulse, trial_.time});
    }
  }
}

/// The joint whose constraints the last iterate violates most.
JointId TimeStepper::worst_joint(Index component, double& violation) const {
  const JointWork& work = joints_[component];
  JointId worst;
  violation = 0.0;
  for (std::size_t row = 0; row < work.end.size(); ++row) {
    const double gap = std::abs(work.end.gap(row));
    if (!(gap > violation)) continue;
    violation = gap;
    worst = work.end.joint(row);
  }
  return worst;
}

}  // namespace carom
