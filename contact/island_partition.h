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
#include <vector>

namespace carom {

/// Finds islands among constraints, or among what stands for them. Keeps its memory.
class CAROM_API IslandPartition {
public:
  /// Arranges a list so that the members of each island stand together, islands ordered by their first node,
  /// the members of each as they came; a list that is so already is left alone.
  /// \param nodes how many there are \param nodes_of nodes_of(item, f) calls f(node) for the nodes (bodies,
  /// mechanisms, components) that an item joins, at least one
  template <class Item, class NodesOf>
  std::span<const Range> arrange(std::span<Item> items, Index nodes, NodesOf&& nodes_of) {
    sets_.start(nodes);
    islands_.clear();
    for (const Item& item : items) {
      Index first = none;
      nodes_of(item, [&](Index node) {
        if (first == none) first = node;
        if (node != first) sets_.join(first, node);
      });
    }
    const auto island_of = [&](const Item& item) {
      Index first = none;
      nodes_of(item, [&](Index node) { first = first == none ? sets_.find(node) : first; });
      return first;
    };
    const auto before = [&](const Item& a, const Item& b) { return island_of(a) < island_of(b); };
    if (!std::is_sorted(items.begin(), items.end(), before)) {
      std::stable_sort(items.begin(), items.end(), before);
    }
    for (Index i = 0; i < items.size(); ++i) {
      if (i == 0 || island_of(items[i]) != island_of(items[i - 1])) islands_.push_back({i, i});
      islands_.back().end = i + 1;
    }
    return islands_;
  }

  /// Likewise of constraints. \param node_of node_of(body) names what answers together with a body
  template <class NodeOf>
  std::span<const Range> arrange_constraints(std::span<Constraint> constraints, Index nodes,
                                             NodeOf&& node_of) {
    if (arrange_single(constraints, node_of)) return islands_;
    return arrange(constraints, nodes, [&](const Constraint& constraint, auto&& f) {
      for (int b = 0; b < constraint.bodies; ++b) {
        f(node_of(constraint.blocks[static_cast<std::size_t>(b)].body));
      }
    });
  }

  /// Parts all nodes; no items.
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

  UnionFind sets_;
  std::vector<Range> islands_;
};

}  // namespace carom
