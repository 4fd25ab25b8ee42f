#pragma once

/// \file
/// Steps of few bodies that nothing couples, under constant loads, while nothing touches: one sweep and its
/// account are all there is to be done. Small systems are made of such steps, in which all that other steps
/// ask for would take longer than they do; in large ones nobody notices it.

#include <carom/core/body_kind.h>
#include <carom/core/energy_term.h>
#include <carom/core/export.h>
#include <carom/core/force_kind.h>
#include <carom/integrators/run/step_report.h>
#include <carom/integrators/time_stepping/step_input.h>
#include <carom/integrators/time_stepping/step_parts.h>

#include <cstdint>
#include <vector>

namespace carom {

/// A batch in flight: bodies of one kind, and the potentials of what acts on them. It follows from the model.
struct FlyingBodies {
  /// Elements of a kind, and what their energy counts as.
  struct Potential {
    const ForceKind* kind;
    Range elements;
    StoredEnergy form;
  };
  EvaluationContext end;  ///< at which potentials are asked for: the end of a step
  Range v;                ///< velocities
  BodyPlace place = {};
  BodyMasses masses = {};
  std::vector<Potential> potentials = {};
};

/// How far FreeFlight comes with a step: something may touch at its start; its bodies have moved as if
/// nothing touched, which is not all there is to be done; it is made.
enum class Flight : std::uint8_t { refused, moved, made };

/// A schedule around the stages of a step: whatever follows from model and options is looked up once.
class CAROM_API FreeFlight {
public:
  /// True if steps of a model and its options may be like that. Impacts are those of the step, and gaps are
  /// not projected: that is for the caller to see.
  [[nodiscard]] static bool fits(const StepParts& parts);
  /// \param parts must outlive it, and fit
  explicit FreeFlight(StepParts& parts);

  /// Makes the step if nothing has touched in the step before and surely nothing does now; where impacts are
  /// located, nor at its end. Else it changes nothing but the trial, as where the account is not finite.
  [[nodiscard]] Flight step(const StepInput& in, State& state, Companion& companion, StepReport& report);

private:
  void add_batch(Range components);

  StepParts* parts_;
  Iteration iteration_ = Iteration::fixed_point;  // of the report
  std::vector<CentreRow> rows_;
  std::vector<FlyingBodies> batches_;
  EnergyFlows flows_;  // zero but for what a flight loses
};

}  // namespace carom
