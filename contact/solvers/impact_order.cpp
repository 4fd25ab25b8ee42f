#include <carom/contact/solvers/impact_order.h>

namespace carom {

std::string_view to_string(ImpactOrder order) {
  switch (order) {
    case ImpactOrder::simultaneous:
      return "simultaneous";
    case ImpactOrder::sequential:
      return "sequential";
  }
  return "unknown";
}

}  // namespace carom
