// Problem: a position that jumps is no motion.

#include <carom/core/errors.h>
#include <carom/integrators/event_driven/law_continuity.h>

#include <algorithm>
#include <utility>

namespace carom {

void LawContinuity::demand(double from, double to, double longest) {
  if (prescribed_.empty() && !detector_->has_moving_ground()) return;
  double last = from;
  for (double part = 1.0; last < to; part += 1.0) {
    const double next = std::min(to, from + part * longest);
    demand_part(last, next);
    last = next;
  }
}

void LawContinuity::demand_part(double from, double to) {
  try {
    if (!prescribed_.empty()) prescribed_.demand_continuous(from, to);
    if (!detector_->has_moving_ground()) return;
    if (after_.time() == from) std::swap(before_, after_);
    detector_->place(from, before_);
    detector_->place(to, after_);
    detector_->demand_continuous(before_, after_);
  } catch (const SolverError& error) {
    SolverFailure failure = error.failure();
    failure.time = from;
    failure.step = to - from;
    throw SolverError("event-driven at t = " + to_text(from) + " s: " + error.what(), std::move(failure));
  }
}

}  // namespace carom
