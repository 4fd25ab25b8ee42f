// Whole steps of time stepping for discs in a box: detection, contact, account and report.
//
// Names: settled/<N> for N discs that have come to rest (3 s), collapse/<N> for the second half of their
// fall. Counters: residual (the largest of the steps timed), contacts.

#include <carom/carom.h>

#include "examples/scenes/discs.h"

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>

namespace {

constexpr double step = 1e-3;  // [s]

/// A box as high as wide when it is full, of 2 m at most.
scenes::Discs scene(int count) {
  scenes::Discs discs{.count = count};
  discs.width = std::min(2.0, 0.1 * std::sqrt(static_cast<double>(count)));
  return discs;
}

void time_steps(benchmark::State& state, double from) {
  carom::System system;
  scenes::add_discs(system, scene(static_cast<int>(state.range(0))));
  carom::Simulation simulation(system, carom::TimeStepping{.step = step});
  simulation.run_until(from);
  double residual = 0.0;
  for (auto _ : state) {
    simulation.step();
    for (const carom::ContactRecord& contact : simulation.report().contacts) {
      residual = std::max(residual, contact.residual);
    }
  }
  state.counters["residual"] = residual;
  state.counters["contacts"] = static_cast<double>(simulation.report().contacts.size());
}

void settled(benchmark::State& state) { time_steps(state, 3.0); }
void collapse(benchmark::State& state) { time_steps(state, 0.4); }

// Steps go on in time: as many as are timed at rest, and of the collapse those of half a second.
BENCHMARK(settled)->Arg(100)->Arg(500)->Arg(2000)->Iterations(500)->Unit(benchmark::kMillisecond);
BENCHMARK(collapse)->Arg(100)->Arg(500)->Arg(2000)->Iterations(500)->Unit(benchmark::kMillisecond);

}  // namespace
