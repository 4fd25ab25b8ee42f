#include <carom/core/arranged_joints.h>
#include <carom/core/errors.h>
#include <carom/core/numerics/union_find.h>
#include <carom/core/registry.h>

#include <algorithm>
#include <string>

namespace carom {

ArrangedJoints::ArrangedJoints(const System& system, Layout& layout, const std::vector<Component>& components,
                               const std::vector<Index>& component_of_body) {
  const auto& entries = system.joint_kinds().entries();
  const auto kinds = static_cast<Index>(entries.size());
  slots_.assign(components.size() * kinds, {});
  serials_.resize(kinds);
  if (system.joints().empty() && kinds == 0) return;
  const auto bodies = static_cast<Index>(layout.bodies().size());
  UnionFind sets;
  sets.start(bodies);
  is_jointed_.assign(bodies, 0);
  table_->places.assign(system.joint_kinds().next_serial(), {});
  layout.place_joints(table_);
  std::vector<BodyId> ends;
  for (Index k = 0; k < kinds; ++k) {
    const JointKind& kind = *entries[k].kind;
    struct Key {
      Index component, slot;
      auto operator<=>(const Key&) const = default;
    };
    std::vector<Key> keys;
    keys.reserve(kind.size());
    for (Index slot = 0; slot < kind.size(); ++slot) {
      ends.clear();
      kind.ends(slot, ends);
      std::erase(ends, ground);
      if (ends.empty() || ends.size() > std::size_t{JointRow::max_bodies}) {
        throw ModelError(system.name(JointId{entries[k].serials[slot], system.token()}) +
                         ": number of bodies is " + std::to_string(ends.size()) + "; allowed: 1 to " +
                         std::to_string(JointRow::max_bodies));
      }
      keys.push_back({component_of_body[ends[0].serial], slot});
      const Index first = layout.index(ends[0]);
      for (const BodyId end : ends) {
        sets.join(first, layout.index(end));
        is_jointed_[layout.index(end)] = 1;
      }
    }
    std::sort(keys.begin(), keys.end());
    std::vector<Index> order;
    order.reserve(keys.size());
    for (const Key& key : keys) {
      const auto place = static_cast<Index>(order.size());
      Range& range = slots_[key.component * kinds + k];
      if (range.empty()) range.begin = range.end = place;
      ++range.end;
      order.push_back(key.slot);
      const Index serial = entries[k].serials[key.slot];
      serials_[k].push_back(serial);
      table_->places[serial] = {k, place};
    }
    table_->kinds.push_back(kind.arranged(order, layout));
  }
  mechanisms_.resize(bodies);
  for (Index body = 0; body < bodies; ++body) mechanisms_[body] = sets.find(body);
}

}  // namespace carom
