#pragma once

/// \file
/// A look at a solver while it sweeps.

#include <functional>
#include <span>

namespace carom {

/// Called after every sweep with the impulses at hand, by row [N s]; empty: nobody looks. \param sweep from 1
using SweepWatch = std::function<void(int sweep, std::span<const double> impulse)>;

}  // namespace carom
