// Piles of discs in a box, the contact problem alone: `ms` of processor time a step, `sweeps` a step, and the
// worst `residual`; once settled, and while they collapse. Positions are moved by the benchmark
// (tests/contact/disc_pile.h), which is not timed.

#include <carom/contact/solvers/solver_chain.h>

#include "tests/contact/disc_pile.h"

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <ctime>

namespace {

using carom::SolverChain;
using carom::contact_test::DiscPile;
using carom::contact_test::PileOptions;

// A box in which the pile becomes about as high as it is wide.
DiscPile make_pile(int discs) {
  return DiscPile({.discs = discs, .width = 0.04 * std::sqrt(static_cast<double>(discs))});
}

double processor_time() {
  std::timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

void measure(benchmark::State& state, DiscPile& pile) {
  SolverChain chain;
  double time = 0.0, sweeps = 0.0, worst = 0.0, contacts = 0.0;
  for (auto _ : state) {
    pile.state();
    const double begin = processor_time();
    chain.solve(pile.problem(), pile.solution());
    const double took = processor_time() - begin;
    state.SetIterationTime(took);
    time += took;
    const carom::ContactReport& report = pile.solution().report;
    sweeps += report.iterations;
    worst = std::max(worst, report.residual);
    contacts += static_cast<double>(pile.problem().groups().size());
    pile.move();
  }
  const auto steps = static_cast<double>(state.iterations());
  state.counters["ms"] = 1e3 * time / steps;
  state.counters["sweeps"] = sweeps / steps;
  state.counters["residual"] = worst;
  state.counters["contacts"] = contacts / steps;
}

void settled(benchmark::State& state) {
  DiscPile pile = make_pile(static_cast<int>(state.range(0)));
  SolverChain chain;
  chain.set_budget({.sweeps = 200});
  int rested = 0;  // steps whose answer was reached early
  for (int step = 0; step < 6000 && rested < 200; ++step) {
    rested = pile.step(chain).iterations <= 10 && step > 100 ? rested + 1 : 0;
  }
  measure(state, pile);
}

void collapse(benchmark::State& state) {
  DiscPile pile = make_pile(static_cast<int>(state.range(0)));
  SolverChain chain;
  for (int step = 0; step < 400; ++step) pile.step(chain);
  measure(state, pile);
}

BENCHMARK(settled)->Arg(100)->Arg(500)->Arg(2000)->Arg(10000)->UseManualTime()->Iterations(500);
BENCHMARK(collapse)->Arg(100)->Arg(500)->Arg(2000)->Arg(10000)->UseManualTime()->Iterations(200);

}  // namespace
