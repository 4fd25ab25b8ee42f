// Problem: which components constraints join in a step.

#include <carom/integrators/time_stepping/step_islands.h>

#include <algorithm>
#include <numeric>

namespace carom {

StepIslands::StepIslands(const Assembly& assembly)
    : assembly_(&assembly), alone_(assembly.components().size()) {
  std::iota(alone_.begin(), alone_.end(), Index{0});
}

void StepIslands::find(std::span<Constraint> constraints) {
  islands_.clear();
  if (std::any_of(constraints.begin(), constraints.end(),
                  [this](const Constraint& constraint) { return joins_components(constraint); })) {
    return join(constraints);
  }
  std::size_t next = 0;
  for (const Index& component : alone_) {
    const Index end = assembly_->components()[component].bodies.end;
    const std::size_t first = next;
    while (next < constraints.size() && constraints[next].body() < end) ++next;
    islands_.push_back({{&component, 1}, constraints.subspan(first, next - first)});
  }
}

Index StepIslands::component_of(Index body) const {
  const auto& all = assembly_->components();
  const auto at = std::upper_bound(
      all.begin(), all.end(), body,
      [](Index wanted, const Component& component) { return wanted < component.bodies.end; });
  return static_cast<Index>(at - all.begin());
}

bool StepIslands::joins_components(const Constraint& constraint) const {
  for (int b = 1; b < constraint.bodies; ++b) {
    const Index body = constraint.blocks[static_cast<std::size_t>(b)].body;
    if (component_of(body) != component_of(constraint.body())) return true;
  }
  return false;
}

/// Some islands have several components.
void StepIslands::join(std::span<Constraint> constraints) {
  const auto island = [this](Index component) { return partition_.island_of(component); };
  const auto count = static_cast<Index>(alone_.size());
  partition_.arrange(constraints, count, [this](Index body) { return component_of(body); });
  joined_ = alone_;
  std::stable_sort(joined_.begin(), joined_.end(), [&](Index a, Index b) { return island(a) < island(b); });
  std::size_t next = 0;
  for (std::size_t first = 0, last = 0; first < joined_.size(); first = last) {
    const Index name = island(joined_[first]);
    while (last < joined_.size() && island(joined_[last]) == name) ++last;
    const std::size_t begin = next;
    while (next < constraints.size() && island(component_of(constraints[next].body())) == name) ++next;
    islands_.push_back({{joined_.data() + first, last - first}, constraints.subspan(begin, next - begin)});
  }
}

}  // namespace carom
