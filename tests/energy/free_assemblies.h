#pragma once

// Bodies in free flight, joined by elements of every kind that keeps energy, and what must not change.

#include "tests/random.h"

#include <carom/carom.h>
#include <carom/core/assembly.h>

#include <algorithm>
#include <cmath>

namespace carom_test {

/// Quantities that are kept without loads from outside, about the origin.
struct Invariants {
  double energy = 0.0;
  carom::Vec<2> linear = carom::Vec<2>::Zero();
  double angular = 0.0;
};

inline Invariants invariants(const carom::Simulation& simulation) {
  using namespace carom;
  const Assembly& assembly = simulation.assembly();
  const State& state = simulation.state();
  std::vector<double> momentum(state.v.size());
  for (Index component = 0; component < assembly.components().size(); ++component) {
    assembly.for_bodies(component, [&](const BodyKind& kind, Range slots, Index, Index v, Index) {
      kind.apply_mass(slots, state.v.data() + v, momentum.data() + v);
    });
  }
  Invariants sum;
  sum.energy = simulation.energy().total();
  for (const BodySlot& slot : assembly.layout()->bodies()) {
    const double* x = state.q.data() + slot.q;
    const double* p = momentum.data() + slot.v;
    sum.linear += Vec<2>(p[0], p[1]);
    sum.angular += x[0] * p[1] - x[1] * p[0] + (slot.v_size == 3 ? p[2] : 0.0);
  }
  return sum;
}

/// Largest departures from the start during a run.
struct Departure {
  double energy = 0.0, linear = 0.0, angular = 0.0;
  double least_loss = 0.0;  // the smallest growth of the dashpots' loss in a step
};

inline Departure departure(carom::Simulation& simulation, int steps) {
  using namespace carom;
  const Invariants start = invariants(simulation);
  Departure largest;
  double lost = simulation.energy().flow(EnergyFlow::dashpot);
  for (int i = 0; i < steps; ++i) {
    simulation.step();
    const Invariants now = invariants(simulation);
    const double loss = simulation.energy().flow(EnergyFlow::dashpot);
    largest.least_loss = std::min(largest.least_loss, loss - lost);
    lost = loss;
    largest.energy = std::max(largest.energy, std::abs(now.energy + lost - start.energy));
    largest.linear = std::max(largest.linear, (now.linear - start.linear).norm());
    largest.angular = std::max(largest.angular, std::abs(now.angular - start.angular));
  }
  return largest;
}

}  // namespace carom_test
