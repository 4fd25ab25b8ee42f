#pragma once

/// \file
/// Clock groups of an advance in the order of their times.

#include <carom/core/export.h>
#include <carom/core/ids.h>

#include <vector>

namespace carom {

/// Groups that are still to be advanced, the earliest first; of those at one time the first in the order of
/// assembly.
class CAROM_API GroupQueue {
public:
  /// Puts groups 0 to `count` at one time [s], in place of all others.
  void fill(Index count, double time);
  /// True if there is none.
  [[nodiscard]] bool empty() const { return waiting_.empty(); }
  /// Takes the earliest group out. There must be one.
  [[nodiscard]] Index take();
  /// Puts a group back. \param time that it has reached [s]
  void put(Index group, double time);

private:
  struct Waiting {
    double time;
    Index group;
  };
  std::vector<Waiting> waiting_;  // the earliest last
};

}  // namespace carom
