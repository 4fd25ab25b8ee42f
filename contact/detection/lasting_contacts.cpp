#include <carom/contact/detection/lasting_contacts.h>

#include <algorithm>

namespace carom {

namespace {

// Contacts come in the order of the step before, in which they mostly are in order.
template <class T>
void sort_if_needed(std::vector<T>& items) {
  if (!std::is_sorted(items.begin(), items.end())) std::sort(items.begin(), items.end());
}

}  // namespace

void LastingContacts::put_in_order() {
  sort_if_needed(keys_);
  sort_if_needed(centres_);
}

bool LastingContacts::contains(const ConstraintKey& key) const {
  return std::binary_search(keys_.begin(), keys_.end(), key);
}

bool LastingContacts::any_centre(Range bodies) const {
  const auto first = std::lower_bound(centres_.begin(), centres_.end(), bodies.begin);
  return first != centres_.end() && *first < bodies.end;
}

}  // namespace carom
