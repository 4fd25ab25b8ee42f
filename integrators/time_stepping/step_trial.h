#pragma once

/// \file
/// The end of a step as far as it is known: the iterate of positions and velocities, the guess at the loads
/// that led to it, the loads that it leads to. A step that fails leaves it where it failed, to be asked why.

#include <carom/contact/detection/detector.h>
#include <carom/core/assembly.h>
#include <carom/core/energy_term.h>
#include <carom/core/export.h>
#include <carom/core/force_kind.h>
#include <carom/integrators/time_stepping/step_input.h>

#include <algorithm>
#include <vector>

namespace carom {

/// Loads by cause, arrays over all velocities [N, N m].
struct CAROM_API LoadsAtEnd {
  std::vector<double> total;        ///< sum; where causes are evaluated its conservative part, until finish()
  std::vector<double> dissipative;  ///< empty if no element books dissipative loads
  std::vector<double> external;     ///< empty if no element books external loads

  /// Arrays for elements that book by cause.
  [[nodiscard]] Loads by_cause();
  /// An array for their sum alone.
  [[nodiscard]] Loads in_one() { return {total.data(), total.data(), total.data()}; }
  /// Adds the other causes to the conservative part, over the velocities `v`.
  void finish(Range v);
};

/// Energy and work over a block of bodies [J]: kinetic energy at the end, works of the loads by cause.
struct BlockWorks {
  double kinetic = 0.0, total = 0.0, dissipative = 0.0, external = 0.0;
};

/// Jumps of loads that depend on velocities, at impacts within the step: arrays over all velocities [N, N m],
/// of the island at hand. One at a share t of the step is J, and (F0 + F1 + (1 - 2 t) J)/2 the mean load.
struct LoadJumps {
  bool on = false;                 ///< there are any
  std::vector<double> jump;        ///< sum of J
  std::vector<double> correction;  ///< sum of (1 - 2 t) J
  std::vector<double> start;       ///< F0 with the correction
};

/// Works and energies of the last iterate of a component.
struct CAROM_API TrialAccount {
  std::vector<BlockWorks> works;          ///< by block, or by part of a batch
  std::vector<StoredEnergies> of_fields;  ///< potentials, by part of a batch
  StoredEnergies potentials;              ///< all, by cause
  bool swept = false;                     ///< StepTrial::end is an iterate of the component at hand

  /// Forgets what was, and makes room. \param parts blocks, or parts of a batch
  void start(Index parts);
  /// Adds the energies to `stored`. Returns the sums of the works.
  BlockWorks add_to(StoredEnergies& stored) const {
    BlockWorks sum;
    double& kinetic = stored[StoredEnergy::kinetic];
    for (const BlockWorks& part : works) {
      kinetic += part.kinetic;
      sum.total += part.total;
      sum.dissipative += part.dissipative;
      sum.external += part.external;
    }
    // Last: they are written just before, one by one, and are not at hand at once.
    for (std::size_t i = 0; i < stored_energy_count; ++i) stored.values[i] += potentials.values[i];
    return sum;
  }
};

/// Quantities of which the model of a run needs some: they save what nobody asks for.
struct StepNeeds {
  bool dissipative = false;      ///< an element books dissipative loads
  bool external = false;         ///< an element books external loads
  bool load_rotations = false;   ///< loads depend on rotations of bodies
  bool start_rotations = false;  ///< loads or contacts depend on rotations at the start
  bool midpoint = false;         ///< an element, or a joint, is asked halfway
};
/// Quantities that the model of a run needs. \param mean whether elements give mean loads
[[nodiscard]] CAROM_API StepNeeds step_needs(const Assembly& assembly, const Detector& detector, bool mean);

/// The trial of one step at a time. Keeps its memory.
struct CAROM_API StepTrial {
  StepTrial(const Assembly& assembly, const StepNeeds& model);

  /// Forgets the step before. \param in the next step, of which no loads are guessed
  void begin(const StepInput& in);
  /// Forgets the step before. \param in the next step, of which loads are guessed \param history of the
  /// loads, is taken over
  void begin(const StepInput& in, LoadHistory& history);
  /// Brings all bodies of the end to where they are at the start: those that a step does not advance stay
  /// there.
  void stand_still(const State& start);
  /// Gives the history back after a step that failed: nothing in it is pending any more.
  void give_back(const StepInput& in, LoadHistory& history);

  /// Guesses loads over a block by those of the last steps.
  void guess_loads(const StepInput& in, Index block);
  /// Takes the loads that the guess led to for the next guess.
  void take_loads(Range v);
  /// Brings the midpoint of a component to the iterate: positions, velocities, time.
  void place_midpoint(const StepInput& in, Index component);
  /// The step of a component as elements see it, `f` called with it.
  template <class F>
  auto with_step(const StepInput& in, Index component, F&& f) const {
    const EvaluationContext start{in.assembly, in.start.view(), at_start, component};
    const EvaluationContext there{in.assembly, end.view(), at_end, component};
    const EvaluationContext middle{in.assembly, midpoint.view(), at_midpoint, component};
    return f(StepContext{start, there, middle, in.step});
  }
  /// Room for velocities without contact, once anything touches.
  void expect_impulses() {
    if (!dv_impulses.empty()) return;
    dv_impulses.resize(end.v.size());
    free.resize(end.v.size());
  }

  /// No impulses have changed velocities so far, of any body.
  void forget_impulses() { std::fill(dv_impulses.begin(), dv_impulses.end(), 0.0); }

  StepNeeds needs;                           ///< of the model
  State end;                                 ///< q_{j+1}, v_{j+1}, z_{j+1} of the last sweep
  State midpoint;                            ///< halfway, where elements or joints are asked
  Evaluation at_start, at_midpoint, at_end;  ///< rotations
  std::vector<double> loads_guess;           ///< F_{j+1}, or mean loads, as guessed
  LoadsAtEnd loads_end;                      ///< loads that the guess led to
  std::vector<float> rounding;               ///< part that rounding cuts off v_{j+1}
  std::vector<double> dv_impulses;     ///< changes of velocity by impulses; empty until anything touches
  std::vector<double> free;            ///< velocities without impulses; empty until anything touches
  TrialAccount account;                ///< of the component at hand
  LoadHistory history;                 ///< of the companion, during a step in which loads are guessed
  std::vector<std::uint8_t> recorded;  ///< by block: its part of the last change, where that is pending
  LoadJumps jumps;                     ///< where impacts are located

private:
  void record_change(const StepInput& in, Index block);
};

}  // namespace carom
