// Problem: a position that jumps is no motion.

#include <carom/core/errors.h>
#include <carom/integrators/event_driven/law_continuity.h>

#include <utility>

namespace carom {

void LawContinuity::demand(double from, double to) {
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
