#pragma once

/// \file
/// Islands of a step: components that constraints join while these are active. They are found in every step,
/// anew where constraints join others than in the step before, and are the unit of its coupling iteration.

#include <carom/contact/island_partition.h>
#include <carom/core/assembly.h>
#include <carom/core/constraint.h>
#include <carom/core/export.h>

#include <span>
#include <vector>

namespace carom {

/// Components that constraints join, and these; or the components of a batch that none joins to others.
struct StepIsland {
  std::span<const Index> components;    ///< ascending
  std::span<Constraint> constraints;    ///< that act on them
  std::span<const Range> batches = {};  ///< its components again: those of one batch that follow one another
  bool joined = false;                  ///< constraints join its components, directly or by way of others
};

/// Finds islands. Keeps memory.
class CAROM_API StepIslands {
public:
  /// \param assembly must outlive it
  explicit StepIslands(const Assembly& assembly);

  /// Finds the islands where no constraint joins components: every batch is one.
  /// \param batches ranges of components, in their order
  void find(std::span<const Range> batches);
  /// Finds the islands where some constraints join components: what they join leaves its batch. Every
  /// component of the batches belongs to an island. Returns the order in which the constraints have to stand,
  /// those of an island together, as they came. \param joined components of each constraint, in the order of
  /// the first ones
  std::span<const Index> find(std::span<const Range> batches, std::span<const JoinedNodes> joined);
  /// Shares the constraints out, which stand in the order of their islands.
  void take(std::span<Constraint> constraints);
  /// The islands, in the order of their first components. Valid until the next find(), as long as the
  /// constraints stay where they are.
  [[nodiscard]] std::span<const StepIsland> list() const { return islands_; }

private:
  [[nodiscard]] bool takes_other(std::span<const Range> batches);
  void part();
  void order_components();
  void add_islands(std::span<const JoinedNodes> joined);
  [[nodiscard]] std::span<const Range> add_ranges(std::span<const Index> components, std::size_t batch);

  const Assembly* assembly_;
  std::vector<Range> batches_;
  std::vector<Index> alone_, joined_;  // their components, in their order; island by island
  std::vector<Index> names_, next_;    // of the islands, by component; the next places in joined_, by name
  std::vector<Range> ranges_;          // of joined_
  std::vector<StepIsland> islands_;
  std::vector<Range> constraints_;  // of each island; empty where batches are the islands
  std::vector<JoinedNodes> known_;  // components that the constraints of the last find() joined
  bool apart_ = false;              // the batches are the islands: constraints join none
  IslandPartition partition_;
};

}  // namespace carom
