// Problem: bring the constraints of each island together, in the order in which they came.

#include <carom/contact/island_partition.h>

#include <numeric>

namespace carom {

void IslandPartition::bring_together(std::span<Constraint> constraints) {
  order_.resize(constraints.size());
  std::iota(order_.begin(), order_.end(), Index{0});
  std::sort(order_.begin(), order_.end(), [this](Index a, Index b) {
    return names_[a] != names_[b] ? names_[a] < names_[b] : a < b;
  });
  moved_.assign(constraints.begin(), constraints.end());
  for (std::size_t i = 0; i < order_.size(); ++i) {
    if (order_[i] != i) constraints[i] = moved_[order_[i]];
  }
  std::sort(names_.begin(), names_.end());
}

}  // namespace carom
