// The energy ledger of the event-driven mode: its residual follows the tolerance; elastic bounces keep their
// energy.

#include "examples/scenes/incline.h"
#include "tests/integrators/event_run.h"

#include <carom/carom.h>

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace {

using namespace carom;
using namespace carom::planar;
using namespace carom_test;

constexpr double g = 9.81;

/// Two particles on a damped spring, thrown down a rough slope: dashpot, friction, impacts, lasting contact.
System damped_pair() {
  System system;
  system.add(Gravity{{0.0, -g}});
  system.add(HalfPlane{.normal = incline(-0.1)},
             Surface{.friction = 0.2, .normal_restitution = 0.4, .tangential_restitution = 0.2});
  const BodyId a = system.add(Particle{.mass = 1.0, .position = {0.0, 1.0}, .velocity = {1.0, 0.0}});
  const BodyId b = system.add(Particle{.mass = 1.0, .position = {0.5, 1.3}});
  system.add(SpringDamper{.from = a, .to = b, .stiffness = 100.0, .damping = 0.3, .free_length = 0.5});
  system.add(AppliedForce{.on = a, .force = [](double t) { return Vec<2>(std::sin(3.0 * t), 0.0); }});
  return system;
}

TEST(EventLedger, ResidualFollowsTheTolerance) {
  for (const FlowMethod method : {FlowMethod::explicit_runge_kutta, FlowMethod::one_step}) {
    std::vector<double> logs;
    for (int digits = 6; digits <= 11; ++digits) {
      const double tolerance = std::pow(10.0, -digits);
      Simulation simulation(damped_pair(), EventDriven{.relative_tolerance = tolerance,
                                                       .absolute_tolerance = 1e-2 * tolerance,
                                                       .method = method});
      const LedgerWatch ledger(simulation);
      simulation.run_until(4.0);
      EXPECT_TRUE(ledger.closes()) << digits;
      EXPECT_GT(simulation.energy().flow(EnergyFlow::dashpot), 0.1);
      EXPECT_GT(simulation.energy().flow(EnergyFlow::sliding), 0.1);
      EXPECT_GT(simulation.energy().flow(EnergyFlow::impact_normal), 1.0);
      logs.push_back(std::log10(ledger.largest()));
      note("residual at 1e-" + std::to_string(digits), ledger.largest());
    }
    // Slope of the line of least squares through six points.
    double slope = 0.0, squares = 0.0;
    for (std::size_t i = 0; i < logs.size(); ++i) {
      const double x = static_cast<double>(i) - 0.5 * static_cast<double>(logs.size() - 1);
      slope -= x * logs[i];
      squares += x * x;
    }
    slope /= squares;
    // Proportional, but for the scatter of where steps end: a factor of two up or down at both ends.
    EXPECT_NEAR(slope, 1.0, 2.0 * std::log10(2.0) / 5.0);
    note("slope", slope);
  }
}

/// Runs until there have been so many impacts; returns the largest error of the energy against the start's.
double energy_error(Simulation& simulation, std::int64_t impacts) {
  const double start = simulation.energy().total();
  double worst = 0.0;
  while (simulation.statistics().impacts < impacts) {
    simulation.step();
    worst = std::max(worst, std::abs(simulation.energy().total() - start));
  }
  return worst / start;
}

TEST(EventLedger, ThousandElasticBounces) {
  // A ball on the floor: flights are parabolas.
  System system;
  system.add(Gravity{{0.0, -g}});
  system.add(HalfPlane{.normal = {0.0, 1.0}}, Surface{.friction = 0.0, .normal_restitution = 1.0});
  system.add(Particle{.mass = 1.0, .position = {0.0, 1.0}});
  Simulation simulation(std::move(system), tight());
  const LedgerWatch ledger(simulation);
  const double error = energy_error(simulation, 1000);
  EXPECT_LE(error, 1e-10);
  note("ball", error);
  EXPECT_EQ(simulation.events().size(), 1000u);
  EXPECT_TRUE(ledger.closes());
}

void elastic_bounces_on_a_spring(std::int64_t impacts) {
  System system;
  system.add(HalfPlane{.point = {0.2, 0.0}, .normal = {-1.0, 0.0}},
             Surface{.friction = 0.0, .normal_restitution = 1.0});
  const BodyId mass = system.add(Particle{.mass = 1.0, .position = {-1.0, 0.0}});
  system.add(SpringDamper{.from = {ground, {-3.0, 0.0}}, .to = mass, .stiffness = 9.0, .free_length = 3.0});
  Simulation simulation(std::move(system), tight());
  const LedgerWatch ledger(simulation);
  const double error = energy_error(simulation, impacts);
  EXPECT_LE(error, 1e-11 * static_cast<double>(impacts));
  note("spring", error);
  EXPECT_TRUE(ledger.closes());
}

TEST(EventLedger, HundredElasticBouncesOnASpring) { elastic_bounces_on_a_spring(100); }

TEST(EventLedgerLong, ThousandElasticBouncesOnASpring) { elastic_bounces_on_a_spring(1000); }

TEST(EventLedger, ThousandElasticBouncesOfASpinningDisc) {
  // e_n = e_t = 1, and so much friction that slow grazes of a wall stick too: spin and velocity change
  // places.
  constexpr double r = 0.2;
  System system;
  system.add(Gravity{{0.0, -g}});
  const Surface surface{.friction = 1e6, .normal_restitution = 1.0, .tangential_restitution = 1.0};
  system.add(HalfPlane{.normal = {0.0, 1.0}}, surface);
  system.add(HalfPlane{.point = {2.0, 0.0}, .normal = {-1.0, 0.0}}, surface);
  system.add(HalfPlane{.point = {-2.0, 0.0}, .normal = {1.0, 0.0}}, surface);
  const BodyId disc = system.add(
      RigidBody{.mass = planar::disc(1.0, r), .position = {0.0, 1.0}, .velocity = {1.0, 0.0}, .spin = 5.0});
  system.add(Disc{.body = disc, .radius = r});
  Simulation simulation(std::move(system), tight());
  const LedgerWatch ledger(simulation);
  const double error = energy_error(simulation, 1000);
  EXPECT_LE(error, 1e-10);
  note("disc", error);
  EXPECT_TRUE(ledger.closes());
}

}  // namespace
