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

/// True if the contact acted up to the end of the part.
bool ClosingSearch::acts(const Constraint& contact, Modes acted) {
  const auto is_of = [&](const auto& entry) { return entry.first == contact.key; };
  const auto mode = std::find_if(acted.rbegin(), acted.rend(), is_of);
  return mode != acted.rend() && mode->second != ContactMode::open;
}

/// True of a contact that has closed often enough.
bool ClosingSearch::is_given_up(const ConstraintKey& key) const {
  const auto known =
      std::find_if(closed_.begin(), closed_.end(), [&](const Count& count) { return count.key == key; });
  return known != closed_.end() && known->others >= most_impacts_;
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
  if (contact.type == ConstraintType::contact) pair = look_.detector().outlines().pair_of(contact.key);
  if (!pair) return -std::numeric_limits<double>::infinity();
  SingleConstraint at;
  look_.contact(*pair, start.view(), at);
  return at.gap;
}

ClosingSearch::Closing ClosingSearch::look(const State& start, const State& end, Modes acted) {
  look_.find(end.view(), std::max(near_, rounding_), at_end_);
  given_up_ = false;
  left_out_.clear();
  const double* const v = end.v.data();
  // A contact with gap g < 0 has closed, even where it recedes again, past the middle of the other body, if
  // it came fast: slow contacts that dip by little are not worth a part.
  at_end_.remove_if([&](const Constraint& contact) {
    const bool closes = contact.normal_velocity(v) < 0.0 || contact.gap < -rounding_;
    if (!closes || acts(contact, acted)) return true;
    if (!is_given_up(contact.key)) return false;
    if (contact.gap < -rounding_) left_out_.add(contact);
    return true;
  });
  Closing first;
  if (at_end_.empty() && left_out_.empty()) return first;
  // As far as contacts may have come since the start.
  double reach = 0.0;
  for (const ConstraintSet* const list : {&at_end_, &left_out_}) {
    for (const Constraint& contact : *list) {
      constexpr double caution = 2.0;
      const double speed = std::max(contact.speed(0, v), contact.speed(0, start.v.data()));
      reach = std::max(reach, std::abs(contact.gap) + caution * (end.time - start.time) * speed);
    }
  }
  look_.find(start.view(), reach, at_start_);
  for (const Constraint& contact : at_end_) {
    if (!(contact.gap < first.gap) || !was_open(contact, start)) continue;
    const bool recedes = !(contact.normal_velocity(v) < 0.0);
    const double fallen = capture_.capture_speed * (end.time - start.time);
    if (recedes && !(gap_at_start(contact, reach) - contact.gap > fallen)) continue;
    first = {contact.gap, contact.normal_velocity(v), contact.key};
  }
  given_up_ = std::any_of(left_out_.begin(), left_out_.end(),
                          [&](const Constraint& contact) { return was_open(contact, start); });
  near_ = std::max(near_, 2.0 * std::abs(std::min(first.gap, 0.0)));
  return first;
}

void ClosingSearch::note(const State& end, const Closing* hit,
                         FunctionRef<const std::vector<double>&()> accelerations, ClosingNotes& out) {
  out.all_free = false;
  out.free.clear();
  out.cut.clear();
  near_ = 0.0;
  for (const Constraint& contact : at_end_) {
    const double rate = contact.normal_velocity(end.v.data());
    // The one at which the part ends may be deeper than rounding, as times cannot be told apart.
    const bool is_hit = hit != nullptr && contact.key == hit->key;
    if (!is_hit && (std::abs(contact.gap) > rounding_ || !(rate < 0.0))) continue;
    bool rebounds = capture_.is_fast(rate);
    if (!rebounds && rate < -capture_.slowest) {
      rebounds = capture_.is_free(rate, contact.acceleration(0, accelerations().data()));
      if (rebounds) out.free.push_back(contact.key);
    }
    if (hit != nullptr) count(contact, rebounds, out);
  }
}

/// Counts a closing. After TimeStepping::most_impacts it does not rebound any more.
void ClosingSearch::count(const Constraint& contact, bool rebounds, ClosingNotes& out) {
  const auto is_it = [&](const Count& count) { return count.key == contact.key; };
  auto known = std::find_if(closed_.begin(), closed_.end(), is_it);
  if (known == closed_.end()) known = closed_.insert(closed_.end(), {contact.key, contact.blocks});
  if (rebounds && known->rebounds < most_impacts_) {
    ++known->rebounds;
    return;
  }
  ++known->others;
  if (!rebounds) return;
  out.cut.push_back(contact.key);
  allow_more(contact);
}

/// Lets the other contacts of the bodies of one rebound as often again.
void ClosingSearch::allow_more(const Constraint& contact) {
  const auto shares_body = [&](const Count& count) {
    return std::any_of(count.bodies.begin(), count.bodies.end(), [&](const Constraint::Block& block) {
      return block.body != none &&
             std::any_of(contact.blocks.begin(), contact.blocks.end(),
                         [&](const Constraint::Block& own) { return own.body == block.body; });
    });
  };
  for (Count& count : closed_) {
    if (count.key != contact.key && shares_body(count)) count.rebounds = 0;
  }
}

}  // namespace carom
