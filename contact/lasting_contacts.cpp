#include <carom/contact/lasting_contacts.h>

#include <algorithm>

namespace carom {

namespace {

// Contacts come in the order of the step before, in which they mostly are in order.
template <class T>
void put_in_order(std::vector<T>& items) {
  if (!std::is_sorted(items.begin(), items.end())) std::sort(items.begin(), items.end());
}

}  // namespace

void LastingContacts::start(double step) {
  step_ = step;
  keys_.clear();
  centres_.clear();
}

void LastingContacts::add(const ContactKey& key, Index centre) {
  keys_.push_back(key);
  if (centre != none) centres_.push_back(centre);
}

void LastingContacts::finish() {
  put_in_order(keys_);
  put_in_order(centres_);
}

bool LastingContacts::contains(const ContactKey& key) const {
  return std::binary_search(keys_.begin(), keys_.end(), key);
}

bool LastingContacts::any_centre(Range bodies) const {
  const auto first = std::lower_bound(centres_.begin(), centres_.end(), bodies.begin);
  return first != centres_.end() && *first < bodies.end;
}

}  // namespace carom
