#pragma once

/// \file
/// Memory that a benchmark and the libraries it uses take.

#include <cstdint>

namespace benchmarks {

/// Calls of operator new so far.
std::int64_t allocations();

/// Bytes in use, as the allocator counts them: whoever took them, Eigen's factors and SUNDIALS too.
std::int64_t live_bytes();

}  // namespace benchmarks
