#pragma once

/// \file
/// Bounds of the work on a component, so that no run goes on for ever without getting anywhere.

#include <carom/core/errors.h>
#include <carom/core/export.h>
#include <carom/integrators/run/stop_request.h>

#include <cstdint>
#include <limits>

namespace carom {

/// Finds out whether something happens more often than it may, over windows of so many.
class RateLimit {
public:
  /// \param window > 0
  explicit RateLimit(std::int64_t window) : window_(window) {}

  /// Begins a window at a time [s].
  void start(double time) {
    counted_ = 0;
    since_ = time;
  }
  /// Counts one more. True if with it a window is full that lasted less than its number over `most` [1/s];
  /// that window stays.
  [[nodiscard]] bool exceeds(double most, double time) {
    if (++counted_ < window_) return false;
    if (time - since_ < static_cast<double>(window_) / most) return true;
    start(time);
    return false;
  }
  /// How often it happened in a window that was too short, up to a time [1/s]; infinite if all of it was at
  /// one instant, 0 where no window was too short.
  [[nodiscard]] double excessive_rate(double time) const {
    return counted_ < window_ ? 0.0 : static_cast<double>(window_) / (time - since_);
  }

private:
  std::int64_t window_;
  std::int64_t counted_ = 0;
  double since_ = 0.0;  // start of the window [s]
};

/// Evaluations since a component last got on: within one step of its flow, one event, one look at it.
class CAROM_API EvaluationLimit {
public:
  /// Thrown where there were too many; who knows the component makes a SolverError of it.
  class CAROM_API Reached : public Error {
  public:
    Reached() : Error("too many evaluations") {}
  };

  /// No limit.
  EvaluationLimit() = default;
  /// \param stop asked at every evaluation, may be null; must outlive this
  EvaluationLimit(std::int64_t most, const StopRequest* stop) : most_(most), stop_(stop) {}

  /// The component got on.
  void restart() { made_ = 0; }
  /// Counts one more. Throws Reached, Cancelled.
  void take() {
    if (++made_ > most_) throw Reached();
    if (stop_ != nullptr) stop_->check();
  }

private:
  std::int64_t most_ = std::numeric_limits<std::int64_t>::max();
  std::int64_t made_ = 0;
  const StopRequest* stop_ = nullptr;
};

}  // namespace carom
