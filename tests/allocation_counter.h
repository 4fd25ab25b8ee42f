#pragma once

// Counts what this executable and the libraries it uses take from operator new.

#include <cstdint>

namespace carom_test {

/// Calls of operator new so far, in all threads.
std::int64_t allocations();

}  // namespace carom_test
