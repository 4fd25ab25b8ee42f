// Problem: sums in which large terms cancel, right to the last digit.

#include <carom/core/numerics/accurate_dot.h>

#include <cmath>
#include <cstddef>

namespace carom {

double accurate_dot(std::span<const double> a, std::span<const double> b, double start) {
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

}  // namespace carom
