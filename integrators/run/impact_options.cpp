#include <carom/integrators/run/impact_options.h>

#include <carom/core/errors.h>

namespace carom {

void check_options(const ImpactOptions& options, const std::string& mode) {
  if (options.order > ImpactOrder::sequential) {
    throw ModelError(mode + ": impact_order is " + std::to_string(static_cast<int>(options.order)) +
                     "; allowed: simultaneous (0) or sequential (1)");
  }
  if (options.sequence_limit < 1) {
    throw ModelError(mode + ": sequence_limit is " + std::to_string(options.sequence_limit) +
                     "; allowed: at least 1");
  }
  if (options.limit_energy_gain && options.refuse_energy_gain) {
    throw ModelError(mode + ": limit_energy_gain is true; allowed where refuse_energy_gain is true: false");
  }
}

}  // namespace carom
