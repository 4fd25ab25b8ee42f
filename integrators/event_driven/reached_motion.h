#pragma once

/// \file
/// The end that an advance of clock groups has reached, for somebody who may interrupt it.

#include <carom/contact/solvers/chain_statistics.h>
#include <carom/core/export.h>
#include <carom/core/state.h>
#include <carom/integrators/event_driven/event_balance.h>
#include <carom/integrators/run/companion.h>

#include <chrono>
#include <vector>

namespace carom {

/// Cuts an advance into stretches that each take a moment of the clock on the wall. The motion does not
/// depend on where stretches end.
class CAROM_API Stretches {
public:
  using Clock = std::chrono::steady_clock;

  /// \param first length of the first stretch, > 0 [s]
  explicit Stretches(double first, Clock::time_point now = Clock::now())
      : shortest_(first / shortest_part), length_(first), begun_(now) {}

  /// End of the stretch that begins at a time, `to` at the latest [s].
  [[nodiscard]] double end(double from, double to, Clock::time_point now = Clock::now());

private:
  static constexpr double shortest_part = 1024.0;

  double shortest_, length_;  // of stretches [s]
  Clock::time_point begun_;   // of the stretch at hand
  bool is_first_ = true;
};

/// How far an advance has come: state and sums at the end of a stretch, and the time up to which the motion
/// is decided.
struct ReachedMotion {
  bool is_known = false;
  State state;                                  ///< at its time
  ContactModes modes;                           ///< of closed contacts then
  EventBalance balance;                         ///< sums up to then; without records
  ChainStatistics solved;                       ///< contact problems up to then
  std::vector<GroupBooks> books;                ///< of groups that go each to the end, while it has not come
  std::chrono::steady_clock::time_point taken;  ///< when it was written, on the wall
  double good_until = 0.0;                      ///< up to this time the motion is decided [s]
};

}  // namespace carom
