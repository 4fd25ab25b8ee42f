// Stiff motion: BDF with derivatives that are sparse, or none; nets and chains of stiff springs beside what
// is known of them.

#include <carom/carom.h>
#include <carom/integrators/flow/flow.h>
#include <carom/integrators/flow/newton_matrix.h>

#include "tests/allocation_counter.h"
#include "tests/integrators/flow_problems.h"

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <string>
#include <vector>

namespace {

using namespace carom;
using namespace carom::planar;
using namespace flow_problems;

TEST(BdfFlow, StiffOscillatorOfVanDerPol) {
  // y'' = 1000 (1 - y^2) y' - y, y(0) = 2, y'(0) = 0; at t = 2000 from E. Hairer, G. Wanner, Test Set for IVP
  // Solvers (problem VDPOL, in time scaled by 1000).
  const Function rates = [](double, const double* y, double* out) {
    out[0] = y[1];
    out[1] = 1e3 * (1.0 - y[0] * y[0]) * y[1] - y[0];
  };
  const Jacobian jacobian = [](double, const double* y, std::vector<RateDerivative>& out) {
    out.push_back({.row = 0, .column = 0, .of_rate = 1.0});
    out.push_back({.row = 0, .column = 1, .of_state = 1.0});
    out.push_back({.row = 1, .column = 0, .of_state = -2e3 * y[0] * y[1] - 1.0});
    out.push_back({.row = 1, .column = 1, .of_rate = 1.0, .of_state = 1e3 * (1.0 - y[0] * y[0])});
  };
  Problem with(2, 1e-11, rates, jacobian), without(2, 1e-11, rates);
  for (Problem* problem : {&with, &without}) {
    const auto flow = make_flow(FlowMethod::bdf, *problem, 1e-8);
    flow->start(0.0, std::array{2.0, 0.0}, 0.0);
    go_to(*flow, 2000.0);
    EXPECT_NEAR(flow->state()[0], 1.706167732170483, 3e-6);  // errors of the jumps between add up: 4e-7
    EXPECT_LE(flow->counts().steps, 5000);                   // an explicit method makes a million
  }
  EXPECT_GT(with.jacobians, 10);
}

TEST(BdfFlow, DerivativesThatCannotBeAreRefused) {
  const auto message = [](const RateDerivative& entry) -> std::string {
    NewtonMatrix matrix(4, 1);
    matrix.entries() = {entry};
    try {
      (void)matrix.take();
    } catch (const ModelError& error) {
      return error.what();
    }
    return "no error";
  };
  EXPECT_EQ(message({.row = 1, .column = 1, .of_rate = 1.0}), "no error");
  EXPECT_NE(message({.row = 0, .column = 1}).find("row 0; allowed: none of an integral"), std::string::npos);
  EXPECT_NE(message({.row = 1, .column = 0}).find("column 0; allowed"), std::string::npos);
  EXPECT_NE(message({.row = 1, .column = 4}).find("no row of multiplier 4"), std::string::npos);
  EXPECT_NE(message({.row = 1, .column = 2, .of_integral = 1.0}).find("an integral of unknown 2"),
            std::string::npos);
  NewtonMatrix matrix(1, 0);
  matrix.entries() = {{.row = 0, .column = 0, .of_rate = 1.0, .of_state = std::nan("")}};
  EXPECT_FALSE(matrix.take());
}

// Integrals, constants and multipliers beside the dense equations they stand for.
TEST(BdfFlow, EquationsOfAStep) {
  // y = (x1, x2, v1, v2, c, w):  x' = v,  2 v1' = -3 x1 + x2 - v2 + 0.5 c + l,  v2' = x1 - 2 v2 - l,
  // v1' - v2' = 0.1 v1 - 0.7 x2 with the multiplier l;  c' = 0 to who solves, w depends on all.
  NewtonMatrix matrix(6, 2);
  std::vector<RateDerivative>& entries = matrix.entries();
  entries = {{2, 2, 2.0, 0.0, -3.0}, {2, 3, 0.0, -1.0, 1.0},  {.row = 2, .column = 4, .of_state = 0.5},
             {3, 3, 1.0, -2.0, 0.0}, {3, 2, 0.0, 0.0, 1.0},   {.row = 2, .column = 6, .of_state = 1.0},
             {6, 2, 1.0, 0.1, 0.0},  {6, 3, -1.0, 0.0, -0.7}, {.row = 3, .column = 6, .of_state = -1.0}};
  ASSERT_TRUE(matrix.take());
  const double gamma = 0.3;
  ASSERT_TRUE(matrix.factor(gamma));
  EXPECT_EQ(matrix.rows(), 3u);
  const std::array<double, 6> b{0.3, -1.2, 0.7, 2.0, -0.4, 5.0};
  std::array<double, 6> x{};
  matrix.solve(b.data(), x.data());
  // Rates of the changes are (x - b) / gamma.
  const auto rate = [&](std::size_t i) { return (x[i] - b[i]) / gamma; };
  EXPECT_NEAR(rate(0), x[2], 1e-14);
  EXPECT_NEAR(rate(1), x[3], 1e-14);
  EXPECT_EQ(x[4], b[4]);
  EXPECT_EQ(x[5], b[5]);
  const double force = 2.0 * rate(2) - (-3.0 * x[0] + x[1] - x[3] + 0.5 * x[4]);
  EXPECT_NEAR(rate(3), x[0] - 2.0 * x[3] - force, 1e-13);
  EXPECT_NEAR(rate(2) - rate(3), 0.1 * x[2] - 0.7 * x[1], 1e-13);
}

/// A square net of particles, stiff along sides and diagonals, that turns and falls.
System net(int side, double stiffness, double damping) {
  System system;
  system.add(Gravity{{0.0, -9.81}});
  std::vector<BodyId> bodies;
  const auto at = [&](int i, int j) { return bodies[static_cast<std::size_t>(i * side + j)]; };
  for (int i = 0; i < side; ++i) {
    for (int j = 0; j < side; ++j) {
      bodies.push_back(
          system.add(Particle{.mass = 1.0, .position = {1.0 * i, 1.0 * j}, .velocity = {-0.5 * j, 0.5 * i}}));
    }
  }
  const auto tie = [&](BodyId from, BodyId to, double length) {
    system.add(SpringDamper{
        .from = from, .to = to, .stiffness = stiffness, .damping = damping, .free_length = length});
  };
  for (int i = 0; i < side; ++i) {
    for (int j = 0; j < side; ++j) {
      if (i + 1 < side) tie(at(i, j), at(i + 1, j), 1.0);
      if (j + 1 < side) tie(at(i, j), at(i, j + 1), 1.0);
      if (i + 1 == side || j + 1 == side) continue;
      tie(at(i, j), at(i + 1, j + 1), std::numbers::sqrt2);
      tie(at(i + 1, j), at(i, j + 1), std::numbers::sqrt2);
    }
  }
  return system;
}

Simulation run(System system, FlowMethod method, double tolerance, double end) {
  Simulation simulation(
      std::move(system),
      EventDriven{.relative_tolerance = tolerance, .absolute_tolerance = 1e-2 * tolerance, .method = method});
  simulation.run_until(end);
  return simulation;
}

double distance_of(const State& a, const State& b) {
  double largest = 0.0;
  for (std::size_t i = 0; i < a.q.size(); ++i) largest = std::max(largest, std::abs(a.q[i] - b.q[i]));
  return largest;
}

TEST(BdfFlow, StiffNetMovesAsByRungeKutta) {
  // Dashpots with c k / m = 1e12 1/s^2 leave explicit steps of some 2e-6 s.
  constexpr double end = 0.02;
  const Simulation implicit = run(net(20, 1e7, 1e5), FlowMethod::bdf, 1e-8, end);
  const Simulation explicit_run = run(net(20, 1e7, 1e5), FlowMethod::explicit_runge_kutta, 1e-8, end);
  // The net is 20 m wide and moves by 0.2 m, in 160 steps; 1e-8 of that.
  EXPECT_LE(distance_of(implicit.state(), explicit_run.state()), 2e-9);
  EXPECT_LE(20 * implicit.statistics().flow_steps, explicit_run.statistics().flow_steps);
}

TEST(BdfFlow, StiffChainSwingsAsItsSlowestMode) {
  // Particles between walls, springs along a line: linear. The slowest mode decays as a damped oscillator,
  // omega = 2 sqrt(k/m) sin(pi / (2 (n+1))), rate of decay omega^2 c / (2 k); the fastest one wants steps a
  // thousand times shorter.
  constexpr int count = 40;
  constexpr double stiffness = 1e7, damping = 3e3, amplitude = 1e-2;
  const double angle = std::numbers::pi / (count + 1);
  const double omega = 2.0 * std::sqrt(stiffness) * std::sin(0.5 * angle);
  const double decay = 0.5 * omega * omega * damping / stiffness;
  const double turn = std::sqrt(omega * omega - decay * decay);
  System system;
  std::vector<BodyId> bodies;
  End<2> before(ground, {0.0, 0.0});
  for (int i = 1; i <= count + 1; ++i) {
    End<2> next(ground, {count + 1.0, 0.0});
    if (i <= count) {
      bodies.push_back(system.add(
          Particle{.mass = 1.0, .position = {i + amplitude * std::sin(i * angle), 0.0}, .velocity = {0, 0}}));
      next = End<2>(bodies.back());
    }
    system.add(SpringDamper{
        .from = before, .to = next, .stiffness = stiffness, .damping = damping, .free_length = 1.0});
    before = next;
  }
  const double end = 2.0 * std::numbers::pi / turn;
  const Simulation simulation = run(std::move(system), FlowMethod::bdf, 1e-9, end);
  const double left =
      amplitude * std::exp(-decay * end) * (std::cos(turn * end) + decay / turn * std::sin(turn * end));
  double error = 0.0;
  for (int i = 1; i <= count; ++i) {
    const double place = simulation.state().position(bodies[static_cast<std::size_t>(i - 1)])[0];
    error = std::max(error, std::abs(place - (i + left * std::sin(i * angle))));
  }
  // Some 300 steps, each wrong by 1e-9 of velocities of 2 m/s, which act for 1/omega: 2e-9 for all of them.
  EXPECT_LE(error, 2e-9);
  EXPECT_LE(simulation.statistics().flow_steps, 1500);
}

/// Uniform rods, pinned to the ground and each other, with stiff torsional springs between them.
System stiff_rods(int count) {
  System system;
  system.add(Gravity{{0.0, -9.81}});
  BodyId last = ground;
  for (int i = 0; i < count; ++i) {
    const BodyId link = system.add(RigidBody{.mass = rod(1.0, 1.0), .position = {i + 0.5, 0.0}});
    const End<2> before = i == 0 ? End<2>(ground) : End<2>(last, {0.5, 0.0});
    system.add(Revolute{.from = before, .to = {link, {-0.5, 0.0}}});
    if (i > 0) system.add(TorsionalSpring{.from = last, .to = link, .stiffness = 1e6, .damping = 1e4});
    last = link;
  }
  return system;
}

TEST(BdfFlow, StiffRodsMoveAsByRungeKutta) {
  const Simulation implicit = run(stiff_rods(6), FlowMethod::bdf, 1e-9, 0.1);
  const Simulation explicit_run = run(stiff_rods(6), FlowMethod::explicit_runge_kutta, 1e-9, 0.1);
  EXPECT_LE(distance_of(implicit.state(), explicit_run.state()), 1e-10);  // 1e-9 of the way fallen, 0.05 m
  EXPECT_LE(20 * implicit.statistics().flow_steps, explicit_run.statistics().flow_steps);
}

/// Two particles that slide along the ground, a stiff spring between them.
System sliding_pair() {
  System system;
  system.add(Gravity{{0.0, -9.81}});
  system.add(HalfPlane{.point = {0, 0}, .normal = {0, 1}},
             Surface{.friction = 0.1, .normal_restitution = 0.0});
  const BodyId back = system.add(Particle{.mass = 1.0, .position = {0, 0}, .velocity = {20, 0}});
  const BodyId front = system.add(Particle{.mass = 2.0, .position = {1, 0}, .velocity = {20.01, 0}});
  system.add(SpringDamper{.from = back, .to = front, .stiffness = 1e4, .damping = 3.0, .free_length = 1.0});
  return system;
}

TEST(BdfFlow, SteadyStateOfComponentsTakesNoMemory) {
  for (const System& system : {net(5, 1e5, 10.0), stiff_rods(5), sliding_pair()}) {
    Simulation simulation(system, EventDriven{.relative_tolerance = 1e-6,
                                              .absolute_tolerance = 1e-8,
                                              .method = FlowMethod::bdf,
                                              .record_events = false});
    for (const double time : {0.1, 0.2}) simulation.run_until(time);  // some memory changes sides
    const std::int64_t before = carom_test::allocations();
    const std::int64_t steps = simulation.statistics().flow_steps;
    simulation.run_until(1.0);
    const std::int64_t taken = carom_test::allocations() - before;
    EXPECT_EQ(taken, 0);
    EXPECT_GT(simulation.statistics().flow_steps, steps + 50);
  }
}

}  // namespace
