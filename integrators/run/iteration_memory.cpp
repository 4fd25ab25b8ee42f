// Problem: spare the sweeps of an iteration that has just failed several times, without giving it up for
// good.

#include <carom/integrators/run/iteration_memory.h>

#include <algorithm>

namespace carom {

const IterationMemory::Entry* IterationMemory::find(Index component) const {
  const auto at = std::lower_bound(entries_.begin(), entries_.end(), component,
                                   [](const Entry& entry, Index wanted) { return entry.component < wanted; });
  return at != entries_.end() && at->component == component ? &*at : nullptr;
}

Iteration IterationMemory::first(Index component) const {
  if (entries_.empty()) return Iteration::fixed_point;
  const Entry* const entry = find(component);
  if (entry == nullptr || entry->steps < patience) return Iteration::fixed_point;
  const bool retry = entry->steps + 1 == patience + retry_interval;
  return retry ? Iteration::fixed_point : entry->solved;
}

Iteration IterationMemory::first(std::span<const Index> components) const {
  Iteration strongest = Iteration::fixed_point;
  for (const Index component : components) strongest = std::max(strongest, first(component));
  return strongest;
}

void IterationMemory::record(const IterationMemory& before, Index component, Iteration solved) {
  if (solved == Iteration::fixed_point) return;
  const Entry* const last = before.find(component);
  const int steps = last == nullptr ? 1 : last->steps + 1;
  const auto behind =
      std::upper_bound(entries_.begin(), entries_.end(), component,
                       [](Index wanted, const Entry& entry) { return wanted < entry.component; });
  entries_.insert(behind, {component, solved, steps == patience + retry_interval ? patience : steps});
}

bool IterationMemory::append(const Entry& entry) {
  const bool in_order = entries_.empty() || entries_.back().component < entry.component;
  const bool other = entry.solved == Iteration::anderson || entry.solved == Iteration::linearly_implicit;
  if (!in_order || !other || entry.steps < 1 || entry.steps >= patience + retry_interval) return false;
  entries_.push_back(entry);
  return true;
}

}  // namespace carom
