#include <carom/contact/detection/pair_filter.h>
#include <carom/core/assembly.h>

#include <algorithm>
#include <set>
#include <utility>

namespace carom {

namespace {

using Pairs = std::set<std::pair<Index, Index>>;

// Pairs of bodies that one joint binds, by their places in the order of assembly.
Pairs joined_pairs(const System& system, const Layout& layout) {
  Pairs pairs;
  std::vector<BodyId> ends;
  for (const auto& entry : system.joint_kinds().entries()) {
    for (Index slot = 0; slot < entry.serials.size(); ++slot) {
      ends.clear();
      entry.kind->ends(slot, ends);
      std::erase(ends, ground);
      for (std::size_t i = 0; i < ends.size(); ++i) {
        for (std::size_t j = 0; j < i; ++j) {
          if (ends[i] != ends[j]) pairs.insert(std::minmax(layout.index(ends[i]), layout.index(ends[j])));
        }
      }
    }
  }
  return pairs;
}

}  // namespace

PairFilter::PairFilter(const Assembly& assembly) {
  collect_filters(assembly);
  collect_excluded(assembly);
}

void PairFilter::collect_filters(const Assembly& assembly) {
  const System& system = assembly.system();
  const Layout& layout = *assembly.layout();
  filters_.assign(layout.bodies().size(), {0, 0});
  const auto add = [&](Index body, const ContactFilter& filter) {
    filters_[body].groups |= filter.groups, filters_[body].touches |= filter.touches;
  };
  for (const auto& entry : system.body_kinds().entries()) {
    for (Index slot = 0; slot < entry.serials.size(); ++slot) {
      if (!entry.kind->has_contact_point(slot)) continue;
      add(layout.index({entry.serials[slot], system.token()}), entry.kind->filter(slot));
    }
  }
  for (const auto& entry : system.shape_kinds().entries()) {
    for (Index slot = 0; slot < entry.serials.size(); ++slot) {
      add(layout.index(entry.kind->body(slot)), entry.kind->filter(slot));
    }
  }
}

void PairFilter::collect_excluded(const Assembly& assembly) {
  const System& system = assembly.system();
  const Layout& layout = *assembly.layout();
  Pairs pairs = joined_pairs(system, layout);
  for (const auto& [a, b, allowed] : system.contact_decisions()) {
    const std::pair<Index, Index> pair = std::minmax(layout.index(a), layout.index(b));
    if (allowed) {
      pairs.erase(pair);
    } else {
      pairs.insert(pair);
    }
  }
  begin_.assign(filters_.size() + 1, 0);
  for (const auto& [low, high] : pairs) ++begin_[low + 1], excluded_.push_back(high);
  for (std::size_t i = 1; i < begin_.size(); ++i) begin_[i] += begin_[i - 1];
}

}  // namespace carom
