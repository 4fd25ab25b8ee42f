#pragma once

/// \file
/// Force of a contact that lasts.

#include <carom/contact/solvers/contact_mode.h>
#include <carom/integrators/run/step_report.h>

#include <array>

namespace carom {

/// A contact that lasts and its force, which acts on `body`, its opposite on what that touches
/// (Simulation::contact_forces()).
struct LastingContact : ContactPlace {
  std::array<double, 3> velocity{};      ///< gamma [m/s]
  std::array<double, 3> force{};         ///< normal first [N]
  double rolling_moment = 0.0;           ///< against the relative spin, on `body` [N m]
  ContactMode mode = ContactMode::open;  ///< sticks, or the sign of its slip
};

}  // namespace carom
