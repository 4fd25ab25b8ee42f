// Problem: pass positions where rows of joints depend on each other.

#include <carom/integrators/time_stepping/time_stepper.h>

#include <algorithm>
#include <cmath>

namespace carom {

namespace {

// Distance from a singular position from which on steps look at where they lead [rad]: more than they turn
// joints by.
constexpr double near_angle = 0.1;

}  // namespace

/// Where rows depend on each other, those halfway may point across those at the end: with an angle a from
/// there at the end, b halfway, sweeps contract by |1 - b/a|. Reactions along the rows at the end contract,
/// and cost an error of second order once; where those halfway have some hold, the matrix of both does
/// without. Pivots are as the squares of angles, that at the start is 2 b - a.
void TimeStepper::choose_reactions(Index component, const State& state, double step) {
  // A contraction that is good enough; halfway rows that have some hold, against those at the end.
  constexpr double good_contraction = 0.7, some_hold = 0.1;
  // Of a pivot, rounding beside the diagonal.
  constexpr double least_pivot = 1e-17;
  JointWork& work = joints_[component];
  const auto angle = [](const JointConstraints& joints, std::size_t row) {
    return std::sqrt(std::max(joints.factors().pivot(row), dependent_pivot));
  };
  work.end.factor();
  work.roundoff_growth = 1.0;
  double nearest = 1.0;
  for (std::size_t row = 0; row < work.end.size(); ++row) {
    const double pivot = work.end.factors().pivot(row);
    nearest = std::min(nearest, pivot);
    if (pivot >= dependent_pivot)
      work.roundoff_growth = std::max(work.roundoff_growth, 1.0 / std::sqrt(pivot));
  }
  work.near_singular = work.roundoff_growth > 1.0 / near_angle;
  if (nearest > near_angle * near_angle) return;
  work.mean.factor();
  for (std::size_t row = 0; row < work.end.size(); ++row) work.left[row] = angle(work.mean, row);
  evaluate_positions(*assembly_, component, state.view(), start_);
  place_rows(work.mean, {state.view(), start_.rotation.data()}, state, step);
  work.mean.factor();
  for (std::size_t row = 0; row < work.end.size(); ++row) {
    const double a = angle(work.end, row);
    if (a > near_angle) continue;
    const double halfway = work.left[row] / a, start = angle(work.mean, row) / a;
    const bool same_side =
        std::abs(start - std::abs(2.0 * halfway - 1.0)) <= std::abs(start - (2.0 * halfway + 1.0));
    const double contraction = std::abs(1.0 - (same_side ? halfway : -halfway));
    if (contraction <= good_contraction) continue;
    // Rounding of positions, magnified by 1/a, turns the rows, and with that velocities.
    const double true_angle = std::sqrt(std::max(work.end.factors().pivot(row), least_pivot));
    work.roundoff_growth = std::max(work.roundoff_growth, contraction / true_angle);
    work.near_singular = true;
    if (work.reactions != Reactions::at_end) {
      work.reactions = halfway >= some_hold ? Reactions::crossed : Reactions::at_end;
    }
  }
  place_joints(component, state, step);
}

/// Factors of the matrix by which conditions at the end are met, in work.end or work.crossed.
void TimeStepper::factor_joints(JointWork& work) {
  if (work.reactions == Reactions::crossed) {
    if (work.crossed.factor(work.end, work.mean)) return;
    work.reactions = Reactions::at_end;
  }
  work.end.factor();
}

/// r becomes multipliers of the reactions, r = work.left.
void TimeStepper::solve_joints(JointWork& work) {
  if (work.reactions == Reactions::crossed) {
    work.crossed.solve(work.left.data());
  } else {
    work.end.solve(work.left.data());
  }
}

}  // namespace carom
