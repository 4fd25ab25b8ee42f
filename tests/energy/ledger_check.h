#pragma once

// Checks of the energy ledger that every run must pass.

#include <carom/carom.h>
#include <carom/testing/trace_checks.h>

#include <gtest/gtest.h>

#include <limits>

namespace carom_test {

/// Round-off, as the library means it: 1e3 eps times the largest term.
inline constexpr double round_off = 1e3 * std::numeric_limits<double>::epsilon();

inline testing::AssertionResult ledger_closes(const carom::EnergyLedger& energy) {
  const carom::energy_test::Verdict verdict = carom::energy_test::check_ledger_closes(energy, round_off);
  return (verdict.holds ? testing::AssertionSuccess() : testing::AssertionFailure()) << verdict.text;
}

}  // namespace carom_test
