#pragma once

/// \file
/// The trace of a run: the energy ledger, the momenta and the largest violation of a constraint at chosen
/// times, and the events between them. A value that can be saved, loaded and compared (trace_comparison.h).

#include <carom/core/energy_term.h>
#include <carom/core/export.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <iosfwd>
#include <string>
#include <string_view>
#include <vector>

namespace carom {

/// Quantity that a number of a trace measures.
enum class Quantity : std::uint8_t { time, energy, momentum, angular_momentum, length };

/// Unit of a quantity: "s", "J", "N s", "N m s", "m".
[[nodiscard]] CAROM_API std::string_view unit(Quantity quantity);

/// A run at one time. Each quantity has a scale: the largest number that entered it so far, which determines
/// its rounding error. (The total momentum of two bodies that fly apart is zero up to rounding of the size of
/// the momentum of one body.)
struct TraceRow {
  double time = 0.0;          ///< [s]
  StoredEnergies stored{};    ///< [J]
  double total = 0.0;         ///< sum of the stored energies [J]
  double initial = 0.0;       ///< total when the ledger was opened [J]
  EnergyFlows flows{};        ///< flows since the ledger was opened [J]
  double residual = 0.0;      ///< residual of the ledger [J]
  double energy_scale = 0.0;  ///< largest term of the ledger so far [J]

  std::array<double, 3> momentum{};          ///< x, y, z (0 in the plane) [N s]
  double momentum_scale = 0.0;               ///< largest part that one body had [N s]
  std::array<double, 3> angular_momentum{};  ///< about the origin; in the plane only z [N m s]
  double angular_momentum_scale = 0.0;       ///< largest part that one body had [N m s]

  double penetration = 0.0;   ///< deepest of a contact since the row before, >= 0 [m]
  double joint_error = 0.0;   ///< largest of a joint since the row before; 0 without joints [m]
  double length_scale = 0.0;  ///< largest coordinate of a body [m]

  /// Scale of a quantity; that of time is 0.
  [[nodiscard]] CAROM_API double scale(Quantity quantity) const;
};

/// One number of a row.
struct TraceTerm {
  std::string_view name;  ///< "kinetic", "impact_normal", "momentum_x", "energy_scale", ...
  Quantity quantity;      ///< what it measures
  bool is_scale;          ///< true for the scales
};
/// How many numbers a row has.
inline constexpr std::size_t trace_term_count = 16 + stored_energy_count + energy_flow_count;

/// The numbers of a row, in the order of files.
[[nodiscard]] CAROM_API const std::array<TraceTerm, trace_term_count>& trace_terms();
/// Values of a row, in the order of trace_terms().
[[nodiscard]] CAROM_API std::array<double, trace_term_count> values_of(const TraceRow& row);
/// The row of some values, in the order of trace_terms().
[[nodiscard]] CAROM_API TraceRow row_of(const std::array<double, trace_term_count>& values);

/// An event at one time, e.g. an impact.
struct TraceEvent {
  double time = 0.0;   ///< [s]
  std::string text{};  ///< e.g. "particle 'lower' on half-plane 'plane', slip+"
};

/// Rows and events of one run, each in the order of time.
class CAROM_API EnergyTrace {
public:
  /// Appends a row. Throws ModelError, naming time and term, for a number that is not finite or a time that
  /// is not later than that of the row before.
  void add(const TraceRow& row);
  /// Appends an event. Throws ModelError for a time that is not finite or before that of the event before,
  /// or without a text.
  void add(TraceEvent event);

  [[nodiscard]] const std::vector<TraceRow>& rows() const { return rows_; }        ///< by time
  [[nodiscard]] const std::vector<TraceEvent>& events() const { return events_; }  ///< by time
  /// Values of one term, row by row. Throws ModelError for a name that is not in trace_terms().
  [[nodiscard]] std::vector<double> values(std::string_view term) const;
  /// The event nearest to a time (of two, the earlier one); null if there is none.
  [[nodiscard]] const TraceEvent* nearest_event(double time) const;

  /// Saves as comma-separated values, digits exact: a header "time [s],kinetic [J],...,event", a line for
  /// each row, and among them, by time, a line for each event, of which only time and event are not empty.
  /// Throws FileError if the file cannot be written.
  void save(const std::string& path) const;
  /// Loads what save() wrote; columns may be in any order. Throws FileError, naming file, line, column and
  /// what is allowed, for a file that is cut off, lacks a column or has an unknown one, or has a number that
  /// is not finite or times out of order.
  [[nodiscard]] static EnergyTrace load(const std::string& path);

private:
  std::vector<TraceRow> rows_;
  std::vector<TraceEvent> events_;
};

/// Writes one line: how many rows and events, from when to when.
CAROM_API std::ostream& operator<<(std::ostream& out, const EnergyTrace& trace);

}  // namespace carom
