#include <carom/core/surface.h>

namespace carom {

std::string_view to_string(ImpactLaw law) {
  switch (law) {
    case ImpactLaw::newton:
      return "newton";
    case ImpactLaw::poisson:
      return "poisson";
    case ImpactLaw::energetic:
      return "energetic";
  }
  return "unknown";
}

}  // namespace carom
