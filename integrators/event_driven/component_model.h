#pragma once

/// \file
/// Facts of one component that its motion from event to event does not change.

#include <carom/contact/detection/detector.h>
#include <carom/core/assembly.h>
#include <carom/core/discontinuity.h>
#include <carom/core/dynamics/joint_constraints.h>
#include <carom/core/export.h>
#include <carom/core/state.h>
#include <carom/integrators/event_driven/motion_unknowns.h>
#include <carom/integrators/run/event_driven.h>

#include <vector>

namespace carom {

/// Causes of the loads on a component, and how the loads may be taken.
struct LoadTraits {
  bool books_dissipative = false;  ///< some elements book losses
  bool books_external = false;     ///< some elements book external work
  bool depends_on_time = false;    ///< loads, joints or shapes on ground do
  bool only_fields = true;         ///< nothing but uniform fields acts
};

/// One component as the event-driven mode sees it.
struct CAROM_API ComponentModel {
  /// All but `joints`, which are those of the component, must outlive it.
  ComponentModel(const Assembly& assembly, const Detector& detector, Index component,
                 const EventDriven& options, const JointConstraints& joints);

  const Assembly* assembly;
  const Detector* detector;
  const EventDriven* options;
  Index index;              ///< of the component
  MotionUnknowns unknowns;  ///< of its motion
  LoadTraits loads;         ///< on it
  /// Everything that might touch, and friction in joints, which always does; pairs of one mechanism stand
  /// together.
  std::vector<ContactPair> pairs;
  std::vector<Range> mechanisms;  ///< ranges of pairs of bodies that answer an impulse together
  /// Times at which laws of the component's elements and drivers and of shapes on ground jump, ascending.
  std::vector<Discontinuity> discontinuities;
  std::vector<double> tolerances;  ///< absolute, of each unknown

  /// Ranges of the component's numbers in those of the model.
  [[nodiscard]] const Component& ranges() const { return assembly->components()[index]; }
  /// Kinetic energy of the component [J]. \param velocities of the model
  [[nodiscard]] double kinetic_energy(const double* velocities) const;
  /// Kinetic energy of all bodies that answer an impulse on one of them [J].
  [[nodiscard]] double kinetic_energy_of_mechanism(Index body, const double* velocities) const;
};

}  // namespace carom
