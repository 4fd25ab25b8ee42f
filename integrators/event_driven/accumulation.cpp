// Problem: where do impacts end whose intervals shrink?

#include <carom/integrators/event_driven/accumulation.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace carom {

void Accumulation::clear() {
  times_.clear();
  of_.clear();
  contacts_.clear();
}

/// Lets go of contacts that no impact has any more.
void Accumulation::forget_contacts() {
  std::array<std::uint8_t, most_contacts> place{};  // 0: of no impact; else one more than the new place
  for (const std::uint8_t of : of_) place[of] = 1;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < contacts_.size(); ++i) {
    if (place[i] == 0) continue;
    contacts_[kept++] = contacts_[i];
    place[i] = static_cast<std::uint8_t>(kept);
  }
  contacts_.resize(kept);
  for (std::uint8_t& of : of_) of = static_cast<std::uint8_t>(place[of] - 1);
}

/// The place of a contact among those of the impacts, where it is put if need be.
std::uint8_t Accumulation::place(const ConstraintKey& contact) {
  const auto known = std::find(contacts_.begin(), contacts_.end(), contact);
  if (known != contacts_.end()) return static_cast<std::uint8_t>(known - contacts_.begin());
  if (contacts_.size() == most_contacts) forget_contacts();
  contacts_.push_back(contact);
  return static_cast<std::uint8_t>(contacts_.size() - 1);
}

void Accumulation::insert(std::size_t before, double time, const ConstraintKey& contact) {
  const auto at = static_cast<std::ptrdiff_t>(before);
  of_.insert(of_.begin() + at, place(contact));
  times_.insert(times_.begin() + at, time);
}

void Accumulation::forget_first(std::size_t count) {
  const auto end = static_cast<std::ptrdiff_t>(count);
  times_.erase(times_.begin(), times_.begin() + end);
  of_.erase(of_.begin(), of_.begin() + end);
}

void Accumulation::remember(double time, const ConstraintKey& contact) {
  if (!times_.empty() && times_.back() == time && this->contact(times_.size() - 1) == contact) return;
  if (times_.size() == remembered) forget_first(1);
  insert(times_.size(), time, contact);
}

void Accumulation::take(const Accumulation& other) {
  if (times_.empty()) {
    *this = other;
    return;
  }
  // Groups that part remember the same: no impact counts twice. Of one time those that were here come first.
  for (std::size_t i = 0; i < other.times_.size(); ++i) {
    const double time = other.times_[i];
    const auto [first, last] = std::equal_range(times_.begin(), times_.end(), time);
    bool is_known = false;
    for (auto at = first; at != last; ++at) {
      is_known = is_known || contact(static_cast<std::size_t>(at - times_.begin())) == other.contact(i);
    }
    if (!is_known) insert(static_cast<std::size_t>(last - times_.begin()), time, other.contact(i));
  }
  if (times_.size() > remembered) forget_first(times_.size() - remembered);
}

double Accumulation::end(double time, std::span<const Constraint> closing) const {
  const double of_all = end(time);
  if (!std::isnan(of_all)) return of_all;
  Accumulation related;
  for (std::size_t i = 0; i < times_.size(); ++i) {
    const bool closes = std::any_of(closing.begin(), closing.end(), [&](const Constraint& constraint) {
      return constraint.key == contact(i);
    });
    if (closes) related.insert(related.times_.size(), times_[i], contact(i));
  }
  return related.end(time);
}

/// Where the pattern of contacts repeats (by one to four impacts) and its intervals shrink in a constant
/// ratio r, the sum of all that would follow the last interval D is D r/(1 - r).
double Accumulation::end(double time) const {
  constexpr double constant = 1e-3;
  const std::size_t n = times_.size();
  for (std::size_t period = 1; period <= 4 && 3 * period + 1 <= n; ++period) {
    bool repeats = true;
    for (std::size_t i = 1; i <= 2 * period; ++i) {
      repeats = repeats && of_[n - i] == of_[n - i - period];
    }
    if (!repeats) continue;
    const auto at = [&](std::size_t back) { return times_[n - 1 - back * period]; };
    const double last = at(0) - at(1), before = at(1) - at(2), earlier = at(2) - at(3);
    const double ratio = last / before;
    if (!(ratio < 1.0) || !(std::abs(ratio - before / earlier) <= constant)) continue;
    // The present impact ends an interval that began with its like, a pattern ago.
    const double since = time - times_[n - period];
    return time + since * ratio / (1.0 - ratio);
  }
  return std::numeric_limits<double>::quiet_NaN();
}

}  // namespace carom
