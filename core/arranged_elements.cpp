#include <carom/core/arranged_elements.h>
#include <carom/core/registry.h>

#include <algorithm>

namespace carom {

ArrangedElements::ArrangedElements(const System& system, const Layout& layout,
                                   const std::vector<Component>& components,
                                   const std::vector<Index>& component_of_body, BlockTable& blocks) {
  const auto& entries = system.force_kinds().entries();
  const auto kinds = static_cast<Index>(entries.size());
  slots_.assign(components.size() * kinds, {});
  std::vector<BodyId> ends;
  std::vector<Index> bodies;
  for (Index k = 0; k < kinds; ++k) {
    const ForceKind& kind = *entries[k].kind;
    struct Key {
      Index component, part, slot;  // part: as BlockTable::part_of() has it
      auto operator<=>(const Key&) const = default;
    };
    std::vector<Key> keys;
    keys.reserve(kind.size());
    for (Index slot = 0; slot < kind.size(); ++slot) {
      ends.clear();
      kind.ends(slot, ends);
      std::erase(ends, ground);
      bodies.clear();
      for (const BodyId end : ends) bodies.push_back(layout.index(end));
      const Index component = ends.empty() ? 0 : component_of_body[ends[0].serial];
      keys.push_back({component, blocks.part_of(components[component], bodies), slot});
    }
    std::sort(keys.begin(), keys.end());
    std::vector<Index> order;
    order.reserve(keys.size());
    for (const Key& key : keys) {
      const auto place = static_cast<Index>(order.size());
      Range& range = slots_[key.component * kinds + k];
      if (range.empty()) range.begin = range.end = place;
      ++range.end;
      blocks.place_element(components, key.component, k, key.part, place);
      order.push_back(key.slot);
    }
    if (kind.is_field()) {
      const Range all{0, kind.size()};
      for (Index component = 0; component < components.size(); ++component) {
        slots_[component * kinds + k] = all;
      }
      blocks.place_field(k, all, kind.works_in_parts());
    }
    kinds_.push_back(kind.arranged(order, layout));
    if (std::is_sorted(order.begin(), order.end())) order = {};
    order_.push_back(std::move(order));
  }
  blocks.close();
}

template <class F>
void ArrangedElements::for_internals(Index component, Index& z, F&& f) const {
  for (Index kind = 0; kind < kinds_.size(); ++kind) {
    const Index size = kinds_[kind]->internal_size();
    if (size == 0) continue;
    const Range range = elements(component, kind);
    for (Index element = range.begin; element < range.end; ++element, z += size) f(kind, element, size, z);
  }
}

std::vector<InternalSlot> ArrangedElements::place_internals(const System& system,
                                                            std::vector<Component>& components) {
  Index z = 0;
  std::vector<InternalSlot> internals;
  std::vector<std::vector<Index>> first(kinds_.size());
  for (Index component = 0; component < components.size(); ++component) {
    components[component].z.begin = z;
    for_internals(component, z, [&](Index kind, Index element, Index size, Index own) {
      const auto& serials = system.force_kinds().entries()[kind].serials;
      internals.push_back({serials[described_slot(kind, element)], own, size});
      first[kind].push_back(own);
    });
    components[component].z.end = z;
  }
  for (Index kind = 0; kind < kinds_.size(); ++kind) {
    if (!first[kind].empty()) kinds_[kind]->place_internal(first[kind]);
  }
  return internals;
}

void ArrangedElements::initial_internals(double* z) const {
  if (kinds_.empty()) return;
  Index next = 0;
  for (Index component = 0; component < slots_.size() / kinds_.size(); ++component) {
    for_internals(component, next, [&](Index kind, Index element, Index, Index own) {
      kinds_[kind]->initial_internal(element, z + own);
    });
  }
}

}  // namespace carom
