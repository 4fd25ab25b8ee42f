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

/// Asks a StopFunction between the parts of long work.
class CAROM_API StopRequest {
public:
  /// Never ends.
  StopRequest() = default;
  /// \param function empty: never ends
  explicit StopRequest(StopFunction function) : function_(std::move(function)) {}

  /// True if there is a function to ask.
  [[nodiscard]] bool asks() const { return static_cast<bool>(function_); }
  /// Throws Cancelled if work shall end.
  void check() const {
    if (function_ && function_()) stop();
  }

private:
  [[noreturn]] static void stop();

  StopFunction function_;
};

}  // namespace carom
