#pragma once

// Long tests take a share of their seeds, and tests of many samples take fewer in builds with sanitizers.

#include <algorithm>
#include <cstdint>
#include <cstdlib>

namespace carom_test {

/// How many seeds a long test takes: its usual ones; all of them with CAROM_ALL_SEEDS in the environment;
/// with CAROM_QUARTER_OF_SEEDS, which .ci/run sets, the first quarter of the usual ones, but not fewer than
/// `least`: what is rare is not among a few.
inline std::uint64_t seeds(std::uint64_t usual, std::uint64_t all, std::uint64_t least = 4) {
  const auto given = [](const char* name) {
    return std::getenv(name) != nullptr;  // NOLINT(concurrency-mt-unsafe): nobody sets it
  };
  if (given("CAROM_ALL_SEEDS")) return all;
  return given("CAROM_QUARTER_OF_SEEDS") ? std::min(usual, std::max(least, usual / 4)) : usual;
}
/// Where the usual ones are all there are.
inline std::uint64_t seeds(std::uint64_t usual) { return seeds(usual, usual); }

/// Of a count of samples that tell something about numbers: all, but a fifth in a build with sanitizers,
/// which looks at memory and takes some twenty times as long.
constexpr int count_of_samples(int all) {
#if defined(__SANITIZE_ADDRESS__)
  return all / 5;
#elif defined(__has_feature)
  return __has_feature(address_sanitizer) ? all / 5 : all;
#else
  return all;
#endif
}

}  // namespace carom_test
