#pragma once

/// \file
/// When passes over a step have converged, each of which has the rows of the path that the one before led to.

#include <carom/core/assembly.h>
#include <carom/core/export.h>
#include <carom/integrators/time_stepping/step_trial.h>

#include <limits>
#include <vector>

namespace carom {

/// Follows the velocities at the ends of passes. Keeps memory.
class CAROM_API PassConvergence {
public:
  explicit PassConvergence(const Assembly& assembly) : lengths_(assembly.length_scales()) {}

  /// Begins a step, of whose path nothing is known.
  void begin();
  /// Begins a step whose first pass has the rows of the path that some velocities at its end would lead to.
  void begin_at(const std::vector<double>& velocities);
  /// True if further passes are of no use: they would change velocities by no more than a tolerance, as the
  /// ratio of the last changes tells; or the last pass has changed them by no more than rounding and errors
  /// of the answers, or by no less than the one before. \param trial with the end of a pass \param tolerance
  /// of velocities [m/s] \param residual the largest certificate of the answers
  [[nodiscard]] bool has_converged(const StepTrial& trial, double tolerance, double residual);
  /// Velocities that are rounding, of the last pass [m/s].
  [[nodiscard]] double noise() const { return noise_; }
  /// Passes that were to be followed by another one.
  [[nodiscard]] int passes() const { return passes_; }

private:
  std::vector<double> lengths_;                              // Assembly::length_scales()
  std::vector<double> last_;                                 // velocities at the end of the pass before
  double change_ = std::numeric_limits<double>::infinity();  // of them in the last pass [m/s]
  double contraction_ = 0.0;                                 // the largest ratio of two changes
  double noise_ = 0.0;                                       // [m/s]
  int passes_ = 0;
};

}  // namespace carom
