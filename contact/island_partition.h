#pragma once

/// \file
/// Islands: bodies, or components, that constraints join while they are active. They are found anew in every
/// step and at every event, move nothing but a list of constraints, and are the unit of the contact problem.

#include <carom/core/constraint.h>
#include <carom/core/export.h>
#include <carom/core/ids.h>
#include <carom/core/numerics/union_find.h>

#include <algorithm>
#include <span>
#include <utility>
#include <vector>

namespace carom {

/// Nodes that a constraint joins: that of its first body and that of another one, or the first alone, twice.
struct JoinedNodes {
  Index first = none, second = none;
  friend bool operator==(const JoinedNodes&, const JoinedNodes&) = default;
};

/// Finds islands among constraints. Keeps its memory.
class CAROM_API IslandPartition {
public:
  /// Arranges constraints so that those of each island stand together, islands ordered by their first node,
  /// the members of each as they came; a list that is so already is left alone.
  /// \param nodes how many there are \param node_of node_of(body) names what answers together with a body:
  /// the body, its mechanism, its component
  template <class NodeOf>
  std::span<const Range> arrange(std::span<Constraint> constraints, Index nodes, NodeOf&& node_of) {
    if (arrange_single(constraints, node_of)) return islands_;
    clear(nodes);
    for (const Constraint& constraint : constraints) {
      for (int b = 1; b < constraint.bodies; ++b) {
        sets_.join(node_of(constraint.body()), node_of(constraint.blocks[static_cast<std::size_t>(b)].body));
      }
    }
    names_.clear();
    for (const Constraint& constraint : constraints) names_.push_back(island_of(node_of(constraint.body())));
    if (!std::is_sorted(names_.begin(), names_.end())) bring_together(constraints);
    return list_islands();
  }
  /// Finds the islands of constraints that are still to be written, and are known by what they join. Nothing
  /// is moved; order() says how the constraints have to stand.
  std::span<const Range> arrange(std::span<const JoinedNodes> constraints, Index nodes);
  /// Numbers of the constraints of the last arrange() of JoinedNodes, in the order of its islands.
  [[nodiscard]] std::span<const Index> order() const { return order_; }

  /// Parts all nodes; no constraints.
  void clear(Index nodes) {
    sets_.start(nodes);
    islands_.clear();
  }
  /// The island of a node, named by its first node, after clear() or an arrange() that joined some.
  [[nodiscard]] Index island_of(Index node) { return sets_.find(node); }

private:
  /// Constraints of one body each, in the order of their nodes: nothing is to be joined or moved.
  template <class NodeOf>
  bool arrange_single(std::span<const Constraint> constraints, NodeOf&& node_of) {
    islands_.clear();
    Index last = none;
    for (Index i = 0; i < constraints.size(); ++i) {
      const Index node = constraints[i].bodies == 1 ? node_of(constraints[i].body()) : none;
      if (node == none || (last != none && node < last)) return false;
      if (node != last) islands_.push_back({i, i});
      islands_.back().end = i + 1;
      last = node;
    }
    return true;
  }

  void bring_together(std::span<Constraint> constraints);
  void find_order();
  std::span<const Range> list_islands();

  UnionFind sets_;
  std::vector<Range> islands_;
  std::vector<Index> names_;     // of the islands, by constraint
  std::vector<Index> distinct_;  // names that occur
  std::vector<Index> next_;      // by name, zero between calls: how many, or the next place
  std::vector<Index> order_;     // of constraints, island by island
};

}  // namespace carom
