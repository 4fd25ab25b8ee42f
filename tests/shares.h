#pragma once

// Long tests take a share of their seeds, or others than usual, and tests of many samples take fewer in
// builds with sanitizers.

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <string>

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

/// Seeds from `first` to one before `last`.
struct SeedRange {
  std::uint64_t first, last;
  [[nodiscard]] int count() const { return static_cast<int>(last - first); }
};

/// So many from a first one, of a long test. With a number as CAROM_SEEDS_AHEAD in the environment they are
/// those so far ahead: scenes that nobody has seen find faults that the usual ones do not.
inline SeedRange seeds_from(std::uint64_t first, std::uint64_t usual, std::uint64_t all,
                            std::uint64_t least = 4) {
  const char* const ahead = std::getenv("CAROM_SEEDS_AHEAD");  // NOLINT(concurrency-mt-unsafe): as above
  if (ahead != nullptr) first += std::stoull(ahead);
  return {first, first + seeds(usual, all, least)};
}
inline SeedRange seeds_from(std::uint64_t first, std::uint64_t usual) {
  return seeds_from(first, usual, usual);
}

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
