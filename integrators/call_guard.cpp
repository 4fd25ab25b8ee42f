#include <carom/core/errors.h>
#include <carom/integrators/call_guard.h>

#include <array>
#include <cstddef>
#include <string>

namespace carom {

namespace {

[[noreturn]] void refuse(std::string_view call, std::size_t caller, std::size_t need) {
  constexpr std::array<std::string_view, 6> callers{"",
                                                    "a law, an element or a stop function within it",
                                                    "the sink of its log",
                                                    "its own observer",
                                                    "its own action (every)",
                                                    "the function given to its edit"};
  constexpr std::array<std::string_view, 3> allowed{"from outside", "from outside or by an action of every()",
                                                    "from outside, by an observer or by an action"};
  throw ModelError("simulation: " + std::string(call) + " was called by " + std::string(callers[caller]) +
                   "; allowed: " + std::string(allowed[need]));
}

}  // namespace

/// A call from within some function.
void CallGuard::demand_within(std::string_view call, Need need) const {
  const bool fits = [&] {
    switch (need) {
      case Need::outside:
        return false;
      case Need::no_reader:
        return caller_ == Caller::action;
      case Need::no_step:
        break;
    }
    return caller_ != Caller::law && caller_ != Caller::log_sink;
  }();
  if (!fits) refuse(call, static_cast<std::size_t>(caller_), static_cast<std::size_t>(need));
}

}  // namespace carom
