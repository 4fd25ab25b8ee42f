#pragma once

// Long tests take a share of their samples; CAROM_ALL_SEEDS in the environment makes them take all. So do
// tests of many samples in builds with sanitizers.

#include <cstdlib>

namespace carom_test {

/// Whether all are asked for.
inline bool all_seeds() {
  return std::getenv("CAROM_ALL_SEEDS") != nullptr;  // NOLINT(concurrency-mt-unsafe): nobody sets it
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
