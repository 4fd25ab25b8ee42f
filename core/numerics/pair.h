#pragma once

/// \file
/// Two numbers worked on at once, for the tight loops. Every instruction set the library is built for has
/// them, and each lane rounds as a number by itself does.

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>

namespace carom {

/// Two numbers side by side; + - * / and comparisons act lane by lane.
using Pair = double __attribute__((vector_size(16)));

/// Reads two neighbouring numbers.
inline Pair load_pair(const double* from) {
  Pair pair;
  std::memcpy(&pair, from, sizeof(Pair));
  return pair;
}
/// Writes two neighbouring numbers.
inline void store_pair(double* to, Pair pair) { std::memcpy(to, &pair, sizeof(Pair)); }
/// Reads two neighbouring numbers that are kept with the digits of a float.
inline Pair load_pair(const float* from) { return Pair{from[0], from[1]}; }
/// Writes two neighbouring numbers with the digits of a float.
inline void store_pair(float* to, Pair pair) {
  to[0] = static_cast<float>(pair[0]);
  to[1] = static_cast<float>(pair[1]);
}
/// A pair of the same number twice.
inline Pair both(double number) { return Pair{number, number}; }
/// First numbers of two pairs.
inline Pair firsts(Pair a, Pair b) { return Pair{a[0], b[0]}; }
/// Second numbers of two pairs.
inline Pair seconds(Pair a, Pair b) { return Pair{a[1], b[1]}; }
/// Square roots.
inline Pair root(Pair a) { return Pair{std::sqrt(a[0]), std::sqrt(a[1])}; }
/// Magnitudes.
inline Pair magnitude(Pair a) {
  using Bits = std::int64_t __attribute__((vector_size(16)));
  return std::bit_cast<Pair>(std::bit_cast<Bits>(a) & Bits{INT64_MAX, INT64_MAX});
}
/// Larger ones; `b` where a lane of `a` is no number.
inline Pair larger(Pair a, Pair b) { return a > b ? a : b; }
/// `a` where `test` is not zero (or no number), else zero.
inline Pair where_not_zero(Pair test, Pair a) {
  using Bits = std::int64_t __attribute__((vector_size(16)));
  return std::bit_cast<Pair>(std::bit_cast<Bits>(a) & std::bit_cast<Bits>(test != both(0.0)));
}

/// Neumaier's compensated sum (core/numerics/compensated_sum.h) in two lanes, without a branch.
class PairSum {
public:
  /// Adds a term to each lane.
  void add(Pair term) {
    const Pair total = sum_ + term;
    const Pair taken = total - sum_;
    correction_ += (sum_ - (total - taken)) + (term - taken);
    sum_ = total;
  }
  /// Adds another sum.
  void add(const PairSum& other) {
    add(other.sum_);
    correction_ += other.correction_;
  }
  /// Sum of the two lanes.
  [[nodiscard]] double value() const { return (sum_[0] + sum_[1]) + (correction_[0] + correction_[1]); }
  /// Sum of the two lanes, without the rounding error of adding them.
  [[nodiscard]] double accurate_value() const {
    const double total = sum_[0] + sum_[1], taken = total - sum_[0];
    const double lost = (sum_[0] - (total - taken)) + (sum_[1] - taken);
    return total + (lost + (correction_[0] + correction_[1]));
  }

private:
  Pair sum_{};
  Pair correction_{};
};

}  // namespace carom
