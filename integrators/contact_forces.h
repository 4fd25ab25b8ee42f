#pragma once

/// \file
/// Impulses and forces of contact on one part, summed over a step, or over the contacts that last.

#include <carom/core/export.h>
#include <carom/core/ids.h>
#include <carom/core/space.h>
#include <carom/integrators/run/lasting_contact.h>
#include <carom/integrators/run/step_report.h>

#include <span>
#include <vector>

namespace carom {

/// Contact on one part in one step, in the plane. The report of an event-driven step has impacts only: forces
/// of contacts that last are those of Simulation::contact_forces().
struct PartForce {
  Vec<2> impulse = filled<2>(0.0);  ///< sum of all impulses [N s]
  double angular_impulse = 0.0;     ///< of all impulses about the origin, with rolling resistance [N m s]
  Vec<2> impact_impulse = filled<2>(0.0);  ///< part of the impulse that acted in impacts [N s]
  /// Impulse of lasting contact over the length of the step; or the sum of forces [N].
  Vec<2> mean_force = filled<2>(0.0);
  double mean_moment = 0.0;  ///< of `mean_force` about the origin, with rolling resistance [N m]
  int contacts = 0;          ///< records that were added up
};

/// Contact on a body; the opposite acts on what it touches. Zero where nothing touches it. Throws ModelError
/// for a report of a model in space: the sums are of the plane.
[[nodiscard]] CAROM_API PartForce force_on(const StepReport& report, BodyId body);
/// Contact on a shape on ground.
[[nodiscard]] CAROM_API PartForce force_on(const StepReport& report, ObstacleId obstacle);

/// Forces of contacts that last (Simulation::contact_forces()) on a body, in both modes; without impulses.
[[nodiscard]] CAROM_API PartForce force_on(std::span<const LastingContact> forces, BodyId body);
/// Forces of contacts that last (Simulation::contact_forces()) on a shape on ground, in both modes; without
/// impulses.
[[nodiscard]] CAROM_API PartForce force_on(std::span<const LastingContact> forces, ObstacleId obstacle);

/// Mean forces of the contacts of a step of time stepping that last, one for each, those of impacts left out.
[[nodiscard]] CAROM_API std::vector<LastingContact> lasting_forces(const StepReport& report);

}  // namespace carom
