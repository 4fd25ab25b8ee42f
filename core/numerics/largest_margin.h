#pragma once

/// \file
/// The point at which the least of many affine functions is largest: a linear program of few unknowns.

#include <carom/core/export.h>

#include <cstddef>
#include <span>
#include <vector>

namespace carom {

/// Maximises min_i (a_i + s_i . x) over x, up to a bound: the simplex method on the dual program
///
///     least sum_i a_i y_i + bound y_b,   sum_i s_i y_i = 0,   sum_i y_i + y_b = 1,   y >= 0
///
/// (Dantzig; with the rule of Bland 1977 where it could cycle), whose basis has one row more than there are
/// unknowns, however many lines there are. It begins at x = 0 with the margin at the bound, and takes the
/// lowest line in. Unknowns that no line needs stay 0. Keeps its memory between calls.
class CAROM_API LargestMargin {
public:
  /// Forgets all lines. \param unknowns size of x
  void start(std::size_t unknowns);
  /// Adds a line a + s . x; its slopes s are to be written, by unknown. Valid until the next line.
  [[nodiscard]] std::span<double> add(double at);
  /// Number of lines.
  [[nodiscard]] std::size_t lines() const { return at_.size(); }
  /// Solves. \param bound of the margin, larger than it need be. False where pivots do not end; x is then of
  /// no use.
  [[nodiscard]] bool solve(double bound);

  /// The point.
  [[nodiscard]] std::span<const double> x() const { return x_; }
  /// Multipliers y_i >= 0 by line, which sum up to 1 with that of the bound: lines with a positive one are at
  /// the least in every solution.
  [[nodiscard]] std::span<const double> multipliers() const { return multipliers_; }

private:
  void begin_at_bound(double bound);
  void find_point();
  void polish_inverse();
  [[nodiscard]] std::size_t lowest(bool first) const;
  void write_column(std::size_t variable, std::span<double> column) const;
  [[nodiscard]] bool exchange(std::size_t entering, bool first);

  std::size_t unknowns_ = 0;
  std::vector<double> at_, slopes_;  // of lines
  // Variables: lines, the bound behind them, then one that stays 0 for each unknown that no line determines.
  std::vector<std::size_t> basic_;
  std::vector<double> inverse_;                    // of the basis, by rows
  std::vector<double> column_, change_, product_;  // scratch
  std::vector<double> x_, multipliers_;
  double bound_ = 0.0, margin_ = 0.0, rounding_ = 0.0;
};

}  // namespace carom
