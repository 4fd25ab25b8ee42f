// The ball between two tables (examples/scenes/tables.h) at a step of 1e-4 s: CPU time of one simulated
// second, beside a loop written by hand for this ball that does the same steps.

#include <carom/carom.h>

#include "examples/scenes/tables.h"

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <stdexcept>

namespace {

constexpr double step = 1e-4;      // [s]
constexpr int steps = 10000;       // one second
constexpr double gravity = -9.81;  // [m/s^2]

struct Ball {
  double x, y, angle, vx, vy, spin;
};

Ball thrown() {
  const scenes::Tables tables;
  return {0.0, tables.height, 0.0, tables.horizontal_speed, tables.vertical_speed, tables.spin};
}

// docs/method.md sections 4 and 6: a sphere, so that normal and tangential directions are decoupled.
[[gnu::noinline]] void run_by_hand(Ball& ball) {
  const scenes::Tables tables;
  const double m = scenes::ball_mass, r = scenes::ball_radius;
  const double inertia = 0.4 * m * r * r;
  const double w_t = 1.0 / m + r * r / inertia;
  for (int i = 0; i < steps; ++i) {
    double vx = ball.vx, vy = ball.vy + step * gravity, spin = ball.spin;
    const bool low = ball.y - r <= 0.0, high = scenes::table_distance - ball.y - r <= 0.0;
    if (low || high) {
      const double n = low ? 1.0 : -1.0;  // the normal is (0, n), the tangent (n, 0)
      const double friction = low ? scenes::lower_friction : scenes::upper_friction;
      const double b_n = n * vy + scenes::table_restitution * n * ball.vy;
      if (b_n < 0.0) {
        const double b_t = n * vx + r * spin + tables.tangential_restitution * (n * ball.vx + r * ball.spin);
        const double normal = -m * b_n;
        const double tangential = std::clamp(-b_t / w_t, -friction * normal, friction * normal);
        vx += n * tangential / m;
        vy += n * normal / m;
        spin += r * tangential / inertia;
      }
    }
    ball.x += 0.5 * step * (ball.vx + vx);
    ball.y += 0.5 * step * (ball.vy + vy);
    ball.angle += 0.5 * step * (ball.spin + spin);
    ball.vx = vx;
    ball.vy = vy;
    ball.spin = spin;
  }
}

void second_by_hand(benchmark::State& state) {
  for (auto _ : state) {
    Ball ball = thrown();
    run_by_hand(ball);
    benchmark::DoNotOptimize(ball);
  }
}

void second_by_library(benchmark::State& state) {
  carom::System system;
  const carom::BodyId body = scenes::add_tables(system, {});
  Ball ball = thrown();
  run_by_hand(ball);
  for (auto _ : state) {
    state.PauseTiming();
    auto simulation = std::make_unique<carom::Simulation>(system, carom::TimeStepping{.step = step});
    state.ResumeTiming();
    simulation->run_until(steps * step);
    state.PauseTiming();
    const auto end = simulation->state().position(body);
    // Both make the same steps, or their ratio says nothing. Impacts amplify rounding.
    if (!(std::abs(end[0] - ball.x) + std::abs(end[1] - ball.y) <= 1e-9)) {
      throw std::logic_error("balls by hand and by library part");
    }
    state.counters["impacts"] = static_cast<double>(simulation->statistics().impacts);
    simulation.reset();
    state.ResumeTiming();
  }
}

BENCHMARK(second_by_hand)->Unit(benchmark::kMillisecond);
BENCHMARK(second_by_library)->Unit(benchmark::kMillisecond);

}  // namespace
