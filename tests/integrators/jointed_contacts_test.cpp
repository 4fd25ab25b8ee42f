// Contact of bodies that joints bind, in time stepping: contact acts along the rows at the start, with the
// answer of the joints there.

#include "tests/energy/ledger_check.h"
#include "tests/integrators/stiff_scenes.h"
#include "tests/shares.h"

#include <carom/carom.h>

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <string>

namespace {

using namespace carom;
using namespace carom::planar;
using carom_test::ledger_closes;
using carom_test::StiffScene;

constexpr double length = 0.4;  // of a bar [m]

/// Two bars with a pin between them that fall turning onto a floor. Where both have an end at the pin two
/// contacts say the same.
System two_bars(bool both_ends, double restitution) {
  System system;
  system.add(Gravity{{0.0, -9.81}});
  const Surface surface{
      .friction = 0.3, .normal_restitution = restitution, .tangential_restitution = restitution};
  system.add(HalfPlane{.point = {0.0, 0.0}, .normal = {0.0, 1.0}}, surface);
  const auto bar = [&](double side) {
    const double angle = side * 0.4;  // the pin comes down first
    return system.add(
        RigidBody{.mass = rod(1.0, length),
                  .position = {side * 0.5 * length * std::cos(0.4), 0.1 + 0.5 * length * std::sin(0.4)},
                  .angle = angle,
                  .velocity = {0.5, -1.0},
                  .spin = side * 3.0});
  };
  const BodyId left = bar(-1.0), right = bar(1.0);
  system.add(Segment{.body = left, .from = {-0.5 * length, 0.0}, .to = {0.5 * length, 0.0}});
  system.add(
      Segment{.body = right, .from = {both_ends ? -0.5 * length : 0.0, 0.0}, .to = {0.5 * length, 0.0}});
  system.add(Revolute{.from = {left, {0.5 * length, 0.0}}, .to = {right, {-0.5 * length, 0.0}}});
  return system;
}

TEST(JointedContacts, ASecondContactAtThePinChangesNothing) {
  for (const double restitution : {0.0, 0.5, 1.0}) {
    for (const double step : {1e-2, 1e-3}) {
      const TimeStepping options{.step = step, .tolerance = 1e-12};
      Simulation one(two_bars(false, restitution), options), two(two_bars(true, restitution), options);
      int struck_twice = 0;
      while (one.time() < 0.12) {
        one.step();
        two.step();
        const auto& contacts = two.report().contacts;
        if (contacts.size() == 2 && contacts[0].impact) ++struck_twice;
        for (std::size_t i = 0; i < one.state().v.size(); ++i) {
          // Both leave a part of the tolerance over the step in velocities; an impact at the pin does not
          // magnify that.
          EXPECT_NEAR(one.state().v[i], two.state().v[i], 10.0 * options.tolerance / step)
              << restitution << " " << step << " t = " << one.time();
        }
      }
      EXPECT_GE(struck_twice, 1);
      EXPECT_TRUE(ledger_closes(two.energy()));
    }
  }
}

// By Johansson's theorem an impact with one coefficient for all contacts does not gain; velocities that the
// law sees and joints that answer are at one position, so that this holds for any step.
TEST(JointedContacts, ImpactsDoNotGainAtAnyStep) {
  for (const double restitution : {0.0, 0.5, 1.0}) {
    for (const double step : {2e-2, 5e-3, 1e-3}) {
      Simulation simulation(two_bars(true, restitution), TimeStepping{.step = step});
      simulation.run_until(1.0);
      EXPECT_GT(simulation.statistics().impacts, 2);
      EXPECT_EQ(simulation.statistics().energy_gained, 0.0) << restitution << " " << step;
      EXPECT_TRUE(ledger_closes(simulation.energy())) << simulation.energy().residual();
    }
  }
}

// A bar on a driven pin strikes: the driver works against the impulse, and the account knows.
TEST(JointedContacts, DriversWorkAgainstImpacts) {
  System system;
  system.add(Gravity{{0.0, -9.81}});
  const Surface surface{.friction = 0.3, .normal_restitution = 0.5, .tangential_restitution = 0.5};
  system.add(HalfPlane{.point = {0.0, 0.0}, .normal = {0.0, 1.0}}, surface);
  const BodyId upper = system.add(RigidBody{.mass = rod(1.0, length), .position = {0.5 * length, 0.3}});
  const BodyId lower = system.add(RigidBody{.mass = rod(1.0, length), .position = {1.5 * length, 0.3}});
  system.add(Segment{.body = lower, .from = {-0.5 * length, 0.0}, .to = {0.5 * length, 0.0}});
  const JointId pin = system.add(Revolute{.from = {ground, {0.0, 0.3}}, .to = {upper, {-0.5 * length, 0.0}}});
  system.add(Revolute{.from = {upper, {0.5 * length, 0.0}}, .to = {lower, {-0.5 * length, 0.0}}});
  system.add(Driver{.joint = pin,
                    .position = [](double t) { return -0.3 * (1.0 - std::cos(8.0 * t)); },
                    .velocity = [](double t) { return -2.4 * std::sin(8.0 * t); },
                    .acceleration = [](double t) { return -19.2 * std::cos(8.0 * t); }});
  Simulation simulation(std::move(system), TimeStepping{.step = 1e-3});
  simulation.run_until(1.5);
  EXPECT_GT(simulation.statistics().impacts, 3);
  EXPECT_EQ(simulation.statistics().energy_gained, 0.0);
  EXPECT_TRUE(ledger_closes(simulation.energy())) << simulation.energy().residual();
}

/// Chains of rods with friction in contact and in joints and with stops, that fall into heaps. Of the 62 up
/// to seed 501 four end with an error, all behind 350 (351, 466, 491, 496): friction in joints and the forces
/// that bound it jump from one to the other, or sweeps do with them.
void expect_chains_lie(const carom_test::SeedRange& seeds) {
  int chains = 0, failed = 0;
  for (std::uint64_t seed = seeds.first; seed < seeds.last; seed += 5) {
    const StiffScene scene(seed);
    if (scene.has_springs()) continue;
    Simulation simulation(scene.system(), scene.options());
    ++chains;
    try {
      simulation.run_until(1.0);
    } catch (const SolverError& error) {
      ++failed;
      EXPECT_NE(std::string(error.what()).find("contact problem"), std::string::npos) << error.what();
    }
    EXPECT_EQ(simulation.statistics().fallbacks, 0) << seed;
    EXPECT_TRUE(ledger_closes(simulation.energy())) << seed << ": " << simulation.energy().residual();
  }
  EXPECT_LE(20 * failed, chains);
}

TEST(JointedContacts, ChainsOfRodsFallAndLie) { expect_chains_lie({1, carom_test::usual_or(101U, 31U)}); }
TEST(JointedContactsLong, ChainsOfRodsFallAndLie) {
  expect_chains_lie(carom_test::seeds_from(101, 200, 250));
}

/// A bar hinged to the ground on the surface of an obstacle; its shape begins at the pin or in its middle.
System hinged(double slope, double restitution, bool from_pin, double coefficient) {
  System system;
  system.add(Gravity{{0.0, -9.81}});
  system.add(
      HalfPlane{.normal = incline(slope)},
      Surface{.friction = 0.3, .normal_restitution = restitution, .tangential_restitution = restitution});
  const double angle = slope + 0.5;
  const Vec<2> along(std::cos(angle), std::sin(angle));
  const BodyId bar =
      system.add(RigidBody{.mass = rod(1.0, length), .position = 0.5 * length * along, .angle = angle});
  system.add(Segment{.body = bar, .from = {from_pin ? -0.5 * length : 0.0, 0.0}, .to = {0.5 * length, 0.0}});
  const JointId pin = system.add(Revolute{.from = ground, .to = {bar, {-0.5 * length, 0.0}}});
  if (coefficient > 0.0) system.add(JointFriction{.joint = pin, .coefficient = coefficient});
  return system;
}

// The corner at the pin touches for ever and cannot move: nothing acts there.
TEST(JointedContacts, ACornerAtAPinToTheGroundCarriesNothing) {
  for (const double slope : {0.0, 0.3}) {
    for (const double restitution : {0.0, 0.5}) {
      for (const double coefficient : {0.0, 0.005}) {
        for (const Mode& mode : {Mode(TimeStepping{}), Mode(EventDriven{})}) {
          Simulation with(hinged(slope, restitution, true, coefficient), mode);
          Simulation without(hinged(slope, restitution, false, coefficient), mode);
          with.run_until(0.6);  // the bar comes down at 0.2 s
          without.run_until(0.6);
          // Rounding, over some impacts; event-driven the tolerance of the flow, whose steps end elsewhere.
          EXPECT_NEAR(with.state().q[2], without.state().q[2], 1e-7) << slope << " " << restitution;
          EXPECT_LE(std::abs(with.energy().residual()), 1e-8 * with.energy().scale());
        }
      }
    }
  }
}

/// Johansson's bound of friction in a joint by the force in it holds in impacts, and they converge to those
/// of the event-driven mode: W of a contact, two bars and a pin that rubs is singular, its answer unique.
TEST(JointedContacts, FrictionInThePinsIsBoundByTheForcesInThem) {
  for (const bool at_base : {true, false}) {
    for (const double restitution : {0.0, 0.5}) {
      System system;
      system.add(Gravity{{0.0, -9.81}});
      system.add(
          HalfPlane{.point = {0.0, 0.0}, .normal = {0.0, 1.0}},
          Surface{.friction = 0.0, .normal_restitution = restitution, .tangential_restitution = restitution});
      const double angle = -0.5;
      const Vec<2> along(std::cos(angle), std::sin(angle));
      const Vec<2> base(0.0, 2.0 * length * std::sin(0.5) + 0.02);
      const auto bar = [&](double from) {
        return system.add(RigidBody{
            .mass = rod(1.0, length), .position = base + (from + 0.5 * length) * along, .angle = angle});
      };
      const BodyId upper = bar(0.0), lower = bar(length);
      system.add(Segment{.body = lower, .from = {0.0, 0.0}, .to = {0.5 * length, 0.0}});
      const JointId ground_pin =
          system.add(Revolute{.from = {ground, base}, .to = {upper, {-0.5 * length, 0.0}}});
      const JointId elbow =
          system.add(Revolute{.from = {upper, {0.5 * length, 0.0}}, .to = {lower, {-0.5 * length, 0.0}}});
      const JointId pin = at_base ? ground_pin : elbow;
      system.add(JointFriction{.joint = pin, .coefficient = 0.02});
      Simulation events(system, EventDriven{}), steps(system, TimeStepping{.step = 1e-5});
      bool struck = false;
      while (!struck && steps.time() < 0.2) {
        steps.step();
        for (const auto& contact : steps.report().contacts) struck = struck || contact.impact;
      }
      ASSERT_TRUE(struck);
      double force = 0.0, moment = 0.0;
      for (const auto& joint : steps.report().joint_impulses) {
        if (joint.joint == pin) force = std::hypot(joint.impulse.force[0], joint.impulse.force[1]);
        if (joint.impulse.moment != 0.0) moment = std::abs(joint.impulse.moment);
      }
      EXPECT_NEAR(moment / (0.02 * force), 1.0, 1e-10);  // slips; answers are certified to 1e-12
      events.run_until(steps.time());
      for (const BodyId body : {upper, lower}) {
        // Of first order in the step: 1e-5 s, some 1e3 rad/s^2 in contact and between the times of impact.
        EXPECT_NEAR(events.state().spin(body), steps.state().spin(body), 1e-2);
      }
    }
  }
}

}  // namespace
