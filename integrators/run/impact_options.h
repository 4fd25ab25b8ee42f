#pragma once

/// \file
/// Checks of the options of impacts, which both modes have.

#include <carom/core/export.h>
#include <carom/integrators/run/event_driven.h>
#include <carom/integrators/run/time_stepping.h>

#include <string>

namespace carom {

/// Options of impacts.
struct ImpactOptions {
  ImpactOrder order = ImpactOrder::simultaneous;
  int sequence_limit = 1;
  bool limit_energy_gain = false;
  bool refuse_energy_gain = false;
};

/// Those of a mode.
template <class Mode>
[[nodiscard]] ImpactOptions impact_options(const Mode& mode) {
  return {mode.impact_order, mode.sequence_limit, mode.limit_energy_gain, mode.refuse_energy_gain};
}

/// Throws ModelError naming the option that is not allowed. \param mode name of the mode, for the message
CAROM_API void check_options(const ImpactOptions& options, const std::string& mode);

}  // namespace carom
