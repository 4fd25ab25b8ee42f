// Problem: rows of joints for every place of a step, past singular positions too.

#include <carom/core/numerics/small_turn.h>
#include <carom/integrators/time_stepping/step_joint_rows.h>

#include <algorithm>
#include <cmath>

namespace carom {

namespace {

// Distance from a singular position from which on steps look at where they lead [rad]: more than they turn
// joints by.
constexpr double near_angle = 0.1;

JointView view_of(const State& state, const Evaluation& evaluation) {
  return {state.view(), evaluation.rotation.data()};
}

/// Rotations at a place of the step, by those at its start, from which bodies turn little.
void turn(const StepInput& in, Index component, const State& state, const Evaluation& start,
          Evaluation& out) {
  constexpr int plane = 2;
  if (in.assembly.layout()->dimension() != plane) {
    return evaluate_positions(in.assembly, component, state.view(), out);
  }
  in.assembly.for_bodies(component, [&](const BodyKind& kind, Range slots, Index q, Index, Index rotation) {
    if (!kind.has_orientation()) return;
    const Index size = kind.q_size(), last = size - 1;  // the angle
    for (Index i = 0; i < slots.size(); ++i, q += size, rotation += 2) {
      const double angle = state.q[q + last] - in.start.q[q + last];
      if (std::abs(angle) <= largest_small_turn) {
        store_pair(out.rotation.data() + rotation,
                   small_turn(load_pair(start.rotation.data() + rotation), angle));
      } else {
        kind.rotations({slots.begin + i, slots.begin + i + 1}, state.q.data() + q,
                       out.rotation.data() + rotation);
      }
    }
  });
}

/// The angle of a row from where it follows from others: pivots are as the squares of angles.
double angle(const JointConstraints& joints, std::size_t row) {
  return std::sqrt(std::max(joints.factors().pivot(row), dependent_pivot));
}

}  // namespace

StepJointRows::StepJointRows(const Assembly& assembly, Index component)
    : component_(component), end_(assembly, component), midpoint_(end_) {}

void StepJointRows::start(const StepInput& in, bool mean, StepTrial& trial) {
  reactions_ = Reactions::halfway;
  mean_ = mean;
  evaluate_positions(in.assembly, component_, in.start.view(), trial.at_start);
}

void StepJointRows::place_midpoint(const StepInput& in, StepTrial& trial) const {
  trial.place_midpoint(in, component_);
  if (!mean_) {
    turn(in, component_, trial.midpoint, trial.at_start, trial.at_midpoint);
    return;
  }
  const std::vector<double>&start = trial.at_start.rotation, &end = trial.at_end.rotation;
  const Range bodies = in.assembly.components()[component_].bodies;
  for (Index body = bodies.begin; body < bodies.end; ++body) {
    const Index first = in.assembly.layout()->bodies()[body].rotation;
    if (first == none) continue;
    for (Index i = first; i < first + 2; ++i) trial.at_midpoint.rotation[i] = 0.5 * (start[i] + end[i]);
  }
}

void StepJointRows::turn_bodies(const StepInput& in, StepTrial& trial) const {
  turn(in, component_, trial.end, trial.at_start, trial.at_end);
  place_midpoint(in, trial);
}

void StepJointRows::place_end(const StepInput& in, StepTrial& trial) {
  turn(in, component_, trial.end, trial.at_start, trial.at_end);
  end_.update(view_of(trial.end, trial.at_end));
}

void StepJointRows::place_gaps(const StepInput& in, StepTrial& trial) {
  turn(in, component_, trial.end, trial.at_start, trial.at_end);
  end_.update_gaps(view_of(trial.end, trial.at_end));
}

void StepJointRows::place(const StepInput& in, StepTrial& trial) {
  place_end(in, trial);
  place_midpoint(in, trial);
  const bool halfway = reactions_ != Reactions::at_end;
  midpoint_.update(halfway ? view_of(trial.midpoint, trial.at_midpoint) : view_of(trial.end, trial.at_end));
}

bool StepJointRows::begin_regular(const StepInput& in, bool mean, StepTrial& trial) {
  start(in, mean, trial);
  place(in, trial);
  end_.factor();
  judge_pivots();
  return regular_;
}

/// How near the rows at the end are to following from each other, by their factors.
void StepJointRows::judge_pivots() {
  double nearest = 1.0, nearest_kept = 1.0;
  for (std::size_t row = 0; row < end_.size(); ++row) {
    const double pivot = end_.factors().pivot(row);
    nearest = std::min(nearest, pivot);
    if (pivot >= dependent_pivot) nearest_kept = std::min(nearest_kept, pivot);
  }
  roundoff_growth_ = 1.0 / std::sqrt(nearest_kept);
  // Rods in line have a pivot as small as this, and are far from singular: the last moves all others along.
  const double of_rods_in_line = 1.0 / static_cast<double>(end_.size());
  const double near = std::min(near_angle * near_angle, 0.5 * of_rods_in_line);
  near_singular_ = nearest_kept < near;
  regular_ = nearest > near;
}

/// Where rows depend on each other, those halfway may point across those at the end: with an angle a from
/// there at the end, b halfway, sweeps contract by |1 - b/a|. Reactions along the rows at the end contract,
/// and cost an error of second order once; where those halfway have some hold, the matrix of both does
/// without. The angle at the start is 2 b - a.
void StepJointRows::choose(const StepInput& in, StepTrial& trial, std::vector<double>& work) {
  end_.factor();
  judge_pivots();
  if (regular_) return;
  if (mean_) {
    mean_ = false;
    place(in, trial);
  }
  midpoint_.factor();
  for (std::size_t row = 0; row < end_.size(); ++row) work[row] = angle(midpoint_, row);
  evaluate_positions(in.assembly, component_, in.start.view(), trial.at_start);
  midpoint_.update(view_of(in.start, trial.at_start));
  midpoint_.factor();
  for (std::size_t row = 0; row < end_.size(); ++row) look_ahead(row, work[row], angle(midpoint_, row));
  place(in, trial);
}

/// Rows of the reactions by one row. \param halfway,start its angles there
void StepJointRows::look_ahead(std::size_t row, double halfway, double start) {
  // A contraction that is good enough; halfway rows that have some hold, against those at the end.
  constexpr double good_contraction = 0.7, some_hold = 0.1;
  // Of a pivot, rounding beside the diagonal.
  constexpr double least_pivot = 1e-17;
  const double a = angle(end_, row);
  if (a > near_angle) return;
  halfway /= a;
  start /= a;
  const bool same_side =
      std::abs(start - std::abs(2.0 * halfway - 1.0)) <= std::abs(start - (2.0 * halfway + 1.0));
  const double contraction = std::abs(1.0 - (same_side ? halfway : -halfway));
  if (contraction <= good_contraction) return;
  // Rounding of positions, magnified by 1/a, turns the rows, and with that velocities.
  const double true_angle = std::sqrt(std::max(end_.factors().pivot(row), least_pivot));
  roundoff_growth_ = std::max(roundoff_growth_, contraction / true_angle);
  near_singular_ = true;
  if (reactions_ != Reactions::at_end) {
    reactions_ = halfway >= some_hold ? Reactions::mixed : Reactions::at_end;
  }
}

void StepJointRows::factor() {
  if (reactions_ == Reactions::mixed) {
    if (mixed_.factor(end_, midpoint_)) return;
    reactions_ = Reactions::at_end;
  }
  end_.factor();
}

void StepJointRows::solve(std::vector<double>& r) {
  if (reactions_ == Reactions::mixed) {
    mixed_.solve(r.data());
  } else {
    end_.solve(r.data());
  }
}

void StepJointRows::add_displacement(std::vector<double>& r, std::vector<double>& x) {
  JointFactors& factors = end_.factors();
  if (reactions_ == Reactions::mixed || !factors.is_uneven()) {
    solve(r);
    pushing().add_response(r.data(), x.data());
    return;
  }
  for (double& gap : r) gap = -gap;
  factors.solve_alike(r.data());
  const Range v = end_.velocities();
  along_.assign(x.size(), 0.0);
  end_.add_transposed(r.data(), along_.data());
  for (Index i = v.begin; i < v.end; ++i) x[i] += factors.alike()[i - v.begin] * along_[i];
}

bool StepJointRows::correct_velocities(StepTrial& trial, std::vector<double>& residuals) {
  end_.update(view_of(trial.end, trial.at_end));
  end_.residuals(JointLevel::velocity, trial.end.v.data(), residuals.data());
  if (!mixed_.factor(end_, midpoint_)) return false;
  mixed_.solve(residuals.data());
  midpoint_.add_response(residuals.data(), trial.end.v.data());
  return true;
}

}  // namespace carom
