// Problem: cut large components into blocks and runs, by the size of the component alone, and tell whose
// elements act on which.

#include <carom/core/block_table.h>

#include <algorithm>
#include <cstdint>

namespace carom {

BlockTable::BlockTable(std::vector<Component>& components, const BodySlots& bodies, Index kinds)
    : kinds_(kinds) {
  // Blocks at the ends of a run wait for the bridges, so runs are long; but two threads are to have a run
  // each from two blocks on.
  constexpr Index short_run = 8;
  for (Component& component : components) {
    const Index size = component.bodies.size();
    const Index count = std::max<Index>(size / block_size, 1);
    const Index runs = std::clamp<Index>(count / short_run, std::min<Index>(count, 2), most_runs);
    const auto share = [](Range whole, Index i, Index parts) {
      return whole.begin + static_cast<Index>(std::uint64_t{whole.size()} * i / parts);
    };
    const auto velocity = [&](Index body) {
      return body < component.bodies.end ? bodies[body].v : component.v.end;
    };
    component.blocks.begin = static_cast<Index>(blocks_.size());
    for (Index i = 0; i < count; ++i) {
      const Range own{share(component.bodies, i, count), share(component.bodies, i + 1, count)};
      blocks_.push_back(
          {own, {velocity(own.begin), velocity(own.end)}, 0, component.blocks.begin + i, false});
    }
    component.blocks.end = static_cast<Index>(blocks_.size());
    component.runs.begin = static_cast<Index>(runs_.size());
    for (Index i = 0; i < runs; ++i) {
      const Range run{share(component.blocks, i, runs), share(component.blocks, i + 1, runs)};
      for (Index block = run.begin; block < run.end; ++block) {
        blocks_[block].run = static_cast<Index>(runs_.size());
      }
      runs_.push_back(run);
    }
    component.runs.end = static_cast<Index>(runs_.size());
  }
  elements_.assign(blocks_.size() * kinds, {});
  bridges_.assign(components.size() * kinds, {});
}

Index BlockTable::part_of(const Component& component, std::span<const Index> bodies) {
  const Range blocks = component.blocks;
  if (blocks.size() == 1 || bodies.empty()) return 0;
  const auto block_of = [&](Index body) {
    const auto found =
        std::upper_bound(blocks_.begin() + blocks.begin, blocks_.begin() + blocks.end, body,
                         [](Index wanted, const Block& block) { return wanted < block.bodies.end; });
    return static_cast<Index>(found - blocks_.begin());
  };
  Index first = none, last = 0;
  for (const Index body : bodies) {
    const Index block = block_of(body);
    first = std::min(first, block);
    last = std::max(last, block);
  }
  if (blocks_[first].run == blocks_[last].run) {
    blocks_[first].last_loading_block = std::max(blocks_[first].last_loading_block, last);
    return last - blocks.begin;
  }
  for (const Index body : bodies) blocks_[block_of(body)].loaded_across_runs = true;
  return blocks.size();
}

void BlockTable::place_element(const std::vector<Component>& components, Index component, Index kind,
                               Index part, Index element) {
  const Range blocks = components[component].blocks;
  Range& range = part < blocks.size() ? elements_[(blocks.begin + part) * kinds_ + kind]
                                      : bridges_[component * kinds_ + kind];
  if (range.empty()) range.begin = range.end = element;
  ++range.end;
}

void BlockTable::place_field(Index kind, Range elements, bool in_parts) {
  for (std::size_t place = kind; place < bridges_.size(); place += kinds_) {
    bridges_[place] = in_parts ? Range{} : elements;
  }
  for (Index block = 0; block < blocks_.size(); ++block) {
    elements_[block * kinds_ + kind] = in_parts ? elements : Range{};
    blocks_[block].loaded_across_runs = blocks_[block].loaded_across_runs || !in_parts;
  }
}

void BlockTable::close() {
  for (const Range run : runs_) {
    Index last_loading_block = run.begin;
    for (Index block = run.begin; block < run.end; ++block) {
      last_loading_block = std::max(last_loading_block, blocks_[block].last_loading_block);
      blocks_[block].last_loading_block = last_loading_block;
    }
  }
}

bool BlockTable::surround(Surroundings& blocks) const {
  blocks.loading.clear();
  blocks.touched.clear();
  // Ranges that begin and end no earlier than those before them.
  const auto add = [](std::vector<Index>& to, Index begin, Index end) {
    if (!to.empty()) begin = std::max(begin, to.back() + 1);
    for (Index block = begin; block < end; ++block) to.push_back(block);
  };
  for (const Index block : blocks.inner) {
    if (blocks_[block].loaded_across_runs) return false;
    add(blocks.loading, block, blocks_[block].last_loading_block + 1);
  }
  for (const Index block : blocks.loading) {
    const auto run = blocks_.begin() + runs_[blocks_[block].run].begin;
    const auto first = std::partition_point(
        run, blocks_.begin() + block, [&](const Block& before) { return before.last_loading_block < block; });
    add(blocks.touched, static_cast<Index>(first - blocks_.begin()), block + 1);
  }
  return true;
}

}  // namespace carom
