#pragma once

/// \file
/// Everything beside the state that can influence a later step or is accumulated along a run.

#include <carom/contact/contact.h>
#include <carom/contact/contact_solver.h>
#include <carom/core/energy_ledger.h>
#include <carom/integrators/step_report.h>

#include <cstdint>
#include <utility>
#include <vector>

namespace carom {

/// With the state, all that a checkpoint holds.
struct Companion {
  EnergyLedger ledger;       ///< the energy account
  Statistics statistics;     ///< counts since the start
  std::vector<double> rounding;  ///< what rounding cut off the velocities: carried on, so that it does not add up
  double grid_start = 0.0;   ///< times of steps are grid_start + n h, so that rounding does not add up [s]
  std::int64_t grid_steps = 0;  ///< n
  std::vector<std::pair<ContactKey, ContactMode>> modes;  ///< contacts of the last step, by key
  std::vector<std::int64_t> fired;                        ///< how often each periodic event has fired
};

}  // namespace carom
