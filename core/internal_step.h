#pragma once

/// \file
/// Internal variables over a step, the motion given:  z1 = z0 + (h/2) (r(t0, z0) + r(t1, z1)),  solved by
/// Newton's method with difference derivatives, so that fast variables set no limit to the step.

#include <carom/core/export.h>
#include <carom/core/function_ref.h>

#include <array>
#include <cstddef>

namespace carom {

/// Rates of internal variables z at the end of a step, r(t1, z).
using InternalRates = FunctionRef<void(const double* z, double* rates)>;

/// Numbers of memory that advance_trapezoidal() works with. \param count internal variables
[[nodiscard]] constexpr std::size_t trapezoidal_memory(std::size_t count) { return count * (count + 3); }

/// Solves for `z` (in: a guess). Returns false if the iteration does not settle. \param step h [s] \param z0
/// variables at the start \param rates0 r(t0, z0) \param rates_at_end may read `z` through other ways too,
/// since z is the memory that is being changed \param number of variables
/// \param memory trapezoidal_memory(number) numbers
[[nodiscard]] CAROM_API bool advance_trapezoidal(double step, const double* z0, const double* rates0,
                                                 InternalRates rates_at_end, double* z, std::size_t number,
                                                 double* memory);

/// Solves for the N internal variables `z` at the end of a step (in: a guess), in memory of its own. Returns
/// false if the iteration does not converge. \param step h [s] \param z0 variables at the start
/// \param rates0 r(t0, z0) \param rates_at_end may read `z` through other ways too
template <int N, class F>
[[nodiscard]] bool advance_trapezoidal(double step, const double* z0, const double* rates0, F&& rates_at_end,
                                       double* z) {
  constexpr auto count = static_cast<std::size_t>(N);
  std::array<double, trapezoidal_memory(count)> memory;
  return advance_trapezoidal(step, z0, rates0, rates_at_end, z, count, memory.data());
}

}  // namespace carom
