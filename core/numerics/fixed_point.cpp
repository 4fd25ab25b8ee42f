#include <carom/core/numerics/fixed_point.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace carom {

FixedPointJudge::Verdict FixedPointJudge::judge(double change, double size) {
  return judge(change, size, 1.0);
}

FixedPointJudge::Verdict FixedPointJudge::judge_ahead(double change, double size) {
  constexpr double unseen = 1e-5;
  const double contraction = last_ > 0.0 && sweeps_ > 0 ? std::clamp(change / last_, unseen, 1.0) : unseen;
  return judge(change, size, contraction);
}

FixedPointJudge::Verdict FixedPointJudge::judge(double change, double size, double part) {
  // Below this many roundings of the numbers themselves a change that no longer shrinks is rounding.
  constexpr double rounding_floor = 64.0 * std::numeric_limits<double>::epsilon();
  // A change that has grown this much over the first few will not come back, nor will numbers that have:
  // where they settle is no answer to the step. The very first ones may vanish by chance: a body at rest, a
  // contact that has not answered yet.
  constexpr double divergence = 1e8;
  constexpr int few = 3;

  const double floor = rounding_floor * size;
  const double previous = last_;
  last_ = change;
  ++sweeps_;
  if (!std::isfinite(change)) return Verdict::failed;
  if (sweeps_ <= few) {
    first_ = std::max(first_, change);
    first_size_ = std::max(first_size_, size);
  }
  if (first_size_ > 0.0 && size > divergence * first_size_) return Verdict::failed;
  if (sweeps_ > 1 && change > floor && previous > 0.0) contraction_ = change / previous;
  if (change <= part * tolerance_) return Verdict::converged;
  if (sweeps_ > 1 && change >= previous && change <= floor) return Verdict::converged;
  if (change > size && change > divergence * (first_ + floor)) return Verdict::failed;
  if (sweeps_ >= max_sweeps_) return Verdict::failed;
  return Verdict::go_on;
}

}  // namespace carom
