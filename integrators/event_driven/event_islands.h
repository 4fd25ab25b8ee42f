#pragma once

/// \file
/// Islands at an event: mechanisms that touch each other answer an impulse together. They are the unit of
/// impacts and of the selection of modes.

#include <carom/contact/island_partition.h>
#include <carom/core/export.h>
#include <carom/core/function_ref.h>
#include <carom/integrators/event_driven/group_model.h>

#include <cstddef>
#include <span>
#include <vector>

namespace carom {

/// Islands of one clock group, as lists of its pairs. Keeps its memory.
class CAROM_API EventIslands {
public:
  /// Finds the islands: mechanisms are joined by the pairs of two bodies that are near. Islands are ordered
  /// by their first bodies, the pairs of each as in the model; pairs of two bodies that are not near are in
  /// none.
  void find(const GroupModel& model, FunctionRef<bool(std::size_t)> is_near);
  /// Number of islands.
  [[nodiscard]] std::size_t size() const { return islands_.size(); }
  /// Pairs of an island, numbers of the model.
  [[nodiscard]] std::span<const Index> pairs(std::size_t island) const {
    return std::span(pairs_).subspan(islands_[island].begin, islands_[island].size());
  }

private:
  IslandPartition partition_;        // of mechanisms, named by their first bodies
  std::vector<JoinedNodes> joined_;  // by pairs that are near, in the order of the model
  std::vector<Index> listed_;        // these pairs
  std::vector<Index> pairs_;         // the same, island by island
  std::span<const Range> islands_;   // of pairs_
};

}  // namespace carom
