#pragma once

/// \file
/// Components cut into blocks and runs, by their size alone, and the elements that act on each block.

#include <carom/core/component.h>
#include <carom/core/export.h>
#include <carom/core/ids.h>
#include <carom/core/layout.h>

#include <cstddef>
#include <span>
#include <vector>

namespace carom {

/// Consecutive bodies of a component. Large components are divided into blocks, whose number depends on the
/// size of the component only; several threads may share a loop over them.
struct Block {
  Range bodies;                     ///< in the order of assembly
  Range v;                          ///< velocities
  Index run = 0;                    ///< its run, see BlockTable::runs()
  Index last_loading_block = 0;     ///< last block of its run whose elements act on it or on blocks before it
  bool loaded_across_runs = false;  ///< bridges act on it
};

/// Some blocks of a component with those around them. All in ascending order.
struct Surroundings {
  std::vector<Index> inner;    ///< the blocks themselves
  std::vector<Index> loading;  ///< whose elements, BlockTable::elements_up_to(), may act on them
  std::vector<Index> touched;  ///< on which those elements may act
};

/// Blocks of all components. Constant once the elements are placed.
class CAROM_API BlockTable {
public:
  /// Approximate number of bodies of a block: the cache of a core can hold the data of several blocks.
  static constexpr Index block_size = 512;
  /// Most runs of one component.
  static constexpr Index most_runs = 8;

  BlockTable() = default;
  /// Cuts components, and writes their blocks and runs into them. \param kinds of force elements
  BlockTable(std::vector<Component>& components, const BodySlots& bodies, Index kinds);

  [[nodiscard]] std::size_t size() const { return blocks_.size(); }  ///< number of blocks
  [[nodiscard]] const Block& operator[](std::size_t block) const { return blocks_[block]; }  ///< a block
  [[nodiscard]] auto begin() const { return blocks_.begin(); }                               ///< first block
  [[nodiscard]] auto end() const { return blocks_.end(); }  ///< behind the last
  /// Runs of all components: consecutive blocks, which one thread computes in their order, so that
  /// computations for a block can wait for its neighbours and still find its data in the cache.
  [[nodiscard]] const std::vector<Range>& runs() const { return runs_; }
  /// Finds the neighbours of the inner blocks, which are of one component. False if bridges act on one of
  /// them: its loads may then depend on any block.
  [[nodiscard]] bool surround(Surroundings& blocks) const;
  /// Elements of a kind that act on a block, and otherwise only on blocks of its run before it.
  [[nodiscard]] Range elements_up_to(Index block, Index kind) const {
    return elements_[block * kinds_ + kind];
  }
  /// Elements of a kind, in a component, that act on several runs.
  [[nodiscard]] Range bridges(Index component, Index kind) const {
    return bridges_[component * kinds_ + kind];
  }

  /// The last block of those in which the ends of an element lie, counted from the first of the component;
  /// the number of blocks if they lie in several runs. Notes in the blocks that the element acts on them.
  /// \param bodies in the order of assembly
  [[nodiscard]] Index part_of(const Component& component, std::span<const Index> bodies);
  /// Places the element that comes next in the order of its kind. \param part by part_of()
  void place_element(const std::vector<Component>& components, Index component, Index kind, Index part,
                     Index element);
  /// Places a field, whose elements act everywhere. \param in_parts whether blocks may evaluate it alone
  void place_field(Index kind, Range elements, bool in_parts);
  /// Ends the placing: a block that waits for another lets those before it wait too.
  void close();

private:
  std::vector<Block> blocks_;
  std::vector<Range> runs_;
  Index kinds_ = 0;
  std::vector<Range> elements_;  // by block, kind
  std::vector<Range> bridges_;   // by component, kind
};

}  // namespace carom
