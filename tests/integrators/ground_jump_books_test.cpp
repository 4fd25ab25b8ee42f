// Shapes on ground whose velocity jumps under bodies: both modes book the same work of the ground and the
// same losses. The bodies are hit by the ground at its new velocity, w say: a mass m at rest on it takes m
// w^2 from what moves the ground, half of which is lost.

#include "tests/energy/ledger_check.h"
#include "tests/random.h"
#include "tests/shares.h"

#include <carom/carom.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <variant>

namespace {

using namespace carom;
using namespace carom::planar;
using carom_test::ledger_closes;

constexpr double g = 9.81, jump = 0.1, end = 0.15;  // [m/s^2], [s]

/// What a run has booked [J].
struct Books {
  double external = 0.0, lost = 0.0, kinetic = 0.0;
};

Books run(const System& system, const Mode& mode) {
  Simulation simulation(system, mode);
  simulation.run_until(end);
  const bool stepping = std::holds_alternative<TimeStepping>(mode);
  if (stepping) {
    EXPECT_TRUE(ledger_closes(simulation.energy()));
  }
  return {simulation.energy().flow(EnergyFlow::external), simulation.energy().lost(),
          simulation.energy().kinetic()};
}

/// A motion whose velocity jumps at a time from one to another.
PrescribedMotion moves(double at, const Vec<2>& before, const Vec<2>& behind) {
  PrescribedMotion motion;
  motion.displacement = [=](double t) -> Vec<2> {
    return std::min(t, at) * before + std::max(0.0, t - at) * behind;
  };
  motion.velocity = [=](double t) -> Vec<2> { return t < at ? before : behind; };
  motion.acceleration = [](double) -> Vec<2> { return Vec<2>(0.0, 0.0); };
  motion.breaks = {at};
  return motion;
}

BodyId add_box(System& system, double mass, const Vec<2>& place, const Vec<2>& velocity) {
  const BodyId body =
      system.add(RigidBody{.mass = box(mass, 0.4, 0.2), .position = place, .velocity = velocity});
  system.add(Polygon{.body = body, .vertices = {{-0.2, -0.1}, {0.2, -0.1}, {0.2, 0.1}, {-0.2, 0.1}}});
  return body;
}

// A lift that starts at once: the impulse of the impact, m w, moves with the lift.
TEST(GroundJumpBooks, LiftThatStartsAtOnce) {
  constexpr double mass = 2.0, speed = 1.0, behind = end - jump;
  System system;
  system.add(Gravity{{0.0, -g}});
  system.set_default_law({.friction = 0.3, .normal_restitution = 0.0});
  system.add(HalfPlane{.normal = {0.0, 1.0}, .motion = moves(jump, {0.0, 0.0}, {0.0, speed})});
  system.add(Particle{.mass = mass});
  const double weight = mass * g * speed * behind, taken = mass * speed * speed;
  const Books exact = run(system, EventDriven{});
  EXPECT_NEAR(exact.external, taken + weight, 1e-9);
  EXPECT_NEAR(exact.lost, 0.5 * taken, 1e-9);
  for (const ImpactTimes impacts : {ImpactTimes::at_step_start, ImpactTimes::located}) {
    for (const ForceRule rule : {ForceRule::trapezoidal, ForceRule::energy_momentum}) {
      for (const double step : {1e-2, 1e-3, 1e-4}) {
        const Books books = run(system, TimeStepping{.step = step, .impacts = impacts, .force_rule = rule});
        // Of the impulse of the weight in the step, and of the fall through the gap that the mean velocity of
        // the step opens, each half the work of the weight over a step is lost; and more in a coarse one.
        const double error = 1.5 * mass * g * speed * step;
        EXPECT_NEAR(books.external, taken + weight, error) << step;
        EXPECT_NEAR(books.lost, 0.5 * taken, error) << step;
      }
    }
  }
}

enum Ground : unsigned { half_plane, block, terrain, conveyor, grounds };
enum Rider : unsigned { particle, ball, brick, stack, riders };

/// Bodies at rest on ground that moves evenly, before its velocity jumps.
System riders_on_ground(std::uint64_t seed, double at) {
  carom_test::Random random(seed);
  System system;
  system.add(Gravity{{0.0, -g}});
  const double friction = random.below(3) == 0 ? 0.0 : random.uniform(0.1, 1.0);
  system.set_default_law({.friction = friction, .normal_restitution = 0.0});
  const Vec<2> before(random.uniform(-0.5, 0.5), random.uniform(-0.5, 0.5));
  // Upward, so that the bodies stay on the ground, by 0.2 to 2 m/s.
  const Vec<2> behind(before[0] + random.uniform(-1.0, 1.0), before[1] + random.uniform(0.2, 2.0));
  PrescribedMotion motion = moves(at, before, behind);
  double surface = 0.0;
  switch (random.below(grounds)) {
    case half_plane:
      system.add(HalfPlane{.normal = {0.0, 1.0}, .motion = motion});
      break;
    case block:
      system.add(
          planar::Block{.vertices = {{-2.0, -1.0}, {2.0, -1.0}, {2.0, 0.0}, {-2.0, 0.0}}, .motion = motion});
      break;
    case terrain:
      system.add(Terrain{
          .vertices = {{-2.0, 0.5}, {-1.5, 0.0}, {1.5, 0.0}, {2.0, 0.5}}, .depth = 0.4, .motion = motion});
      break;
    default:
      surface = random.uniform(-0.5, 0.5);
      system.add(HalfPlane{.normal = {0.0, 1.0}, .motion = motion, .surface_speed = surface});
  }
  const Vec<2> velocity(friction > 0.0 ? before[0] + surface : before[0], before[1]);
  const double mass = random.uniform(0.5, 3.0);
  switch (random.below(riders)) {
    case particle:
      system.add(Particle{.mass = mass, .velocity = velocity});
      break;
    case ball: {
      const BodyId body =
          system.add(RigidBody{.mass = disc(mass, 0.1), .position = {0.0, 0.1}, .velocity = velocity});
      system.add(Disc{.body = body, .radius = 0.1});
      break;
    }
    case brick:
      add_box(system, mass, {0.0, 0.1}, velocity);
      break;
    default:
      add_box(system, mass, {0.0, 0.1}, velocity);
      add_box(system, random.uniform(0.5, 3.0), {0.02, 0.3}, velocity);
  }
  return system;
}

/// Both modes book the same, but for the work of the forces of contact over some steps.
void expect_same_books(std::uint64_t seed) {
  carom_test::Random random(seed + 77);
  const double at = random.below(2) == 0 ? jump : random.uniform(0.02, 0.12);
  const System system = riders_on_ground(seed, at);
  const Books exact = run(system, EventDriven{});
  constexpr double step = 1e-4;
  // Up to 6 kg press the ground, which goes up to 2.5 m/s and along by 1.5 m/s; for two steps at the most.
  constexpr double error = 2.0 * step * 6.0 * g * 4.0;
  for (const ImpactTimes impacts : {ImpactTimes::at_step_start, ImpactTimes::located}) {
    const Books books = run(system, TimeStepping{.step = step, .impacts = impacts});
    EXPECT_NEAR(books.external, exact.external, error) << "seed " << seed;
    EXPECT_NEAR(books.lost, exact.lost, error) << "seed " << seed;
    EXPECT_NEAR(books.kinetic, exact.kinetic, error) << "seed " << seed;
  }
}

TEST(GroundJumpBooks, AreTheSameInBothModes) {
  for (std::uint64_t seed = 0; seed < 12; ++seed) expect_same_books(seed);
}

TEST(GroundJumpBooksLong, AreTheSameInBothModes) {
  const carom_test::SeedRange range = carom_test::seeds_from(1000, 100, 1000);
  for (std::uint64_t seed = range.first; seed < range.last; ++seed) expect_same_books(seed);
}

// A drum, and a swing, whose spin jumps: the moment of the impulses does the work.
TEST(GroundJumpBooks, OfAShapeThatBeginsToTurn) {
  constexpr double spin = 1.5, arm = 0.7, mass = 1.3, step = 1e-4;
  System system;
  system.add(Gravity{{0.0, -g}});
  system.set_default_law({.friction = 0.8, .normal_restitution = 0.0, .rolling_resistance = 0.01});
  PrescribedMotion motion;
  motion.angle = [=](double t) { return std::max(0.0, t - jump) * spin; };
  motion.spin = [=](double t) { return t < jump ? 0.0 : spin; };
  motion.angular_acceleration = [](double) { return 0.0; };
  motion.breaks = {jump};
  system.add(HalfPlane{.normal = {0.0, 1.0}, .motion = motion});
  const BodyId body = system.add(RigidBody{.mass = disc(mass, 0.1), .position = {arm, 0.1}});
  system.add(Disc{.body = body, .radius = 0.1});
  const auto until = [&](const Mode& mode) {
    Simulation simulation(system, mode);
    simulation.run_until(end);
    return simulation.energy();
  };
  const EnergyLedger exact = until(EventDriven{}), stepped = until(TimeStepping{.step = step});
  EXPECT_GT(exact.flow(EnergyFlow::external), 0.5 * mass * spin * spin * arm * arm);
  // The weight over three steps.
  constexpr double error = 3.0 * step * mass * g * spin * arm;
  EXPECT_NEAR(stepped.flow(EnergyFlow::external), exact.flow(EnergyFlow::external), error);
  EXPECT_NEAR(stepped.flow(EnergyFlow::rolling), exact.flow(EnergyFlow::rolling), error);
  EXPECT_NEAR(stepped.lost(), exact.lost(), error);
}

// The record of the contact tells the same velocities as that of the event: the approach to ground that has
// jumped, which is an impact.
TEST(GroundJumpBooks, RecordsTellTheApproachBehindTheJump) {
  constexpr double speed = 0.7;
  System system;
  system.add(Gravity{{0.0, -g}});
  system.set_default_law({.friction = 0.0, .normal_restitution = 0.4});
  system.add(HalfPlane{.normal = {0.0, 1.0}, .motion = moves(jump, {0.0, 0.0}, {0.0, speed})});
  system.add(Particle{.mass = 1.0});
  constexpr double step = 1e-3;
  Simulation simulation(system, TimeStepping{.step = step});
  simulation.run_until(jump - 0.5 * step);
  EXPECT_EQ(simulation.statistics().impacts, 0);
  simulation.run_until(jump + 0.5 * step);
  ASSERT_EQ(simulation.statistics().impacts, 1);
}

}  // namespace
