// The net (examples/scenes/net.h): time per particle of a plain explicit sweep, of the library's force
// evaluation and of its whole steps, converged to 1e-10; what a step allocates; storage per particle and
// spring.
//
// Names: <what>/<k> for k x k particles. `per_particle` is in seconds, over one sweep or step.

#include <carom/carom.h>
#include <carom/core/assembly.h>
#include <carom/core/workers.h>

#include "benchmarks/allocation_meter.h"
#include "benchmarks/plain_net.h"
#include "examples/scenes/net.h"

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <stdexcept>
#include <utility>

namespace {

using benchmarks::PlainNet;

// Motion of the net while its steps are timed.
enum class Phase {
  falling,     // free fall, no spring works
  working,     // free fall, springs stretched by 1 % at the start: it draws together from its border inwards
  by_default,  // the same with the options as they come
  resting      // lies with its lowest row along the plane
};

constexpr double tolerance = 1e-10;  // [m]
constexpr int settling = 10;         // steps before any is timed: by then guesses have their history
constexpr double longest = 0.02;     // then a run starts anew: what a step costs depends on when it is [s]

scenes::Net net_of(Phase phase, int k) {
  scenes::Net net{.k = k};
  if (phase == Phase::working || phase == Phase::by_default) net.prestress = 0.01;
  if (phase == Phase::resting) {
    net.tilt = net.slope;
    net.height = -1e-9;  // so that rounding of positions leaves no particle above the plane
  }
  return net;
}

carom::TimeStepping options_of(Phase phase) {
  carom::TimeStepping options{.step = scenes::net_step};
  if (phase != Phase::by_default) options.tolerance = tolerance;
  return options;
}

carom::System system_of(const scenes::Net& net) {
  carom::System system;
  add_net(system, net);
  return system;
}

// A simulation that can be set back to its start. Made once for each net: that takes longer than the timing.
struct Run {
  carom::Simulation simulation;
  carom::State begin;

  explicit Run(Phase phase, int k)
      : simulation(system_of(net_of(phase, k)), options_of(phase)), begin(simulation.state()) {
    settle();
  }
  void settle() {
    for (int i = 0; i < settling; ++i) simulation.step();
  }
  void restart() {
    simulation.set_state(begin);
    settle();
  }
};

Run& run(Phase phase, int k) {
  static std::map<std::pair<Phase, int>, std::unique_ptr<Run>> runs;
  auto& entry = runs[{phase, k}];
  if (!entry) entry = std::make_unique<Run>(phase, k);
  return *entry;
}

PlainNet& plain(int k) {
  static std::map<int, std::unique_ptr<PlainNet>> nets;
  auto& entry = nets[k];
  if (!entry) entry = std::make_unique<PlainNet>(net_of(Phase::working, k));
  return *entry;
}

void count_particles(benchmark::State& state, int k) {
  using benchmark::Counter;
  state.counters["per_particle"] =
      Counter(static_cast<double>(k) * k, Counter::kIsIterationInvariantRate | Counter::kInvert);
}

// Both sides compute the same, or their ratio says nothing.
void demand_equal_forces(const carom::Simulation& simulation, const carom::Evaluation& evaluation, int k) {
  PlainNet& net = plain(k);
  const PlainNet kept = net;
  net.q = simulation.state().q;
  net.v = simulation.state().v;
  benchmarks::plain_forces(net);
  double difference = 0.0, size = 0.0;
  for (std::size_t i = 0; i < net.force.size(); ++i) {
    difference = std::max(difference, std::abs(net.force[i] - evaluation.force[i]));
    size = std::max(size, std::abs(net.force[i]));
  }
  net = kept;
  if (!(difference <= 1e-12 * size)) throw std::logic_error("plain and library forces differ");
}

template <void (*Sweep)(PlainNet&, double)>
void time_plain(benchmark::State& state) {
  const int k = static_cast<int>(state.range(0));
  PlainNet& net = plain(k);
  for (auto _ : state) {
    Sweep(net, scenes::net_step);
    benchmark::ClobberMemory();
  }
  count_particles(state, k);
}

void plain_sweep(benchmark::State& state) { time_plain<benchmarks::plain_sweep>(state); }
void plain_blocked(benchmark::State& state) { time_plain<benchmarks::plain_sweep_blocked>(state); }
void plain_sweep_avx2(benchmark::State& state) {
  if (!benchmarks::has_avx2()) return state.SkipWithError("no AVX2");
  time_plain<benchmarks::plain_sweep_avx2>(state);
}
void plain_blocked_avx2(benchmark::State& state) {
  if (!benchmarks::has_avx2()) return state.SkipWithError("no AVX2");
  time_plain<benchmarks::plain_sweep_blocked_avx2>(state);
}

// The library and the hand-written step go the same way from the same start.
void demand_equal_motion(int k) {
  constexpr int steps = 30;
  const scenes::Net net = net_of(Phase::working, k);
  carom::Simulation simulation(system_of(net),
                               carom::TimeStepping{.step = scenes::net_step, .tolerance = tolerance});
  PlainNet by_hand(net);
  for (int i = 0; i < steps; ++i) {
    simulation.step();
    benchmarks::plain_step(by_hand, scenes::net_step, tolerance);
  }
  for (std::size_t i = 0; i < by_hand.q.size(); ++i) {
    if (!(std::abs(by_hand.q[i] - simulation.state().q[i]) <= steps * 10.0 * tolerance)) {
      throw std::logic_error("nets by hand and by library part");
    }
  }
}

void plain_step(benchmark::State& state) {
  const int k = static_cast<int>(state.range(0));
  static const bool checked = (demand_equal_motion(10), true);
  static_cast<void>(checked);
  const auto settled = [&] {
    PlainNet net(net_of(Phase::working, k));
    for (int i = 0; i < settling; ++i) benchmarks::plain_step(net, scenes::net_step, tolerance);
    return net;
  };
  const PlainNet begin = settled();
  PlainNet net = begin;
  int steps = 0;
  std::int64_t sweeps = 0;
  for (auto _ : state) {
    if (++steps * scenes::net_step > longest) {
      state.PauseTiming();
      net = begin;
      steps = 0;
      state.ResumeTiming();
    }
    sweeps += benchmarks::plain_step(net, scenes::net_step, tolerance);
  }
  count_particles(state, k);
  state.counters["sweeps"] =
      benchmark::Counter(static_cast<double>(sweeps), benchmark::Counter::kAvgIterations);
}

void forces(benchmark::State& state) {
  const int k = static_cast<int>(state.range(0));
  const carom::Simulation& simulation = run(Phase::working, k).simulation;
  carom::Evaluation evaluation = make_evaluation(simulation.assembly());
  for (auto _ : state) {
    evaluate(simulation.assembly(), 0, simulation.state().view(), evaluation);
    benchmark::ClobberMemory();
  }
  demand_equal_forces(simulation, evaluation, k);
  count_particles(state, k);
}

void time_steps(benchmark::State& state, Phase phase) {
  const int k = static_cast<int>(state.range(0));
  Run& at = run(phase, k);
  carom::Simulation& simulation = at.simulation;
  std::int64_t sweeps = 0, allocations = 0;
  std::size_t contacts = 0;
  for (auto _ : state) {
    if (simulation.time() > longest) {
      state.PauseTiming();
      at.restart();
      state.ResumeTiming();
    }
    const std::int64_t before = benchmarks::allocations();
    const carom::StepReport& report = simulation.step();
    allocations += benchmarks::allocations() - before;
    sweeps += report.sweeps;
    contacts += report.contacts.size();
  }
  count_particles(state, k);
  using benchmark::Counter;
  state.counters["sweeps"] = Counter(static_cast<double>(sweeps), Counter::kAvgIterations);
  state.counters["allocations"] = Counter(static_cast<double>(allocations), Counter::kAvgIterations);
  state.counters["contacts"] = Counter(static_cast<double>(contacts), Counter::kAvgIterations);
}

void step_falling(benchmark::State& state) { time_steps(state, Phase::falling); }
void step_working(benchmark::State& state) { time_steps(state, Phase::working); }
void step_by_default(benchmark::State& state) { time_steps(state, Phase::by_default); }
void step_resting(benchmark::State& state) { time_steps(state, Phase::resting); }

// The stretched net on several threads: range(1) of them, by the clock on the wall. `per_particle` is its.
void step_threads(benchmark::State& state) {
  const int k = static_cast<int>(state.range(0));
  const auto threads = static_cast<int>(state.range(1));
  if (threads > 1 && !carom::Workers::several_available()) {
    state.SkipWithError("built without oneTBB");
    return;
  }
  const carom::System system = system_of(net_of(Phase::working, k));
  const auto begin = [&] {
    carom::Simulation simulation(
        system, carom::TimeStepping{.step = scenes::net_step, .tolerance = tolerance, .threads = threads});
    for (int i = 0; i < settling; ++i) simulation.step();
    return simulation;
  };
  carom::Simulation simulation = begin();
  for (auto _ : state) {
    if (simulation.time() > longest) {
      state.PauseTiming();
      simulation = begin();
      state.ResumeTiming();
    }
    simulation.step();
  }
  count_particles(state, k);
}

// The first second of the net as it is: falls, strikes, rebounds. `per_particle` is over one step.
void second(benchmark::State& state) {
  const int k = static_cast<int>(state.range(0));
  const carom::System system = system_of({.k = k});
  for (auto _ : state) {
    state.PauseTiming();
    carom::Simulation simulation(system,
                                 carom::TimeStepping{.step = scenes::net_step, .tolerance = tolerance});
    state.ResumeTiming();
    simulation.run_until(1.0);
    const carom::Statistics& statistics = simulation.statistics();
    const auto steps = static_cast<double>(statistics.steps);
    using benchmark::Counter;
    state.counters["per_particle"] = Counter(steps * k * k, Counter::kIsRate | Counter::kInvert);
    state.counters["sweeps"] = static_cast<double>(statistics.sweeps) / steps;
    state.counters["impacts"] = static_cast<double>(statistics.impacts);
  }
}

// The first step rates the couplings, once for a run.
void first_step(benchmark::State& state) {
  const int k = static_cast<int>(state.range(0));
  const carom::System system = system_of(net_of(Phase::working, k));
  for (auto _ : state) {
    state.PauseTiming();
    carom::Simulation simulation(system,
                                 carom::TimeStepping{.step = scenes::net_step, .tolerance = tolerance});
    state.ResumeTiming();
    simulation.step();
  }
  count_particles(state, k);
}

// Bytes that a simulation holds after a few steps, the user's own System apart.
double bytes_of(const scenes::Net& net) {
  const carom::System system = system_of(net);
  const std::int64_t before = benchmarks::live_bytes();
  carom::Simulation simulation(system, carom::TimeStepping{.step = scenes::net_step, .tolerance = tolerance});
  for (int i = 0; i < 4; ++i) simulation.step();
  return static_cast<double>(benchmarks::live_bytes() - before);
}

// From three nets: bytes = c + a particles + b springs.
void storage(benchmark::State& state) {
  const scenes::Net few{.k = 100, .diagonals = false};
  const scenes::Net many{.k = 100};
  const scenes::Net small{.k = 50};
  double per_particle = 0.0, per_spring = 0.0;
  for (auto _ : state) {
    const double with = bytes_of(many);
    per_spring = (with - bytes_of(few)) / (springs(many) - springs(few));
    per_particle = (with - bytes_of(small) - per_spring * (springs(many) - springs(small))) /
                   (particles(many) - particles(small));
  }
  state.counters["bytes_per_particle"] = per_particle;
  state.counters["bytes_per_spring"] = per_spring;
}

// Nets of a million particles take long to make and do not lose their way in noise: few iterations.
constexpr int million = 1000;

void sizes(benchmark::internal::Benchmark* timed) {
  for (const int k : {10, 30, 100, 300}) timed->Arg(k);
}
void small_sizes(benchmark::internal::Benchmark* timed) {
  for (const int k : {10, 30, 100}) timed->Arg(k);
}

BENCHMARK(plain_sweep)->Apply(sizes);
BENCHMARK(plain_sweep_avx2)->Apply(sizes);
BENCHMARK(plain_blocked)->Apply(sizes);
BENCHMARK(plain_blocked_avx2)->Apply(sizes);
BENCHMARK(plain_step)->Apply(sizes);
BENCHMARK(forces)->Apply(sizes);
BENCHMARK(step_falling)->Apply(sizes);
BENCHMARK(step_working)->Apply(sizes);
BENCHMARK(step_resting)->Apply(sizes);
BENCHMARK(step_by_default)->Apply(sizes);

BENCHMARK(plain_sweep)->Arg(million)->Iterations(2)->Repetitions(3)->Unit(benchmark::kMillisecond);
BENCHMARK(plain_sweep_avx2)->Arg(million)->Iterations(2)->Repetitions(3)->Unit(benchmark::kMillisecond);
BENCHMARK(plain_blocked)->Arg(million)->Iterations(2)->Repetitions(3)->Unit(benchmark::kMillisecond);
BENCHMARK(plain_blocked_avx2)->Arg(million)->Iterations(2)->Repetitions(3)->Unit(benchmark::kMillisecond);
BENCHMARK(plain_step)->Arg(million)->Iterations(2)->Repetitions(3)->Unit(benchmark::kMillisecond);
BENCHMARK(forces)->Arg(million)->Iterations(2)->Repetitions(3)->Unit(benchmark::kMillisecond);
BENCHMARK(step_working)->Arg(million)->Iterations(2)->Repetitions(3)->Unit(benchmark::kMillisecond);

BENCHMARK(step_threads)->Args({300, 1})->Args({300, 2})->UseRealTime();
BENCHMARK(second)->Apply(small_sizes)->Iterations(1)->Repetitions(2)->Unit(benchmark::kMillisecond);
BENCHMARK(second)->Arg(300)->Arg(million)->Iterations(1)->Repetitions(1)->Unit(benchmark::kMillisecond);
BENCHMARK(first_step)->Arg(100)->Iterations(1)->Repetitions(3)->Unit(benchmark::kMillisecond);
BENCHMARK(storage)->Iterations(1)->Repetitions(1)->Unit(benchmark::kMillisecond);

}  // namespace
