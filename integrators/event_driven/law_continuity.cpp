// Problem: a position that jumps is no motion.

#include <carom/core/run_error.h>
#include <carom/integrators/event_driven/law_continuity.h>

#include <algorithm>
#include <utility>

namespace carom {

void LawContinuity::demand(double from, double to, double longest) {
  good_until_ = from;
  if (prescribed_.empty() && !detector_->has_moving_ground()) return;
  for (double part = 1.0; good_until_ < to; part += 1.0) {
    const double next = std::min(to, from + part * longest);
    demand_part(good_until_, next);
    good_until_ = next;
  }
}

void LawContinuity::demand_part(double from, double to) {
  try {
    if (!prescribed_.empty()) prescribed_.demand_continuous(from, to);
    if (!detector_->has_moving_ground()) return;
    if (after_.time() == from) std::swap(before_, after_);
    detector_->place(from, before_);
    detector_->place(to, after_);
    detector_->shapes().demand_continuous(before_, after_);
  } catch (const RunError& error) {
    SolverFailure failure = error.failure();
    failure.time = from;
    failure.step = to - from;
    throw RunError("event-driven at t = " + to_text(from) + " s: " + error.what(), std::move(failure));
  }
}

}  // namespace carom
