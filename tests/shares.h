#pragma once

// Long tests take a share of their samples; CAROM_ALL_SEEDS in the environment makes them take all.

#include <cstdlib>

namespace carom_test {

/// Whether all are asked for.
inline bool all_seeds() {
  return std::getenv("CAROM_ALL_SEEDS") != nullptr;  // NOLINT(concurrency-mt-unsafe): nobody sets it
}

}  // namespace carom_test
