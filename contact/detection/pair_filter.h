#pragma once

/// \file
/// Which bodies may touch each other.
///
/// Shapes of one body do not touch each other. Bodies that a joint binds to each other overlap at the joint
/// as a rule, and do not touch unless System::allow_contact() says so; it may also part two others. Filters
/// of shapes come on top.

#include <carom/core/contact_filter.h>
#include <carom/core/export.h>
#include <carom/core/ids.h>

#include <algorithm>
#include <vector>

namespace carom {

class Assembly;

/// Pairs of bodies that may touch, of one assembly. Bodies are in its order.
class CAROM_API PairFilter {
public:
  /// Of no body.
  PairFilter() = default;
  /// Of all bodies. Not needed afterwards.
  explicit PairFilter(const Assembly& assembly);

  /// True if something of one body may touch something of another: they are two, no joint or decision parts
  /// them, and their filters do not part all of them. The order of the two does not matter.
  [[nodiscard]] bool may_touch(Index a, Index b) const {
    return a != b && carom::may_touch(filters_[a], filters_[b]) && !is_excluded(a, b);
  }
  /// True if two shapes of two bodies, or their centres, may touch, by their own filters.
  [[nodiscard]] bool may_touch(Index a, const ContactFilter& of_a, Index b, const ContactFilter& of_b) const {
    return a != b && carom::may_touch(of_a, of_b) && !is_excluded(a, b);
  }
  /// True if joints or decisions part any.
  [[nodiscard]] bool excludes_any() const { return !excluded_.empty(); }
  /// True if a joint or a decision parts two bodies.
  [[nodiscard]] bool is_excluded(Index a, Index b) const {
    const Index low = a < b ? a : b, high = a < b ? b : a;
    return std::binary_search(excluded_.data() + begin_[low], excluded_.data() + begin_[low + 1], high);
  }
  /// Groups and touched groups of everything of a body; of a body that can touch nothing, none.
  [[nodiscard]] const ContactFilter& filter(Index body) const { return filters_[body]; }

private:
  void collect_filters(const Assembly& assembly);
  void collect_excluded(const Assembly& assembly);

  std::vector<ContactFilter> filters_;  // by body
  std::vector<Index> begin_;            // of each body: its first in `excluded_`
  std::vector<Index> excluded_;         // partners that follow it in the order of assembly, ascending
};

}  // namespace carom
