// Problem: most runs have more events than anybody looks at.

#include <carom/integrators/run/recorded_events.h>

#include <algorithm>
#include <utility>

namespace carom {

const std::vector<EventRecord>& RecordedEvents::records() {
  seen_ = true;
  if (packed_.empty()) return records_;
  records_.reserve(packed_.size());
  for (std::size_t i = 0; i < packed_.size(); ++i) records_.push_back(packed_.record(i));
  packed_ = {};
  return records_;
}

std::int64_t RecordedEvents::next_instant() const {
  if (!records_.empty()) return records_.back().instant + 1;
  return packed_.empty() ? 0 : packed_.instant(packed_.size() - 1) + 1;
}

void RecordedEvents::append(PackedEvents& fresh, std::size_t limit) {
  if (fresh.empty()) return;
  const std::int64_t next = next_instant();
  const auto too_many = [limit](std::size_t size) { return limit > 0 && size > limit ? size - limit : 0; };
  if (seen_) {
    for (std::size_t i = 0; i < fresh.size(); ++i) {
      records_.push_back(fresh.record(i));
      records_.back().instant += next;
    }
    const auto first = records_.begin();
    records_.erase(first, first + static_cast<std::ptrdiff_t>(too_many(records_.size())));
  } else {
    for (std::size_t i = 0; next != 0 && i < fresh.size(); ++i) fresh.set_instant(i, fresh.instant(i) + next);
    if (packed_.empty()) {
      std::swap(packed_, fresh);
    } else {
      packed_.append(fresh);
    }
    if (const std::size_t count = too_many(packed_.size()); count > 0) packed_.drop_first(count);
  }
  fresh.clear();
}

void RecordedEvents::append(std::vector<EventRecord> of_instant) {
  PackedEvents fresh;
  for (EventRecord& event : of_instant) {
    event.instant = 0;
    fresh.append(event);
  }
  append(fresh, 0);
}

void RecordedEvents::clear() {
  packed_.clear();
  records_.clear();
}

}  // namespace carom
