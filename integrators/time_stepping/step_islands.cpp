// Problem: which components constraints join in a step.

#include <carom/integrators/time_stepping/step_islands.h>

#include <algorithm>
#include <numeric>
#include <utility>

namespace carom {

StepIslands::StepIslands(const Assembly& assembly) : assembly_(&assembly) {}

void StepIslands::find(std::span<const Range> batches) {
  if (takes_other(batches) || !apart_) part();
}

/// True if the batches are other ones than those of the last find(), which are forgotten.
bool StepIslands::takes_other(std::span<const Range> batches) {
  const auto is_same = [](Range a, Range b) { return a.begin == b.begin && a.end == b.end; };
  const bool same = std::equal(batches.begin(), batches.end(), batches_.begin(), batches_.end(), is_same);
  if (same && !islands_.empty()) return false;
  batches_.assign(batches.begin(), batches.end());
  alone_.clear();
  for (const Range batch : batches_) {
    for (Index component = batch.begin; component < batch.end; ++component) alone_.push_back(component);
  }
  return true;
}

void StepIslands::take(std::span<Constraint> constraints) {
  if (constraints.empty()) {
    for (StepIsland& island : islands_) island.constraints = {};
    return;
  }
  const auto& components = assembly_->components();
  std::size_t next = 0;
  for (std::size_t i = 0; i < islands_.size(); ++i) {
    const std::size_t first = next;
    if (!apart_) {
      next = constraints_[i].end;
    } else {
      const Index end = components[islands_[i].batches.front().end - 1].bodies.end;
      while (next < constraints.size() && constraints[next].body() < end) ++next;
    }
    islands_[i].constraints = constraints.subspan(first, next - first);
  }
}

/// Every batch is an island.
void StepIslands::part() {
  islands_.clear();
  std::size_t first = 0;
  for (const Range& batch : batches_) {
    islands_.push_back({std::span(alone_).subspan(first, batch.size()), {}, {&batch, 1}});
    first += batch.size();
  }
  apart_ = true;
}

std::span<const Index> StepIslands::find(std::span<const Range> batches,
                                         std::span<const JoinedNodes> joined) {
  // Islands follow from what is joined alone; at rest that stays the same step after step.
  const bool same = !takes_other(batches) && !apart_ &&
                    std::equal(joined.begin(), joined.end(), known_.begin(), known_.end());
  if (same) return partition_.order();
  known_.assign(joined.begin(), joined.end());
  partition_.arrange(joined, static_cast<Index>(assembly_->components().size()));
  order_components();
  add_islands(joined);
  return partition_.order();
}

/// Components island by island, each in their order: by counting.
void StepIslands::order_components() {
  names_.resize(assembly_->components().size());
  next_.assign(names_.size(), 0);
  for (const Index component : alone_) ++next_[names_[component] = partition_.island_of(component)];
  Index place = 0;
  for (Index& next : next_) place += std::exchange(next, place);
  joined_.resize(alone_.size());
  for (const Index component : alone_) joined_[next_[names_[component]]++] = component;
}

/// Some islands have several components. What is left of a batch between them stays together.
void StepIslands::add_islands(std::span<const JoinedNodes> joined) {
  const std::span<const Index> order = partition_.order();
  const auto name = [this](std::size_t i) { return names_[joined_[i]]; };
  const auto is_alone = [&](std::size_t i) {
    return name(i) == joined_[i] && (i + 1 == joined_.size() || name(i + 1) != name(i));
  };
  islands_.clear();
  constraints_.clear();
  apart_ = false;
  ranges_.clear();
  ranges_.reserve(alone_.size());  // they stay where they are
  Index next = 0;
  std::size_t batch = 0;
  for (std::size_t first = 0, last = 0; first < joined_.size(); first = last) {
    while (last < joined_.size() && name(last) == name(first)) ++last;
    while (joined_[first] >= batches_[batch].end) ++batch;
    // Others that stand alone in the batch.
    const bool alone = last == first + 1;
    while (alone && last < joined_.size() && joined_[last] < batches_[batch].end && is_alone(last)) ++last;
    const Index begin = next, behind = last < joined_.size() ? name(last) : none;
    while (next < order.size() && names_[joined[order[next]].first] < behind) ++next;
    const std::span<const Index> components(joined_.data() + first, last - first);
    islands_.push_back({components, {}, add_ranges(components, batch), !alone});
    constraints_.push_back({begin, next});
  }
}

/// Splits components where they do not follow one another, and where a batch ends.
std::span<const Range> StepIslands::add_ranges(std::span<const Index> components, std::size_t batch) {
  const std::size_t first = ranges_.size();
  for (const Index component : components) {
    const bool goes_on =
        ranges_.size() > first && ranges_.back().end == component && component < batches_[batch].end;
    while (component >= batches_[batch].end) ++batch;
    if (!goes_on) ranges_.push_back({component, component});
    ranges_.back().end = component + 1;
  }
  return std::span<const Range>(ranges_).subspan(first);
}

}  // namespace carom
