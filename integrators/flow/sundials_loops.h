#pragma once

/// \file
/// Loops over the numbers of vectors, in place of those of SUNDIALS: common packages of it are compiled
/// without optimisation. No SUNDIALS here. Results may be written over any operand. Sums are made in four
/// interleaved parts, in an order that depends on the length alone.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace carom::sundials_loops {

/// z = a x + b y.
inline void linear_sum(std::size_t n, double a, const double* x, double b, const double* y, double* z) {
  for (std::size_t i = 0; i < n; ++i) z[i] = a * x[i] + b * y[i];
}

/// z = c in every place.
inline void fill(std::size_t n, double c, double* z) { std::fill_n(z, n, c); }

/// z = x y, place by place.
inline void multiply(std::size_t n, const double* x, const double* y, double* z) {
  for (std::size_t i = 0; i < n; ++i) z[i] = x[i] * y[i];
}

/// z = x / y, place by place.
inline void divide(std::size_t n, const double* x, const double* y, double* z) {
  for (std::size_t i = 0; i < n; ++i) z[i] = x[i] / y[i];
}

/// z = c x. With c = 1 a copy.
inline void scale(std::size_t n, double c, const double* x, double* z) {
  if (c == 1.0) {
    if (z != x) std::copy_n(x, n, z);
    return;
  }
  for (std::size_t i = 0; i < n; ++i) z[i] = c * x[i];
}

/// z = |x|.
inline void absolute(std::size_t n, const double* x, double* z) {
  for (std::size_t i = 0; i < n; ++i) z[i] = std::abs(x[i]);
}

/// z = 1 / x.
inline void invert(std::size_t n, const double* x, double* z) {
  for (std::size_t i = 0; i < n; ++i) z[i] = 1.0 / x[i];
}

/// z = x + b.
inline void add_constant(std::size_t n, const double* x, double b, double* z) {
  for (std::size_t i = 0; i < n; ++i) z[i] = x[i] + b;
}

/// Sum of x y.
[[nodiscard]] inline double dot(std::size_t n, const double* x, const double* y) {
  std::array<double, 4> sum{};
  std::size_t i = 0;
  for (; i + 4 <= n; i += 4) {
    for (std::size_t k = 0; k < 4; ++k) sum[k] += x[i + k] * y[i + k];
  }
  for (; i < n; ++i) sum[0] += x[i] * y[i];
  return (sum[0] + sum[1]) + (sum[2] + sum[3]);
}

/// Largest |x w|; not a number if any product is not.
[[nodiscard]] inline double weighted_maximum(std::size_t n, const double* x, const double* w) {
  std::array<double, 4> largest{}, check{};
  const auto take = [&](std::size_t k, double number) {
    const double size = std::abs(number);
    largest[k] = size > largest[k] ? size : largest[k];
    check[k] += 0.0 * number;  // stays 0 unless the number is none
  };
  std::size_t i = 0;
  for (; i + 4 <= n; i += 4) {
    for (std::size_t k = 0; k < 4; ++k) take(k, x[i + k] * w[i + k]);
  }
  for (; i < n; ++i) take(0, x[i] * w[i]);
  return std::max(std::max(largest[0], largest[1]), std::max(largest[2], largest[3])) +
         ((check[0] + check[1]) + (check[2] + check[3]));
}

/// Largest |x|; not a number if any is not finite.
[[nodiscard]] inline double maximum(std::size_t n, const double* x) {
  double largest = 0.0, check = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    largest = std::max(largest, std::abs(x[i]));
    check += 0.0 * x[i];
  }
  return largest + check;
}

/// Smallest x, n > 0.
[[nodiscard]] inline double minimum(std::size_t n, const double* x) { return *std::min_element(x, x + n); }

/// True if every number is finite.
[[nodiscard]] inline bool all_finite(std::size_t n, const double* x) {
  double check = 0.0;
  for (std::size_t i = 0; i < n; ++i) check += 0.0 * x[i];
  return check == 0.0;
}

/// w = 1 / (relative |y| + absolute), place by place: an error times w is at most 1 if it is tolerated.
inline void tolerance_weights(std::size_t n, double relative, const double* y, const double* absolute,
                              double* w) {
  for (std::size_t i = 0; i < n; ++i) w[i] = 1.0 / (relative * std::abs(y[i]) + absolute[i]);
}

/// z = sum of c[j] x(j), j < count. `x` gives the array of vector j.
template <class Arrays>
void combine(std::size_t n, std::size_t count, const double* c, Arrays&& x, double* z) {
  std::size_t i = 0;
  for (; i + 4 <= n; i += 4) {  // as many as stay in registers
    std::array<double, 4> sum;
    const double* first = x(std::size_t{0}) + i;
    for (std::size_t k = 0; k < 4; ++k) sum[k] = c[0] * first[k];
    for (std::size_t j = 1; j < count; ++j) {
      const double* next = x(j) + i;
      for (std::size_t k = 0; k < 4; ++k) sum[k] += c[j] * next[k];
    }
    for (std::size_t k = 0; k < 4; ++k) z[i + k] = sum[k];
  }
  for (; i < n; ++i) {
    double sum = c[0] * x(std::size_t{0})[i];
    for (std::size_t j = 1; j < count; ++j) sum += c[j] * x(j)[i];
    z[i] = sum;
  }
}

}  // namespace carom::sundials_loops
