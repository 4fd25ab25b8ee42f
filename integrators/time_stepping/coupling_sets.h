#pragma once

/// \file
/// Coupling sets: the components that contact connects in a step, or may connect on their ways through it.
/// No load crosses a set, so that each may be advanced by itself.

#include <carom/contact/detection/box.h>
#include <carom/contact/detection/broad_phase.h>
#include <carom/contact/detection/detector.h>
#include <carom/core/assembly.h>
#include <carom/core/export.h>
#include <carom/core/numerics/union_find.h>
#include <carom/integrators/time_stepping/step_islands.h>

#include <span>
#include <vector>

namespace carom {

/// Finds the coupling sets of a step. A set is named by its first component. Keeps memory.
class CAROM_API CouplingSets {
public:
  /// \param assembly,detector must outlive it
  CouplingSets(const Assembly& assembly, const Detector& detector);

  /// Begins with a step: every component is a set of its own.
  void begin();
  /// Joins the components of each island.
  void join(std::span<const StepIsland> islands);
  /// Joins components whose outlines may touch and have boxes that overlap. True if any were of two sets.
  /// \param boxes around all that outlines of bodies sweep in the step, by outline
  [[nodiscard]] bool join(std::span<const Box<2>> boxes);
  /// The set of a component.
  [[nodiscard]] Index set_of(Index component) { return sets_.find(component); }
  /// The set of a body.
  [[nodiscard]] Index set_of_body(Index body) { return set_of(assembly_->component_of(body)); }

private:
  const Assembly* assembly_;
  const Detector* detector_;
  UnionFind sets_;
  BroadPhase<2> broad_;
};

}  // namespace carom
