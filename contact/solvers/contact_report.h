#pragma once

/// \file
/// Report on the answer to a contact problem.

#include <carom/contact/solvers/chain_statistics.h>
#include <carom/contact/solvers/contact_solver.h>
#include <carom/core/export.h>

#include <cstdint>
#include <limits>
#include <string_view>

namespace carom {

/// An answer with a residual up to this is taken at once. Direct solvers reach 1e-15 to 1e-13; the rest is
/// room for problems of condition 1e3 more.
inline constexpr double accepted_residual = 1e-12;

/// When no solver came below accepted_residual, the best answer is taken if its residual is up to this.
/// The iterative last resort stops there; 1e-10 of the impulse scale is still far below any step's error.
inline constexpr double tolerated_residual = 1e-10;

/// Report on one contact problem, solved or not.
struct ContactReport {
  Outcome outcome = Outcome::not_solved;
  bool degenerate = false;  ///< the answer stands at a boundary between modes
  double residual = std::numeric_limits<double>::infinity();  ///< relative, of the impulses (residual.h)
  int worst_group = -1;                                       ///< group where the residual is taken
  int iterations = 0;                                         ///< pivots and sweeps of all solvers tried
  std::uint8_t tried = 0;                                     ///< bit i: SolverId i was tried
  std::string_view solver{};  ///< whose answer or proof it is; empty only for a problem without rows
  std::string_view reason{};  ///< static text: why not solved

  /// Whether the impulses may be used: every outcome but no_solution and not_solved.
  [[nodiscard]] bool usable() const {
    return outcome != Outcome::no_solution && outcome != Outcome::not_solved;
  }
  /// Whether a solver was tried.
  [[nodiscard]] bool was_tried(SolverId id) const { return (tried >> static_cast<unsigned>(id) & 1u) != 0; }
};

/// Adds a problem that was asked of a chain. \param best whose answer it is \param applicable solvers tried
/// that are made for it
void count(const ContactReport& report, SolverId best, int applicable, ChainStatistics& statistics);

}  // namespace carom
