// The loops over the numbers of vectors beside the plainest ones.

#include <carom/integrators/flow/sundials_loops.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

namespace {

// For lengths around those that they are cut into.
TEST(SundialsLoops, DoWhatTheySay) {
  namespace loops = carom::sundials_loops;
  for (const std::size_t n : {1U, 2U, 3U, 4U, 5U, 7U, 8U, 9U, 130U}) {
    std::vector<double> x(n), y(n), z(n), w(n);
    for (std::size_t i = 0; i < n; ++i) {
      x[i] = std::sin(1.0 + static_cast<double>(i));
      y[i] = 1.5 + std::cos(3.0 * static_cast<double>(i));
    }
    double sum = 0.0, largest = 0.0, weighted = 0.0;
    for (std::size_t i = 0; i < n; ++i) {
      sum += x[i] * y[i];
      largest = std::max(largest, std::abs(x[i]));
      weighted = std::max(weighted, std::abs(x[i] * y[i]));
    }
    EXPECT_NEAR(loops::dot(n, x.data(), y.data()), sum, 1e-13 * static_cast<double>(n));  // another order
    EXPECT_EQ(loops::maximum(n, x.data()), largest);
    EXPECT_EQ(loops::weighted_maximum(n, x.data(), y.data()), weighted);
    EXPECT_EQ(loops::minimum(n, y.data()), *std::min_element(y.begin(), y.end()));

    const std::array<double, 3> c{0.5, -2.0, 3.0};
    const std::array<const double*, 3> vectors{x.data(), y.data(), z.data()};
    z = x;
    loops::combine(
        n, 3, c.data(), [&](std::size_t j) { return vectors[j]; }, z.data());  // over an operand
    for (std::size_t i = 0; i < n; ++i) ASSERT_EQ(z[i], (0.5 * x[i] - 2.0 * y[i]) + 3.0 * x[i]) << n;

    const auto check = [&](auto&& expected) {
      for (std::size_t i = 0; i < n; ++i) ASSERT_DOUBLE_EQ(w[i], expected(i)) << n << ' ' << i;
    };
    loops::linear_sum(n, 2.0, x.data(), -3.0, y.data(), w.data());
    check([&](std::size_t i) { return 2.0 * x[i] - 3.0 * y[i]; });
    loops::multiply(n, x.data(), y.data(), w.data());
    check([&](std::size_t i) { return x[i] * y[i]; });
    loops::divide(n, x.data(), y.data(), w.data());
    check([&](std::size_t i) { return x[i] / y[i]; });
    loops::scale(n, 1.0, x.data(), w.data());
    check([&](std::size_t i) { return x[i]; });
    loops::scale(n, -4.0, w.data(), w.data());
    check([&](std::size_t i) { return -4.0 * x[i]; });
    loops::absolute(n, x.data(), w.data());
    check([&](std::size_t i) { return std::abs(x[i]); });
    loops::invert(n, y.data(), w.data());
    check([&](std::size_t i) { return 1.0 / y[i]; });
    loops::add_constant(n, x.data(), 7.0, w.data());
    check([&](std::size_t i) { return x[i] + 7.0; });
    loops::tolerance_weights(n, 0.1, x.data(), y.data(), w.data());
    check([&](std::size_t i) { return 1.0 / (0.1 * std::abs(x[i]) + y[i]); });
    loops::fill(n, 2.5, w.data());
    check([](std::size_t) { return 2.5; });

    // Not a number in any place is never overlooked.
    EXPECT_TRUE(loops::all_finite(n, x.data()));
    for (const double bad :
         {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
      for (const std::size_t place : {std::size_t{0}, n / 2, n - 1}) {
        z = x;
        z[place] = bad;
        EXPECT_FALSE(loops::all_finite(n, z.data()));
        EXPECT_TRUE(std::isnan(loops::maximum(n, z.data())));
        EXPECT_TRUE(std::isnan(loops::weighted_maximum(n, z.data(), y.data())));
      }
    }
  }
}

}  // namespace
