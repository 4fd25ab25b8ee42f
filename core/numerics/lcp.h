#pragma once

/// \file
/// The plain linear complementarity problem, the meeting place of the pivoting methods.

#include <carom/core/export.h>

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace carom {

/// Find z >= 0 with w = q + M z >= 0 and w^T z = 0 (Johansson 1999, equation 12).
struct CAROM_API Lcp {
  int size = 0;
  std::vector<double> m;  ///< M, row-major, size x size
  std::vector<double> q;  ///< q, size

  /// Sizes the problem for `n` unknowns, all entries zero; keeps its memory.
  void reset(int n);

  /// Entry of M.
  [[nodiscard]] double& at(int row, int column) {
    return m[static_cast<std::size_t>(row) * static_cast<std::size_t>(size) +
             static_cast<std::size_t>(column)];
  }
  [[nodiscard]] double at(int row, int column) const {
    return m[static_cast<std::size_t>(row) * static_cast<std::size_t>(size) +
             static_cast<std::size_t>(column)];
  }
};

/// How a pivoting method ended.
enum class LcpStatus : std::uint8_t {
  solved,           ///< z solves the problem
  secondary_ray,    ///< Lemke: no row blocks; for copositive-plus M there is no solution
  pivot_bound,      ///< too many pivots (a cycle)
  vanishing_pivot,  ///< principal pivoting: the diagonal element to pivot on is zero
  inaccurate        ///< a basis was found, but what it gives is no solution: rounding has won
};

/// Name of a status: "solved", "secondary ray", "pivot bound", "vanishing pivot", "inaccurate".
[[nodiscard]] CAROM_API std::string_view to_string(LcpStatus status);

/// Answer of a pivoting method.
struct LcpAnswer {
  LcpStatus status = LcpStatus::inaccurate;
  int pivots = 0;
};

/// max_i |min(w_i / s_i, z_i / t)|, the natural residual, with t = max |z| and s_i = max(|q_i|, t max_j
/// |M_ij|) the size that the terms of row i can have (1 where that is zero). Infinite where a number is not
/// finite.
[[nodiscard]] CAROM_API double lcp_residual(const Lcp& problem, std::span<const double> z);

/// An LCP answer whose residual is larger is `inaccurate`: basic solutions are refined to a few roundings.
inline constexpr double lcp_accuracy = 1e-11;

}  // namespace carom
