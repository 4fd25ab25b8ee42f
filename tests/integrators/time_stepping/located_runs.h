#pragma once

// Runs to the end whose accounts close, and how far apart two of them end: tests of located impacts against
// the event-driven mode.

#include "tests/energy/ledger_check.h"

#include <carom/carom.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <variant>

namespace carom_test {

inline carom::TimeStepping located(double step) {
  return {.step = step, .impacts = carom::ImpactTimes::located};
}

/// The state at the end; in time stepping the account must close.
inline carom::State run(const carom::System& system, const carom::Mode& mode, double end) {
  carom::Simulation simulation(system, mode);
  simulation.run_until(end);
  if (std::holds_alternative<carom::TimeStepping>(mode)) {
    EXPECT_TRUE(ledger_closes(simulation.energy()));
  }
  return simulation.state();
}

/// Largest difference of their coordinates.
inline double distance(const carom::State& a, const carom::State& b) {
  double largest = 0.0;
  for (std::size_t i = 0; i < a.q.size(); ++i) largest = std::max(largest, std::abs(a.q[i] - b.q[i]));
  return largest;
}

/// A floor under gravity.
inline void add_floor(carom::System& system, double friction, double e_n, double e_t) {
  constexpr double g = 9.81;
  system.add(carom::planar::Gravity{{0.0, -g}});
  system.add(carom::planar::HalfPlane{.normal = {0.0, 1.0}},
             carom::Surface{.friction = friction, .normal_restitution = e_n, .tangential_restitution = e_t},
             "floor");
}

}  // namespace carom_test
