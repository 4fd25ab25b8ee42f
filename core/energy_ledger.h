#pragma once

/// \file
/// The energy ledger. Its flows are works of the impulses and forces that acted, never differences of the
/// total, so its residual checks the bookkeeping of the library.

#include <carom/core/energy_term.h>
#include <carom/core/export.h>
#include <carom/core/numerics/compensated_sum.h>

#include <array>
#include <iosfwd>

namespace carom {

/// Stored energies now, and flows of energy since the start:
///     stored = initial + sum of gains - sum of losses + residual.
class CAROM_API EnergyLedger {
public:
  /// Opens the ledger.
  void open(const StoredEnergies& stored);
  /// Books a step: the flows in the step, and the stored energies after it.
  void book(const EnergyFlows& flows, const StoredEnergies& stored);
  /// Adds the flows of another ledger, of some of the bodies, and takes its scale in; stored energies stay.
  void add_flows(const EnergyLedger& part);
  /// Books a step with one flow, and the stored energies after it. \param amount of the flow [J]
  void book(EnergyFlow flow, double amount, const StoredEnergies& stored);

  /// Stored energy of one form now [J].
  [[nodiscard]] double stored(StoredEnergy term) const { return stored_[term]; }
  /// All stored energies [J].
  [[nodiscard]] const StoredEnergies& stored() const { return stored_; }
  /// Kinetic energy [J].
  [[nodiscard]] double kinetic() const { return stored_[StoredEnergy::kinetic]; }
  /// Potential energy of all kinds [J].
  [[nodiscard]] double potential() const { return stored_.potential(); }
  /// Kinetic and potential energy [J].
  [[nodiscard]] double total() const { return stored_.total(); }
  /// Total when the ledger was opened [J].
  [[nodiscard]] double initial() const { return initial_; }
  /// One flow, summed since the start [J].
  [[nodiscard]] double flow(EnergyFlow term) const {
    return flows_[term_place(term, energy_flow_count)].value();
  }
  /// Sum of the losses since the start [J].
  [[nodiscard]] double lost() const;
  /// Residual [J], by the equation above: zero up to rounding if no term is missing.
  [[nodiscard]] double residual() const;
  /// The largest term that entered so far [J]; compare the residual with it.
  [[nodiscard]] double scale() const { return scale_; }

  /// All data needed to continue bit for bit, in a fixed order.
  static constexpr std::size_t saved_size = stored_energy_count + 2 + 2 * energy_flow_count;
  [[nodiscard]] std::array<double, saved_size> save() const;
  void load(const std::array<double, saved_size>& numbers);

private:
  void store(const StoredEnergies& stored);

  StoredEnergies stored_;
  double initial_ = 0.0;
  double scale_ = 0.0;
  std::array<CompensatedSum, energy_flow_count> flows_{};
};

/// Writes the terms that are not zero as a table.
CAROM_API std::ostream& operator<<(std::ostream& out, const EnergyLedger& ledger);

}  // namespace carom
