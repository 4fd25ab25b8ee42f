#pragma once

// Random input with a fixed seed, so that a failure comes back.

#include <carom/core/space.h>

#include <cstdint>
#include <random>

namespace carom_test {

class Random {
public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}

  double uniform(double lower, double upper) {
    return std::uniform_real_distribution<double>(lower, upper)(engine_);
  }
  unsigned below(unsigned bound) { return std::uniform_int_distribution<unsigned>(0, bound - 1)(engine_); }
  std::uint64_t bits() { return engine_(); }

  template <int D>
  carom::Vec<D> vec(double size = 1.0) {
    carom::Vec<D> result;
    for (int i = 0; i < D; ++i) result[i] = uniform(-size, size);
    return result;
  }

private:
  std::mt19937_64 engine_;
};

}  // namespace carom_test
