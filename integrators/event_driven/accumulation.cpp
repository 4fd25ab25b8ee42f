// Problem: where do impacts end whose intervals shrink?

#include <carom/integrators/event_driven/accumulation.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace carom {

void Accumulation::remember(double time, const ConstraintKey& contact) {
  if (!impacts_.empty() && impacts_.back().time == time && impacts_.back().contact == contact) return;
  if (impacts_.size() == remembered) impacts_.erase(impacts_.begin());
  impacts_.push_back({time, contact});
}

void Accumulation::take(const Accumulation& other) {
  if (impacts_.empty()) {
    impacts_ = other.impacts_;
    return;
  }
  // Groups that part remember the same: no impact counts twice.
  for (const Impact& impact : other.impacts_) {
    if (std::find(impacts_.begin(), impacts_.end(), impact) == impacts_.end()) impacts_.push_back(impact);
  }
  std::stable_sort(impacts_.begin(), impacts_.end(),
                   [](const Impact& a, const Impact& b) { return a.time < b.time; });
  if (impacts_.size() > remembered) {
    impacts_.erase(impacts_.begin(), impacts_.end() - static_cast<std::ptrdiff_t>(remembered));
  }
}

double Accumulation::end(double time, std::span<const Constraint> closing) const {
  const double of_all = end(time);
  if (!std::isnan(of_all)) return of_all;
  Accumulation related;
  for (const Impact& impact : impacts_) {
    const bool closes = std::any_of(closing.begin(), closing.end(), [&](const Constraint& constraint) {
      return constraint.key == impact.contact;
    });
    if (closes) related.impacts_.push_back(impact);
  }
  return related.end(time);
}

/// Where the pattern of contacts repeats (by one to four impacts) and its intervals shrink in a constant
/// ratio r, the sum of all that would follow the last interval D is D r/(1 - r).
double Accumulation::end(double time) const {
  constexpr double constant = 1e-3;
  const std::size_t n = impacts_.size();
  for (std::size_t period = 1; period <= 4 && 3 * period + 1 <= n; ++period) {
    bool repeats = true;
    for (std::size_t i = 1; i <= 2 * period; ++i) {
      repeats = repeats && impacts_[n - i].contact == impacts_[n - i - period].contact;
    }
    if (!repeats) continue;
    const auto at = [&](std::size_t back) { return impacts_[n - 1 - back * period].time; };
    const double last = at(0) - at(1), before = at(1) - at(2), earlier = at(2) - at(3);
    const double ratio = last / before;
    if (!(ratio < 1.0) || !(std::abs(ratio - before / earlier) <= constant)) continue;
    // The present impact ends an interval that began with its like, a pattern ago.
    const double since = time - impacts_[n - period].time;
    return time + since * ratio / (1.0 - ratio);
  }
  return std::numeric_limits<double>::quiet_NaN();
}

}  // namespace carom
