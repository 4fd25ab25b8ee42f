// Many small systems in one: copies that do not touch each other move as each does alone.

#include <carom/carom.h>

#include <gtest/gtest.h>

#include <vector>

namespace {

using namespace carom;
using namespace carom::planar;

constexpr double radius = 0.1;  // [m]

/// Discs that bounce and roll, all in the same place, each with a spin of its own; none touches another one.
System discs(int first, int count) {
  System system;
  system.add(Gravity{{0.0, -9.81}});
  system.set_default_law(Surface{.friction = 0.3, .normal_restitution = 0.5});
  system.add(HalfPlane{.normal = {0.0, 1.0}});
  for (int i = first; i < first + count; ++i) {
    const BodyId body = system.add(RigidBody{.mass = disc(1.0, radius),
                                             .position = {0.0, radius + 1e-3 * (1 + i % 7)},
                                             .velocity = {1.0, -0.1},
                                             .spin = 0.5 * i});
    system.add(Disc{.body = body, .radius = radius, .filter = {.groups = 2, .touches = 1}});
  }
  return system;
}

/// All coordinates and velocities of the last body.
std::vector<double> last_after(const System& system, const Mode& mode) {
  Simulation simulation(system, mode);
  simulation.run_until(0.3);
  const State& state = simulation.state();
  std::vector<double> numbers(state.q.end() - 3, state.q.end());
  numbers.insert(numbers.end(), state.v.end() - 3, state.v.end());
  return numbers;
}

TEST(Ensemble, CopiesMoveAsEachDoesAlone) {
  for (const Mode& mode : {Mode(TimeStepping{.step = 1e-3}), Mode(EventDriven{})}) {
    for (const int last : {0, 3, 39}) {
      EXPECT_EQ(last_after(discs(0, last + 1), mode), last_after(discs(last, 1), mode)) << last;
    }
  }
}

}  // namespace
