#include <carom/core/numerics/time_difference.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace carom {

TimeDifference::TimeDifference(double time, int order, std::span<const double> discontinuities) {
  // Powers of two, so that times of any usual size stay exact.
  constexpr double first_step = 0x1p-12, second_step = 0x1p-10;
  // The last time keeps clear of the end, where functions already say what comes after it.
  constexpr double reach = 6.5;

  const double infinity = std::numeric_limits<double>::infinity();
  const auto next = std::upper_bound(discontinuities.begin(), discontinuities.end(), time);
  const double begin = next == discontinuities.begin() ? -infinity : *(next - 1);
  const double end = next == discontinuities.end() ? infinity : *next;
  const double step = std::min(order == 1 ? first_step : second_step, (end - begin) / reach);
  const double start = std::max(std::min(time - 3.0 * step, end - reach * step), begin);
  for (std::size_t i = 0; i < count; ++i) times_[i] = start + static_cast<double>(i) * step;

  // Weights of the derivatives of the polynomial, after B. Fornberg, Math. Comp. 51 (1988) 699-706.
  std::array<std::array<double, 3>, count> c{};
  const auto highest = static_cast<std::size_t>(order);
  c[0][0] = 1.0;
  double c1 = 1.0, c4 = times_[0] - time;
  for (std::size_t i = 1; i < count; ++i) {
    const std::size_t most = std::min(i, highest);
    const double c5 = c4;
    double c2 = 1.0;
    c4 = times_[i] - time;
    for (std::size_t j = 0; j < i; ++j) {
      const double c3 = times_[i] - times_[j];
      c2 *= c3;
      if (j + 1 == i) {
        for (std::size_t k = most; k > 0; --k) {
          c[i][k] = c1 * (static_cast<double>(k) * c[i - 1][k - 1] - c5 * c[i - 1][k]) / c2;
        }
        c[i][0] = -c1 * c5 * c[i - 1][0] / c2;
      }
      for (std::size_t k = most; k > 0; --k) {
        c[j][k] = (c4 * c[j][k] - static_cast<double>(k) * c[j][k - 1]) / c3;
      }
      c[j][0] *= c4 / c3;
    }
    c1 = c2;
  }
  for (std::size_t i = 0; i < count; ++i) weights_[i] = c[i][highest];
}

}  // namespace carom
