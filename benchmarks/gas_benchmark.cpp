// A gas of hard discs in a box, event-driven: cost of an impact by the number of discs, at one density. Equal
// discs, e_n = 1, no friction; a tenth of the box is covered. `per_impact` in seconds, `steps` and
// `evaluations` per impact.

#include <carom/carom.h>

#include <benchmark/benchmark.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>
#include <stdexcept>

namespace {

using namespace carom;
using namespace carom::planar;

System gas(int count) {
  constexpr double radius = 0.2;
  System system;
  system.set_default_law({.friction = 0.0, .normal_restitution = 1.0, .tangential_restitution = 0.0});
  const int across = static_cast<int>(std::ceil(std::sqrt(count)));
  std::mt19937 engine(7);
  const auto draw = [&] { return static_cast<double>(engine()) / 2147483648.0 - 1.0; };
  for (int i = 0; i < count; ++i) {
    const double dx = 0.2 * draw();
    const double dy = 0.2 * draw();
    const double u = draw();
    const double w = draw();
    const Vec<2> place(i % across + 0.5 + dx, i / across + 0.5 + dy);
    const BodyId body =
        system.add(RigidBody{.mass = disc(1.0, radius), .position = place, .velocity = Vec<2>(u, w)});
    system.add(Disc{.body = body, .radius = radius});
  }
  const double half = 0.5 * across;
  for (const Vec<2>& normal : {Vec<2>(1.0, 0.0), Vec<2>(-1.0, 0.0), Vec<2>(0.0, 1.0), Vec<2>(0.0, -1.0)}) {
    system.add(HalfPlane{.point = Vec<2>(half, half) - half * normal, .normal = normal});
  }
  return system;
}

void discs_in_a_box(benchmark::State& state) {
  const auto count = static_cast<int>(state.range(0));
  const auto method = static_cast<FlowMethod>(state.range(1));
  const double end = 2000.0 / count;
  double impacts = 0.0, steps = 0.0, evaluations = 0.0;
  for (auto _ : state) {
    state.PauseTiming();
    Simulation simulation(gas(count), EventDriven{.method = method, .interval = 1e9, .record_events = false});
    state.ResumeTiming();
    simulation.run_until(end);
    state.PauseTiming();
    impacts = static_cast<double>(simulation.statistics().impacts);
    steps = static_cast<double>(simulation.statistics().flow_steps);
    evaluations = static_cast<double>(simulation.statistics().flow_evaluations);
    const double balance = std::abs(simulation.energy().residual());
    if (!(balance <= 1e-9 * simulation.energy().scale())) throw std::logic_error("the ledger does not close");
    state.ResumeTiming();
  }
  using benchmark::Counter;
  state.counters["impacts"] = impacts;
  state.counters["per_impact"] =
      Counter(impacts * static_cast<double>(state.iterations()), Counter::kIsRate | Counter::kInvert);
  state.counters["steps"] = steps / impacts;
  state.counters["evaluations"] = evaluations / impacts;
}
BENCHMARK(discs_in_a_box)
    ->ArgsProduct({{10, 100, 1000},
                   {static_cast<std::int64_t>(FlowMethod::explicit_runge_kutta),
                    static_cast<std::int64_t>(FlowMethod::one_step)}})
    ->ArgNames({"discs", "method"})
    ->Unit(benchmark::kMillisecond);

}  // namespace
