// Impacts that have no answer by the law, since contacts that jam a body have unequal e: from event to event
// they are solved with e = 0, or refused by name.

#include "tests/energy/ledger_check.h"
#include "tests/integrators/mixed_scenes.h"
#include "tests/integrators/throws.h"

#include <carom/carom.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace {

using namespace carom;
using namespace carom::planar;
using carom_test::ledger_closes;

constexpr double mass = 2.0, speed = 1.0;  // [kg], [m/s]

/// A disc that fills the room between two planes and moves towards one of them. Newton's law asks for
/// v <= -0.9 of the upper plane and v >= -0.2 of the lower one.
System squeezed(double lower, double upper, ImpactLaw law = ImpactLaw::newton) {
  constexpr double radius = 0.25;
  System system;
  system.add(HalfPlane{.point = {0.0, -radius}, .normal = {0.0, 1.0}},
             Surface{.friction = 0.0, .normal_restitution = lower, .impact_law = law}, "low");
  system.add(HalfPlane{.point = {0.0, radius}, .normal = {0.0, -1.0}},
             Surface{.friction = 0.0, .normal_restitution = upper, .impact_law = law}, "high");
  const BodyId body = system.add(RigidBody{.mass = disc(mass, radius), .velocity = {3.0, speed}}, "disc");
  system.add(Disc{.body = body, .radius = radius}, "disc");
  return system;
}

TEST(EventJams, AnImpactWithoutAnAnswerIsSolvedWithoutRestitution) {
  Simulation simulation(squeezed(0.2, 0.9), EventDriven{});
  simulation.run_until(1.0);
  const BodyId disc = simulation.system().body("disc");
  EXPECT_NEAR(simulation.state().velocity(disc)[1], 0.0, 1e-15);
  EXPECT_NEAR(simulation.state().position(disc)[0], 3.0, 1e-13);  // it slides on, without friction
  EXPECT_EQ(simulation.statistics().plastic_jams, 1);
  EXPECT_EQ(simulation.statistics().scaled_impacts, 0);
  EXPECT_NEAR(simulation.energy().flow(EnergyFlow::impact_normal), 0.5 * mass * speed * speed, 1e-14);
  EXPECT_TRUE(ledger_closes(simulation.energy()));
  int noted = 0;
  for (const EventRecord& event : simulation.events()) noted += event.restitution_factor == 0.0 ? 1 : 0;
  EXPECT_EQ(noted, 2);
}

TEST(EventJams, EqualRestitutionIsKept) {
  // Here v^+ = -e v^- is an answer for both, to and fro until that is slower than the capture speed.
  Simulation simulation(squeezed(0.5, 0.5), EventDriven{});
  simulation.run_until(1.0);
  EXPECT_EQ(simulation.statistics().plastic_jams, 0);
  EXPECT_GT(simulation.statistics().impacts, 10);
  EXPECT_NEAR(simulation.state().velocity(simulation.system().body("disc"))[1], 0.0, 1e-12);
}

TEST(EventJams, AreRefusedByNameIfAskedFor) {
  Simulation simulation(squeezed(0.2, 0.9), EventDriven{.impact_rules = {.refuse_jams = true}});
  EXPECT_THROWS(SolverError, simulation.run_until(1.0), "no solution", "refuse_jams", "half-plane 'low'",
                "half-plane 'high' approaches at 1 m/s");
  EXPECT_EQ(simulation.statistics().plastic_jams, 0);
}

TEST(EventJams, OfTheEnergeticLawAreSolvedOrRefusedLikewiseInBothModes) {
  // No expansion does the work that the law asks for: the disc cannot move.
  const System system = squeezed(0.2, 0.9, ImpactLaw::energetic);
  for (const Mode& mode : {Mode(EventDriven{}), Mode(TimeStepping{.step = 1e-3})}) {
    Simulation simulation(system, mode);
    simulation.run_until(1.0);
    EXPECT_NEAR(simulation.state().velocity(system.body("disc"))[1], 0.0, 1e-15);
    EXPECT_EQ(simulation.statistics().plastic_jams, 1);
    EXPECT_NEAR(simulation.energy().flow(EnergyFlow::impact_normal), 0.5 * mass * speed * speed, 1e-14);
    EXPECT_TRUE(ledger_closes(simulation.energy()));
  }
  Simulation by_events(system, EventDriven{.impact_rules = {.refuse_jams = true}});
  EXPECT_THROWS(SolverError, by_events.run_until(1.0), "no solution", "refuse_jams", "half-plane 'low'");
  Simulation by_steps(system, TimeStepping{.step = 1e-3, .impact_rules = {.refuse_jams = true}});
  EXPECT_THROWS(SolverError, by_steps.run_until(1.0), "no solution", "refuse_jams", "half-plane 'low'");
}

TEST(EventJams, PoissonsLawHasAnAnswer) {
  // Both planes give back impulses, which cancel each other.
  Simulation simulation(squeezed(0.2, 0.9, ImpactLaw::poisson), EventDriven{});
  simulation.run_until(1.0);
  EXPECT_NEAR(simulation.state().velocity(simulation.system().body("disc"))[1], 0.0, 1e-15);
  EXPECT_EQ(simulation.statistics().plastic_jams, 0);
}

TEST(EventJams, TheLogSaysSo) {
  std::string text;
  Simulation simulation(squeezed(0.2, 0.9), EventDriven{});
  simulation.log() = Log([&](LogLevel, std::string_view line) { text.append(line).append("\n"); });
  simulation.run_until(1.0);
  EXPECT_NE(text.find("jams with others; their impact was solved with e = 0"), std::string::npos) << text;
}

TEST(EventJams, OfWhatHardlySlidesHasAnImpactWithoutCollision) {
  // A polygon comes to rest between two pegs; one contact still slides by 1e-10 m/s. What normal velocities
  // are left, 1e-13 m/s, decide whether impulses exist that stop it.
  Simulation simulation(carom_test::MixedScene(2267).system(), EventDriven{});
  simulation.run_until(1.0);
  EXPECT_GE(simulation.statistics().events[static_cast<std::size_t>(EventKind::impact_without_collision)], 2);
  EXPECT_NEAR(simulation.state().velocity(simulation.system().bodies().front()).norm(), 0.0, 1e-9);
}

/// Runs on, and time stepping, which knows of no forces without bound, from the same state: it tells the
/// same, ever more closely.
void expect_agrees_with_time_stepping(Simulation& simulation, double until) {
  const State start = simulation.state();
  simulation.run_until(until);
  EXPECT_NEAR(simulation.energy().residual(), 0.0, 1e-9 * simulation.energy().scale());
  double apart = 1.0;
  for (const double step : {1e-5, 1e-6}) {
    Simulation steps(simulation.system(), TimeStepping{.step = step});
    State same = steps.state();
    same.time = start.time;
    same.q = start.q;
    same.v = start.v;
    steps.set_state(same);
    steps.run_until(until);
    double largest = 0.0;
    for (std::size_t i = 0; i < same.q.size(); ++i)
      largest = std::max(largest, std::abs(steps.state().q[i] - simulation.state().q[i]));
    EXPECT_LE(largest, 5.0 * step);  // order 1, at up to some 20 rad/s
    EXPECT_LE(largest, 0.2 * apart);
    apart = largest;
  }
}

std::int64_t impacts_without_collision(const Simulation& simulation) {
  return simulation.statistics().events[static_cast<std::size_t>(EventKind::impact_without_collision)];
}

TEST(EventForces, ThatGrowWithoutBoundEndInAnImpactWithoutCollision) {
  // A segment between terrain and a polygon slides at 4 mm/s, and stops at once.
  Simulation simulation(carom_test::MixedScene(18134).system(), EventDriven{});
  simulation.run_until(0.7555);
  expect_agrees_with_time_stepping(simulation, 0.7565);
  EXPECT_EQ(impacts_without_collision(simulation), 3);
}

TEST(EventForces, WithoutBoundEndWhereContactsComeToFollowFromEachOther) {
  // A polygon between a half-plane and another polygon: the forces grow as 1 / (t* - t) to 1e9 N, and from
  // 1e-15 s before t* the contacts follow from each other, to rounding. Steps end on either side of that.
  for (const FlowMethod method : {FlowMethod::adams, FlowMethod::one_step}) {
    SCOPED_TRACE(static_cast<int>(method));
    Simulation simulation(carom_test::MixedScene(7390).system(), EventDriven{.method = method});
    simulation.run_until(0.4515);
    const std::int64_t before = impacts_without_collision(simulation);
    expect_agrees_with_time_stepping(simulation, 0.4518);
    EXPECT_GT(impacts_without_collision(simulation), before);
  }
}

TEST(EventForces, AreSearchedUpToTheEndOfSlidingOnly) {
  // Steps reach far behind the time at which a body stops; there, sliding on against friction as it is now,
  // its forces come back.
  for (const std::uint64_t number : {1249u, 6929u, 9750u}) {
    SCOPED_TRACE("scene " + std::to_string(number));
    Simulation simulation(carom_test::MixedScene(number).system(), EventDriven{});
    simulation.observe([](const Simulation& now) {
      for (const LastingContact& contact : now.contact_forces()) {
        EXPECT_GE(contact.force[0], -1e-6) << now.name(contact.key) << ", t = " << now.time();
      }
    });
    simulation.run_until(1.0);
  }
}

// Friction of belts that run against each other wedges a body between them.
TEST(EventJams, BeltsThatJamABodyAreNamed) {
  System system;
  system.add(Gravity{{0.0, -9.81}});
  system.set_default_law({.friction = 1.5, .normal_restitution = 0.3, .static_friction = 1.95});
  system.add(HalfPlane{.normal = {0.0, 1.0}, .surface_speed = 1.0}, "floor");
  system.add(Wall{.from = {1.0, 0.0}, .to = {1.0, 1.0}, .radius = 0.05, .surface_speed = -1.0}, "wall");
  const BodyId body =
      system.add(RigidBody{.mass = disc(1.0, 0.08), .position = {0.8, 0.12}, .velocity = {0.5, 0.0}});
  system.add(Polygon{.body = body, .vertices = {{-0.07, -0.04}, {0.07, -0.04}, {0.07, 0.04}, {-0.07, 0.04}}});
  Simulation by_events(system, EventDriven{});
  EXPECT_THROWS(SolverError, by_events.run_until(0.7),
                "carried by the surfaces of half-plane 'floor', wall 'wall'",
                "allowed: surfaces that do not carry a body against what stops it, or less friction");
  Simulation by_steps(system, TimeStepping{.step = 5e-4});
  EXPECT_THROWS(SolverError, by_steps.run_until(0.7), "carried by the surfaces of", "'floor'", "'wall'",
                "less friction");
}

// A jaw that begins to move stands still at that instant, and is named all the same: so is ground that turns
// round.
TEST(EventJams, GroundThatBeginsToMoveIsNamed) {
  for (const double begin : {0.0, 0.5}) {
    System system;
    system.set_default_law({.friction = 0.3, .normal_restitution = 0.2});
    system.add(HalfPlane{.point = {0.1, 0.0}, .normal = {-1.0, 0.0}}, "wall");
    const auto pushed = [begin](double t) {
      return Vec<2>(t < begin ? 0.0 : (t - begin) * (t - begin), 0.0);
    };
    system.add(HalfPlane{.point = {-0.1, 0.0},
                         .normal = {1.0, 0.0},
                         .motion = {.displacement = pushed, .breaks = {begin}}},
               "jaw");
    const BodyId body = system.add(RigidBody{.mass = disc(1.0, 0.1)});
    system.add(Disc{.body = body, .radius = 0.1});
    Simulation simulation(system, EventDriven{});
    EXPECT_THROWS(SolverError, simulation.run_until(1.0), "no forces keep the contact",
                  "pressed by the motion of half-plane 'jaw' (allowed: motion that leaves them room");
  }
}

// A belt that carries a disc under a wall that leans over it, farther and farther: at the angle at which the
// wedge locks, forces of contact grow without bound. Both the belt and the wall are named.
TEST(EventJams, AWedgeThatLocksNamesItsGround) {
  System system;
  system.add(Gravity{{0.0, -9.81}});
  system.set_default_law({.friction = 0.8, .normal_restitution = 0.1, .tangential_restitution = 0.1});
  system.add(HalfPlane{.normal = {0.0, 1.0}, .surface_speed = -1.0}, "belt");
  system.add(Wall{.from = {-1.0, 0.02},
                  .to = {-1.0, 1.0},
                  .radius = 0.02,
                  .pivot = {-1.0, 0.02},
                  .motion = {.angle = [](double t) { return -0.6 * std::sin(2.0 * t); }}},
             "flap");
  const BodyId body = system.add(RigidBody{.mass = disc(1.0, 0.1), .position = {-0.85, 0.1}});
  system.add(Disc{.body = body, .radius = 0.1});
  Simulation simulation(system, EventDriven{});
  EXPECT_THROWS(SolverError, simulation.run_until(1.0), "grow without bound",
                "pressed by the motion of wall 'flap' (allowed: motion that leaves them room",
                "carried by the surfaces of half-plane 'belt'", "less friction");
}

}  // namespace
