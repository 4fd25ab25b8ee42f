#include <carom/core/assembly.h>
#include <carom/integrators/time_stepping/gap_rounding.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace carom {

double gap_rounding(const Assembly& assembly, const TimeStepping& options) {
  constexpr double usual = 1e-12, roundings = 4.0 * std::numeric_limits<double>::epsilon();
  const State start = assembly.initial_state();
  const Layout& layout = *assembly.layout();
  const auto dimension = static_cast<Index>(layout.dimension());
  double largest = 0.0;
  layout.bodies().for_range({0, static_cast<Index>(layout.bodies().size())}, [&](Index, const BodySlot& at) {
    for (Index i = at.q; i < at.q + dimension; ++i) largest = std::max(largest, std::abs(start.q[i]));
  });
  return std::max(options.tolerance > 0.0 ? options.tolerance : usual, roundings * largest);
}

}  // namespace carom
