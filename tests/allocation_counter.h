#pragma once

// Counts what this executable and the libraries it uses take from operator new.

#include <cstdint>

namespace carom_test {

/// Calls of operator new so far, in all threads.
std::int64_t allocations();

/// Memory taken from operator new and not given back, as the allocator counts it [bytes].
std::int64_t bytes_in_use();

}  // namespace carom_test
