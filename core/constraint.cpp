#include <carom/core/constraint.h>

namespace carom {

std::string_view to_string(ContactMode mode) {
  switch (mode) {
    case ContactMode::open:
      return "open";
    case ContactMode::stick:
      return "stick";
    case ContactMode::slip_positive:
      return "slip+";
    case ContactMode::slip_negative:
      return "slip-";
    case ContactMode::slip:
      return "slip";
  }
  return "unknown mode";
}

}  // namespace carom
