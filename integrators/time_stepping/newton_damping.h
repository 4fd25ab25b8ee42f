#pragma once

/// \file
/// Shorter steps of Newton's method where whole ones lead away: a step whose next correction is many times
/// as long is taken back, and half of it is made. Corrections are measured in velocities, so that the test
/// does not depend on how stiff couplings are (P. Deuflhard, Newton Methods for Nonlinear Problems, Springer
/// 2004, section 3.3). His test, that each correction is shorter than the one before, would take back good
/// steps: contacts that change between modes lengthen a correction once.

#include <carom/contact/island_problem.h>
#include <carom/core/assembly.h>
#include <carom/core/export.h>
#include <carom/integrators/time_stepping/step_input.h>
#include <carom/integrators/time_stepping/step_rule.h>
#include <carom/integrators/time_stepping/step_trial.h>

#include <span>
#include <vector>

namespace carom {

/// The last step over one island. Keeps memory only.
class CAROM_API NewtonDamping {
public:
  /// An iteration begins.
  void start() { known_ = false; }
  /// Keeps the impulses of the iterate, before the problem is solved for the next. \param contact null: none
  void keep_impulses(const IslandProblem* contact);
  /// Takes a whole step from the iterate, or shortens the last one, where this correction says that it led
  /// away; then the trial is brought back to where that began. Writes the guess at the loads, the impulses,
  /// and the correction that is made.
  /// \param components of the island \param size of the correction
  /// \param guess the next guess of a whole step, over all velocities
  /// \param correction of velocities, over all velocities
  void apply(const Assembly& assembly, std::span<const Index> components, const SweepChange& size,
             const std::vector<double>& guess, std::vector<double>& correction, IslandProblem* contact,
             StepTrial& trial);

private:
  [[nodiscard]] bool leads_away(const SweepChange& size) const;

  // The iterate from which the last step was made, and the end of a whole step; over all velocities or
  // coordinates, impulses by row.
  struct Step {
    std::vector<double> q, v, guess, next_guess, correction, impulses, next_impulses;
  };
  Step last_;
  std::vector<double> impulses_;  // of the iterate
  double size_ = 0.0;             // of the last correction [m]
  double share_ = 1.0;            // of the last step that was made
  bool known_ = false;            // there is a last step
};

}  // namespace carom
