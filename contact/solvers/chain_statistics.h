#pragma once

/// \file
/// Which contact solvers there are, and how often each was asked and believed.

#include <carom/core/export.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <iosfwd>
#include <string_view>

namespace carom {

/// Solvers in the order in which a report counts them.
enum class SolverId : std::uint8_t {
  single_contact,
  principal_pivoting,
  lemke,
  dense_sweeps,  ///< of problems with discs, or of many rows
  enumeration,
  nonlinear_cg  ///< of problems in factors only, and the only one of these
};

/// All solvers, in the order of SolverId.
inline constexpr std::array all_solvers{SolverId::single_contact, SolverId::principal_pivoting,
                                        SolverId::lemke,          SolverId::dense_sweeps,
                                        SolverId::enumeration,    SolverId::nonlinear_cg};

/// Number of solvers in SolverId.
inline constexpr std::size_t solver_count = all_solvers.size();

/// Names of the solvers, in the order of SolverId.
inline constexpr std::array<std::string_view, solver_count> solver_names{
    "single contact", "principal pivoting", "Lemke", "dense sweeps", "enumeration", "nonlinear CG"};

/// Name of a solver.
[[nodiscard]] CAROM_API std::string_view to_string(SolverId solver);

/// Residuals by which answers are counted.
inline constexpr std::array certified_residuals{1e-12, 1e-10, 1e-8};

/// Counts since construction or reset.
struct ChainStatistics {
  std::int64_t problems = 0;                          ///< problems solved or not
  std::array<std::int64_t, solver_count> accepted{};  ///< answers used, by solver
  std::array<std::int64_t, solver_count> tried{};     ///< attempts, by solver
  std::int64_t fall_backs = 0;                        ///< problems whose first solver was not accepted
  std::int64_t tolerated =
      0;  ///< answers above accepted_residual that were used, but of sweeps over large problems
  std::int64_t several_solutions = 0;  ///< outcomes by name
  std::int64_t forces_not_unique = 0;
  std::int64_t degenerate = 0;
  std::int64_t no_solution = 0;
  std::int64_t not_solved = 0;
  std::int64_t accepted_at_cap = 0;
  /// Answers used, by residual: up to each of certified_residuals and above the one before it, then those
  /// above all.
  std::array<std::int64_t, certified_residuals.size() + 1> certified{};
  double worst_residual = 0.0;  ///< largest residual of an answer that was used

  /// Counts the residual of an answer that was used.
  void count_residual(double residual) {
    std::size_t place = 0;
    while (place < certified_residuals.size() && residual > certified_residuals[place]) ++place;
    ++certified[place];
    if (residual > worst_residual) worst_residual = residual;
  }
  /// Adds the counts of others; the worst residual is the larger one.
  CAROM_API ChainStatistics& operator+=(const ChainStatistics& other);
  friend bool operator==(const ChainStatistics&, const ChainStatistics&) = default;
};

/// Writes the counts as a table; outcomes that never came are left out.
CAROM_API std::ostream& operator<<(std::ostream& out, const ChainStatistics& statistics);

}  // namespace carom
