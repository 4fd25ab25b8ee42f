#pragma once

/// \file
/// Calls of a simulation from within functions that the simulation itself calls: which work, which are
/// refused.

#include <carom/core/export.h>

#include <cstdint>
#include <string_view>
#include <utility>

namespace carom {

/// Knows whose function a simulation is calling, and refuses calls that would change what is in use then.
class CAROM_API CallGuard {
public:
  /// Whose function is running, the innermost.
  enum class Caller : std::uint8_t {
    nobody,    ///< calls come from outside
    law,       ///< what steps evaluate: laws, elements, the function of stop_when()
    log_sink,  ///< where news of a step is written
    observer,  ///< of observe()
    action,    ///< of every()
    change     ///< the function given to edit()
  };
  /// Requirement of a call.
  enum class Need : std::uint8_t {
    outside,    ///< steps: nobody in between
    no_reader,  ///< changes of state, model or mode: from outside, or by actions
    no_step     ///< the rest: not while a step is being made or told
  };

  /// While it lives, calls are taken to come from this caller.
  class CAROM_API Scope {
  public:
    /// \param guard must outlive this
    Scope(CallGuard& guard, Caller caller) : guard_(&guard), before_(std::exchange(guard.caller_, caller)) {}
    ~Scope() { guard_->caller_ = before_; }
    Scope(const Scope&) = delete;
    Scope& operator=(const Scope&) = delete;

  private:
    CallGuard* guard_;
    Caller before_;
  };

  /// Throws ModelError naming the call and the function that made it, unless it may come from there.
  void demand(std::string_view call, Need need) const {
    if (caller_ != Caller::nobody) demand_within(call, need);  // every call may come from outside
  }

private:
  void demand_within(std::string_view call, Need need) const;

  Caller caller_ = Caller::nobody;
};

}  // namespace carom
