// One step at a time: what the trapezoidal rule and the law of contact make of it, what is reported.

#include "examples/scenes/incline.h"
#include "tests/analytic/projectile.h"
#include "tests/analytic/sphere_impact.h"
#include "tests/energy/ledger_check.h"
#include "tests/integrators/same_run.h"
#include "tests/random.h"

#include <carom/carom.h>
#include <carom/integrators/run/companion.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace {

using namespace carom;
using namespace carom::planar;
using carom_test::ledger_closes;

constexpr double eps = std::numeric_limits<double>::epsilon();

TEST(TimeStepper, FollowsAParabolaExactly) {
  const analytic::Projectile<2> flight{{1.0, 20.0}, {10.0, 3.0}, {0.5, -9.81}};
  System system;
  system.add(Gravity{flight.gravity});
  const BodyId particle =
      system.add(Particle{.mass = 0.3, .position = flight.start, .velocity = flight.velocity_at_start});
  const BodyId body = system.add(RigidBody{.mass = rod(2.0, 1.0),
                                           .position = flight.start,
                                           .angle = 0.1,
                                           .velocity = flight.velocity_at_start,
                                           .spin = -4.0});
  Simulation simulation(std::move(system), TimeStepping{.step = 1e-2});
  simulation.run_until(3.0);
  const State& state = simulation.state();
  for (const BodyId id : {particle, body}) {
    // 300 additions of rounded steps to numbers of size 50.
    EXPECT_LE((Vec<2>(state.position(id)) - flight.position(3.0)).norm(), 300 * 50 * 0.5 * eps);
    // The rounding of velocities is carried on, so that it does not add up.
    EXPECT_LE((Vec<2>(state.velocity(id)) - flight.velocity(3.0)).norm(), 4 * 30 * eps);
  }
  EXPECT_EQ(state.spin(body), -4.0);
  EXPECT_NEAR(state.angle(body), 0.1 - 12.0, 300 * 12 * 0.5 * eps);
  EXPECT_EQ(simulation.statistics().most_sweeps, 1);  // nothing to iterate
}

TEST(TimeStepper, OscillatorTakesTheStepOfTheTrapezoidalRule) {
  // m x'' = -k x - c x', one step: (1 + a + b) v1 = (1 - a - b) v0 - (h k/m) x0 with a = h^2 k/(4 m),
  // b = h c/(2 m), x1 = x0 + h (v0 + v1)/2.
  constexpr double m = 2.0, k = 300.0, c = 1.5, x0 = 0.4, v0 = -3.0, h = 1e-2;
  System system;
  // The dashpot of a spring of free length 0 acts along the line, which is the x-axis.
  const BodyId mass = system.add(Particle{.mass = m, .position = {x0, 0.0}, .velocity = {v0, 0.0}});
  system.add(SpringDamper{.from = ground, .to = mass, .stiffness = k, .damping = c, .free_length = 0.0});
  Simulation simulation(std::move(system), TimeStepping{.step = h, .tolerance = 0.0});
  simulation.step();
  const double a = 0.25 * h * h * k / m, b = 0.5 * h * c / m;
  const double v1 = ((1.0 - a - b) * v0 - h * k / m * x0) / (1.0 + a + b);
  EXPECT_NEAR(simulation.state().velocity(mass)[0], v1, 4 * eps * std::abs(v0));
  EXPECT_NEAR(simulation.state().position(mass)[0], x0 + 0.5 * h * (v0 + v1), 4 * eps);
  EXPECT_EQ(simulation.state().position(mass)[1], 0.0);
}

TEST(TimeStepper, GuessesLoadsThatGoOnAsAPolynomial) {
  // A force of n^3 newtons at the end of step n, whose differences have no rounding: with three of them known
  // the guess is what it leads to.
  constexpr double h = 0x1p-10;
  System system;
  const BodyId mass = system.add(Particle{.mass = 1.0});
  system.add(planar::AppliedForce{.on = mass, .force = [](double t) -> Vec<2> {
                                    const double n = t / h;
                                    return {n * n * n, -n * n};
                                  }});
  Simulation simulation(std::move(system), TimeStepping{.step = h});
  for (int i = 0; i < 3; ++i) EXPECT_GT(simulation.step().sweeps, 1) << i;
  for (int i = 0; i < 20; ++i) EXPECT_EQ(simulation.step().sweeps, 1) << i;
}

TEST(TimeStepper, LoadsMayBeLargerThanFloats) {
  // The guess is kept as floats, which end at 3e38; the step does not depend on it.
  const auto end = [](double scale) {
    System system;
    const BodyId mass = system.add(Particle{.mass = scale});
    system.add(planar::AppliedForce{.on = mass, .force = [scale](double t) -> Vec<2> {
                                      return {scale * std::cos(9.0 * t), 0.0};
                                    }});
    Simulation simulation(std::move(system), TimeStepping{.step = 1e-2, .tolerance = 0.0});
    simulation.run_until(0.5);
    return simulation.state().position(mass)[0];
  };
  EXPECT_NEAR(end(1e45), end(1.0), 50 * eps);  // 50 steps, each rounded
}

TEST(TimeStepper, LoadsThatNeverChangeNeedNoIterationAndLeadToTheSame) {
  // A spring without stiffness changes no load, but its component is iterated.
  const auto end = [](bool with_spring) {
    System system;
    system.add(Gravity{{0.5, -9.81}});
    system.add(HalfPlane{.normal = {0.0, 1.0}}, Surface{.friction = 0.3, .normal_restitution = 0.6}, "floor");
    const BodyId wheel = system.add(
        RigidBody{.mass = disc(2.0, 0.1), .position = {0.0, 0.4}, .velocity = {1.0, 0.0}, .spin = 3.0});
    system.add(Disc{.body = wheel, .radius = 0.1});
    if (with_spring) system.add(SpringDamper{.from = ground, .to = wheel, .free_length = 1.0});
    Simulation simulation(std::move(system), TimeStepping{.step = 1e-3});
    simulation.run_until(2.0);
    EXPECT_GT(simulation.statistics().impacts, 3);
    return std::pair(carom_test::motion_bits(simulation.state()), simulation.energy().save());
  };
  EXPECT_EQ(end(false), end(true));
}

TEST(TimeStepper, ToleranceBoundsWhatIsLeftOfTheIteration) {
  // The change between two sweeps is below the tolerance; what is left is smaller by rate/(1 - rate).
  const auto end = [](double tolerance) {
    System system;
    const BodyId mass = system.add(Particle{.mass = 1.0, .position = {1.2, 0.0}, .velocity = {0.0, 3.0}});
    system.add(SpringDamper{.from = ground, .to = mass, .stiffness = 1000.0, .free_length = 1.0});
    Simulation simulation(std::move(system), TimeStepping{.step = 2e-2, .tolerance = tolerance});
    simulation.step();
    return std::pair(simulation.state().q, simulation.report().sweeps);
  };
  const auto [exact, most] = end(0.0);
  int sweeps = most;
  for (const double tolerance : {1e-12, 1e-9, 1e-6}) {
    const auto [q, count] = end(tolerance);
    EXPECT_LE(std::hypot(q[0] - exact[0], q[1] - exact[1]), tolerance);
    EXPECT_LT(count, sweeps);
    sweeps = count;
  }
}

System ball_on_floor(const Vec<2>& position, const Vec<2>& velocity, const Surface& surface,
                     double gravity = 0.0) {
  System system;
  if (gravity > 0.0) system.add(Gravity{{0.0, -gravity}});
  system.add(HalfPlane{.normal = {0.0, 1.0}}, surface, "floor");
  system.add(Particle{.mass = 2.0, .position = position, .velocity = velocity}, "ball");
  return system;
}

TEST(TimeStepper, PointImpactByTheClosedForm) {
  carom_test::Random random(3);
  for (int trial = 0; trial < 2000; ++trial) {
    const Surface surface{.friction = random.uniform(0.0, 2.0),
                          .normal_restitution = random.uniform(0.0, 1.0),
                          .tangential_restitution = random.uniform(0.0, 1.0)};
    const Vec<2> before(random.uniform(-5.0, 5.0), random.uniform(-5.0, -0.01));
    Simulation simulation(ball_on_floor({0.0, 0.0}, before, surface), TimeStepping{});
    const StepReport& report = simulation.step();
    const analytic::SphereImpact law{2.0, 2.0, surface.friction, surface.normal_restitution,
                                     surface.tangential_restitution};
    const double factor = law.tangential_factor(before[1], std::abs(before[0]));
    const Vec<2> after(before[0] * (1.0 - factor / 2.0), -surface.normal_restitution * before[1]);
    const auto velocity = simulation.state().velocity(simulation.system().body("ball"));
    EXPECT_NEAR(velocity[0], after[0], 64 * eps) << trial;  // numbers up to 10
    EXPECT_NEAR(velocity[1], after[1], 64 * eps) << trial;
    ASSERT_EQ(report.contacts.size(), 1u);
    const ContactRecord& contact = report.contacts[0];
    EXPECT_NEAR(contact.impulse[0], law.normal_impulse(before[1]), 128 * eps);
    EXPECT_NEAR(contact.impulse[1], -factor * before[0], 128 * eps);
    const ContactMode expected = law.sticks(before[1], std::abs(before[0])) ? ContactMode::stick
                                 : before[0] > 0.0                          ? ContactMode::slip_positive
                                                                            : ContactMode::slip_negative;
    EXPECT_EQ(contact.mode, expected) << trial;
  }
}

TEST(TimeStepper, ContactRecordTellsAll) {
  Simulation simulation(
      ball_on_floor({0.0, -0.01}, {3.0, -2.0}, {.friction = 0.1, .normal_restitution = 0.5}),
      TimeStepping{.step = 1e-3});
  const StepReport& report = simulation.step();
  EXPECT_EQ(report.time, 1e-3);
  EXPECT_EQ(report.step, 1e-3);
  ASSERT_EQ(report.contacts.size(), 1u);
  const ContactRecord& contact = report.contacts[0];
  EXPECT_EQ(contact.body, simulation.system().body("ball"));
  EXPECT_EQ(contact.obstacle, simulation.system().obstacle("floor"));
  EXPECT_EQ(simulation.name(contact.key), "particle 'ball' on half-plane 'floor'");
  EXPECT_EQ(contact.gap, -0.01);
  EXPECT_EQ(contact.directions, 2);
  EXPECT_EQ(contact.velocity_before[0], -2.0);
  EXPECT_EQ(contact.velocity_before[1], 3.0);
  EXPECT_DOUBLE_EQ(contact.velocity_after[0], 1.0);
  EXPECT_DOUBLE_EQ(contact.impulse[0], 6.0);
  EXPECT_DOUBLE_EQ(contact.impulse[1], -0.6);
  EXPECT_DOUBLE_EQ(contact.velocity_after[1], 2.7);
  EXPECT_DOUBLE_EQ(contact.work[0], 6.0 * 0.5 * (-2.0 + 1.0));
  EXPECT_DOUBLE_EQ(contact.work[1], -0.6 * 0.5 * (3.0 + 2.7));
  EXPECT_TRUE(contact.impact);
  EXPECT_EQ(contact.mode, ContactMode::slip_positive);
  EXPECT_EQ(contact.outcome, Outcome::solved);
  EXPECT_LE(contact.residual, 1e-15);
  EXPECT_FALSE(contact.solver.empty());
  const Statistics& statistics = simulation.statistics();
  EXPECT_EQ(statistics.impacts, 1);
  EXPECT_EQ(statistics.contact_steps, 1);
  EXPECT_EQ(statistics.deepest_gap, -0.01);
  ASSERT_EQ(simulation.companion().modes.size(), 1u);
  EXPECT_EQ(simulation.companion().modes[0].first, contact.key);
}

TEST(TimeStepper, TakesContactsWhoseGapIsNotPositiveToRounding) {
  const Surface surface{.friction = 0.0, .normal_restitution = 1.0};
  Simulation touching(ball_on_floor({0.0, 0.0}, {0.0, -1.0}, surface), TimeStepping{});
  EXPECT_EQ(touching.step().contacts.size(), 1u);
  // A ball that lies on the floor to rounding, up to TimeStepping::tolerance, would fall for a step without
  // it.
  for (const double gap : {5e-324, 1e-16, 9e-13}) {
    Simulation resting(ball_on_floor({0.0, gap}, {0.0, 0.0}, surface, 9.81), TimeStepping{});
    EXPECT_EQ(resting.step().contacts.size(), 1u);
    EXPECT_NEAR(resting.state().q[1], gap, 1e-18);
  }
  Simulation apart(ball_on_floor({0.0, 1.1e-12}, {0.0, -1.0}, surface), TimeStepping{});
  EXPECT_EQ(apart.step().contacts.size(), 0u);  // noticed a step later
  EXPECT_EQ(apart.step().contacts.size(), 1u);
  EXPECT_EQ(apart.state().v[1], 1.0);
  // One that leaves takes part and gets no impulse; its violation is not corrected by moving the body.
  Simulation leaving(ball_on_floor({0.0, -0.5}, {0.0, 1.0}, surface), TimeStepping{.step = 1e-3});
  const StepReport& report = leaving.step();
  ASSERT_EQ(report.contacts.size(), 1u);
  EXPECT_EQ(report.contacts[0].mode, ContactMode::open);
  EXPECT_EQ(report.contacts[0].impulse[0], 0.0);
  EXPECT_FALSE(report.contacts[0].impact);
  EXPECT_EQ(leaving.state().v[1], 1.0);
  EXPECT_NEAR(leaving.state().q[1], -0.5 + 1e-3, eps);
}

TEST(TimeStepper, RestingContactCarriesTheWeight) {
  Simulation simulation(
      ball_on_floor({0.0, -1e-6}, {0.0, 0.0}, {.friction = 0.5, .normal_restitution = 0.0}, 9.81),
      TimeStepping{.step = 1e-3});
  for (int i = 0; i < 1000; ++i) {
    const StepReport& report = simulation.step();
    ASSERT_EQ(report.contacts.size(), 1u);
    EXPECT_NEAR(report.contacts[0].impulse[0], 2.0 * 9.81 * 1e-3, 8 * eps * 0.02);
    EXPECT_FALSE(report.contacts[0].impact);
  }
  // At rest but for the rounding of weight and impulse, 1e-2 eps a step.
  EXPECT_NEAR(simulation.state().q[1], -1e-6, 1e-17);
  EXPECT_LE(std::abs(simulation.state().v[1]), 1e-17);
  EXPECT_EQ(simulation.statistics().impacts, 0);
}

TEST(TimeStepper, TangentialRestitutionActsInEveryStepOfALastingContact) {
  // With e_t = 1 a sticking contact reverses its tangential velocity each step and rests in the mean only.
  Simulation simulation(
      ball_on_floor({0.0, -1e-6}, {1e-3, 0.0},
                    {.friction = 5.0, .normal_restitution = 0.0, .tangential_restitution = 1.0}, 9.81),
      TimeStepping{.step = 1e-3});
  for (int i = 0; i < 10; ++i) {
    simulation.step();
    EXPECT_NEAR(simulation.state().v[0], i % 2 == 0 ? -1e-3 : 1e-3, 1e-17);
  }
}

TEST(TimeStepper, SeparateComponentsDoNotSeeEachOther) {
  // Two scenes in one model move bit for bit as each alone.
  const auto add_first = [](System& system) {
    const BodyId a = system.add(Particle{.mass = 1.0, .position = {0.0, 0.5}, .velocity = {1.0, 0.0}});
    const BodyId b = system.add(Particle{.mass = 2.0, .position = {1.0, 1.0}});
    system.add(SpringDamper{.from = a, .to = b, .stiffness = 500.0, .damping = 1.0, .free_length = 1.0});
  };
  const auto add_second = [](System& system) {
    const BodyId c = system.add(
        RigidBody{.mass = disc(1.0, 0.2), .position = {5.0, 0.6}, .velocity = {-1.0, 0.0}, .spin = 3.0});
    system.add(Disc{.body = c, .radius = 0.2});
  };
  const auto add_world = [](System& system) {
    system.add(Gravity{{0.0, -9.81}});
    system.add(HalfPlane{.normal = incline(0.1)}, Surface{.friction = 0.3, .normal_restitution = 0.6});
  };
  System first, second, both;
  for (System* system : {&first, &second, &both}) add_world(*system);
  add_first(first);
  add_second(second);
  add_first(both);
  add_second(both);
  const auto run = [](const System& system) {
    Simulation simulation(system, TimeStepping{.step = 1e-3});
    simulation.run_until(1.0);
    return simulation;
  };
  const Simulation one = run(first), two = run(second), all = run(both);
  std::vector<double> together = one.state().q;
  together.insert(together.end(), two.state().q.begin(), two.state().q.end());
  EXPECT_EQ(all.state().q, together);
  EXPECT_EQ(all.statistics().impacts, one.statistics().impacts + two.statistics().impacts);
}

TEST(TimeStepper, ReportsSweepsContractionAndTheWorstCoupling) {
  System system;
  scenes::add_pair(system, scenes::Incline{});
  system.add(SpringDamper{.from = ground, .to = system.body("upper"), .stiffness = 1.0, .free_length = 1.0},
             "weak");
  Simulation simulation(std::move(system), TimeStepping{.step = 1e-3});
  State moving = simulation.state();
  moving.velocity(simulation.system().body("lower")) = Vec<2>(0.0, 1.0);
  moving.velocity(simulation.system().body("upper")) = Vec<2>(0.0, -1.0);
  simulation.set_state(moving);
  const StepReport& report = simulation.step();
  EXPECT_EQ(report.worst_coupling, simulation.system().element("spring"));
  EXPECT_DOUBLE_EQ(report.worst_coupling_rate, 0.25e-6 * 2000.0);
  EXPECT_GE(report.sweeps, 3);
  EXPECT_NEAR(report.contraction, 5e-4, 5e-5);
  EXPECT_EQ(simulation.statistics().most_sweeps, report.sweeps);
  EXPECT_EQ(simulation.statistics().largest_contraction, report.contraction);
}

}  // namespace
