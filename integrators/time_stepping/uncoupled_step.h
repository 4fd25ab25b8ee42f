#pragma once

/// \file
/// Steps of few bodies that nothing couples, under constant loads, over ground at rest: while they fly one
/// sweep and its account are all there is to be done, and where they touch ground each contact is a problem
/// of its own. Small systems are made of such steps, in which all that other steps ask for would take longer
/// than they do; in large ones nobody notices it.

#include <carom/core/body_kind.h>
#include <carom/core/energy_term.h>
#include <carom/core/export.h>
#include <carom/core/force_kind.h>
#include <carom/integrators/run/step_report.h>
#include <carom/integrators/time_stepping/contact_stage.h>
#include <carom/integrators/time_stepping/step_input.h>
#include <carom/integrators/time_stepping/step_model.h>
#include <carom/integrators/time_stepping/step_trial.h>

#include <cstdint>
#include <span>
#include <vector>

namespace carom {

/// Bodies of one kind that follow one another, a component each.
struct LooseBodies {
  Range components;
  Range bodies;
  BodyPlace place = {};
  BodyMasses masses = {};
};

/// Uncoupled bodies that are looked at together: does any touch? If so they go by parts, whose contacts are
/// found, solved and booked at once.
struct LoosePiece {
  LooseBodies all = {};
  std::vector<LooseBodies> parts = {};
};

/// A batch of them, and the potentials of what acts on them. It follows from the model.
struct LooseBatch {
  /// Elements of a kind, and what their energy counts as.
  struct Potential {
    const ForceKind* kind;
    Range elements;
    StoredEnergy form;
  };
  EvaluationContext end;  ///< at which potentials are asked for: the end of a step
  Range v;                ///< velocities
  LooseBodies all = {};
  std::vector<LoosePiece> pieces = {};  ///< of `all`
  std::vector<Potential> potentials = {};
};

/// Works of the loads of a batch over a step, and potentials at its end.
struct LooseAccount {
  BlockWorks works;
  StoredEnergies potentials;
};

/// How far a flight comes with a step: something may touch at its start; its bodies have moved as if
/// nothing touched, which is not all there is to be done; it is made.
enum class Flight : std::uint8_t { not_free, moved, made };

/// A schedule around the stages of a step: whatever follows from model and options is looked up once.
class CAROM_API UncoupledStep {
public:
  /// True if steps of a model and its options may be like that. Impacts are those of the step, and gaps are
  /// not projected: that is for the caller to see.
  [[nodiscard]] static bool fits(const StepModel& model);
  /// All must outlive it, and fit. \param margin gaps that count as closed [m]
  UncoupledStep(const StepModel& model, const ContactStage& contacts, StepTrial& trial, double margin);

  /// Makes the step if nothing has touched in the step before and surely nothing does now; where impacts are
  /// located, nor at its end. Else it changes nothing but the trial, as where the account is not finite.
  [[nodiscard]] Flight fly(const StepInput& in, State& state, Companion& companion, StepReport& report);

  /// The batches, of a step in which some may touch.
  [[nodiscard]] std::span<LooseBatch> batches() { return batches_; }
  /// Velocities and positions of some bodies, whose contacts are solved.
  void move(const StepInput& in, const LooseBodies& bodies) const;
  /// Works and energies of a batch that has moved.
  [[nodiscard]] LooseAccount account(const StepInput& in, LooseBatch& batch) const;
  /// Iteration that reports name.
  [[nodiscard]] Iteration iteration() const { return iteration_; }

private:
  void add_batch(Range components);

  const StepModel* model_;
  const ContactStage* contacts_;
  StepTrial* trial_;
  Iteration iteration_ = Iteration::fixed_point;
  std::vector<CentreRow> rows_;
  std::vector<LooseBatch> batches_;
};

}  // namespace carom
