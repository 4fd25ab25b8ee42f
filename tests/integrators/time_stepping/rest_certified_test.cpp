// At rest a step costs a check: the impulses of the step before are certified, and nothing is factored.

#include <carom/carom.h>

#include "tests/shares.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <random>
#include <vector>

namespace {

using namespace carom;
using namespace carom::planar;

constexpr double gravity = 9.81, step = 2e-3;

constexpr double density = 100.0;  // [kg/m^2]

/// Boxes that are dropped into a box of 4 m, a few beside and on each other. \param mass out: of all [kg]
System heap(int boxes, unsigned seed, double& mass) {
  std::mt19937 random(seed);
  const auto number = [&](double least, double most) {
    return std::uniform_real_distribution<double>(least, most)(random);
  };
  System system;
  system.set_default_law({.friction = 0.5, .normal_restitution = 0.0});
  system.add(Gravity{{0.0, -gravity}});
  system.add(open_box({0.0, 0.0}, 4.0, 4.0, 0.5));
  constexpr int in_a_row = 8;
  for (int i = 0; i < boxes; ++i) {
    const double width = number(0.1, 0.2), height = number(0.1, 0.2);
    const Vec<2> place(-1.6 + 0.45 * (i % in_a_row) + number(-0.03, 0.03), 0.15 + 0.28 * (i / in_a_row));
    const MassProperties<2> of_box = box(density * width * height, width, height);
    const BodyId body = system.add(RigidBody{.mass = of_box, .position = place, .angle = number(-0.2, 0.2)});
    mass += of_box.mass;
    system.add(Polygon{.body = body,
                       .vertices = {{-0.5 * width, -0.5 * height},
                                    {0.5 * width, -0.5 * height},
                                    {0.5 * width, 0.5 * height},
                                    {-0.5 * width, 0.5 * height}}});
  }
  return system;
}

double fastest(const State& state) {
  double most = 0.0;
  for (const double velocity : state.v) most = std::max(most, std::abs(velocity));
  return most;
}

/// Attempts of the exact solvers; sweeps count as tried where they certify their start, too.
std::int64_t attempts(const ChainStatistics& statistics) {
  constexpr auto swept = static_cast<std::size_t>(SolverId::nonlinear_cg);
  return std::accumulate(statistics.tried.begin(), statistics.tried.end(), std::int64_t{0}) -
         statistics.tried[swept];
}

TEST(RestCertified, StepsAtRestAskNoSolver) {
  for (const int boxes : {8, 20, 30}) {
    double mass = 0.0;
    Simulation simulation(heap(boxes, 3, mass), TimeStepping{.step = step});
    for (int i = 0; i < 20 && (i == 0 || fastest(simulation.state()) > 1e-13); ++i) {
      simulation.run_until(0.5 * (i + 1));
    }
    ASSERT_LE(fastest(simulation.state()), 1e-13) << boxes;
    const State start = simulation.state();
    const ChainStatistics before = simulation.contact_statistics();
    constexpr int steps = carom_test::count_of_samples(1000);
    for (int i = 0; i < steps; ++i) simulation.step();
    const ChainStatistics after = simulation.contact_statistics();
    const std::int64_t problems = after.problems - before.problems;
    EXPECT_GE(problems, steps) << boxes;
    // One in some tens takes the rounding out that has gathered.
    EXPECT_LT(attempts(after) - attempts(before), problems / 10) << boxes;
    // A certificate of 1e-14, of g h = 0.02 m/s times the weights of a few boxes on the lightest one; in 2 s.
    EXPECT_LE(fastest(simulation.state()), 1e-13) << boxes;
    for (std::size_t i = 0; i < start.q.size(); ++i) {
      EXPECT_NEAR(simulation.state().q[i], start.q[i], 2e-13) << boxes;
    }
    double lift = 0.0;
    for (const ContactRecord& contact : simulation.report().contacts) {
      if (contact.key.b.owner == FeatureKey::Owner::obstacle)
        lift += contact.impulse[0] * contact.normal[1] + contact.impulse[1] * -contact.normal[0];
    }
    EXPECT_NEAR(lift / step, mass * gravity, 1e-12 * mass * gravity) << boxes;
  }
}

/// A push ends the rest in the step in which it comes.
TEST(RestCertified, LoadsThatChangeAreSeen) {
  double mass = 0.0;
  System system = heap(8, 3, mass);
  const BodyId pushed = system.bodies().front();
  system.add(AppliedForce{
      .on = pushed, .force = [](double t) { return Vec<2>(t < 3.0 ? 0.0 : 50.0, 0.0); }, .breaks = {3.0}});
  Simulation simulation(system, TimeStepping{.step = step});
  simulation.run_until(3.0);
  const double before = simulation.state().position(pushed)[0];
  simulation.run_until(3.2);
  EXPECT_GT(simulation.state().position(pushed)[0], before + 0.05);
}

}  // namespace
