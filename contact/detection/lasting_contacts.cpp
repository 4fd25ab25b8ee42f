#include <carom/contact/detection/lasting_contacts.h>

#include <algorithm>

namespace carom {

/// Contacts come in the order of the step before, in which their bodies mostly are in order.
void LastingContacts::put_in_order() {
  if (!std::is_sorted(centres_.begin(), centres_.end())) std::sort(centres_.begin(), centres_.end());
}

bool LastingContacts::any_centre(Range bodies) const {
  const auto first = std::lower_bound(centres_.begin(), centres_.end(), bodies.begin);
  return first != centres_.end() && *first < bodies.end;
}

}  // namespace carom
