#include <carom/core/largest_coordinate.h>

#include <algorithm>
#include <cmath>

namespace carom {

double largest_coordinate(const State& state, Range bodies) {
  const Layout& layout = *state.layout();
  const auto dimension = static_cast<Index>(layout.dimension());
  double largest = 0.0;
  layout.bodies().for_range(bodies, [&](Index, const BodySlot& at) {
    for (Index i = at.q; i < at.q + dimension; ++i) largest = std::max(largest, std::abs(state.q[i]));
  });
  return largest;
}

double largest_coordinate(const State& state) {
  return largest_coordinate(state, {0, static_cast<Index>(state.layout()->bodies().size())});
}

}  // namespace carom
