// Problem: cut large components into blocks and runs, by the size of the component alone, and tell whose
// elements act on which.

#include <carom/core/assembly.h>

#include <algorithm>
#include <cstdint>

namespace carom {

void Assembly::cut_components() {
  // Blocks at the ends of a run wait for the bridges, so runs are long; but two threads are to have a run
  // each from two blocks on.
  constexpr Index short_run = 8;
  for (Component& component : components_) {
    const Index size = component.bodies.size();
    const Index count = std::max<Index>(size / block_size, 1);
    const Index runs = std::clamp<Index>(count / short_run, std::min<Index>(count, 2), most_runs);
    const auto share = [](Range whole, Index i, Index parts) {
      return whole.begin + static_cast<Index>(std::uint64_t{whole.size()} * i / parts);
    };
    const auto velocity = [&](Index body) {
      return body < component.bodies.end ? layout_->bodies()[body].v : component.v.end;
    };
    component.blocks.begin = static_cast<Index>(blocks_.size());
    for (Index i = 0; i < count; ++i) {
      const Range bodies{share(component.bodies, i, count), share(component.bodies, i + 1, count)};
      blocks_.push_back(
          {bodies, {velocity(bodies.begin), velocity(bodies.end)}, 0, component.blocks.begin + i, false});
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
}

/// The last block of those in which the ends of an element lie, counted from the first of the component; the
/// number of blocks if they lie in several runs. Notes in the blocks that the element acts on them.
Index Assembly::part_of(Index component, const std::vector<BodyId>& ends) {
  const Range blocks = components_[component].blocks;
  if (blocks.size() == 1 || ends.empty()) return 0;
  const auto block_of = [&](BodyId end) {
    const auto found =
        std::upper_bound(blocks_.begin() + blocks.begin, blocks_.begin() + blocks.end, layout_->index(end),
                         [](Index wanted, const Block& block) { return wanted < block.bodies.end; });
    return static_cast<Index>(found - blocks_.begin());
  };
  Index first = none, last = 0;
  for (const BodyId end : ends) {
    const Index block = block_of(end);
    first = std::min(first, block);
    last = std::max(last, block);
  }
  if (blocks_[first].run == blocks_[last].run) {
    blocks_[first].last_loading_block = std::max(blocks_[first].last_loading_block, last);
    return last - blocks.begin;
  }
  for (const BodyId end : ends) blocks_[block_of(end)].loaded_across_runs = true;
  return blocks.size();
}

/// What closes a block closes those before it.
void Assembly::close_blocks() {
  for (const Range run : runs_) {
    Index last_loading_block = run.begin;
    for (Index block = run.begin; block < run.end; ++block) {
      last_loading_block = std::max(last_loading_block, blocks_[block].last_loading_block);
      blocks_[block].last_loading_block = last_loading_block;
    }
  }
}

bool Assembly::surround(Surroundings& blocks) const {
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
