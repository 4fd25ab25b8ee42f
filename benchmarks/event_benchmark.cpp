// The event-driven mode by its events: a disc that bounces without loss, beside a loop written by hand for
// this purpose (classical Runge-Kutta of fixed step, the impact by Newton's method on the gap, its law in
// closed form, without contacts, error control or energy ledger); balls that come to rest; contacts that
// last; a slider that sticks and slips. `per_event` in seconds; `steps` and `evaluations` per event.

#include <carom/carom.h>

#include "examples/scenes/shaker.h"

#include <benchmark/benchmark.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <optional>
#include <stdexcept>
#include <utility>

namespace {

using namespace carom;
using namespace carom::planar;

constexpr double gravity = 9.81;

// Only what it takes: nothing recorded, nobody looks in between.
EventDriven options(FlowMethod method) {
  return {.relative_tolerance = 1e-9,
          .absolute_tolerance = 1e-9,
          .method = method,
          .interval = 1e9,
          .record_events = false};
}

double count_events(const Simulation& simulation) {
  const EventCounts& events = simulation.statistics().events;
  return static_cast<double>(std::accumulate(events.begin(), events.end(), std::int64_t{0}));
}

// Runs a model from its start for `end` seconds, again and again.
template <class Make>
void time_run(benchmark::State& state, const Mode& mode, double end, Make&& make, bool by_event = true) {
  double events = 0.0, steps = 0.0, evaluations = 0.0;
  for (auto _ : state) {
    state.PauseTiming();
    std::optional<Simulation> made(std::in_place, make(), mode);
    Simulation& simulation = *made;
    state.ResumeTiming();
    simulation.run_until(end);
    state.PauseTiming();
    events = count_events(simulation);
    steps = static_cast<double>(simulation.statistics().flow_steps);
    evaluations = static_cast<double>(simulation.statistics().flow_evaluations);
    const double balance = std::abs(simulation.energy().residual());
    if (!(balance <= 1e-5 * simulation.energy().scale())) throw std::logic_error("the ledger does not close");
    made.reset();  // as little part of the run as making it
    state.ResumeTiming();
  }
  using benchmark::Counter;
  state.counters["events"] = events;
  if (by_event) {
    state.counters["per_event"] = Counter(events, Counter::kIsIterationInvariantRate | Counter::kInvert);
    state.counters["steps"] = steps / events;
    state.counters["evaluations"] = evaluations / events;
  } else {
    state.counters["per_second"] = Counter(end, Counter::kIsIterationInvariantRate | Counter::kInvert);
    state.counters["steps"] = steps / end;
    state.counters["evaluations"] = evaluations / end;
  }
}

// A disc that bounces for ever: e_n = e_t = 1 reverses the velocity of what sticks, spin and speed go to and
// fro. Flights of 0.9 s, which no method integrates; in air so thin that it changes nothing one has to.

constexpr double mass = 2.0, radius = 0.1, friction = 0.3, flight = 0.9;
constexpr int impacts = 100;
constexpr double bouncing_end = flight * impacts;  // half a flight after the last impact
using Motion = std::array<double, 6>;              // x, y, angle and their rates
constexpr Motion at_start{0.0, radius, 0.0, 0.5, 0.5 * flight* gravity, 3.0};

System bouncing_disc(bool in_air) {
  System system;
  system.add(Gravity{{0.0, -gravity}});
  system.add(HalfPlane{.normal = {0.0, 1.0}},
             Surface{.friction = friction, .normal_restitution = 1.0, .tangential_restitution = 1.0});
  // Starts at the top of a flight.
  const BodyId ball =
      system.add(RigidBody{.mass = disc(mass, radius),
                           .position = {at_start[0], radius + 0.125 * gravity * flight * flight},
                           .velocity = {at_start[3], 0.0},
                           .spin = at_start[5]},
                 "ball");
  system.add(Disc{.body = ball, .radius = radius});
  constexpr double air = 1e-18;  // [N s/m]
  if (in_air) system.add(Drag{.on = ball, .linear = air});
  return system;
}

class ByHand {
public:
  void run(double end) {
    motion_ = at_start;
    motion_[1] = radius + 0.125 * gravity * flight * flight;
    motion_[4] = 0.0;
    evaluations_ = steps_ = 0.0;
    impacts_ = 0.0;
    constexpr double longest = 0.1;
    for (double time = 0.0; time < end;) {
      const double length = std::min(longest, end - time);
      Motion after;
      step(motion_, length, after);
      if (after[1] >= radius) {
        motion_ = after;
        time += length;
        continue;
      }
      time += to_impact(length, after);
    }
  }
  [[nodiscard]] const Motion& motion() const { return motion_; }
  [[nodiscard]] double evaluations() const { return evaluations_; }
  [[nodiscard]] double steps() const { return steps_; }
  [[nodiscard]] double impacts() const { return impacts_; }

private:
  static void rates(const Motion& y, Motion& out) { out = {y[3], y[4], y[5], 0.0, -gravity, 0.0}; }

  void step(const Motion& from, double h, Motion& to) {
    std::array<Motion, 4> k;
    Motion y;
    rates(from, k[0]);
    for (std::size_t i = 0; i < y.size(); ++i) y[i] = from[i] + 0.5 * h * k[0][i];
    rates(y, k[1]);
    for (std::size_t i = 0; i < y.size(); ++i) y[i] = from[i] + 0.5 * h * k[1][i];
    rates(y, k[2]);
    for (std::size_t i = 0; i < y.size(); ++i) y[i] = from[i] + h * k[2][i];
    rates(y, k[3]);
    for (std::size_t i = 0; i < y.size(); ++i) {
      to[i] = from[i] + h / 6.0 * (k[0][i] + 2.0 * (k[1][i] + k[2][i]) + k[3][i]);
    }
    evaluations_ += 4.0;
    steps_ += 1.0;
  }

  double to_impact(double longest, Motion after) {
    double length = longest;
    for (int i = 0; i < 20; ++i) {
      const double next = std::clamp(length - (after[1] - radius) / after[4], 0.0, longest);
      const bool found = std::abs(next - length) < 1e-14;
      length = next;
      step(motion_, length, after);
      if (found) break;
    }
    motion_ = after;
    // The lowest point moves with x' + r spin; 1/m + r^2/I = 3/m.
    const double normal = -2.0 * mass * motion_[4], slip = motion_[3] + radius * motion_[5];
    const double stick = -2.0 * slip * mass / 3.0;
    const double push =
        std::abs(stick) <= friction * normal ? stick : -std::copysign(friction * normal, slip);
    motion_[4] += normal / mass;
    motion_[3] += push / mass;
    motion_[5] += push * radius / (0.5 * mass * radius * radius);
    impacts_ += 1.0;
    return length;
  }

  Motion motion_{};
  double evaluations_ = 0.0, steps_ = 0.0, impacts_ = 0.0;
};

void bounce_by_hand(benchmark::State& state) {
  ByHand body;
  for (auto _ : state) {
    body.run(bouncing_end);
    auto motion = body.motion();
    benchmark::DoNotOptimize(motion);
  }
  using benchmark::Counter;
  state.counters["per_event"] =
      Counter(body.impacts(), Counter::kIsIterationInvariantRate | Counter::kInvert);
  state.counters["events"] = body.impacts();
  state.counters["steps"] = body.steps() / body.impacts();
  state.counters["evaluations"] = body.evaluations() / body.impacts();
}

void bounce(benchmark::State& state, const EventDriven& chosen, bool in_air) {
  ByHand by_hand;
  by_hand.run(bouncing_end);
  Simulation simulation(bouncing_disc(in_air), chosen);
  simulation.run_until(bouncing_end);
  if (count_events(simulation) != by_hand.impacts()) throw std::logic_error("an impact is missing");
  const State& there = simulation.state();
  const Motion& here = by_hand.motion();
  const double apart =
      std::hypot(there.q[0] - here[0], there.q[1] - here[1], radius * (there.q[2] - here[2]));
  if (!(apart <= 1e-3)) throw std::logic_error("the two bouncing discs are not in one place");
  time_run(state, chosen, bouncing_end, [in_air] { return bouncing_disc(in_air); });
  state.counters["apart"] = apart;
}

BENCHMARK(bounce_by_hand)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(bounce, in_flight, options(FlowMethod::explicit_runge_kutta), false)
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(bounce, by_default, EventDriven{}, false)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(bounce, in_air_by_default, EventDriven{}, true)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(bounce, explicit_runge_kutta, options(FlowMethod::explicit_runge_kutta), true)
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(bounce, adams, options(FlowMethod::adams), true)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(bounce, bdf, options(FlowMethod::bdf), true)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(bounce, one_step, options(FlowMethod::one_step), true)->Unit(benchmark::kMicrosecond);

// Balls side by side, dropped from 0.02 to 0.1 m: 3 s, in which their impacts accumulate and they lie still.
System balls(int count) {
  System system;
  system.add(Gravity{{0.0, -gravity}});
  system.add(HalfPlane{.normal = {0.0, 1.0}}, Surface{.friction = 0.3, .normal_restitution = 0.9});
  constexpr double ball_radius = 0.01;
  for (int i = 0; i < count; ++i) {
    const double part = count > 1 ? static_cast<double>(i) / (count - 1) : 1.0;
    const BodyId ball = system.add(RigidBody{.mass = solid_sphere(0.01, ball_radius),
                                             .position = {0.03 * i, ball_radius + 0.02 + 0.08 * part},
                                             .velocity = {0.1, 0.0}});
    system.add(Disc{.body = ball, .radius = ball_radius});
  }
  return system;
}

void balls_at_rest(benchmark::State& state) {
  time_run(state, options(FlowMethod::explicit_runge_kutta), 3.0,
           [&] { return balls(static_cast<int>(state.range(0))); });
}
BENCHMARK(balls_at_rest)->Arg(1)->Arg(10)->Arg(100)->Arg(1000)->Unit(benchmark::kMillisecond);

// The same with the options as they come: tolerances 1e-9 and 1e-11, every event recorded.
void balls_by_default(benchmark::State& state) {
  time_run(state, EventDriven{}, 3.0, [&] { return balls(static_cast<int>(state.range(0))); });
}
BENCHMARK(balls_by_default)->Arg(1)->Arg(10)->Arg(100)->Arg(1000)->Unit(benchmark::kMillisecond);

// Contact that lasts, 10 s of it: a brick at rest, the same on a plane that shakes too little to move it, a
// disc that rolls down a plane; in both modes.

System lying_brick() {
  System system;
  system.add(Gravity{{0.0, -gravity}});
  system.add(HalfPlane{.normal = {0.0, 1.0}}, Surface{.friction = 0.3, .normal_restitution = 0.5});
  const BodyId brick = system.add(RigidBody{.mass = box(1.0, 0.2, 0.1), .position = {0.0, 0.05}});
  system.add(Polygon{.body = brick, .vertices = {{-0.1, -0.05}, {0.1, -0.05}, {0.1, 0.05}, {-0.1, 0.05}}});
  return system;
}

System shaken_brick() {
  System system;
  scenes::add_shaker(system, {.growth = 1e-3});
  return system;
}

System rolling_disc() {
  System system;
  system.add(Gravity{{0.0, -gravity}});
  system.add(HalfPlane{.normal = incline(-0.1)}, Surface{.friction = 0.3, .normal_restitution = 0.5});
  const BodyId wheel = system.add(RigidBody{.mass = disc(1.0, 0.1), .position = Vec<2>(0.1 * incline(-0.1))});
  system.add(Disc{.body = wheel, .radius = 0.1});
  return system;
}

constexpr double lasting_end = 10.0;
using Make = System (*)();

void lasting(benchmark::State& state, Make make) {
  time_run(state, options(FlowMethod::explicit_runge_kutta), lasting_end, make, false);
}
void lasting_one_step(benchmark::State& state, Make make) {
  time_run(state, options(FlowMethod::one_step), lasting_end, make, false);
}
void lasting_by_default(benchmark::State& state, Make make) {
  time_run(state, EventDriven{}, lasting_end, make, false);
}
void lasting_stepped(benchmark::State& state, Make make) {
  time_run(state, TimeStepping{.step = 1e-3}, lasting_end, make, false);
}
BENCHMARK_CAPTURE(lasting, brick, lying_brick)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(lasting, shaken_brick, shaken_brick)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(lasting, rolling_disc, rolling_disc)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(lasting_one_step, brick, lying_brick)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(lasting_one_step, shaken_brick, shaken_brick)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(lasting_one_step, rolling_disc, rolling_disc)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(lasting_by_default, brick, lying_brick)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(lasting_by_default, shaken_brick, shaken_brick)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(lasting_by_default, rolling_disc, rolling_disc)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(lasting_stepped, brick, lying_brick)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(lasting_stepped, shaken_brick, shaken_brick)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(lasting_stepped, rolling_disc, rolling_disc)->Unit(benchmark::kMicrosecond);

// A mass on a spring that rubs: it turns round a hundred times, 0.02 m nearer to the middle each time.
System slider() {
  System system;
  constexpr double stiffness = 2.0 * 0.1 * 1.0 * gravity / 0.02;
  system.add(Gravity{{0.0, -gravity}});
  system.add(HalfPlane{.normal = {0.0, 1.0}}, Surface{.friction = 0.1, .normal_restitution = 0.0});
  const BodyId block = system.add(Particle{.mass = 1.0, .position = {2.005, 0.0}});
  system.add(SpringDamper{.from = {ground, {0.0, 0.0}}, .to = block, .stiffness = stiffness});
  return system;
}

// A mass on a spring on a belt: it sticks, breaks loose, slips back, sticks again.
System on_a_belt() {
  System system;
  system.add(Gravity{{0.0, -gravity}});
  system.add(HalfPlane{.normal = {0.0, 1.0},
                       .motion = {.displacement = [](double t) { return Vec<2>(0.2 * t, 0.0); },
                                  .velocity = [](double) { return Vec<2>(0.2, 0.0); },
                                  .acceleration = [](double) { return Vec<2>(0.0, 0.0); }}},
             Surface{.friction = 0.2, .normal_restitution = 0.0, .static_friction = 0.4});
  const BodyId block = system.add(Particle{.mass = 1.0, .position = {0.0, 0.0}, .velocity = {0.2, 0.0}});
  system.add(SpringDamper{.from = {ground, {0.0, 0.0}}, .to = block, .stiffness = 100.0});
  return system;
}

void slide(benchmark::State& state, const EventDriven& chosen) { time_run(state, chosen, 32.0, slider); }
void belt(benchmark::State& state, const EventDriven& chosen) { time_run(state, chosen, 30.0, on_a_belt); }
BENCHMARK_CAPTURE(slide, by_default, EventDriven{})->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(slide, explicit_runge_kutta, options(FlowMethod::explicit_runge_kutta))
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(slide, adams, options(FlowMethod::adams))->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(slide, bdf, options(FlowMethod::bdf))->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(slide, one_step, options(FlowMethod::one_step))->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(belt, by_default, EventDriven{})->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(belt, explicit_runge_kutta, options(FlowMethod::explicit_runge_kutta))
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(belt, adams, options(FlowMethod::adams))->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(belt, bdf, options(FlowMethod::bdf))->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(belt, one_step, options(FlowMethod::one_step))->Unit(benchmark::kMicrosecond);

}  // namespace
