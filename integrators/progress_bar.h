#pragma once

/// \file
/// A progress bar for long runs.

#include <carom/core/export.h>

#include <chrono>
#include <iosfwd>

namespace carom {

/// Draws "[#####     ]  50 %  12 s left" over itself once a run has lasted a second, a few times a second.
class CAROM_API ProgressBar {
public:
  using Clock = std::chrono::steady_clock;

  /// \param out where to draw
  /// \param from, to simulated times the run spans [s]
  ProgressBar(std::ostream& out, double from, double to, Clock::time_point now = Clock::now());
  /// Wipes the bar.
  ~ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  /// Takes the simulated time reached; draws if it is time to.
  void update(double time, Clock::time_point now = Clock::now());

  /// True if the standard error is a terminal.
  [[nodiscard]] static bool terminal();

private:
  std::ostream& out_;
  double from_, to_;
  Clock::time_point start_, next_;
  bool drawn_ = false;
};

}  // namespace carom
