#pragma once

// How far a run is from numbers that are known.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace carom_test {

/// Largest difference of two lists of numbers, which must be of one length.
inline double largest_difference(const std::vector<double>& found, const std::vector<double>& known) {
  EXPECT_EQ(found.size(), known.size());
  double most = 0.0;
  for (std::size_t i = 0; i < std::min(found.size(), known.size()); ++i)
    most = std::max(most, std::abs(found[i] - known[i]));
  return most;
}

}  // namespace carom_test
