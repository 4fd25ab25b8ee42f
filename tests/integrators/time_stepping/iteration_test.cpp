// The ways to the end of a step: all lead to the same one, each where it says.

#include "tests/energy/ledger_check.h"
#include "tests/integrators/throws.h"

#include <carom/carom.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace {

using namespace carom;
using namespace carom::planar;
using carom_test::ledger_closes;

/// A turning pair: two masses of 1 kg on a spring of free length 1 m.
System pair(double stiffness, double damping = 0.0) {
  System system;
  const BodyId first = system.add(Particle{.mass = 1.0, .position = {0.52, 0.0}, .velocity = {0.0, 1.0}});
  const BodyId second = system.add(Particle{.mass = 1.0, .position = {-0.52, 0.0}, .velocity = {0.0, -1.0}});
  system.add(SpringDamper{
      .from = first, .to = second, .stiffness = stiffness, .damping = damping, .free_length = 1.0});
  return system;
}

/// A net of 4 x 4 falling on a slope, its dashpots strong.
System net(double stiffness) {
  System system;
  system.add(Gravity{{0.0, -9.81}});
  system.add(HalfPlane{.point = {0.0, -0.02}, .normal = {-std::sin(0.1), std::cos(0.1)}},
             Surface{.friction = 0.3, .normal_restitution = 0.5, .tangential_restitution = 0.5});
  std::vector<BodyId> dots;
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j) {
      dots.push_back(
          system.add(Particle{.mass = 0.1, .position = {0.1 * j, 0.1 * i}, .velocity = {0.5, -1.0}}));
    }
  }
  const auto join = [&](int a, int b, double length) {
    system.add(SpringDamper{.from = dots[static_cast<std::size_t>(a)],
                            .to = dots[static_cast<std::size_t>(b)],
                            .stiffness = stiffness,
                            .damping = 1.0,
                            .free_length = length});
  };
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j) {
      if (j < 3) join(4 * i + j, 4 * i + j + 1, 0.1);
      if (i < 3) join(4 * i + j, 4 * i + j + 4, 0.1);
      if (i < 3 && j < 3) join(4 * i + j, 4 * i + j + 5, 0.1 * std::numbers::sqrt2);
    }
  }
  return system;
}

/// The largest difference of coordinates after `steps` steps of both.
double difference(const System& system, TimeStepping a, TimeStepping b, int steps) {
  Simulation first(system, a), second(system, b);
  double largest = 0.0;
  for (int i = 0; i < steps; ++i) {
    first.step();
    second.step();
    for (std::size_t k = 0; k < first.state().q.size(); ++k) {
      largest = std::max(largest, std::abs(first.state().q[k] - second.state().q[k]));
    }
  }
  return largest;
}

TEST(Iteration, AllEndAtTheSameStep) {
  for (const ForceRule rule : {ForceRule::trapezoidal, ForceRule::energy_momentum}) {
    const TimeStepping plain{.step = 1e-3, .tolerance = 1e-14, .force_rule = rule};
    for (const Iteration iteration : {Iteration::anderson, Iteration::linearly_implicit}) {
      TimeStepping other = plain;
      other.iteration = iteration;
      // Each leaves an error of the tolerance over one minus its contraction, a few 1e-14 a step, and the
      // pair adds up 200 of them in its phase.
      EXPECT_LE(difference(pair(5e4, 10.0), plain, other, 200), 1e-10) << to_string(iteration);
    }
  }
}

TEST(Iteration, AllEndAtTheSameStepInContact) {
  const TimeStepping plain{.step = 2e-4, .tolerance = 1e-14};
  for (const Iteration iteration : {Iteration::anderson, Iteration::linearly_implicit}) {
    TimeStepping other = plain;
    other.iteration = iteration;
    // 60 ms: the lowest row has struck, some particles slide.
    Simulation check(net(1e4), other);
    check.run_until(0.06);
    EXPECT_GT(check.statistics().impacts, 0);
    EXPECT_TRUE(ledger_closes(check.energy()));
    EXPECT_LE(check.statistics().worst_residual, 1e-12);
    EXPECT_LE(difference(net(1e4), plain, other, 300), 1e-10) << to_string(iteration);
  }
}

TEST(Iteration, TheReportSaysWhichRanAndHow) {
  for (const Iteration iteration :
       {Iteration::fixed_point, Iteration::anderson, Iteration::linearly_implicit}) {
    Simulation simulation(pair(1e6), TimeStepping{.step = 1e-3, .iteration = iteration});
    const StepReport& report = simulation.step();
    EXPECT_EQ(report.iteration, iteration);
    EXPECT_GE(report.sweeps, 2);
    // h^2 k/(4 m) times 2, for both ends move: 0.5 for plain sweeps.
    if (iteration == Iteration::fixed_point) {
      EXPECT_NEAR(report.contraction, 0.5, 0.05);
    }
    if (iteration == Iteration::linearly_implicit) {
      EXPECT_LT(report.contraction, 0.1);
    }
  }
}

TEST(Iteration, AndersonNeedsFewerSweeps) {
  Simulation plain(net(2e4), TimeStepping{.step = 1e-3});
  Simulation anderson(net(2e4), TimeStepping{.step = 1e-3, .iteration = Iteration::anderson});
  plain.run_until(0.05);
  anderson.run_until(0.05);
  EXPECT_LT(3 * anderson.statistics().sweeps, 2 * plain.statistics().sweeps);
}

TEST(Iteration, AndersonAloneConvergesWhereSweepsGrow) {
  // 1.3 for the contraction of plain sweeps.
  const TimeStepping plain{.step = 1e-3, .iteration = Iteration::fixed_point};
  TimeStepping other = plain;
  other.iteration = Iteration::anderson;
  Simulation refused(pair(2.6e6), plain);
  EXPECT_THROW(refused.step(), SolverError);
  Simulation simulation(pair(2.6e6), other);
  EXPECT_NO_THROW(simulation.run_until(0.1));
  EXPECT_TRUE(ledger_closes(simulation.energy()));
}

/// h^2 k/m = 1e4.
constexpr double stiff_step = 1e-2;
constexpr double stiff = 1e8;

TEST(Iteration, StiffPairIsRefusedByPlainSweepsByName) {
  Simulation simulation(pair(stiff), TimeStepping{.step = stiff_step, .iteration = Iteration::fixed_point});
  const std::vector<double> before = simulation.state().q;
  try {
    simulation.step();
    FAIL();
  } catch (const SolverError& error) {
    const std::string text = error.what();
    for (const char* part : {"fixed-point iteration does not contract", "spring-damper #0", "rate",
                             "would contract", "linearly implicit"}) {
      EXPECT_NE(text.find(part), std::string::npos) << text;
    }
    ASSERT_FALSE(error.failure().parts.empty());
    EXPECT_GT(error.failure().suggested_step, 0.0);
  }
  EXPECT_EQ(simulation.state().q, before);
}

TEST(Iteration, StiffPairIsStableWithTheLinearlyImplicitSolve) {
  // Along its axis the trapezoidal rule keeps the energy whatever the step.
  System system;
  const BodyId first = system.add(Particle{.mass = 1.0, .position = {0.52, 0.0}});
  const BodyId second = system.add(Particle{.mass = 1.0, .position = {-0.52, 0.0}});
  system.add(SpringDamper{.from = first, .to = second, .stiffness = stiff, .free_length = 1.0});
  Simulation simulation(std::move(system),
                        TimeStepping{.step = stiff_step, .iteration = Iteration::linearly_implicit});
  const double start = simulation.energy().total();
  double largest = 0.0;
  for (int i = 0; i < 1000; ++i) {
    simulation.step();
    largest = std::max(largest, std::abs(simulation.energy().total() - start));
  }
  // Positions are known to 1e-16 m, so the force to k 1e-16 and the energy to k 1e-16 times the stretch of
  // 0.04 m, 2e-16 of itself; the iteration leaves 1e-12 m (its tolerance), 5e-11 of the energy a step at
  // worst, mostly of changing sign.
  EXPECT_LE(largest, 1e-8 * start);
  EXPECT_TRUE(ledger_closes(simulation.energy())) << simulation.energy().residual();
}

TEST(Iteration, StiffTurningPairIsStable) {
  // Turning nearly at its free length, as a rod would (the pull of 1 m/s stretches it by 4e-8 m), under the
  // rule that conserves: T + V cannot grow, whatever the stiffness; damped: it must not either.
  for (const double damping : {0.0, 1e3}) {
    System system;
    const BodyId first = system.add(Particle{.mass = 1.0, .position = {0.5, 0.0}, .velocity = {0.0, 1.0}});
    const BodyId second = system.add(Particle{.mass = 1.0, .position = {-0.5, 0.0}, .velocity = {0.0, -1.0}});
    system.add(SpringDamper{
        .from = first, .to = second, .stiffness = stiff, .damping = damping, .free_length = 1.0});
    Simulation simulation(std::move(system), TimeStepping{.step = stiff_step,
                                                          .force_rule = ForceRule::energy_momentum,
                                                          .iteration = Iteration::linearly_implicit});
    const double start = simulation.energy().total();
    for (int i = 0; i < 1000; ++i) simulation.step();
    EXPECT_LE(simulation.energy().total(), start * (1.0 + 1e-8));
    EXPECT_TRUE(ledger_closes(simulation.energy())) << simulation.energy().residual();
  }
}

TEST(Iteration, StiffPairOnAPlane) {
  // A stiff upright pair dropped on a plane: contact and coupling are solved together.
  System system;
  system.add(Gravity{{0.0, -9.81}});
  system.add(HalfPlane{.point = {0.0, 0.0}, .normal = {0.0, 1.0}},
             Surface{.friction = 0.3, .normal_restitution = 0.0, .tangential_restitution = 0.0});
  const BodyId lower = system.add(Particle{.mass = 1.0, .position = {0.0, 0.05}, .velocity = {0.4, 0.0}});
  const BodyId upper = system.add(Particle{.mass = 1.0, .position = {0.0, 1.05}, .velocity = {0.4, 0.0}});
  system.add(
      SpringDamper{.from = lower, .to = upper, .stiffness = stiff, .damping = 1e5, .free_length = 1.0});
  Simulation simulation(std::move(system),
                        TimeStepping{.step = stiff_step, .iteration = Iteration::linearly_implicit});
  simulation.run_until(0.3);
  EXPECT_GT(simulation.statistics().contact_steps, 0);
  EXPECT_GE(simulation.state().position(lower)[1], -0.02);
  // The rule keeps such a stiff vibration from growing, it does not damp it: the blow of 1 m/s stays in it,
  // changing sign every step, over h times that speed.
  EXPECT_NEAR(simulation.state().position(upper)[1] - simulation.state().position(lower)[1], 1.0, 1e-2);
  EXPECT_TRUE(ledger_closes(simulation.energy()));
}

TEST(Iteration, GoesOnBitForBitFromACheckpoint) {
  const std::string path = testing::TempDir() + "iteration.checkpoint";
  for (const Iteration iteration : {Iteration::anderson, Iteration::linearly_implicit}) {
    const TimeStepping options{.step = 1e-3, .iteration = iteration};
    Simulation whole(net(1e4), options);
    whole.run_until(0.05);
    whole.save(path);
    whole.run_until(0.1);
    Simulation loaded(whole.system(), options);
    loaded.load(path);
    loaded.run_until(0.1);
    EXPECT_EQ(loaded.state().q, whole.state().q) << to_string(iteration);
    EXPECT_EQ(loaded.state().v, whole.state().v);
  }
  std::remove(path.c_str());
}

}  // namespace
