// Problem: the earliest of many groups without a search, as long as few are put back.

#include <carom/integrators/event_driven/group_queue.h>

#include <algorithm>

namespace carom {

void GroupQueue::fill(Index count, double time) {
  waiting_.clear();
  for (Index group = count; group-- > 0;) waiting_.push_back({time, group});
}

Index GroupQueue::take() {
  const Index group = waiting_.back().group;
  waiting_.pop_back();
  return group;
}

void GroupQueue::put(Index group, double time) {
  const auto later = [](const Waiting& a, const Waiting& b) {
    return a.time > b.time || (a.time == b.time && a.group > b.group);
  };
  const Waiting entry{time, group};
  waiting_.insert(std::upper_bound(waiting_.begin(), waiting_.end(), entry, later), entry);
}

}  // namespace carom
