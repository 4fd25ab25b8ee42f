// Particles in space: the same steps with three coordinates and a friction disc instead of an interval.

#include "tests/analytic/convergence.h"
#include "tests/analytic/projectile.h"
#include "tests/analytic/sphere_impact.h"
#include "tests/energy/ledger_check.h"
#include "tests/random.h"

#include <carom/carom.h>

#include <Eigen/Geometry>

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace {

using namespace carom;
using namespace carom::spatial;
using carom_test::ledger_closes;

TEST(SpatialParticle, FliesOnAParabola) {
  const analytic::Projectile<3> flight{{1.0, 2.0, 3.0}, {4.0, -5.0, 6.0}, {0.1, -0.2, -9.81}};
  System system;
  system.add(Gravity{flight.gravity});
  const BodyId body =
      system.add(Particle{.mass = 0.7, .position = flight.start, .velocity = flight.velocity_at_start});
  Simulation simulation(std::move(system), TimeStepping{.step = 1e-2});
  simulation.run_until(2.0);
  // Exact but for the rounding of 200 additions to numbers of size 20.
  EXPECT_LE((Vec<3>(simulation.state().position(body)) - flight.position(2.0)).norm(), 200 * 20 * 1.2e-16);
  EXPECT_LE((Vec<3>(simulation.state().velocity(body)) - flight.velocity(2.0)).norm(), 200 * 20 * 1.2e-16);
  EXPECT_TRUE(ledger_closes(simulation.energy()));
}

TEST(SpatialParticle, BouncesByTheClosedForm) {
  carom_test::Random random(7);
  int sticks = 0, slips = 0;
  for (int trial = 0; trial < 500; ++trial) {
    const double mass = std::pow(10.0, random.uniform(-2.0, 2.0));
    const Surface surface{.friction = random.uniform(0.0, 1.5),
                          .normal_restitution = random.uniform(0.0, 1.0),
                          .tangential_restitution = random.uniform(0.0, 1.0)};
    const Vec<3> normal = random.vec<3>().normalized();
    Vec<3> velocity = random.vec<3>(10.0);
    if (velocity.dot(normal) > 0.0) velocity = -velocity;
    System system;
    system.add(HalfSpace{.point = {1.0, 2.0, 3.0}, .normal = normal}, surface);
    const BodyId body = system.add(
        Particle{.mass = mass, .position = Vec<3>(1.0, 2.0, 3.0) - 1e-9 * normal, .velocity = velocity});
    Simulation simulation(std::move(system), TimeStepping{});
    const StepReport& report = simulation.step();

    const analytic::SphereImpact law{mass, mass, surface.friction, surface.normal_restitution,
                                     surface.tangential_restitution};
    const double approach = velocity.dot(normal);
    const Vec<3> slip = velocity - approach * normal;
    const Vec<3> expected = -surface.normal_restitution * approach * normal +
                            (1.0 - law.tangential_factor(approach, slip.norm()) / mass) * slip;
    EXPECT_LE((Vec<3>(simulation.state().velocity(body)) - expected).norm(), 1e-12) << trial;
    ASSERT_EQ(report.contacts.size(), 1u);
    EXPECT_EQ(report.contacts[0].directions, 3);
    const bool stick = law.sticks(approach, slip.norm());
    EXPECT_EQ(report.contacts[0].mode, stick ? ContactMode::stick : ContactMode::slip) << trial;
    (stick ? sticks : slips) += 1;
    EXPECT_TRUE(ledger_closes(simulation.energy())) << trial;
    // Isotropy: friction acts against the slip, never across it.
    const double across =
        (Vec<3>(simulation.state().velocity(body)) - velocity).dot(normal.cross(slip).normalized());
    EXPECT_LE(std::abs(across), 1e-12) << trial;
  }
  EXPECT_GE(sticks, 50);
  EXPECT_GE(slips, 50);
}

TEST(SpatialParticle, SlidesDownAPlaneAndSticks) {
  // a = g (sin - mu cos) along the line of steepest descent; at rest for mu > tan.
  const double slope = 0.4;
  const Vec<3> normal(std::sin(slope) * 0.6, std::sin(slope) * 0.8, std::cos(slope));
  const Vec<3> down = (normal[2] * normal - Vec<3>::UnitZ()).normalized();
  for (const double mu : {0.1, 0.3, 0.6}) {
    System system;
    system.add(Gravity{{0.0, 0.0, -9.81}});
    system.add(HalfSpace{.normal = normal}, Surface{.friction = mu, .normal_restitution = 0.0});
    const Vec<3> start = -1e-9 * normal;
    const BodyId body = system.add(Particle{.mass = 2.0, .position = start});
    Simulation simulation(std::move(system), TimeStepping{.step = 1e-3});
    simulation.run_until(1.0);
    const double a = std::max(0.0, 9.81 * (std::sin(slope) - mu * std::cos(slope)));
    EXPECT_LE((Vec<3>(simulation.state().position(body)) - start - 0.5 * a * down).norm(), 1e-12) << mu;
    EXPECT_LE((Vec<3>(simulation.state().velocity(body)) - a * down).norm(), 1e-12) << mu;
    EXPECT_TRUE(ledger_closes(simulation.energy()));
  }
}

TEST(SpatialParticle, SpringOscillatesWithOrderTwo) {
  // A spring of free length 0 to the ground: x'' = -(k/m) x in every direction.
  const double w = std::sqrt(50.0 / 0.5);
  const Vec<3> anchor(1.0, -1.0, 0.5), x0(0.3, 0.4, -0.2), v0(1.0, 0.0, 2.0);
  const double t = 2.0;
  const Vec<3> exact = anchor + std::cos(w * t) * x0 + std::sin(w * t) / w * v0;
  std::vector<double> steps, errors;
  for (const double step : {2e-3, 1e-3, 5e-4, 2.5e-4}) {
    System system;
    const BodyId body = system.add(Particle{.mass = 0.5, .position = anchor + x0, .velocity = v0});
    system.add(SpringDamper{.from = {ground, anchor}, .to = body, .stiffness = 50.0, .free_length = 0.0});
    Simulation simulation(std::move(system), TimeStepping{.step = step, .tolerance = 1e-14});
    simulation.run_until(t);
    steps.push_back(step);
    errors.push_back((Vec<3>(simulation.state().position(body)) - exact).norm());
    EXPECT_TRUE(ledger_closes(simulation.energy()));
    // Linear in the coordinates: energy is kept.
    EXPECT_NEAR(simulation.energy().total(), simulation.energy().initial(),
                1e-12 * simulation.energy().scale());
  }
  EXPECT_NEAR(analytic::slope(steps, errors), 2.0, 1e-3);  // series in h^2, (h w)^2/10 = 4e-5
}

TEST(SpatialParticle, PairOnASpringOverAPlane) {
  System system;
  system.add(Gravity{{0.0, 0.0, -9.81}});
  system.add(HalfSpace{.normal = {0.1, 0.2, 1.0}},
             Surface{.friction = 0.3, .normal_restitution = 0.8, .tangential_restitution = 0.8});
  const BodyId a =
      system.add(Particle{.mass = 1.0, .position = {0.0, 0.0, 2.0}, .velocity = {3.0, 1.0, 0.0}});
  const BodyId b = system.add(Particle{.mass = 0.4, .position = {0.5, 0.3, 2.8}});
  system.add(SpringDamper{.from = a, .to = b, .stiffness = 800.0, .damping = 0.5, .free_length = 1.0});
  Simulation simulation(std::move(system), TimeStepping{.step = 5e-4});
  simulation.observe([](const Simulation& now) { ASSERT_TRUE(ledger_closes(now.energy())) << now.time(); });
  simulation.run_until(4.0);
  EXPECT_GE(simulation.statistics().impacts, 4);
  EXPECT_LE(simulation.statistics().worst_residual, 1e-12);
  EXPECT_EQ(simulation.statistics().energy_gains, 0);
  EXPECT_GT(simulation.energy().flow(EnergyFlow::dashpot), 0.0);
}

}  // namespace
