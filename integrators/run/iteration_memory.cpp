// Problem: spare the sweeps of an iteration that has just failed several times, without giving it up for
// good.

#include <carom/integrators/run/iteration_memory.h>

#include <algorithm>

namespace carom {

const IterationMemory::Entry* IterationMemory::find(Index island) const {
  const auto at = std::lower_bound(entries_.begin(), entries_.end(), island,
                                   [](const Entry& entry, Index wanted) { return entry.island < wanted; });
  return at != entries_.end() && at->island == island ? &*at : nullptr;
}

Iteration IterationMemory::first(Index island) const {
  if (entries_.empty()) return Iteration::fixed_point;
  const Entry* const entry = find(island);
  if (entry == nullptr || entry->steps < patience) return Iteration::fixed_point;
  const bool retry = entry->steps + 1 == patience + retry_interval;
  return retry ? Iteration::fixed_point : entry->solved;
}

void IterationMemory::record(const IterationMemory& before, Index island, Iteration solved) {
  if (solved == Iteration::fixed_point) return;
  const Entry* const last = before.find(island);
  const int steps = last == nullptr ? 1 : last->steps + 1;
  entries_.push_back({island, solved, steps == patience + retry_interval ? patience : steps});
}

bool IterationMemory::append(const Entry& entry) {
  const bool in_order = entries_.empty() || entries_.back().island < entry.island;
  const bool other = entry.solved == Iteration::anderson || entry.solved == Iteration::linearly_implicit;
  if (!in_order || !other || entry.steps < 1 || entry.steps >= patience + retry_interval) return false;
  entries_.push_back(entry);
  return true;
}

}  // namespace carom
