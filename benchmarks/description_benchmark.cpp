// Describing a model, copying it, and making a simulation of it: wheels on pins in a row, with one part of
// some kind on each. `per_wheel` in seconds of CPU; linear growth is the same number for any count.

#include <carom/carom.h>

#include <benchmark/benchmark.h>

#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace {

using namespace carom;
using namespace carom::planar;

using AddPart = std::function<void(System&, BodyId, JointId, int)>;

const std::vector<std::pair<std::string, AddPart>>& kinds() {
  static const std::vector<std::pair<std::string, AddPart>> all{
      {"driver",
       [](System& system, BodyId, JointId pin, int) {
         system.add(Driver{.joint = pin,
                           .position = [](double t) { return t; },
                           .velocity = [](double) { return 1.0; },
                           .acceleration = [](double) { return 0.0; }});
       }},
      {"motor",
       [](System& system, BodyId, JointId pin, int) {
         system.add(Motor{.joint = pin, .torque = [](double, double, double) { return 1.0; }});
       }},
      {"stop",
       [](System& system, BodyId, JointId pin, int) { system.add(Stop{.joint = pin, .upper = 2.0}); }},
      {"friction", [](System& system, BodyId, JointId pin,
                      int) { system.add(JointFriction{.joint = pin, .bound = 0.1}); }},
      {"shape",
       [](System& system, BodyId wheel, JointId, int) { system.add(Disc{.body = wheel, .radius = 0.3}); }},
      {"spring",
       [](System& system, BodyId wheel, JointId, int i) {
         system.add(SpringDamper{.from = ground, .to = {wheel, {0.1, 0.0}}, .stiffness = 1.0},
                    "spring " + std::to_string(i));
       }},
  };
  return all;
}

System wheels(int count, const AddPart& add) {
  System system;
  system.add(HalfPlane{.normal = {0.0, 1.0}}, Surface{.friction = 0.0, .normal_restitution = 0.0});
  for (int i = 0; i < count; ++i) {
    const BodyId wheel = system.add(RigidBody{.mass = disc(1.0, 0.3), .position = {1.0 * i, 1.0}},
                                    "wheel " + std::to_string(i));
    const JointId pin = system.add(Revolute{.from = {ground, {1.0 * i, 1.0}}, .to = wheel});
    add(system, wheel, pin, i);
  }
  return system;
}

void describe(benchmark::State& state, const AddPart& add) {
  const int count = static_cast<int>(state.range(0));
  for (auto _ : state) {
    Simulation simulation(wheels(count, add), TimeStepping{});
    benchmark::DoNotOptimize(simulation.state().q.data());
  }
  state.counters["per_wheel"] =
      benchmark::Counter(count, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

const bool registered = [] {
  for (const auto& [name, add] : kinds()) {
    benchmark::RegisterBenchmark(("describe_" + name).c_str(),
                                 [&add = add](benchmark::State& state) { describe(state, add); })
        ->Arg(500)
        ->Arg(4000)
        ->Unit(benchmark::kMillisecond);
  }
  return true;
}();

}  // namespace
