// Problem: bring the constraints of each island together, in the order in which they came.

#include <carom/contact/island_partition.h>

namespace carom {

/// By counting: constraints are large, so that each is moved once, and there are few islands of many.
void IslandPartition::bring_together(std::span<Constraint> constraints) {
  distinct_.clear();
  for (const Index name : names_) {
    if (name >= next_.size()) next_.resize(name + 1, 0);
    if (next_[name]++ == 0) distinct_.push_back(name);
  }
  std::sort(distinct_.begin(), distinct_.end());
  Index place = 0;
  for (const Index name : distinct_) {
    const Index count = next_[name];
    next_[name] = place;
    place += count;
  }
  moved_.assign(constraints.begin(), constraints.end());
  for (std::size_t i = 0; i < moved_.size(); ++i) constraints[next_[names_[i]]++] = moved_[i];
  place = 0;
  for (const Index name : distinct_) {
    std::fill(names_.begin() + place, names_.begin() + next_[name], name);
    place = std::exchange(next_[name], 0);
  }
}

}  // namespace carom
