#pragma once

/// \file
/// The mode of a contact after a step, from which the next one starts.

#include <carom/contact/solvers/contact_mode.h>
#include <carom/core/constraint.h>
#include <carom/integrators/run/step_report.h>

#include <cmath>
#include <cstddef>

namespace carom {

/// Mode of a contact from which the next step starts. Where forces are not unique, which of the contacts that
/// hold a body carry it is up to the solver: one that stays closed without an impulse is held like the
/// others. \param entry what the step did to it \param after velocities of all bodies at the end
[[nodiscard]] inline ContactMode mode_after(const Constraint& at, const ContactRecord& entry,
                                            const double* after) {
  constexpr double noise = 1e-12;                                          // of the velocities along a row
  if (entry.mode != ContactMode::open || at.rows != 2) return entry.mode;  // of a contact in the plane
  const auto vanishes = [&](int row) {
    const double velocity = entry.velocity_after[static_cast<std::size_t>(row)];
    return std::abs(velocity) <= noise * at.speed(row, after);
  };
  if (!vanishes(0)) return entry.mode;
  if (vanishes(1)) return ContactMode::stick;
  return entry.velocity_after[1] > 0.0 ? ContactMode::slip_positive : ContactMode::slip_negative;
}

}  // namespace carom
