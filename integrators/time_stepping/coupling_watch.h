#pragma once

/// \file
/// Which coupling limits the contraction of steps most. Rated once, and again when the iteration has come to
/// contract twice as badly.

#include <carom/core/dynamics/coupling_rating.h>
#include <carom/core/export.h>
#include <carom/integrators/run/step_report.h>
#include <carom/integrators/time_stepping/step_input.h>
#include <carom/integrators/time_stepping/step_trial.h>

#include <span>
#include <vector>

namespace carom {

/// True of Anderson's iteration where couplings of some components are so stiff that iterates wander farther
/// than bodies are apart: it may find another solution of equations that are not linear (a spring turned end
/// for end); and of several components that contact joins, whose answers jump, so that what it makes of the
/// last few leads anywhere. \param trial rotations in it are worked with
[[nodiscard]] CAROM_API bool leads_astray(Iteration iteration, const StepInput& in,
                                          std::span<const Index> components, StepTrial& trial);

/// Ratings of all components.
class CAROM_API CouplingWatch {
public:
  explicit CouplingWatch(const Assembly& assembly)
      : ratings_(assembly.components().size()), contraction_(assembly.components().size(), -1.0) {}

  /// Takes a step of a component, and writes the worst coupling so far into the report.
  /// \param trial rotations in it are worked with
  void rate(const StepInput& in, Index component, double contraction, StepTrial& trial, StepReport& report);

private:
  std::vector<CouplingRating> ratings_;  // by component, of the last time it was rated
  std::vector<double> contraction_;      // seen then, negative if never rated
};

}  // namespace carom
