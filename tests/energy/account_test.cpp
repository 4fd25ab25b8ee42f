// The energy ledger of whole runs: it closes to round-off through everything that can happen, and its lines
// say what closed forms say.

#include "examples/scenes/incline.h"
#include "tests/analytic/convergence.h"
#include "tests/analytic/damped_oscillator.h"
#include "tests/energy/ledger_check.h"

#include <carom/carom.h>
#include <carom/testing/matchers.h>

#include <gtest/gtest.h>

#include <cmath>
#include <initializer_list>
#include <limits>
#include <vector>

namespace {

using namespace carom;
using namespace carom::planar;
using carom::energy_test::ledger_closes_within;
using carom_test::ledger_closes;
using carom_test::round_off;

constexpr double eps = std::numeric_limits<double>::epsilon();

void closes_through_impacts(std::initializer_list<double> angles) {
  for (const double angle : angles) {
    for (const auto& [mu, e_n, e_t] :
         {std::array{0.1, 1.0, 1.0}, {0.5, 0.8, 0.4}, {0.3, 0.2, 0.9}, {0.0, 0.5, 0.0}}) {
      for (const bool is_bar : {true, false}) {
        const scenes::Incline incline{
            .angle = angle, .friction = mu, .normal_restitution = e_n, .tangential_restitution = e_t};
        System system;
        scenes::add_plane(system, incline);
        if (is_bar) {
          scenes::add_bar(system, incline);
        } else {
          scenes::add_pair(system, incline);
        }
        Simulation simulation(std::move(system), TimeStepping{.step = 1.0 / 1200});
        const EnergyRecorder recorder(simulation);
        simulation.run_until(6.0);
        EXPECT_THAT(recorder.trace(), ledger_closes_within(round_off));
        const EnergyLedger& energy = simulation.energy();
        EXPECT_GT(simulation.statistics().impacts, 0);
        if (is_bar) {
          // No coupling: all that left went through contact.
          EXPECT_EQ(energy.flow(EnergyFlow::dashpot), 0.0);
          EXPECT_LE(std::abs(energy.flow(EnergyFlow::coupling_discretisation)), 1e3 * eps * energy.scale());
        }
        if (e_n == e_t) {
          EXPECT_GE(energy.lost() - energy.flow(EnergyFlow::coupling_discretisation),
                    -1e3 * eps * energy.scale());
          EXPECT_EQ(simulation.statistics().energy_gains, 0);
        }
      }
    }
  }
}

TEST(Account, ClosesThroughImpactsOnTheIncline) { closes_through_impacts({0.3}); }

TEST(AccountLong, ClosesThroughImpactsOnTheIncline) { closes_through_impacts({0.0, -0.7}); }

TEST(Account, ImpactOfABallStandsInItsLines) {
  // One impact of a point with slip: dE_n = -m v_n^2 (1 - e^2)/2, friction takes mu P_n times the mean slip.
  System system;
  system.add(HalfPlane{.normal = {0.0, 1.0}}, Surface{.friction = 0.2, .normal_restitution = 0.6});
  const BodyId ball = system.add(Particle{.mass = 2.0, .position = {0.0, 0.0}, .velocity = {5.0, -3.0}});
  Simulation simulation(std::move(system), TimeStepping{});
  simulation.step();
  const double impulse = 2.0 * 3.0 * 1.6;
  const double after = 5.0 - 0.2 * impulse / 2.0;
  EXPECT_NEAR(simulation.state().velocity(ball)[0], after, 8 * eps * 5.0);
  EXPECT_NEAR(simulation.energy().flow(EnergyFlow::impact_normal), 9.0 * (1.0 - 0.36), 32 * eps * 34.0);
  EXPECT_NEAR(simulation.energy().flow(EnergyFlow::impact_tangential), 0.2 * impulse * 0.5 * (5.0 + after),
              32 * eps * 34.0);
  EXPECT_EQ(simulation.energy().flow(EnergyFlow::sliding), 0.0);
  EXPECT_EQ(simulation.energy().flow(EnergyFlow::contact_normal), 0.0);
}

TEST(Account, SlidingStandsInItsLine) {
  // A block of 2 kg slides 1 m/s for 0.1 s under gravity with mu = 0.2: the work of friction is mu m g x.
  System system;
  system.add(Gravity{{0.0, -10.0}});
  system.add(HalfPlane{.normal = {0.0, 1.0}}, Surface{.friction = 0.2, .normal_restitution = 0.0});
  const BodyId block = system.add(Particle{.mass = 2.0, .position = {0.0, -1e-9}, .velocity = {1.0, 0.0}});
  Simulation simulation(std::move(system), TimeStepping{.step = 1e-3});
  simulation.run_until(0.1);
  const double way = simulation.state().position(block)[0];
  EXPECT_NEAR(way, 0.1 - 0.5 * 2.0 * 0.01, 1e-14);
  EXPECT_NEAR(simulation.energy().flow(EnergyFlow::sliding), 0.2 * 2.0 * 10.0 * way, 1e-14);
  EXPECT_EQ(simulation.energy().flow(EnergyFlow::impact_tangential), 0.0);
  EXPECT_EQ(simulation.statistics().impacts, 0);
  EXPECT_TRUE(ledger_closes(simulation.energy()));
}

TEST(Account, CaptureSpeedDecidesAboutLinesOnly) {
  const auto run = [](double capture_speed) {
    System system;
    system.add(Gravity{{0.0, -9.81}});
    system.add(HalfPlane{.normal = {0.0, 1.0}}, Surface{.friction = 0.3, .normal_restitution = 0.7});
    system.add(Particle{.mass = 1.0, .position = {0.0, 0.2}, .velocity = {1.0, 0.0}});
    Simulation simulation(std::move(system), TimeStepping{.step = 1e-3, .capture_speed = capture_speed});
    simulation.run_until(2.0);
    return simulation;
  };
  const Simulation fine = run(0.0), coarse = run(1.5);
  EXPECT_EQ(fine.state().q, coarse.state().q);
  EXPECT_EQ(fine.state().v, coarse.state().v);
  EXPECT_GT(fine.statistics().impacts, coarse.statistics().impacts);
  const auto normal = [](const Simulation& s) {
    return s.energy().flow(EnergyFlow::impact_normal) + s.energy().flow(EnergyFlow::contact_normal);
  };
  const auto tangential = [](const Simulation& s) {
    return s.energy().flow(EnergyFlow::impact_tangential) + s.energy().flow(EnergyFlow::sliding);
  };
  EXPECT_NEAR(normal(fine), normal(coarse), 1e3 * eps * fine.energy().scale());
  EXPECT_NEAR(tangential(fine), tangential(coarse), 1e3 * eps * fine.energy().scale());
  EXPECT_TRUE(ledger_closes(fine.energy()));
  EXPECT_TRUE(ledger_closes(coarse.energy()));
}

constexpr analytic::DampedOscillator oscillator{1.0, 2.0, 100.0, 3.0, 0.5, 9.81, 10.0, 11.0, 2.0, -1.0};

System oscillator_system() {
  System system;
  system.add(Gravity{{0.0, -oscillator.gravity}});
  const BodyId lower = system.add(Particle{.mass = oscillator.lower_mass,
                                           .position = {0.0, oscillator.lower},
                                           .velocity = {0.0, oscillator.lower_speed}});
  const BodyId upper = system.add(Particle{.mass = oscillator.upper_mass,
                                           .position = {0.0, oscillator.upper},
                                           .velocity = {0.0, oscillator.upper_speed}});
  system.add(SpringDamper{.from = lower,
                          .to = upper,
                          .stiffness = oscillator.stiffness,
                          .damping = oscillator.damping,
                          .free_length = oscillator.free_length});
  return system;
}

TEST(Account, DashpotLossOnALineIsNeverNegative) {
  // Along one line the loss of a step is h c (mean rate)^2 at any step: never negative, not even by rounding,
  // however coarse the step.
  for (const double h : {1e-3, 1e-2, 0.05}) {
    Simulation simulation(oscillator_system(), TimeStepping{.step = h, .tolerance = 0.0});
    double before = 0.0;
    simulation.observe([&](const Simulation& now) {
      const double loss = now.energy().flow(EnergyFlow::dashpot);
      EXPECT_GE(loss, before) << now.time();
      before = loss;
    });
    simulation.run_until(2.0);
    EXPECT_TRUE(ledger_closes(simulation.energy()));
    EXPECT_GT(before, 0.0);
  }
}

TEST(Account, DashpotLossConvergesWithOrderTwo) {
  std::vector<double> steps, errors;
  for (const double h : {4e-3, 2e-3, 1e-3, 5e-4}) {
    Simulation simulation(oscillator_system(), TimeStepping{.step = h});
    simulation.run_until(0.4);
    steps.push_back(h);
    errors.push_back(std::abs(simulation.energy().flow(EnergyFlow::dashpot) - oscillator.dashpot_loss(0.4)));
  }
  EXPECT_NEAR(analytic::slope(steps, errors), 2.0,
              0.01);  // series in h^2, (h w)^2 = 2e-3 at the largest step
}

TEST(Account, WorkOfAConstantForceAndTorque) {
  // F.(x - x0) and torque times angle, exact for a motion of constant acceleration.
  System system;
  const BodyId body =
      system.add(RigidBody{.mass = {.mass = 2.0, .inertia = 0.5}, .velocity = {1.0, -1.0}, .spin = 0.5});
  system.add(AppliedForce{.on = body, .force = [](double) { return Vec<2>(3.0, -1.0); }});
  system.add(AppliedTorque{.on = body, .torque = [](double) { return 0.7; }});
  Simulation simulation(std::move(system), TimeStepping{.step = 1e-2});
  simulation.run_until(2.0);
  const State& state = simulation.state();
  const double work = 3.0 * state.position(body)[0] - state.position(body)[1] + 0.7 * state.angle(body);
  EXPECT_NEAR(state.position(body)[0], 1.0 * 2.0 + 0.5 * 1.5 * 4.0, 1e-14);
  EXPECT_NEAR(state.angle(body), 0.5 * 2.0 + 0.5 * 1.4 * 4.0, 1e-14);
  EXPECT_NEAR(simulation.energy().flow(EnergyFlow::external), work, 200 * eps * work);  // 200 steps
  EXPECT_TRUE(ledger_closes(simulation.energy()));
}

TEST(Account, WorkOfAnOscillatingForce) {
  // m x'' = F cos wt from rest: v = F sin(wt)/(m w), work = m v^2/2. Second order in h.
  std::vector<double> steps, errors;
  for (const double h : {2e-2, 1e-2, 5e-3}) {
    System system;
    const BodyId mass = system.add(Particle{.mass = 2.0});
    system.add(
        AppliedForce{.on = mass, .force = [](double t) { return Vec<2>(5.0 * std::cos(3.0 * t), 0.0); }});
    Simulation simulation(std::move(system), TimeStepping{.step = h});
    simulation.run_until(2.5);
    const double speed = 5.0 * std::sin(7.5) / 6.0;
    steps.push_back(h);
    errors.push_back(std::abs(simulation.energy().flow(EnergyFlow::external) - speed * speed));
    EXPECT_NEAR(simulation.energy().flow(EnergyFlow::external), simulation.energy().kinetic(), 1e3 * eps);
    EXPECT_TRUE(ledger_closes(simulation.energy()));
  }
  EXPECT_NEAR(analytic::slope(steps, errors), 2.0, 1e-3);  // series in h^2, (h w)^2/60 of the first term
}

TEST(Account, ForceOffTheCentreDoesWorkAtItsPoint) {
  // A force at the end of a free rod: the ledger closes only if its torque works too.
  System system;
  const BodyId bar = system.add(RigidBody{.mass = rod(1.0, 2.0)});
  system.add(
      AppliedForce{.on = {bar, {1.0, 0.0}}, .force = [](double t) { return Vec<2>(std::sin(t), 4.0); }});
  Simulation simulation(std::move(system), TimeStepping{.step = 1e-3});
  simulation.run_until(1.0);
  EXPECT_GT(simulation.state().angle(bar), 1.0);
  EXPECT_NEAR(simulation.energy().flow(EnergyFlow::external), simulation.energy().kinetic(),
              1e3 * eps * simulation.energy().scale());
  EXPECT_TRUE(ledger_closes(simulation.energy()));
}

TEST(Account, BoxOnTwoCorners) {
  // Dropped flat: both corners strike at once, their tangential rows depend on each other. By symmetry the
  // box leaves without spin at e_n times its speed.
  System system;
  system.add(Gravity{{0.0, -9.81}});
  system.add(HalfPlane{.normal = {0.0, 1.0}},
             Surface{.friction = 0.4, .normal_restitution = 0.5, .tangential_restitution = 0.5});
  const BodyId body = system.add(
      RigidBody{.mass = box(2.0, 1.0, 0.4), .position = {0.0, 0.2 - 1e-9}, .velocity = {0.0, -2.0}});
  system.add(Polygon{.body = body, .vertices = {{-0.5, -0.2}, {0.5, -0.2}, {0.5, 0.2}, {-0.5, 0.2}}});
  Simulation simulation(std::move(system), TimeStepping{.step = 1e-3});
  simulation.step();
  EXPECT_EQ(simulation.report().contacts.size(), 2u);
  EXPECT_NEAR(simulation.state().velocity(body)[1], 1.0,
              1e-12);  // the load of the step is part of the problem
  EXPECT_NEAR(simulation.state().velocity(body)[0], 0.0, 1e-12);
  EXPECT_NEAR(simulation.state().spin(body), 0.0, 1e-12);
  for (const ContactRecord& contact : simulation.report().contacts) EXPECT_LE(contact.residual, 1e-12);
  // Bouncing, then lying on both corners.
  const EnergyRecorder recorder(simulation);
  simulation.run_until(3.0);
  EXPECT_THAT(recorder.trace(), ledger_closes_within(round_off));
  EXPECT_GT(simulation.statistics().contact_steps, 100);
  EXPECT_LE(std::abs(simulation.state().position(body)[1] - 0.2), 1e-3);
  EXPECT_LE(simulation.statistics().worst_residual, 1e-10);
  EXPECT_EQ(simulation.statistics().energy_gains, 0);
}

TEST(Account, BoxInACorner) {
  // Two half-planes form a valley; the box falls into it, with friction on both sides, and comes to rest.
  System system;
  system.add(Gravity{{0.0, -9.81}});
  const Surface surface{.friction = 0.3, .normal_restitution = 0.4, .tangential_restitution = 0.4};
  system.add(HalfPlane{.normal = incline(0.6)}, surface, "right");
  system.add(HalfPlane{.normal = incline(-0.9)}, surface, "left");
  const BodyId body =
      system.add(RigidBody{.mass = box(1.0, 0.6, 0.4), .position = {0.1, 2.0}, .angle = 0.2, .spin = 1.0});
  system.add(Polygon{.body = body, .vertices = {{-0.3, -0.2}, {0.3, -0.2}, {0.3, 0.2}, {-0.3, 0.2}}});
  Simulation simulation(std::move(system), TimeStepping{.step = 1e-3});
  std::size_t most = 0;
  const EnergyRecorder recorder(simulation);
  simulation.observe([&](const Simulation& now) { most = std::max(most, now.report().contacts.size()); });
  simulation.run_until(4.0);
  EXPECT_THAT(recorder.trace(), ledger_closes_within(round_off));
  EXPECT_GE(most, 2u);
  EXPECT_LE(simulation.statistics().worst_residual, 1e-10);
  EXPECT_EQ(simulation.statistics().energy_gains, 0);  // one e everywhere
  EXPECT_LE(simulation.energy().kinetic(), 1e-3);      // at rest but for bounces of the size g h
  EXPECT_GT(simulation.energy().flow(EnergyFlow::impact_normal), 0.0);
}

}  // namespace
