#pragma once

/// \file
/// The paper's pivoting rule for linear complementarity problems.

#include <carom/core/export.h>
#include <carom/core/numerics/lcp.h>
#include <carom/core/numerics/rank_revealing_qr.h>

#include <cstddef>
#include <span>
#include <vector>

namespace carom {

/// A diagonal element below this part of the largest entry of its row and column counts as vanishing.
inline constexpr double vanishing_pivot_threshold = 1e-11;

/// Principal pivoting (Johansson 1999, section 3): scan q from the first row down, exchange w_i and z_i at
/// the first q_i < 0, repeat until q >= 0. Ends for P-matrices; other matrices may cycle (pivot_bound) or ask
/// to divide by zero (vanishing_pivot), which it never does.
///
/// The solution is solved anew from the final set of exchanged rows and refined. Keeps its memory.
class CAROM_API PrincipalPivoting {
public:
  /// Writes z (size n). Statuses: solved (lcp_residual below lcp_accuracy), pivot_bound, vanishing_pivot,
  /// inaccurate; z is zero where it is not solved. Ends after `most_pivots` exchanges (0: 20 + 10 n).
  [[nodiscard]] LcpAnswer solve(const Lcp& problem, std::span<double> z, int most_pivots = 0);

private:
  void exchange(std::size_t index);
  [[nodiscard]] bool vanishes(std::size_t index) const;
  void read_solution(const Lcp& problem, std::span<double> z);

  std::size_t n_ = 0;
  std::vector<double> a_, q_, size_;
  std::vector<char> exchanged_;
  std::vector<double> system_, rhs_, unknown_;
  std::vector<std::size_t> support_;
  RankRevealingQr qr_;
};

}  // namespace carom
