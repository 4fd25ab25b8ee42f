#pragma once

/// \file
/// Do two traces of a run agree? And where not: which term departs first, when, by how much, near what?

#include <carom/core/energy_trace.h>
#include <carom/core/export.h>

#include <cstddef>
#include <iosfwd>
#include <optional>
#include <string>
#include <vector>

namespace carom {

/// Allowed difference between a trace and the stored one. A term may differ by its absolute tolerance plus
/// `relative` times the scale of its quantity in the stored trace at that time (TraceRow::scale()). The
/// tolerance is relative to the scale and not to the term: a small term, such as the friction loss beside a
/// large kinetic energy, is computed from large numbers and has their rounding errors.
struct TraceTolerances {
  double relative = 0.0;          ///< of the scale of the quantity, >= 0
  double energy = 0.0;            ///< absolute, >= 0 [J]
  double momentum = 0.0;          ///< absolute, >= 0 [N s]
  double angular_momentum = 0.0;  ///< absolute, >= 0 [N m s]
  double length = 0.0;            ///< absolute, >= 0 [m]
};

/// Two times this close, relative to the larger, are the same: steps that end "exactly there" do so within
/// the rounding of sums of steps.
inline constexpr double same_time = 1e-12;

/// One term at one time.
struct TermDifference {
  double time = 0.0;     ///< [s]
  double value = 0.0;    ///< in the trace, in the unit of the term
  double stored = 0.0;   ///< in the stored trace
  double allowed = 0.0;  ///< how far they may be apart

  /// |value - stored|.
  [[nodiscard]] CAROM_API double amount() const;
  /// Amount divided by the allowed difference: 0 where the two are equal, infinite where no difference is
  /// allowed.
  [[nodiscard]] CAROM_API double ratio() const;
};

/// How one term compares.
struct TermComparison {
  TraceTerm term{};
  TermDifference worst{};                 ///< where the ratio is largest (the first such time)
  std::optional<TermDifference> first{};  ///< the first that is not allowed, if there is one
};

/// How two traces compare.
struct TraceComparison {
  std::vector<TermComparison> terms{};  ///< every term but time and scales, in the order of trace_terms()
  /// Place in `terms` of the one that departs first (of several at one time, the one with the largest ratio);
  /// none if every term is within its tolerance at every time.
  std::optional<std::size_t> first{};
  /// For people: the first departure with the nearest events, and a table of the terms that depart.
  std::string report{};

  /// True if no term departs.
  [[nodiscard]] bool agree() const { return !first; }
};

/// Compares term by term, row by row. Throws ModelError for tolerances that are negative or not finite, for
/// traces without rows, and for traces that were not taken at the same times (within `same_time`): values are
/// not interpolated.
[[nodiscard]] CAROM_API TraceComparison compare(const EnergyTrace& trace, const EnergyTrace& stored,
                                                const TraceTolerances& tolerances);

/// Writes the report.
CAROM_API std::ostream& operator<<(std::ostream& out, const TraceComparison& comparison);

}  // namespace carom
