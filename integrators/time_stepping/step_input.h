#pragma once

/// \file
/// The start of a step. All stages read it, none changes it, whatever is thrown.

#include <carom/core/assembly.h>
#include <carom/core/state.h>
#include <carom/integrators/run/companion.h>

namespace carom {

/// One step from t_j to t_{j+1}.
struct StepInput {
  const Assembly& assembly;    ///< the model
  const State& start;          ///< state at t_j
  const Companion& companion;  ///< at t_j; its history of loads is with the trial
  double step;                 ///< h [s]
  double end_time;             ///< t_{j+1} [s]
  double last_step = 0.0;      ///< length of the step before [s]
  double share = 1.0;          ///< of the step of which this is a part
  bool repeats = false;        ///< the step before began with the same, and has another length
};

}  // namespace carom
