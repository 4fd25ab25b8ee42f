#pragma once

/// \file
/// The point nearest to zero in an intersection of half-spaces.

#include <carom/core/export.h>

#include <cstddef>
#include <span>
#include <vector>

namespace carom {

/// Finds the least |x| with a_i + s_i . x >= 0 for all lines i, by the dual method of D. Goldfarb and A.
/// Idnani, Math. Program. 27 (1983) 1-33: lines are satisfied one after the other, the most violated first,
/// by those that they hold fast. The answer is continuous in a and S. Meant for a few unknowns. Keeps its
/// memory between calls.
class CAROM_API LeastDistance {
public:
  /// \param at a, positive where zero satisfies a line
  /// \param slopes s_i, one after the other, of the size of x
  /// \param noise of a: violations up to it are none
  /// \param x the answer; where no point satisfies all, the one nearest to zero that satisfies those before
  ///   the line that contradicts them
  /// Returns false where that is so.
  bool solve(std::span<const double> at, std::span<const double> slopes, double noise, std::span<double> x);

private:
  bool satisfy(std::size_t line, std::span<const double> at, std::span<const double> slopes,
               std::span<double> x);
  void split(const double* slope, std::span<const double> slopes, std::size_t size);

  std::vector<std::size_t> held_;      // lines that hold x
  std::vector<double> multipliers_;    // of them
  std::vector<double> basis_, upper_;  // orthonormal basis of their slopes, which are basis times upper
  std::vector<double> part_;           // of a slope by held ones
  std::vector<double> rest_;           // and what they leave of it
};

}  // namespace carom
