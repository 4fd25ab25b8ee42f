#pragma once

/// \file
/// Facts of one clock group that its motion from event to event does not change.

#include <carom/contact/detection/body_pair_bound.h>
#include <carom/contact/detection/detector.h>
#include <carom/core/assembly.h>
#include <carom/core/constraint.h>
#include <carom/core/discontinuity.h>
#include <carom/core/export.h>
#include <carom/core/layout.h>
#include <carom/core/state.h>
#include <carom/integrators/event_driven/group_joints.h>
#include <carom/integrators/event_driven/motion_sample.h>
#include <carom/integrators/event_driven/motion_unknowns.h>
#include <carom/integrators/run/event_driven.h>

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace carom {

/// Causes of the loads on a group, and how the loads may be taken.
struct LoadTraits {
  bool books_dissipative = false;  ///< some elements book losses
  bool books_external = false;     ///< some elements book external work
  bool depends_on_time = false;    ///< loads, joints or shapes on ground do
  bool are_constant = true;        ///< nothing acts but fields that are constant in time and space
  bool needs_rotations = false;    ///< loads, joints or places of contact depend on rotations of bodies
};

/// Components that share one time.
struct GroupComponents {
  std::vector<Index> components;        ///< of the assembly, ascending
  std::vector<ContactPair> body_pairs;  ///< pairs of two of their bodies that may touch
};

/// The components of one clock group as the event-driven mode sees them.
struct CAROM_API GroupModel {
  /// All but `group` and `joints`, which are those of the group, must outlive it.
  GroupModel(const Assembly& assembly, const Detector& detector, const GroupComponents& group,
             const EventDriven& options, const GroupJoints& joints);

  const Assembly* assembly;
  const Detector* detector;
  const EventDriven* options;
  MotionUnknowns unknowns;  ///< of its motion; has the components
  LoadTraits loads;         ///< on them
  /// Everything that might touch, and friction in joints, which always does. First what touches the ground
  /// and what belongs to joints, that of one mechanism together; then pairs of two bodies. Behind each
  /// contact that resists rolling its resistance.
  std::vector<ContactPair> pairs;
  std::vector<BodyPairBound> bounds;  ///< of the pairs with an outline, in their order
  /// Times at which laws of the group's elements and drivers and of shapes on ground jump, ascending.
  std::vector<Discontinuity> discontinuities;
  std::shared_ptr<const std::vector<double>> tolerances;  ///< absolute, of each unknown

  /// The components, with their places.
  [[nodiscard]] const std::vector<MotionUnknowns::Part>& parts() const { return unknowns.parts(); }
  /// Place of a pair in `bounds`; `none`: a point and a flat boundary.
  [[nodiscard]] Index bound_of(std::size_t pair) const {
    return bound_places_.empty() ? none : bound_places_[pair];
  }
  /// The first body.
  [[nodiscard]] BodyId first_body() const {
    return assembly->layout()->id(parts().front().ranges.bodies.begin);
  }
  /// Calls f(kind, slots, q offset, v offset, part) for consecutive bodies of one kind.
  template <class F>
  void for_bodies(F&& f) const {
    for (const MotionUnknowns::Part& part : parts()) {
      assembly->for_bodies(part.component, [&](const BodyKind& kind, Range slots, Index q, Index v, Index) {
        f(kind, slots, q, v, part);
      });
    }
  }
  /// Kinetic energy of the group [J]. \param velocities of the model
  [[nodiscard]] double kinetic_energy(const double* velocities) const;
  /// The first element without a direction in a sample (find_without_direction()). \param speed [m/s]
  [[nodiscard]] ElementId find_without_direction(const MotionSample& at, double speed) const;
  /// Tells, for messages, what drives the joints of the group (driven_by()).
  [[nodiscard]] std::string driven() const;

private:
  std::vector<Index> bound_places_;  // by pair; empty without bounds
};

}  // namespace carom
