// Problem: which contact forces end a flow?

#include <carom/integrators/event_driven/unbounded_forces.h>

#include <algorithm>
#include <cmath>

namespace carom {

bool UnboundedForces::find(std::span<const ActiveContact> contacts, double bound) {
  clear();
  for (const ActiveContact& contact : contacts) {
    if (!(std::abs(contact.normal) > bound)) continue;
    if (!found_) found_ = std::make_unique<Found>();
    found_->pairs.push_back(contact.pair);
  }
  return found_ != nullptr;
}

bool UnboundedForces::contains(const ContactPair& pair) const {
  if (!found_) return false;
  const std::vector<ContactPair>& pairs = found_->pairs;
  return std::find(pairs.begin(), pairs.end(), pair) != pairs.end();
}

}  // namespace carom
