#pragma once

/// \file
/// The start of a step. All stages read it, none changes it, whatever is thrown.

#include <carom/core/assembly.h>
#include <carom/core/function_ref.h>
#include <carom/core/state.h>
#include <carom/integrators/run/companion.h>
#include <carom/integrators/time_stepping/step_scope.h>

namespace carom {

/// A step that is part of a longer one: of its time, or of the model.
struct StepPart {
  double share = 1.0;    ///< of the whole step: velocities of the part are as exact as those of the whole
  bool repeats = false;  ///< the last step began at the same state and companion, but had another length
  const StepScope* scope = nullptr;  ///< what it advances; null: all bodies
  /// Asked where the step is to be made again since contacts turn in it: true if that is of no use, so that
  /// the step ends and nothing changes. The way of a first pass differs by third order in its length.
  /// \param end of the pass \param modes of its contacts
  FunctionRef<bool(const State& end, const ContactModes& modes)> stops{};
};

/// One step from t_j to t_{j+1}.
struct StepInput {
  const Assembly& assembly;    ///< the model
  const State& start;          ///< state at t_j
  const Companion& companion;  ///< at t_j; its history of loads is with the trial
  double step;                 ///< h [s]
  double end_time;             ///< t_{j+1} [s]
  double last_step = 0.0;      ///< length of the step before [s]
  StepPart part = {};          ///< of a longer step

  /// The bodies that the step advances.
  [[nodiscard]] ChosenBodies bodies() const { return bodies_of(part.scope); }
};

}  // namespace carom
