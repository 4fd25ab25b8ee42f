#pragma once

/// \file
/// What a check says. The checks know nothing of GoogleTest; matchers.h makes matchers of them.

#include <string>

namespace carom::energy_test {

/// Whether something holds, and what a reader needs to see where it does not.
struct Verdict {
  bool holds = false;
  std::string text{};  ///< a table or a message, lines ended
};

}  // namespace carom::energy_test
