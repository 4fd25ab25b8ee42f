#pragma once

/// \file
/// The end of a step without overlaps (TimeStepping::project_gaps): bodies of contacts that took part are
/// moved by the smallest displacement, along their joints.
///
/// An impact is noticed up to a step late, at a depth d and a speed w. Loads that press the contact, by the
/// acceleration a, have made the body faster since it closed: then its speed was w0, w0^2 = w^2 - 2 a d. The
/// projection lifts it by d, against these loads. If it came back at e w, it would bounce with what it was
/// lifted by, for ever with e near 1; it comes back at e w0.

#include <carom/contact/assembly_gaps.h>
#include <carom/contact/separation.h>
#include <carom/core/assembly.h>
#include <carom/core/constraint.h>
#include <carom/core/dynamics/joint_constraints.h>
#include <carom/core/energy_term.h>
#include <carom/core/export.h>
#include <carom/integrators/time_stepping/step_balance.h>
#include <carom/integrators/time_stepping/step_input.h>
#include <carom/integrators/time_stepping/step_islands.h>
#include <carom/integrators/time_stepping/step_model.h>

#include <span>
#include <vector>

namespace carom {

/// Moves the bodies of islands, and books what that changes. Keeps memory only.
class CAROM_API StepProjection {
public:
  /// Both must outlive it.
  StepProjection(const StepModel& model, JointStages& joints) : model_(&model), stages_(&joints) {}

  /// Lets late contacts of islands come back as if they had been noticed when they closed, by what they may
  /// approach beyond their law (Constraint::allowed_approach); in all sweeps of the step alike.
  void lower_rebounds(const StepInput& in, std::span<const StepIsland> islands, StepTrial& trial);
  /// Begins with a step, or with one that is made again: nothing is moved yet.
  void begin() { moved_.clear(); }
  /// Moves those of an island whose end is in the trial, and books that. Returns the components that it has
  /// moved, valid until the next call: loads at the end are to be evaluated again. Throws SolverError naming
  /// a contact that cannot be opened. \param places ground at the end
  std::span<const Index> apply(const StepIsland& island, const StepInput& in, const GroundPlaces& places,
                               SolverChain& chain, StepTrial& trial, StepBalance& balance);
  /// Brings the bodies that were moved in the step back to where they came without that. \param end positions
  /// of the end of the step
  void take_back(State& end) const;

private:
  // Components whose bodies move together.
  struct Part {
    std::span<const Index> components;
    std::span<const Range> ranges;  // of the same, as they follow one another
    std::span<const Constraint> constraints;
    bool joined;  // by contacts of bodies with each other
  };
  // Where, and with which solvers gaps are opened.
  struct Means {
    const GroundPlaces& places;
    SolverChain& chain;
  };
  void project(const Part& part, const StepInput& in, const Means& means, StepTrial& trial,
               StepBalance& balance);
  void change_by_loads(const StepInput& in, Index body, StepTrial& trial);
  [[nodiscard]] StoredEnergies potentials(std::span<const Index> components, StepTrial& trial) const;

  const StepModel* model_;
  JointStages* stages_;
  AssemblyGaps gaps_;
  Separator separator_;
  std::vector<Index> moved_;  // components, in the step at hand,
  std::vector<double> came_;  // and where they came without that, by coordinate
  std::vector<JointConstraints*> joints_;
  std::vector<double> by_loads_;  // changes of velocities within the step, of bodies of late contacts
};

}  // namespace carom
