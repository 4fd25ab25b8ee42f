#pragma once

/// \file
/// Anderson's acceleration of a fixed-point iteration x -> g(x): the next guess combines the last few,
///     x' = g_n - sum_j c_j (g_j+1 - g_j),   c minimises |f_n - sum_j c_j (f_j+1 - f_j)|,   f = g - x,
/// in a weighted norm (D. G. Anderson, J. ACM 12 (1965) 547-560).

#include <carom/core/export.h>

#include <cstddef>
#include <span>
#include <vector>

namespace carom {

/// Remembers the last few iterates of one iteration. Allocates only while problems grow.
class CAROM_API AndersonAcceleration {
public:
  /// Number of differences that are combined.
  static constexpr std::size_t depth = 5;

  /// Starts a new iteration of `size` numbers.
  void start(std::size_t size);
  /// Takes x and g(x), writes the next guess over x. `weights` scale the components of f in the norm.
  void next(std::span<double> x, std::span<const double> g, std::span<const double> weights);

private:
  std::size_t size_ = 0;
  std::size_t known_ = 0;  // iterates seen since start()
  std::vector<double> f_, g_;
  std::vector<double> f_steps_, g_steps_;  // ring of `depth` differences each
};

}  // namespace carom
