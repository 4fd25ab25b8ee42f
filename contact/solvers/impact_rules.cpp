#include <carom/contact/solvers/impact_rules.h>

#include <carom/core/errors.h>

namespace carom {

std::string_view to_string(EnergyGain gain) {
  switch (gain) {
    case EnergyGain::report:
      return "report";
    case EnergyGain::limit:
      return "limit";
    case EnergyGain::refuse:
      return "refuse";
  }
  return "unknown";
}

void check_rules(const ImpactRules& rules, const std::string& mode) {
  const std::string part = mode + ": impact_rules.";
  if (rules.order > ImpactOrder::sequential) {
    throw ModelError(part + "order is " + std::to_string(static_cast<int>(rules.order)) +
                     "; allowed: simultaneous (0) or sequential (1)");
  }
  if (rules.sequence_limit < 1) {
    throw ModelError(part + "sequence_limit is " + std::to_string(rules.sequence_limit) +
                     "; allowed: at least 1");
  }
  if (rules.energy_gain > EnergyGain::refuse) {
    throw ModelError(part + "energy_gain is " + std::to_string(static_cast<int>(rules.energy_gain)) +
                     "; allowed: report (0), limit (1) or refuse (2)");
  }
}

}  // namespace carom
