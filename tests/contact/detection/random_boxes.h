#pragma once

// Sets of boxes for the broad phase, and all pairs of a set by trying each.

#include <carom/contact/detection/box.h>
#include <carom/core/ids.h>

#include "tests/random.h"

#include <cmath>
#include <span>
#include <vector>

namespace carom_test {

/// A box whose sides are from half a size to a size.
template <int D>
carom::Box<D> random_box(Random& random, double field, double size) {
  carom::Box<D> box;
  for (int k = 0; k < D; ++k) {
    box.min[k] = random.uniform(0.0, field);
    box.max[k] = box.min[k] + size * random.uniform(0.5, 1.0);
  }
  return box;
}

/// Boxes with sizes from 1 to `most` [m], the logarithm even, that fill about `share` of a field.
template <int D>
std::vector<carom::Box<D>> random_boxes(Random& random, int count, double most, double share = 0.5) {
  std::vector<double> sizes;
  double volume = 0.0;
  for (int i = 0; i < count; ++i) {
    sizes.push_back(std::pow(most, random.uniform(0.0, 1.0)));
    volume += std::pow(0.75 * sizes.back(), D);
  }
  const double field = std::pow(volume / share, 1.0 / D);
  std::vector<carom::Box<D>> boxes;
  for (const double size : sizes) boxes.push_back(random_box<D>(random, field, size));
  return boxes;
}

/// All pairs that the broad phase must find.
template <int D>
std::vector<carom::BoxPair> all_pairs(std::span<const carom::Box<D>> boxes, double margin,
                                      std::span<const carom::Index> owners = {}) {
  std::vector<carom::BoxPair> pairs;
  // Most pairs are parted along the first axis, which plain numbers tell soonest in builds without
  // optimisation.
  std::vector<double> low, high;
  for (const carom::Box<D>& box : boxes) low.push_back(box.min[0]), high.push_back(box.max[0]);
  const double *const from = low.data(), *const to = high.data();
  const auto count = static_cast<carom::Index>(boxes.size());
  for (carom::Index i = 0; i < count; ++i) {
    for (carom::Index j = i + 1; j < count; ++j) {
      if (from[i] - to[j] > margin || from[j] - to[i] > margin) continue;
      const bool same = !owners.empty() && owners[i] == owners[j] && owners[i] != carom::none;
      if (!same && carom::are_within(boxes[i], boxes[j], margin)) pairs.push_back({i, j});
    }
  }
  return pairs;
}

}  // namespace carom_test
