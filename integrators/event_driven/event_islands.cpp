// Problem: which bodies answer an impulse together depends on what touches now.

#include <carom/integrators/event_driven/event_islands.h>

#include <algorithm>

namespace carom {

void EventIslands::find(const GroupModel& model, FunctionRef<bool(std::size_t)> is_near) {
  const Assembly& assembly = *model.assembly;
  pairs_.clear();
  islands_.clear();
  pairs_.reserve(model.pairs.size());
  sets_.start(static_cast<Index>(assembly.layout()->bodies().size()));
  for (Index i = 0; i < model.pairs.size(); ++i) {
    if (model.pairs[i].rolling) {
      if (!pairs_.empty() && pairs_.back() + 1 == i) pairs_.push_back(i);
      continue;
    }
    if (model.pairs[i].has_outline()) {
      if (!is_near(i)) continue;
    }
    if (model.pairs[i].other != none) {
      sets_.join(assembly.mechanism(model.pairs[i].body), assembly.mechanism(model.pairs[i].other));
    }
    pairs_.push_back(i);
  }
  const auto island_of = [&](Index pair) { return sets_.find(assembly.mechanism(model.pairs[pair].body)); };
  const auto before = [&](Index a, Index b) { return island_of(a) < island_of(b); };
  // Of bodies that touch the ground only they stand so already.
  if (!std::is_sorted(pairs_.begin(), pairs_.end(), before)) {
    std::stable_sort(pairs_.begin(), pairs_.end(), before);
  }
  for (Index i = 0; i < pairs_.size(); ++i) {
    if (i == 0 || before(pairs_[i - 1], pairs_[i])) islands_.push_back({i, i});
    islands_.back().end = i + 1;
  }
}

}  // namespace carom
