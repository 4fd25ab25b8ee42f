#pragma once

// What must hold of the energy account of every run.

#include <carom/carom.h>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace carom_test {

/// Round-off, as the library means it: 1e3 eps times the largest term.
inline testing::AssertionResult ledger_closes(const carom::EnergyLedger& energy) {
  const double residual = energy.residual();
  const double allowed = 1e3 * std::numeric_limits<double>::epsilon() * energy.scale();
  if (std::abs(residual) <= allowed) return testing::AssertionSuccess();
  return testing::AssertionFailure() << "residual " << residual << " J, allowed " << allowed << " J:\n"
                                     << energy;
}

}  // namespace carom_test
