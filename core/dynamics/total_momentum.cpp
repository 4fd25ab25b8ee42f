#include <carom/core/assembly.h>
#include <carom/core/dynamics/total_momentum.h>
#include <carom/core/numerics/compensated_sum.h>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace carom {

namespace {

struct Sum {
  void add(std::size_t axis, double term) {
    parts[axis].add(term);
    scale = std::max(scale, std::abs(term));
  }
  [[nodiscard]] std::array<double, 3> value() const {
    return {parts[0].value(), parts[1].value(), parts[2].value()};
  }

  std::array<CompensatedSum, 3> parts{};
  double scale = 0.0;
};

}  // namespace

TotalMomentum total_momentum(const Assembly& assembly, const State& state) {
  check_sizes(assembly, state);
  const Layout& layout = *assembly.layout();
  const auto dimension = static_cast<Index>(layout.dimension());
  std::vector<double> momentum(state.v.size());
  for (Index component = 0; component < assembly.components().size(); ++component) {
    assembly.for_bodies(component, [&](const BodyKind& kind, Range slots, Index, Index v, Index) {
      kind.apply_mass(slots, state.v.data() + v, momentum.data() + v);
    });
  }
  Sum linear, angular;
  for (const BodySlot& slot : layout.bodies()) {
    const double* x = state.q.data() + slot.q;
    const double* p = momentum.data() + slot.v;
    for (Index i = 0; i < dimension; ++i) linear.add(i, p[i]);
    const auto add_moment = [&](std::size_t axis, Index i, Index j) {
      angular.add(axis, x[i] * p[j]);
      angular.add(axis, -x[j] * p[i]);
    };
    add_moment(2, 0, 1);
    if (dimension == 2) {
      if (slot.v_size == 3) angular.add(2, p[2]);
    } else {
      assert(slot.v_size == 3);  // in space there are particles only
      add_moment(0, 1, 2);
      add_moment(1, 2, 0);
    }
  }
  return {linear.value(), angular.value(), linear.scale, angular.scale};
}

}  // namespace carom
