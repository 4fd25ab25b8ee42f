// Energy at impacts (docs/method.md, section 5): what can be gained, what cannot, and who is told.

#include "tests/analytic/sphere_impact.h"
#include "tests/energy/ledger_check.h"
#include "tests/random.h"
#include "tests/shares.h"

#include <carom/carom.h>

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace {

using namespace carom;
using namespace carom::planar;
using carom_test::ledger_closes;

/// r1 = r, r2 = -r, I = m r^2, mu = 1: the corner at (-r, -r) of a body without spin strikes with (v0, -2
/// v0).
System inconsistent(double e_n, double e_t, double mass = 1.0, double r = 1.0, double v0 = 1.0) {
  System system;
  system.add(HalfPlane{.normal = {0.0, 1.0}},
             Surface{.friction = 1.0, .normal_restitution = e_n, .tangential_restitution = e_t}, "floor");
  const BodyId body = system.add(
      RigidBody{
          .mass = {.mass = mass, .inertia = mass * r * r}, .position = {0.0, r}, .velocity = {v0, -2.0 * v0}},
      "body");
  system.add(Point{.body = body, .position = {-r, -r}});
  return system;
}

TEST(ImpactGain, PapersExampleIsReproducedAndReported) {
  struct Example {
    double e_n, e_t, part;
  };
  for (const Example& example :
       {Example{1.0, 0.0, 2.0 / 15.0}, Example{1.0, 0.5, 1.0 / 30.0}, Example{1.0, 1.0, 0.0}}) {
    constexpr double mass = 3.7, v0 = 1.9;
    Simulation simulation(inconsistent(example.e_n, example.e_t, mass, 0.4, v0), TimeStepping{});
    std::vector<std::string> news;
    simulation.log() =
        Log([&](LogLevel, std::string_view line) { news.emplace_back(line); }, LogLevel::warning);
    const double before = simulation.energy().kinetic();
    EXPECT_DOUBLE_EQ(before, 2.5 * mass * v0 * v0);
    simulation.step();
    // A dozen operations on numbers of the size of T.
    const double round_off = 16.0 * 2.3e-16 * before;
    const double gain = simulation.energy().kinetic() - before;
    EXPECT_NEAR(gain, example.part * before, round_off);
    EXPECT_NEAR(gain, analytic::inconsistent_impact_energy(mass, v0, example.e_n, example.e_t), round_off);
    EXPECT_TRUE(ledger_closes(simulation.energy()));
    EXPECT_NEAR(simulation.energy().flow(EnergyFlow::impact_normal) +
                    simulation.energy().flow(EnergyFlow::impact_tangential),
                -gain, round_off);
    if (example.part > 0.0) {
      EXPECT_NEAR(simulation.report().energy_gain, gain, round_off);
      EXPECT_EQ(simulation.statistics().energy_gains, 1);
      EXPECT_NEAR(simulation.statistics().energy_gained, gain, round_off);
      ASSERT_EQ(news.size(), 1u);
      EXPECT_NE(news[0].find("impact adds"), std::string::npos) << news[0];
    } else {
      EXPECT_EQ(simulation.report().energy_gain, 0.0);
      EXPECT_EQ(simulation.statistics().energy_gains, 0);
      EXPECT_TRUE(news.empty());
    }
  }
}

TEST(ImpactGain, GainedExactlyWhereTheFormulaSays) {
  // Gained where e_n > (e_t + sqrt(12 - 3 e_t^2))/4.
  for (double e_t = 0.0; e_t <= 1.0; e_t += 0.125) {
    const double border = 0.25 * (e_t + std::sqrt(12.0 - 3.0 * e_t * e_t));
    for (const double e_n : {border - 1e-6, border + 1e-6}) {
      if (e_n > 1.0) continue;
      Simulation simulation(inconsistent(e_n, e_t), TimeStepping{});
      simulation.step();
      EXPECT_EQ(simulation.statistics().energy_gains, e_n > border ? 1 : 0) << e_n << " " << e_t;
    }
  }
}

TEST(ImpactGain, CanBeRefused) {
  Simulation simulation(inconsistent(1.0, 0.0),
                        TimeStepping{.impact_rules = {.energy_gain = EnergyGain::refuse}});
  const State before = simulation.state();
  try {
    simulation.step();
    FAIL() << "nothing was thrown";
  } catch (const SolverError& error) {
    const std::string message = error.what();
    EXPECT_NE(message.find("body 'body'"), std::string::npos) << message;
    EXPECT_NE(message.find("half-plane 'floor'"), std::string::npos) << message;
    EXPECT_NE(message.find("0.333"), std::string::npos) << message;
    EXPECT_TRUE(error.has_problem());
  }
  EXPECT_EQ(simulation.state().q, before.q);
  EXPECT_EQ(simulation.state().v, before.v);
  EXPECT_EQ(simulation.statistics().steps, 0);
  // A law that gains nothing passes.
  Simulation allowed(inconsistent(1.0, 1.0),
                     TimeStepping{.impact_rules = {.energy_gain = EnergyGain::refuse}});
  EXPECT_NO_THROW(allowed.step());
}

TEST(ImpactGain, NeverWithOneCoefficientAndOneContact) {
  // T changes by P_n (y- + y+)/2 + P_t (x- + x+)/2 <= 0 for e_n = e_t and a fixed obstacle.
  carom_test::Random random(20250111);
  for (int trial = 0; trial < carom_test::count_of_samples(20000); ++trial) {
    const double e = trial % 7 == 0 ? 1.0 : random.uniform(0.0, 1.0);
    System system;
    system.add(
        HalfPlane{.normal = {0.0, 1.0}},
        Surface{.friction = random.uniform(0.0, 5.0), .normal_restitution = e, .tangential_restitution = e});
    const double mass = std::pow(10.0, random.uniform(-3.0, 3.0));
    const double gyration = std::pow(10.0, random.uniform(-1.0, 1.0));
    const Vec<2> corner(random.uniform(-2.0, 2.0), random.uniform(-2.0, 2.0));
    const BodyId body = system.add(RigidBody{.mass = {.mass = mass, .inertia = mass * gyration * gyration},
                                             .position = {0.0, -corner[1] - 1e-9},
                                             .velocity = random.vec<2>(10.0),
                                             .spin = random.uniform(-10.0, 10.0)});
    system.add(Point{.body = body, .position = corner});
    Simulation simulation(std::move(system), TimeStepping{});
    const double before = simulation.energy().kinetic();
    simulation.step();
    // A few roundings (contact velocities, impulses, new velocities, T) times the condition of W, in which
    // the arm counts with its square over that of the radius of gyration.
    const double condition = 1.0 + corner.squaredNorm() / (gyration * gyration);
    EXPECT_LE(simulation.energy().kinetic(), before * (1.0 + 8.0 * 2.3e-16 * condition)) << "trial " << trial;
    EXPECT_EQ(simulation.statistics().energy_gains, 0) << "trial " << trial;
    EXPECT_TRUE(ledger_closes(simulation.energy())) << "trial " << trial;
  }
}

}  // namespace
