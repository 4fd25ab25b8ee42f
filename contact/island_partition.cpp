// Problem: bring the constraints of each island together, in the order in which they came.

#include <carom/contact/island_partition.h>

namespace carom {

/// By counting: there are few islands of many constraints. Names are in order afterwards.
void IslandPartition::find_order() {
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
  order_.resize(names_.size());
  for (Index i = 0; i < names_.size(); ++i) order_[next_[names_[i]]++] = i;
  place = 0;
  for (const Index name : distinct_) {
    std::fill(names_.begin() + place, names_.begin() + next_[name], name);
    place = std::exchange(next_[name], 0);
  }
}

/// Constraints are large: each is moved once, along the cycles of the order. Their rows stay.
void IslandPartition::bring_together(std::span<Constraint> constraints) {
  find_order();
  for (Index first = 0; first < order_.size(); ++first) {
    if (order_[first] == first) continue;
    Constraint aside = std::move(constraints[first]);
    Index place = first;
    for (Index from = order_[place]; from != first; place = from, from = order_[place]) {
      constraints[place] = std::move(constraints[from]);
      order_[place] = place;
    }
    constraints[place] = std::move(aside);
    order_[place] = place;
  }
}

std::span<const Range> IslandPartition::list_islands() {
  for (Index i = 0; i < names_.size(); ++i) {
    if (i == 0 || names_[i] != names_[i - 1]) islands_.push_back({i, i});
    islands_.back().end = i + 1;
  }
  return islands_;
}

std::span<const Range> IslandPartition::arrange(std::span<const JoinedNodes> constraints, Index nodes) {
  clear(nodes);
  for (const JoinedNodes& nodes_of : constraints) {
    if (nodes_of.first != nodes_of.second) sets_.join(nodes_of.first, nodes_of.second);
  }
  names_.clear();
  for (const JoinedNodes& nodes_of : constraints) names_.push_back(island_of(nodes_of.first));
  find_order();
  return list_islands();
}

}  // namespace carom
