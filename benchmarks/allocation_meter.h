#pragma once

/// \file
/// Memory that a benchmark and the libraries it uses take from operator new.

#include <cstdint>

namespace benchmarks {

/// Calls of operator new so far.
std::int64_t allocations();

/// Bytes asked for and not given back yet.
std::int64_t live_bytes();

}  // namespace benchmarks
