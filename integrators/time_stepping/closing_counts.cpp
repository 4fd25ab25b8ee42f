// Problem: a contact that closes again and again in one step rebounds so often and not more.

#include <carom/integrators/time_stepping/closing_counts.h>

#include <algorithm>
#include <cmath>

namespace carom {

namespace {

/// True if two contacts are of the same bodies, or of the same body and shape on ground.
bool have_same_parts(const ConstraintKey& a, const ConstraintKey& b) {
  const auto same = [](const FeatureKey& one, const FeatureKey& other) {
    return one.owner == other.owner && one.serial == other.serial;
  };
  return same(a.a, b.a) && same(a.b, b.b);
}

/// True if a contact acted up to the end of a part.
bool acts(const Constraint& contact, ClosingCounts::Modes acted) {
  const auto is_of = [&](const auto& entry) { return entry.first == contact.key; };
  const auto mode = std::find_if(acted.rbegin(), acted.rend(), is_of);
  return mode != acted.rend() && mode->second != ContactMode::open;
}

}  // namespace

bool ClosingCounts::is_given_up(const ConstraintKey& key) const {
  const auto known =
      std::find_if(closed_.begin(), closed_.end(), [&](const Count& count) { return count.key == key; });
  return known != closed_.end() && known->others >= most_impacts_;
}

void ClosingCounts::find(const State& end, Modes acted, const ChosenBodies& bodies) {
  look_.find(end.view(), rounding_, at_end_, nullptr, nullptr, bodies);
  at_end_.remove_if([&](const Constraint& contact) {
    const bool closes = contact.normal_velocity(end.v.data()) < 0.0 || contact.gap < -rounding_;
    return !closes || acts(contact, acted) || is_given_up(contact.key);
  });
}

bool ClosingCounts::lists_parts_of(const ConstraintKey& contact) const {
  return std::any_of(at_end_.begin(), at_end_.end(),
                     [&](const Constraint& other) { return have_same_parts(other.key, contact); });
}

void ClosingCounts::note(const State& end, const ConstraintKey* hit,
                         FunctionRef<const std::vector<double>&()> accelerations, ClosingNotes& out) {
  out.all_free = false;
  out.free.clear();
  out.cut.clear();
  for (const Constraint& contact : at_end_) {
    const double rate = contact.normal_velocity(end.v.data());
    const bool is_hit = hit != nullptr && contact.key == *hit;
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
void ClosingCounts::count(const Constraint& contact, bool rebounds, ClosingNotes& out) {
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
void ClosingCounts::allow_more(const Constraint& contact) {
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
