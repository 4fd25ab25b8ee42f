// Whole steps of time stepping for discs in a box: detection, contact, account and report.
//
// Names: settled/<N> for N discs that have come to rest (3 s, 10,000 of them 4.5 s), with the residual of
// contact by default, and settled_to_<residual>; collapse/<N> for the second half of their fall; pouring/<N>
// for rows that fall one by one onto those that lie already, all but the last quarter; <name>_two_threads;
// laden_tray/<N> for N discs in a row on a tray that a hinge holds, all of which answer together;
// dominoes/<N> for N that fall, from when the first lie on each other: contacts almost depend on each other.
// Counters: residual (the largest of the steps timed), contacts.

#include <carom/carom.h>

#include "examples/scenes/discs.h"
#include "tests/integrators/event_driven/body_scenes.h"

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>

namespace {

constexpr double step = 1e-3;  // [s]

/// A box as high as wide when it is full; of 2 m at most for up to 2,000 discs.
scenes::Discs scene(int count) {
  const double square = 0.1 * std::sqrt(static_cast<double>(count));
  return {.count = count, .width = count <= 2000 ? std::min(2.0, square) : square};
}

void time_steps(benchmark::State& state, const scenes::Discs& discs, const carom::TimeStepping& options,
                double from) {
  carom::System system;
  scenes::add_discs(system, discs);
  carom::Simulation simulation(system, options);
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

constexpr double falling = 0.4;  // time from which on steps are timed [s]

/// Time from which on steps of the pile at rest are timed [s]. In a wide pile the last loose discs stop late,
/// each of which upsets the forces, and it takes these many steps to find their equilibrium: until then steps
/// use up their sweeps, and go on where the last one stopped. With a residual of 1e-8 that lasts for 1.3 s of
/// 100 discs, 1.6 s of 500, 2.1 s of 2,000, 4.1 s of 10,000.
double at_rest(int count) { return count <= 2000 ? 3.0 : 4.5; }

int count_of(const benchmark::State& state) { return static_cast<int>(state.range(0)); }

void settled(benchmark::State& state) {
  time_steps(state, scene(count_of(state)), {.step = step}, at_rest(count_of(state)));
}
void settled_to(benchmark::State& state, double residual) {
  carom::TimeStepping options{.step = step};
  options.contact_budget.residual = residual;
  time_steps(state, scene(count_of(state)), options, at_rest(count_of(state)));
}
void settled_two_threads(benchmark::State& state) {
  time_steps(state, scene(count_of(state)), {.step = step, .threads = 2}, at_rest(count_of(state)));
}
void collapse(benchmark::State& state) { time_steps(state, scene(count_of(state)), {.step = step}, falling); }
void collapse_two_threads(benchmark::State& state) {
  time_steps(state, scene(count_of(state)), {.step = step, .threads = 2}, falling);
}

/// Rows so far apart that when half of the discs lie the other half still falls.
void pouring(benchmark::State& state) {
  scenes::Discs discs = scene(count_of(state));
  discs.rows_apart = 12.0;
  const double rows = discs.count / (discs.width / (2.4 * discs.radius));
  const double height = discs.rows_apart * discs.radius * rows;
  const double end = std::sqrt(2.0 * height / scenes::discs_gravity);  // the last row lands
  time_steps(state, discs, {.step = step}, 0.75 * end - 0.5);
}

/// Its cost should grow as that of discs on a floor.
void laden_tray(benchmark::State& state) {
  using namespace carom::planar;
  const int count = count_of(state);
  constexpr double pitch = 0.11, radius = 0.05;
  const double width = pitch * count;
  carom::System system;
  system.add(Gravity{{0.0, -scenes::discs_gravity}});
  system.set_default_law({.friction = 0.5, .normal_restitution = 0.0, .tangential_restitution = 0.0});
  const carom::BodyId tray =
      system.add(RigidBody{.mass = box(count, width, 2.0 * radius), .position = {0.0, -radius}});
  system.add(Polygon{.body = tray, .vertices = body_scenes::corners_of(width, 2.0 * radius)});
  system.add(Revolute{.from = {carom::ground, {0.0, -radius}}, .to = tray});
  for (int i = 0; i < count; ++i) {
    const carom::Vec<2> place(pitch * (i - 0.5 * (count - 1)), radius);
    const carom::BodyId body = system.add(RigidBody{.mass = disc(1.0, radius), .position = place});
    system.add(Disc{.body = body, .radius = radius});
  }
  carom::Simulation simulation(system, carom::TimeStepping{.step = step});
  simulation.run_until(10 * step);
  for (auto _ : state) simulation.step();
  state.counters["contacts"] = static_cast<double>(simulation.report().contacts.size());
}

void dominoes(benchmark::State& state) {
  using namespace carom::planar;
  constexpr double height = 0.041, width = 0.0076, pitch = 0.0276;  // [m]
  constexpr double push = 4.0, from = 0.6;                          // [rad/s], [s]
  carom::System system;
  system.add(Gravity{{0.0, -scenes::discs_gravity}});
  system.set_default_law({.friction = 0.2, .normal_restitution = 0.0, .tangential_restitution = 0.0});
  system.add(HalfPlane{.normal = {0.0, 1.0}},
             carom::Surface{.friction = 2.0, .normal_restitution = 0.0, .tangential_restitution = 0.0});
  for (int i = 0; i < count_of(state); ++i) {
    const double spin = i == 0 ? push : 0.0;  // about its lower corner
    const carom::BodyId domino = system.add(RigidBody{.mass = box(0.01, width, height),
                                                      .position = {i * pitch, 0.5 * height},
                                                      .velocity = 0.5 * spin * carom::Vec<2>(height, width),
                                                      .spin = -spin});
    system.add(Polygon{.body = domino, .vertices = body_scenes::corners_of(width, height)});
  }
  carom::Simulation simulation(system, carom::TimeStepping{.step = 0.1 * step});
  simulation.run_until(from);
  for (auto _ : state) simulation.step();
  state.counters["contacts"] = static_cast<double>(simulation.report().contacts.size());
}

// Steps go on in time: as many as are timed at rest, and of the collapse those of half a second.
void sizes(benchmark::internal::Benchmark* of) {
  of->Arg(100)->Arg(500)->Arg(2000)->Arg(10000)->Iterations(500)->Unit(benchmark::kMillisecond);
}
BENCHMARK(settled)->Apply(sizes);
BENCHMARK_CAPTURE(settled_to, 1e-8, 1e-8)->Apply(sizes);
BENCHMARK_CAPTURE(settled_to, 1e-4, 1e-4)->Apply(sizes);
BENCHMARK(collapse)->Apply(sizes);
BENCHMARK(pouring)->Apply(sizes);
BENCHMARK(dominoes)->Arg(20)->Iterations(2000)->Unit(benchmark::kMillisecond);
BENCHMARK(laden_tray)->Arg(100)->Arg(500)->Arg(2000)->Iterations(100)->Unit(benchmark::kMillisecond);
// The wall clock, as the processor time of both threads is the sum.
BENCHMARK(settled)->Name("settled_one_thread")->Arg(2000)->Iterations(500)->UseRealTime();
BENCHMARK(settled_two_threads)->Arg(2000)->Iterations(500)->UseRealTime();
BENCHMARK(collapse)->Name("collapse_one_thread")->Arg(2000)->Iterations(500)->UseRealTime();
BENCHMARK(collapse_two_threads)->Arg(2000)->Iterations(500)->UseRealTime();

}  // namespace
