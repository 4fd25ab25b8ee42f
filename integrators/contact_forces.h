#pragma once

/// \file
/// Impulses and mean forces of contact on one part, summed over a step.

#include <carom/core/export.h>
#include <carom/core/ids.h>
#include <carom/core/space.h>
#include <carom/integrators/run/step_report.h>

namespace carom {

/// Contact on one part in one step, in the plane. The event-driven mode records impacts only: forces of
/// lasting contact are not among its impulses.
struct PartForce {
  Vec<2> impulse = filled<2>(0.0);         ///< sum of all [N s]
  double angular_impulse = 0.0;            ///< of them about the origin, with rolling resistance [N m s]
  Vec<2> impact_impulse = filled<2>(0.0);  ///< part of the impulse that acted in impacts [N s]
  Vec<2> mean_force = filled<2>(0.0);      ///< impulse of lasting contact over the length of the step [N]
  int contacts = 0;                        ///< records that it is the sum of
};

/// Contact on a body; the opposite acts on what it touches. Zero where nothing touches it. Throws ModelError
/// for a report of a model in space, whose records have no tangents.
[[nodiscard]] CAROM_API PartForce force_on(const StepReport& report, BodyId body);
/// Contact on a shape on ground.
[[nodiscard]] CAROM_API PartForce force_on(const StepReport& report, ObstacleId obstacle);

}  // namespace carom
