#pragma once

/// \file
/// Many runs in one program, on several threads: sweeps and random draws that stay in C++.

#include <carom/core/export.h>

#include <cstddef>
#include <exception>
#include <functional>
#include <string>
#include <vector>

namespace carom {

/// A run that has thrown.
struct RunFailure {
  std::size_t run = 0;        ///< its number
  std::string message;        ///< of the exception; empty if it is none of std::exception
  std::exception_ptr thrown;  ///< what it has thrown
};

/// Calls f(0), ..., f(count - 1), each once, in any order on several threads. Runs that share nothing but
/// what they read have the same bits for any number of threads: each makes its own Simulation, with one
/// thread, and writes into a place of its own. Returns the runs that have thrown, by their numbers; the
/// others are made all the same. Throws ModelError for less than one thread, and for several where the
/// library was built without oneTBB. \param threads at most so many at once
CAROM_API std::vector<RunFailure> for_each_run(std::size_t count, int threads,
                                               const std::function<void(std::size_t)>& f);

}  // namespace carom
