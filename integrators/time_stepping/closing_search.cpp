// Problem: which contact closes first in a step that did not know of it.

#include <carom/integrators/time_stepping/closing_search.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace carom {

namespace {

/// True if two contacts are of the same bodies, or of the same body and shape on ground.
bool have_same_parts(const ConstraintKey& a, const ConstraintKey& b) {
  const auto same = [](const FeatureKey& one, const FeatureKey& other) {
    return one.owner == other.owner && one.serial == other.serial;
  };
  return same(a.a, b.a) && same(a.b, b.b);
}

}  // namespace

/// True unless the contact acted up to the end of the part, or has closed often enough.
bool ClosingSearch::may_close(const Constraint& contact, Modes acted) const {
  const auto is_of = [&](const auto& entry) { return entry.first == contact.key; };
  const auto mode = std::find_if(acted.rbegin(), acted.rend(), is_of);
  if (mode != acted.rend() && mode->second != ContactMode::open) return false;
  const auto known = std::find_if(closed_.begin(), closed_.end(),
                                  [&](const Count& count) { return count.key == contact.key; });
  return known == closed_.end() || (known->fast < most_impacts_ && known->slow < most_impacts_);
}

/// True if a contact was open at the start. One that is not listed then may have been closed as another one
/// of its parts, for the nearest features of two outlines change: if one of these was, its vertex says it.
bool ClosingSearch::was_open(const Constraint& contact, const State& start) {
  const auto is_it = [&](const Constraint& other) { return other.key == contact.key; };
  const auto known = std::find_if(at_start_.begin(), at_start_.end(), is_it);
  if (known != at_start_.end()) return known->gap >= -rounding_;
  const bool is_alone = std::none_of(at_start_.begin(), at_start_.end(), [&](const Constraint& other) {
    return have_same_parts(other.key, contact.key) && other.gap < -rounding_;
  });
  return is_alone || gap_of_vertex(contact, start) >= -rounding_;
}

/// Least gap of the parts of a contact at the start, at least as large as `reach` where none is listed [m].
double ClosingSearch::gap_at_start(const Constraint& contact, double reach) const {
  double gap = std::numeric_limits<double>::infinity();
  for (const Constraint& other : at_start_) {
    if (have_same_parts(other.key, contact.key)) gap = std::min(gap, other.gap);
  }
  return std::isinf(gap) ? reach : gap;
}

/// Gap of the vertex of a contact at the start, to all of the other outline; of contacts without outlines
/// minus infinity [m].
double ClosingSearch::gap_of_vertex(const Constraint& contact, const State& start) {
  std::optional<ContactPair> pair;
  if (contact.type == ConstraintType::contact) pair = pair_of(look_.detector(), contact.key);
  if (!pair) return -std::numeric_limits<double>::infinity();
  Constraint at;
  look_.contact(*pair, start.view(), at);
  return at.gap;
}

ClosingSearch::Closing ClosingSearch::look(const State& start, const State& end, Modes acted) {
  look_.find(end.view(), near_, at_end_);
  const double* const v = end.v.data();
  // A contact with gap g < 0 has closed, even where it recedes again, past the middle of the other body, if
  // it came fast: slow contacts that dip by little are not worth a part.
  std::erase_if(at_end_, [&](const Constraint& contact) {
    const bool closes = contact.normal_velocity(v) < 0.0 || contact.gap < -rounding_;
    return !closes || !may_close(contact, acted);
  });
  Closing first;
  if (at_end_.empty()) return first;
  // As far as contacts may have come since the start.
  double reach = 0.0;
  for (const Constraint& contact : at_end_) {
    constexpr double caution = 2.0;
    const double speed = std::max(contact.speed(0, v), contact.speed(0, start.v.data()));
    reach = std::max(reach, std::abs(contact.gap) + caution * (end.time - start.time) * speed);
  }
  look_.find(start.view(), reach, at_start_);
  for (const Constraint& contact : at_end_) {
    if (!(contact.gap < first.gap) || !was_open(contact, start)) continue;
    const bool recedes = !(contact.normal_velocity(v) < 0.0);
    const double fallen = capture_speed_ * (end.time - start.time);
    if (recedes && !(gap_at_start(contact, reach) - contact.gap > fallen)) continue;
    first = {contact.gap, contact.normal_velocity(v), contact.key};
  }
  near_ = std::max(near_, 2.0 * std::abs(std::min(first.gap, 0.0)));
  return first;
}

void ClosingSearch::count(const Closing& closing) {
  near_ = 0.0;
  const auto is_it = [&](const Count& count) { return count.key == closing.key; };
  auto known = std::find_if(closed_.begin(), closed_.end(), is_it);
  if (known == closed_.end()) known = closed_.insert(closed_.end(), {closing.key});
  ++(closing.rate < -capture_speed_ ? known->fast : known->slow);
}

}  // namespace carom
