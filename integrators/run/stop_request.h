#pragma once

/// \file
/// A way to end long work from outside.

#include <carom/core/errors.h>
#include <carom/core/export.h>

#include <functional>
#include <utility>

namespace carom {

/// Work that ended because the function of stop_when() said so. What did the work stands at its last good
/// state and can go on from there.
class CAROM_API Cancelled : public Error {
public:
  using Error::Error;
};

/// Says whether work shall end: true to end it. Called often, in the thread that does the work; it may read
/// what other threads write (std::stop_token, std::atomic), and what it throws comes out unchanged.
using StopFunction = std::function<bool()>;

/// Gets a time that a run has reached [s]. What it throws ends the run and comes out unchanged.
using ReachedFunction = std::function<void(double)>;

/// Asks a StopFunction between the parts of long work.
class CAROM_API StopRequest {
public:
  /// Never ends.
  StopRequest() = default;
  /// \param function empty: never ends
  explicit StopRequest(StopFunction function) : function_(std::move(function)) {}

  /// Asks this function from now on (Simulation::stop_when()).
  void stop_when(StopFunction function) { function_ = std::move(function); }
  /// Asks this function too, for somebody who waits (Simulation::interrupt_when()).
  void interrupt_when(StopFunction function, ReachedFunction reached) {
    interrupt_ = std::move(function);
    reached_ = std::move(reached);
  }

  /// True if stop_when() has a function to ask.
  [[nodiscard]] bool asks() const { return static_cast<bool>(function_); }
  /// True if somebody waits, who may interrupt work at any moment.
  [[nodiscard]] bool may_interrupt() const { return static_cast<bool>(interrupt_); }
  /// Throws Cancelled if work shall end.
  void check() const {
    if (function_ && function_()) stop();
    if (interrupt_) check_interrupt();
  }
  /// True if the last work ended because of the function of interrupt_when().
  [[nodiscard]] bool interrupted() const { return interrupted_; }
  /// New work begins.
  void begin() const { interrupted_ = false; }
  /// Tells who waits which time the work has reached [s].
  void tell(double time) const;

private:
  [[noreturn]] static void stop();
  void check_interrupt() const;

  StopFunction function_, interrupt_;
  ReachedFunction reached_;
  mutable bool interrupted_ = false;
};

}  // namespace carom
