// Problem: which bodies answer an impulse together depends on what touches now.

#include <carom/integrators/event_driven/event_islands.h>

namespace carom {

void EventIslands::find(const GroupModel& model, FunctionRef<bool(std::size_t)> is_near) {
  const Assembly& assembly = *model.assembly;
  listed_.clear();
  joined_.clear();
  for (Index i = 0; i < model.pairs.size(); ++i) {
    const ContactPair& pair = model.pairs[i];
    if (pair.rolling) {
      // It is in the island of its contact, if that is in one.
      if (listed_.empty() || listed_.back() + 1 != i) continue;
      joined_.push_back({joined_.back().first, joined_.back().first});
    } else {
      if (pair.has_outline() && !is_near(i)) continue;
      const Index first = assembly.mechanism(pair.body);
      joined_.push_back({first, pair.other == none ? first : assembly.mechanism(pair.other)});
    }
    listed_.push_back(i);
  }
  islands_ = partition_.arrange(joined_, static_cast<Index>(assembly.layout()->bodies().size()));
  pairs_.clear();
  for (const Index place : partition_.order()) pairs_.push_back(listed_[place]);
}

}  // namespace carom
