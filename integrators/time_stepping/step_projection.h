#pragma once

/// \file
/// The end of a step without overlaps (TimeStepping::project_gaps): bodies of contacts that took part are
/// moved by the smallest displacement, along their joints.

#include <carom/core/assembly.h>
#include <carom/core/constraint.h>
#include <carom/core/dynamics/joint_constraints.h>
#include <carom/core/energy_term.h>
#include <carom/core/export.h>
#include <carom/integrators/time_stepping/gap_projection.h>
#include <carom/integrators/time_stepping/step_balance.h>
#include <carom/integrators/time_stepping/step_input.h>
#include <carom/integrators/time_stepping/step_islands.h>
#include <carom/integrators/time_stepping/step_parts.h>

#include <span>
#include <vector>

namespace carom {

/// Moves the bodies of islands, and books what that changes. Keeps memory only.
class CAROM_API StepProjection {
public:
  /// \param parts must outlive it
  explicit StepProjection(StepParts& parts) : parts_(&parts) {}

  /// Moves those of an island whose end is in the trial. Throws SolverError naming a contact that cannot be
  /// opened.
  void apply(const StepIsland& island, const StepInput& in, StepBalance& balance);

private:
  // Components whose bodies move together.
  struct Part {
    std::span<const Index> components;
    std::span<const Constraint> constraints;
    bool joined;  // by contacts of bodies with each other
  };
  void project(const Part& part, const StepInput& in, StepBalance& balance);
  [[nodiscard]] StoredEnergies potentials(std::span<const Index> components);

  StepParts* parts_;
  GapProjection projection_;
  std::vector<JointConstraints*> joints_;
};

}  // namespace carom
