#pragma once

/// \file
/// Four numbers at a time, each by itself: the compiler's vectors of four doubles. The result of each is that
/// of plain arithmetic, whatever registers the machine has. A source that calculates with them passes them by
/// reference or inlines: by value they have no fixed place in a call.

namespace carom {

/// Four doubles.
using Lanes = double __attribute__((vector_size(32)));

/// Four integers, or answers to comparisons of Lanes: -1 true, 0 false.
using LaneMask = long long __attribute__((vector_size(32)));

inline constexpr int lane_count = 4;

}  // namespace carom
