#pragma once

// Long tests take a share of their seeds, or others than usual, and tests of many samples take fewer in
// builds with sanitizers.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <initializer_list>
#include <string>
#include <vector>

namespace carom_test {

inline bool in_environment(const char* name) {
  return std::getenv(name) != nullptr;  // NOLINT(concurrency-mt-unsafe): nobody sets it
}

/// Whether long tests take a part of what they repeat.
inline bool takes_a_quarter() {
  return in_environment("CAROM_QUARTER_OF_SEEDS") && !in_environment("CAROM_ALL_SEEDS");
}

/// Whether a long test takes a case of its list: each, but where tests take a part the third, the sixth, and
/// so on. In a table whose rows are of four or five such cases are in every column.
inline bool is_taken(int place) { return !takes_a_quarter() || place % 3 == 2; }

/// How many seeds a long test takes: its usual ones; all of them with CAROM_ALL_SEEDS in the environment;
/// with CAROM_QUARTER_OF_SEEDS, which .ci/run sets, the first quarter of the usual ones, but not fewer than
/// `least`: what is rare is not among a few.
inline std::uint64_t seeds(std::uint64_t usual, std::uint64_t all, std::uint64_t least = 4) {
  if (in_environment("CAROM_ALL_SEEDS")) return all;
  return takes_a_quarter() ? std::min(usual, std::max(least, usual / 4)) : usual;
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

/// Whether this build has sanitizers, which look at memory and take some twenty times as long.
#if defined(__SANITIZE_ADDRESS__)
inline constexpr bool with_sanitizers = true;
#elif defined(__has_feature)
inline constexpr bool with_sanitizers = __has_feature(address_sanitizer);
#else
inline constexpr bool with_sanitizers = false;
#endif

/// A number by which a test repeats something: the usual one, or another one with sanitizers, for fewer runs.
template <typename Number>
constexpr Number usual_or(Number usual, Number sanitized) {
  return with_sanitizers ? sanitized : usual;
}

/// Of a count of samples that tell something about numbers: all, but a fifth with sanitizers.
template <typename Number>
constexpr Number count_of_samples(Number all) {
  return usual_or(all, all / 5);
}

/// Of values that a test goes through: all, but with sanitizers the first and every `nth` after it.
template <typename Value>
std::vector<Value> samples(std::initializer_list<Value> all, std::size_t nth = 2) {
  std::vector<Value> taken;
  const std::size_t apart = usual_or(std::size_t{1}, nth);
  for (std::size_t i = 0; i < all.size(); i += apart) taken.push_back(all.begin()[i]);
  return taken;
}

}  // namespace carom_test
