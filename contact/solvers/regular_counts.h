#pragma once

/// \file
/// Counts of regular contacts, which are all that most steps have.

#include <carom/contact/solvers/chain_statistics.h>
#include <carom/contact/solvers/contact_report.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace carom {

/// Counts of answers of solve_regular_contact() that were used: all of one solver, and with residuals of the
/// first class.
struct RegularCounts {
  std::int64_t problems = 0;    ///< one contact each
  std::int64_t degenerate = 0;  ///< answers that stand at a boundary between modes
  double worst_residual = 0.0;  ///< largest certificate

  /// Counts a problem.
  void count(double residual, bool is_degenerate) {
    ++problems;
    degenerate += is_degenerate ? 1 : 0;
    worst_residual = std::max(worst_residual, residual);
  }
  /// Adds the counts of other problems.
  void add(const RegularCounts& other) {
    problems += other.problems;
    degenerate += other.degenerate;
    worst_residual = std::max(worst_residual, other.worst_residual);
  }
  /// Adds the counts to those of all solvers.
  void add_to(ChainStatistics& sum) const {
    static_assert(accepted_residual <= certified_residuals[0]);
    constexpr auto id = static_cast<std::size_t>(SolverId::single_contact);
    sum.problems += problems;
    sum.tried[id] += problems;
    sum.accepted[id] += problems;
    sum.certified[0] += problems;
    sum.degenerate += degenerate;
    sum.worst_residual = std::max(sum.worst_residual, worst_residual);
  }
};

}  // namespace carom
