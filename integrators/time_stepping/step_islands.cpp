// Problem: which components constraints join in a step.

#include <carom/integrators/time_stepping/step_islands.h>

#include <algorithm>
#include <numeric>

namespace carom {

StepIslands::StepIslands(const Assembly& assembly)
    : assembly_(&assembly), alone_(assembly.components().size()) {
  std::iota(alone_.begin(), alone_.end(), Index{0});
}

void StepIslands::find(std::span<const Range> batches, std::span<Constraint> constraints) {
  if (std::any_of(constraints.begin(), constraints.end(),
                  [this](const Constraint& constraint) { return joins_components(constraint); })) {
    return join(batches, constraints);
  }
  if (apart_ != batches.data() || islands_.size() != batches.size()) part(batches);
  const auto& components = assembly_->components();
  std::size_t next = 0;
  for (StepIsland& island : islands_) {
    const Index end = components[island.batches.front().end - 1].bodies.end;
    const std::size_t first = next;
    while (next < constraints.size() && constraints[next].body() < end) ++next;
    island.constraints = constraints.subspan(first, next - first);
  }
}

/// Every batch is an island.
void StepIslands::part(std::span<const Range> batches) {
  islands_.clear();
  for (const Range& batch : batches) {
    islands_.push_back({std::span(alone_).subspan(batch.begin, batch.size()), {}, {&batch, 1}});
  }
  apart_ = batches.data();
}

bool StepIslands::joins_components(const Constraint& constraint) const {
  if (constraint.bodies == 1) return false;
  const Component& first = assembly_->components()[assembly_->component_of(constraint.body())];
  for (int b = 1; b < constraint.bodies; ++b) {
    const Index body = constraint.blocks[static_cast<std::size_t>(b)].body;
    if (body < first.bodies.begin || body >= first.bodies.end) return true;
  }
  return false;
}

/// Some islands have several components. What is left of a batch between them stays together.
void StepIslands::join(std::span<const Range> batches, std::span<Constraint> constraints) {
  const auto component_of = [this](Index body) { return assembly_->component_of(body); };
  const auto island = [this](Index component) { return partition_.island_of(component); };
  partition_.arrange(constraints, static_cast<Index>(alone_.size()), component_of);
  const auto is_alone = [&](std::size_t i) {
    const bool last = i + 1 == joined_.size() || island(joined_[i + 1]) != island(joined_[i]);
    return last && island(joined_[i]) == joined_[i];
  };
  joined_ = alone_;
  std::stable_sort(joined_.begin(), joined_.end(), [&](Index a, Index b) { return island(a) < island(b); });
  islands_.clear();
  apart_ = nullptr;
  ranges_.clear();
  ranges_.reserve(alone_.size());  // they stay where they are
  std::size_t next = 0, batch = 0;
  for (std::size_t first = 0, last = 0; first < joined_.size(); first = last) {
    const Index name = island(joined_[first]);
    while (last < joined_.size() && island(joined_[last]) == name) ++last;
    while (joined_[first] >= batches[batch].end) ++batch;
    // Others that stand alone in the batch.
    const bool alone = last == first + 1;
    while (alone && last < joined_.size() && joined_[last] < batches[batch].end && is_alone(last)) ++last;
    const std::size_t begin = next;
    const Index behind = last < joined_.size() ? island(joined_[last]) : none;
    while (next < constraints.size() && island(component_of(constraints[next].body())) < behind) ++next;
    const std::span<const Index> components(joined_.data() + first, last - first);
    islands_.push_back({components, constraints.subspan(begin, next - begin),
                        add_ranges(components, batches.subspan(batch))});
  }
}

/// Splits components where they do not follow one another, and where a batch ends.
std::span<const Range> StepIslands::add_ranges(std::span<const Index> components,
                                               std::span<const Range> batches) {
  const std::size_t first = ranges_.size();
  auto batch = batches.begin();
  for (const Index component : components) {
    const bool goes_on = ranges_.size() > first && ranges_.back().end == component && component < batch->end;
    while (component >= batch->end) ++batch;
    if (!goes_on) ranges_.push_back({component, component});
    ranges_.back().end = component + 1;
  }
  return std::span<const Range>(ranges_).subspan(first);
}

}  // namespace carom
