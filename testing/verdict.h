#pragma once

/// \file
/// Result of a check. The checks do not depend on GoogleTest; matchers.h makes matchers of them.

#include <string>

namespace carom::energy_test {

/// Whether a condition holds, and an explanation if it does not.
struct Verdict {
  bool holds = false;
  std::string text{};  ///< a table or a message, lines ended
};

}  // namespace carom::energy_test
