#include <carom/core/numerics/bound_iteration.h>

namespace carom {

namespace {

// Bounds and the forces in joints are repeated until they change no more than by this part; answers of
// contact problems are certified to 1e-12.
constexpr double enough = 1e-13;
// Where the changes do not shrink any more this is rounding.
constexpr double nearly_enough = 1e-11;
// Most models settle within ten repetitions.
constexpr int plain_repetitions = 25;

}  // namespace

void BoundIteration::begin() {
  ++repetitions_;
  before_.clear();
  after_.clear();
}

void BoundIteration::add(double before, double after) {
  if (repetitions_ <= plain_repetitions) return;
  before_.push_back(before);
  after_.push_back(after);
}

bool BoundIteration::converged(double change) {
  const bool stalls = change <= nearly_enough && change >= 0.5 * last_change_;
  last_change_ = change;
  return change <= enough || stalls;
}

bool BoundIteration::accelerates() {
  if (before_.empty()) return false;
  if (ones_.empty()) {
    acceleration_.start(before_.size());
    ones_.assign(before_.size(), 1.0);
  }
  acceleration_.next(before_, after_, ones_);
  return true;
}

}  // namespace carom
