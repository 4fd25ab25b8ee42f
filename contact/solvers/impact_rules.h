#pragma once

/// \file
/// Options of impacts, which both modes have (strike.h).

#include <carom/contact/solvers/impact_order.h>
#include <carom/core/export.h>

#include <cstdint>
#include <string>
#include <string_view>

namespace carom {

/// Treatment of an impact that would add energy (possible where e_n and e_t differ).
enum class EnergyGain : std::uint8_t {
  report,  ///< nothing: records and statistics say how much
  limit,   ///< all e of the impact are scaled by the largest factor that does not (ImpactNote says it)
  refuse   ///< it ends the run with a SolverError
};

/// Name of a choice: "report", "limit", "refuse".
[[nodiscard]] CAROM_API std::string_view to_string(EnergyGain gain);

/// How impacts of several contacts are resolved (docs/contact_law.md).
struct ImpactRules {
  ImpactOrder order = ImpactOrder::simultaneous;  ///< contacts of one impact together or one after the other
  /// Of sequential impacts: the most at one instant among bodies that touch, >= 1. Then one simultaneous
  /// problem with e = 0 ends them; its loss is booked as `accumulation`.
  int sequence_limit = 1000;
  EnergyGain energy_gain = EnergyGain::report;  ///< of an impact that would add energy
  /// Refuse, with a SolverError that names them, contacts that jam a body and have no answer by the law of
  /// impact (docs/contact_law.md).
  /// Else their island is solved with e = 0, in that step of time stepping or in that impact of the
  /// event-driven mode, which ImpactNote::restitution_factor says.
  bool refuse_jams = false;
};

/// Throws ModelError naming the option that is not allowed. \param mode name of the mode, for the message
CAROM_API void check_rules(const ImpactRules& rules, const std::string& mode);

}  // namespace carom
