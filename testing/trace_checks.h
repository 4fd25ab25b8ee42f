#pragma once

/// \file
/// Checks of a trace. A failed check reports where the failure begins, the nearest event, and the terms there
/// and in the row before.

#include <carom/core/energy_ledger.h>
#include <carom/core/energy_trace.h>
#include <carom/core/space.h>
#include <carom/testing/verdict.h>

#include <array>

namespace carom::energy_test {

/// A direction or a point, in the plane or in space.
struct Coordinates {
  Coordinates(double x, double y, double z = 0.0) : values{x, y, z} {}
  Coordinates(const Vec<2>& v) : values{v[0], v[1], 0.0} {}   // NOLINT(google-explicit-constructor)
  Coordinates(const Vec<3>& v) : values{v[0], v[1], v[2]} {}  // NOLINT(google-explicit-constructor)

  std::array<double, 3> values;  ///< x, y, z
};

/// Checks throw ModelError for a trace without rows, and for a tolerance that is negative or not finite.

/// In every row, the residual of the ledger is at most `relative` times the largest term so far; both the
/// residual that the ledger gave and the one that the recorded terms leave, which costs some 20 roundings
/// more. Rounding of a run is at most 1e3 eps = 2.2e-13.
[[nodiscard]] Verdict check_ledger_closes(const EnergyTrace& trace, double relative);

/// The residual of a given ledger is at most `relative` times its largest term; the verdict shows the ledger.
[[nodiscard]] Verdict check_ledger_closes(const EnergyLedger& ledger, double relative);

/// T + V - W_external - intervention in no row lies by more than `tolerance` [J] above its least value in the
/// rows before (so that a slow rise is found too).
[[nodiscard]] Verdict check_energy_never_rises(const EnergyTrace& trace, double tolerance);

/// The momentum along `direction` stays as in the first row, within `relative` times
/// TraceRow::momentum_scale. Throws ModelError for a direction that is zero or not finite.
[[nodiscard]] Verdict check_momentum_in(const EnergyTrace& trace, const Coordinates& direction,
                                        double relative);

/// The angular momentum about a fixed `point` [m] stays as in the first row, within `relative` times
/// (TraceRow::angular_momentum_scale + |point| TraceRow::momentum_scale). Time stepping keeps that of coupled
/// bodies up to an error of order h^2 only (docs/method.md, section 6).
[[nodiscard]] Verdict check_angular_momentum_about(const EnergyTrace& trace, const Coordinates& point,
                                                   double relative);

/// Neither penetration of contacts nor error of joints exceeds `metres` [m]. Time stepping detects an impact
/// up to one step late: a contact is as deep as (3 - e_n)/2 h v there.
[[nodiscard]] Verdict check_constraints_within(const EnergyTrace& trace, double metres);

}  // namespace carom::energy_test
