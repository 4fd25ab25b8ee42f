// Free discs over a floor, in time stepping: time per disc and step, beside one loop by hand that does the
// same sweep and account, and beside the same discs as one component; and ensembles of small systems.
//
// Names: <what>/<N> for N discs in one system. `per_disc` is in seconds, over one step. ensemble and
// ensemble_rolling/<N>: N simulations of one disc each, stepped in turn. And balls event-driven:
// `bytes_per_ball`.

#include <carom/carom.h>

#include "benchmarks/allocation_meter.h"
#include "benchmarks/discs.h"
#include "benchmarks/plain_discs.h"

#include <benchmark/benchmark.h>

#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <vector>

namespace {

constexpr double radius = 0.01;  // [m]
constexpr double height = 50.0;  // of the centres; nothing comes to the floor [m]
constexpr double step = 1e-4;    // [s]
constexpr double longest = 1.0;  // then a run starts anew [s]

enum class Joined { not_at_all, by_springs };

carom::System discs(int count, Joined joined, double above) {
  namespace planar = carom::planar;
  carom::System system;
  system.add(planar::Gravity{.acceleration = {0.0, -benchmarks::disc_gravity}});
  system.add(planar::HalfPlane{.point = {0.0, 0.0}, .normal = {0.0, 1.0}},
             carom::Surface{.friction = 0.3, .normal_restitution = 0.5});
  std::vector<carom::BodyId> bodies;
  for (int i = 0; i < count; ++i) {
    const auto mass = planar::disc(benchmarks::disc_density * radius * radius, radius);
    bodies.push_back(system.add(planar::RigidBody{.mass = mass,
                                                  .position = benchmarks::disc_position(i, radius, above),
                                                  .velocity = {benchmarks::disc_speed, 0.0},
                                                  .spin = benchmarks::disc_spin}));
    system.add(planar::Disc{.body = bodies.back(), .radius = radius});
  }
  if (joined == Joined::not_at_all) return system;
  for (std::size_t i = 1; i < bodies.size(); ++i) {
    system.add(planar::SpringDamper{.from = {bodies[i - 1]}, .to = {bodies[i]}, .stiffness = 1e-3});
  }
  return system;
}

void count_discs(benchmark::State& state) {
  using benchmark::Counter;
  state.counters["per_disc"] =
      Counter(static_cast<double>(state.range(0)), Counter::kIsIterationInvariantRate | Counter::kInvert);
}

/// Steps of some simulations, one step of each in turn. They start anew in time.
void time_steps(benchmark::State& state, std::vector<carom::Simulation>& simulations) {
  for (carom::Simulation& simulation : simulations) simulation.step();
  std::vector<carom::State> begin;
  for (const carom::Simulation& simulation : simulations) begin.push_back(simulation.state());
  std::int64_t allocations = 0;
  std::size_t contacts = 0;
  for (auto _ : state) {
    if (simulations.front().time() > longest) {
      state.PauseTiming();
      for (std::size_t i = 0; i < begin.size(); ++i) simulations[i].set_state(begin[i]);
      state.ResumeTiming();
    }
    const std::int64_t before = benchmarks::allocations();
    for (carom::Simulation& simulation : simulations) contacts += simulation.step().contacts.size();
    allocations += benchmarks::allocations() - before;
  }
  count_discs(state);
  using benchmark::Counter;
  state.counters["contacts"] = Counter(static_cast<double>(contacts), Counter::kAvgIterations);
  state.counters["allocations"] = Counter(static_cast<double>(allocations), Counter::kAvgIterations);
}

void time_system(benchmark::State& state, Joined joined, double above) {
  std::vector<carom::Simulation> simulations;
  simulations.emplace_back(discs(static_cast<int>(state.range(0)), joined, above),
                           carom::TimeStepping{.step = step});
  time_steps(state, simulations);
}

void time_ensemble(benchmark::State& state, double above) {
  std::vector<carom::Simulation> simulations;
  for (std::int64_t i = 0; i < state.range(0); ++i) {
    simulations.emplace_back(discs(1, Joined::not_at_all, above), carom::TimeStepping{.step = step});
  }
  time_steps(state, simulations);
}

void uncoupled(benchmark::State& state) { time_system(state, Joined::not_at_all, height); }
void uncoupled_rolling(benchmark::State& state) { time_system(state, Joined::not_at_all, radius); }
void one_component(benchmark::State& state) { time_system(state, Joined::by_springs, height); }
void ensemble(benchmark::State& state) { time_ensemble(state, height); }
void ensemble_rolling(benchmark::State& state) { time_ensemble(state, radius); }

// Both sides go the same way, or their ratio says nothing.
void demand_equal_motion() {
  constexpr int count = 150, steps = 30;
  carom::Simulation simulation(discs(count, Joined::not_at_all, height), carom::TimeStepping{.step = step});
  benchmarks::PlainDiscs plain(count, radius, height);
  for (int i = 0; i < steps; ++i) {
    simulation.step();
    benchmarks::plain_step_with_gaps(plain, radius, step);
  }
  for (std::size_t i = 0; i < plain.q.size(); ++i) {
    if (!(std::abs(plain.q[i] - simulation.state().q[i]) <= 1e-12)) {
      throw std::logic_error("discs by hand and by library part");
    }
  }
  const double difference = plain.kinetic + plain.potential - simulation.energy().total();
  if (!(std::abs(difference) <= 1e-10)) throw std::logic_error("energies by hand and by library part");
}

template <class Step>
void time_plain(benchmark::State& state, Step&& make_step) {
  static const bool checked = (demand_equal_motion(), true);
  static_cast<void>(checked);
  benchmarks::PlainDiscs plain(static_cast<int>(state.range(0)), radius, height);
  for (auto _ : state) {
    make_step(plain);
    benchmark::ClobberMemory();
  }
  count_discs(state);
}

void by_hand(benchmark::State& state) {
  time_plain(state, [](benchmarks::PlainDiscs& plain) { benchmarks::plain_step(plain, step); });
}
void by_hand_with_gaps(benchmark::State& state) {
  time_plain(state,
             [](benchmarks::PlainDiscs& plain) { benchmarks::plain_step_with_gaps(plain, radius, step); });
}

/// Bytes that an event-driven run of balls holds for each, the user's own System apart, after the 90 impacts
/// of each have accumulated; no event is recorded.
void event_storage(benchmark::State& state) {
  namespace planar = carom::planar;
  constexpr int balls = 1000;
  constexpr double rest = 3.0;  // [s]
  carom::System system;
  system.add(planar::Gravity{.acceleration = {0.0, -benchmarks::disc_gravity}});
  system.add(planar::HalfPlane{.normal = {0.0, 1.0}},
             carom::Surface{.friction = 0.3, .normal_restitution = 0.9});
  for (int i = 0; i < balls; ++i) {
    const double fall = 0.02 + 0.08 * i / (balls - 1);
    const carom::BodyId ball =
        system.add(planar::RigidBody{.mass = planar::solid_sphere(0.01, radius),
                                     .position = benchmarks::disc_position(i, radius, radius + fall),
                                     .velocity = {benchmarks::disc_speed, 0.0}});
    system.add(planar::Disc{.body = ball, .radius = radius});
  }
  for (auto _ : state) {
    const std::int64_t before = benchmarks::live_bytes();
    carom::Simulation simulation(system, carom::EventDriven{.record_events = false});
    simulation.run_until(rest);
    state.counters["bytes_per_ball"] = static_cast<double>(benchmarks::live_bytes() - before) / balls;
  }
}

void sizes(benchmark::internal::Benchmark* timed) {
  for (const int n : {100, 2000, 10000}) timed->Arg(n);
}

BENCHMARK(by_hand)->Apply(sizes);
BENCHMARK(by_hand_with_gaps)->Apply(sizes);
BENCHMARK(uncoupled)->Apply(sizes);
BENCHMARK(uncoupled_rolling)->Apply(sizes);
BENCHMARK(one_component)->Arg(2000);
BENCHMARK(ensemble)->Arg(1)->Arg(100);
BENCHMARK(ensemble_rolling)->Arg(1)->Arg(100);
BENCHMARK(event_storage)->Iterations(1)->Repetitions(1);

}  // namespace
