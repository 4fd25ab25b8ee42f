// Problem: a step of a mechanism in the air at the cost of one sweep.

#include <carom/core/numerics/largest_of.h>
#include <carom/integrators/time_stepping/pair_change.h>
#include <carom/integrators/time_stepping/untouched_joints.h>

#include <algorithm>
#include <cmath>

namespace carom {

UntouchedJoints::UntouchedJoints(JointIterate& iterate, Index first_row)
    : iterate_(&iterate), rows_{first_row, first_row + static_cast<Index>(iterate.impulse.size())} {}

bool UntouchedJoints::start(const StepInput& in, const StepRule& rule, StepTrial& trial) {
  JointIterate& joints = *iterate_;
  const JointHistory& history = in.companion.joints;
  const auto known = static_cast<std::size_t>(history.usable(joints.component, rows_.end, in.step));
  if (known == 0) return false;
  const Range v = joints.v();
  const std::size_t steps = history.velocities.best_steps(v, known, joints.arrays->lengths.data());
  history.impulses.guess(rows_, steps, joints.impulse.data() - rows_.begin);
  history.velocities.guess(v, steps, joints.arrays->dv_joints.data());
  if (rule.is_mean()) {
    joints.clear(joints.arrays->displacement);
  } else {
    history.displacements.guess(v, steps, joints.arrays->displacement.data());
  }
  joints.find_free_velocities(in, rule, trial);
  joints.move_bodies(in, rule, trial);
  if (!rule.is_mean()) joints.displace(joints.arrays->displacement, trial.end);
  sweeps_ = 0;
  return joints.rows.begin_regular(in, rule.is_mean(), trial);
}

void UntouchedJoints::guess_impulses(const StepInput& in) {
  const JointHistory& history = in.companion.joints;
  if (history.usable(iterate_->component, rows_.end, in.step) == 0) return;
  history.impulses.guess(rows_, 1, iterate_->impulse.data() - rows_.begin);
}

void UntouchedJoints::sweep(const StepInput& in, const StepRule& rule, StepTrial& trial) {
  // Factors of the first iterate serve all, as they change by what rows turn between two iterates, unless
  // that does not help.
  constexpr int patience = 4;
  // Rows that turn by no more are left where they are.
  constexpr double not_seen = 0.1 * JointIterate::rounding;
  JointIterate& joints = *iterate_;
  note_velocities(trial);
  if (sweeps_ >= patience) joints.rows.factor();
  if (sweeps_ > 0) joints.find_free_velocities(in, rule, trial);
  joints.correct_impulses(in, trial);
  const double turned = turn_of_rows(in, trial);
  if (sweeps_ > 0 && turned <= not_seen && violation_.gap <= 1.0 && !rule.is_mean()) {
    joints.move_bodies(in, rule, trial);
    joints.displace(joints.arrays->displacement, trial.end);
    joints.rows.turn_bodies(in, trial);
  } else {
    correct_again(in, rule, turned > JointIterate::rounding, trial);
  }
  violation_ = joints.violation(trial.end);
  ++sweeps_;
  trial.account.swept = true;
}

/// Completes a sweep whose rows turn. \param look first looks at them where the correction leads: that alone
/// costs less than another sweep
void UntouchedJoints::correct_again(const StepInput& in, const StepRule& rule, bool look, StepTrial& trial) {
  JointIterate& joints = *iterate_;
  if (look) {
    joints.move_bodies(in, rule, trial);
    return_to_joints(in, trial);
    joints.rows.place_end(in, trial);
    note_velocities(trial);
  }
  joints.correct_impulses(in, trial);
  joints.move_bodies(in, rule, trial);
  return_to_joints(in, trial);
  joints.rows.place(in, trial);
}

/// Velocities with which the rows were brought to where they are.
void UntouchedJoints::note_velocities(const StepTrial& trial) {
  const Range v = iterate_->v();
  std::copy(trial.end.v.begin() + v.begin, trial.end.v.begin() + v.end,
            iterate_->arrays->before_v.begin() + v.begin);
}

/// Angle that the correction turns the rows by, to be compared with the rounding of velocities [rad, or m in
/// place of it: whether it is exact does not matter to the answer].
double UntouchedJoints::turn_of_rows(const StepInput& in, const StepTrial& trial) const {
  const JointArrays& arrays = *iterate_->arrays;
  return 0.5 * in.step * largest_of(iterate_->v(), [&](auto at) {
           return magnitude(at(trial.free.data()) + at(arrays.dv_joints.data()) - at(arrays.before_v.data()));
         });
}

/// One step of Newton's method for g(q_{j+1}, t_{j+1}) = 0, with the rows of the iterate before and the gaps
/// that they predict. The displacement is made anew, so that nothing across the joints goes on from guess to
/// guess.
void UntouchedJoints::return_to_joints(const StepInput& in, StepTrial& trial) {
  JointIterate& joints = *iterate_;
  if (joints.rows.is_mean()) return;
  JointArrays& arrays = *joints.arrays;
  const Range v = joints.v();
  const double half = 0.5 * in.step;
  for (Index i = v.begin; i < v.end; ++i) {
    arrays.scratch[i] = half * (trial.end.v[i] - arrays.before_v[i]) - arrays.displacement[i];
  }
  joints.rows.at_end().residuals(JointLevel::displacement, arrays.scratch.data(), joints.left.data());
  joints.clear(arrays.displacement);
  joints.rows.add_displacement(joints.left, arrays.displacement);
  joints.displace(arrays.displacement, trial.end);
}

SweepChange UntouchedJoints::change(const StepInput& in, const StepTrial& trial) {
  JointIterate& joints = *iterate_;
  const JointArrays& arrays = *joints.arrays;
  const Range v = joints.v();
  const bool obeyed = violation() <= 1.0;
  const double* now = trial.end.v.data();
  const double* then = arrays.before_v.data();
  if (obeyed) {
    joints.clear(joints.arrays->scratch);
    joints.rows.at_midpoint().add_response(joints.impulse.data(), joints.arrays->scratch.data());
    now = arrays.scratch.data();
    then = arrays.dv_joints.data();
  }
  // Positions change by h/2 times this.
  PairChange seen;
  SweepChange change;
  Index i = v.begin;
  for (; i + 1 < v.end; i += 2) {
    const Pair weight = both(in.step) * load_pair(arrays.lengths.data() + i);
    seen.take(weight * (load_pair(now + i) - load_pair(then + i)),
              weight * load_pair(trial.end.v.data() + i));
  }
  seen.add_to(change);
  for (; i < v.end; ++i) {
    const double weight = in.step * arrays.lengths[i];
    change.take(weight * (now[i] - then[i]), weight * trial.end.v[i]);
  }
  if (obeyed && change.change <= JointIterate::rounding * change.size) change.change = 0.0;
  return change;
}

void UntouchedJoints::record(bool struck, JointHistory& history) const {
  const JointIterate& joints = *iterate_;
  int& known = history.known[joints.component];
  if (!joints.rows.is_regular()) {
    known = 0;
    return;
  }
  known = struck ? 1 : std::min(known + 1, JointHistory::most);
  history.impulses.record(rows_, joints.impulse.data() - rows_.begin);
  history.velocities.record(joints.v(), joints.arrays->dv_joints.data());
  history.displacements.record(joints.v(), joints.arrays->displacement.data());
}

}  // namespace carom
