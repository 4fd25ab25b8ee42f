#pragma once

/// \file
/// Which contacts rebound where impacts are located (TimeStepping::impacts): bounces that loads end again and
/// again come to an end, others are impacts however slow they are.

#include <carom/core/export.h>
#include <carom/integrators/run/time_stepping.h>

namespace carom {

class Assembly;

/// Numbers that say so.
struct CaptureRule {
  double capture_speed;   ///< what closes faster rebounds [m/s]
  double slowest;         ///< what closes more slowly is rounding [m/s]
  double longest_bounce;  ///< a slow contact that would be apart for longer rebounds [s]

  /// The rule of a model.
  [[nodiscard]] CAROM_API static CaptureRule of(const Assembly& assembly, const TimeStepping& options);

  /// True if a contact closes fast.
  [[nodiscard]] bool is_fast(double rate) const { return rate < -capture_speed; }
  /// True if a contact closes slowly, and loads would bring it back late, or not at all: with e = 1 a contact
  /// that is pressed by the acceleration a is apart for 2 |rate|/a.
  /// \param rate of its gap [m/s] \param acceleration its rate without the contact [m/s^2]
  [[nodiscard]] bool is_free(double rate, double acceleration) const {
    if (!(rate < -slowest) || is_fast(rate)) return false;
    return -acceleration * longest_bounce <= 2.0 * -rate;
  }
};

}  // namespace carom
