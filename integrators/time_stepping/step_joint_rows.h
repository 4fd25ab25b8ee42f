#pragma once

/// \file
/// Rows of the joints of one component in a step: Gm halfway (or where the reactions push), G1 at the end;
/// and the factors by which conditions at the end are met. Near a singular position, where rows depend on
/// each other, the rows of the reactions are chosen so that sweeps contract.
///
/// Mean rows are Gm at the mean of the places and of the rotation matrices at both ends, for
/// ForceRule::energy_momentum: where bodies turn by 2 atan(h w/2) these are, up to a factor, discrete
/// derivatives of the constraints of planar joints, g_{j+1} - g_j = h Gm (v_j + v_{j+1})/2 (Gonzalez 1999).

#include <carom/core/assembly.h>
#include <carom/core/dynamics/joint_constraints.h>
#include <carom/core/dynamics/mixed_constraints.h>
#include <carom/core/export.h>
#include <carom/integrators/time_stepping/step_input.h>
#include <carom/integrators/time_stepping/step_trial.h>

#include <vector>

namespace carom {

/// Rows along which the joints of a component push.
enum class Reactions : std::uint8_t {
  halfway,  ///< rows halfway
  at_end,   ///< rows at the end
  mixed     ///< rows halfway, by the matrix of these and the rows at the end
};

/// The rows of a step. Memory of one component.
class CAROM_API StepJointRows {
public:
  StepJointRows(const Assembly& assembly, Index component);

  /// Begins a step: reactions along the rows halfway. \param mean whether these are mean rows
  void start(const StepInput& in, bool mean, StepTrial& trial);
  /// Begins a step at its first iterate where no row is near to following from others: start(), place(), and
  /// the factors of the rows at the end. False where one is.
  [[nodiscard]] bool begin_regular(const StepInput& in, bool mean, StepTrial& trial);
  /// Brings the rows at the end, and of the reactions, to the iterate, with rotations there and halfway.
  /// Throws SolverError where a prescribed motion is not finite, as the others.
  void place(const StepInput& in, StepTrial& trial);
  /// Brings the midpoint of the trial and all rotations to the iterate, and leaves the rows where they are.
  void turn_bodies(const StepInput& in, StepTrial& trial) const;
  /// Brings the midpoint of the trial to the iterate, with the rotations of the rows halfway.
  void place_midpoint(const StepInput& in, StepTrial& trial) const;
  /// Brings the rows at the end alone there, rotations included.
  void place_end(const StepInput& in, StepTrial& trial);
  /// Brings the gaps at the end alone there, rotations included.
  void place_gaps(const StepInput& in, StepTrial& trial);
  /// Chooses the rows of the reactions at the first iterate, where place() has brought them, and factors the
  /// rows at the end. Where a row is near to following from others they are no mean rows. \param work one
  /// number by row
  void choose(const StepInput& in, StepTrial& trial, std::vector<double>& work);
  /// Factors the matrix by which conditions at the end are met.
  void factor();
  /// r becomes multipliers of the reactions.
  void solve(std::vector<double>& r);
  /// Adds to x, over all velocities, a displacement that takes gaps r away: the smallest in the mass norm.
  /// Where masses are uneven it is the smallest of bodies that weigh alike: a light body between heavy ones
  /// would go far across its joints for the small way that they might go along them. r becomes multipliers.
  void add_displacement(std::vector<double>& r, std::vector<double>& x);
  /// Brings velocities onto the joints where bodies are now, by the mixed rows: where rounding of positions
  /// turns rows too much. False if that matrix is singular. \param residuals work, then multipliers
  [[nodiscard]] bool correct_velocities(StepTrial& trial, std::vector<double>& residuals);

  /// Rows of the reactions that answer a displacement at the end.
  [[nodiscard]] JointConstraints& pushing() { return reactions_ == Reactions::mixed ? midpoint_ : end_; }
  [[nodiscard]] JointConstraints& at_midpoint() { return midpoint_; }  ///< Gm
  [[nodiscard]] JointConstraints& at_end() { return end_; }            ///< G1
  [[nodiscard]] const JointConstraints& at_end() const { return end_; }
  /// Rows along which reactions act.
  [[nodiscard]] Reactions reactions() const { return reactions_; }
  /// True if they are mean rows.
  [[nodiscard]] bool is_mean() const { return mean_; }
  /// True if no row at the end of the first iterate was near to following from others.
  [[nodiscard]] bool is_regular() const { return regular_; }
  /// True near a singular position.
  [[nodiscard]] bool is_near_singular() const { return near_singular_; }
  /// Growth of rounding there.
  [[nodiscard]] double roundoff_growth() const { return roundoff_growth_; }

private:
  void judge_pivots();
  void look_ahead(std::size_t row, double halfway, double start);

  Index component_;
  JointConstraints end_, midpoint_;
  MixedConstraints mixed_;
  std::vector<double> along_;  // G^T l where masses are uneven
  Reactions reactions_ = Reactions::halfway;
  double roundoff_growth_ = 1.0;
  bool near_singular_ = false, regular_ = false, mean_ = false;
};

}  // namespace carom
