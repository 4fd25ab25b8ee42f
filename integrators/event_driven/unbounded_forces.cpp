// Problem: which contact forces end a flow?

#include <carom/integrators/event_driven/unbounded_forces.h>

#include <algorithm>
#include <cmath>

namespace carom {

bool UnboundedForces::find(std::span<const ActiveContact> contacts, double bound) {
  pairs_.clear();
  for (const ActiveContact& contact : contacts) {
    if (std::abs(contact.normal) > bound) pairs_.push_back(contact.pair);
  }
  return !pairs_.empty();
}

bool UnboundedForces::contains(const ContactPair& pair) const {
  return std::find(pairs_.begin(), pairs_.end(), pair) != pairs_.end();
}

}  // namespace carom
