// Problem: sums in which large terms cancel, right to the last digit.

#include <carom/core/numerics/accurate_dot.h>

#include <cmath>
#include <cstddef>

namespace carom {

namespace {

[[gnu::always_inline]] inline double dot_of(std::span<const double> a, std::span<const double> b,
                                            double start) {
  double sum = start, error = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const double product = a[i] * b[i];
    const double product_error = std::fma(a[i], b[i], -product);
    const double next = sum + product;
    const double part = next - sum;
    error += ((sum - (next - part)) + (product - part)) + product_error;
    sum = next;
  }
  return sum + error;
}

#if defined(__x86_64__) && defined(__GNUC__)
// The same arithmetic, and the same bits, where the machine has an instruction for fma: else it is a call.
[[gnu::target("fma")]] double dot_in_registers(std::span<const double> a, std::span<const double> b,
                                               double start) {
  return dot_of(a, b, start);
}
const bool has_fma = __builtin_cpu_supports("fma") != 0;
#else
constexpr bool has_fma = false;
double dot_in_registers(std::span<const double> a, std::span<const double> b, double start) {
  return dot_of(a, b, start);
}
#endif

}  // namespace

double accurate_dot(std::span<const double> a, std::span<const double> b, double start) {
  return has_fma ? dot_in_registers(a, b, start) : dot_of(a, b, start);
}

}  // namespace carom
