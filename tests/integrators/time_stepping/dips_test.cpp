// Contacts that close within a step and are open again at its end: steps of any length find them.

#include "tests/integrators/time_stepping/located_runs.h"
#include "tests/random.h"

#include <carom/carom.h>

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <string>

namespace {

using namespace carom;
using namespace carom::planar;
using carom_test::located;
using carom_test::Random;

EventDriven exact() { return EventDriven{.relative_tolerance = 1e-12, .absolute_tolerance = 1e-12}; }

BodyId add_disc(System& system, double radius, const Vec<2>& place, const Vec<2>& velocity) {
  const BodyId body =
      system.add(RigidBody{.mass = disc(1.0, radius), .position = place, .velocity = velocity});
  system.add(Disc{.body = body, .radius = radius});
  return body;
}

BodyId add_bar(System& system, double length, const Vec<2>& place, double angle, double spin) {
  const double half = 0.5 * length, thick = 0.02;
  const BodyId body = system.add(
      RigidBody{.mass = box(1.0, length, 2.0 * thick), .position = place, .angle = angle, .spin = spin});
  system.add(
      Polygon{.body = body, .vertices = {{-half, -thick}, {half, -thick}, {half, thick}, {-half, thick}}});
  return body;
}

/// One step of a scene without loads, as long as to pass the dip, ends where the event-driven mode is then.
/// \returns impacts in it
std::int64_t expect_same_end(const System& system, double step) {
  Simulation stepped(system, located(step)), events(system, exact());
  stepped.step();
  events.run_until(step);
  // Instants are found to 1e-12 m; grazing impacts magnify that.
  EXPECT_LT(carom_test::distance(stepped.state(), events.state()), 1e-8);
  EXPECT_EQ(stepped.statistics().impacts, events.statistics().impacts);
  return stepped.statistics().impacts;
}

Surface any_law(Random& random) {
  return {.friction = random.uniform(0.0, 0.5), .normal_restitution = random.uniform(0.2, 1.0)};
}

/// A disc flies over a corner of the ground: it is farther from it at both ends of the step.
System over_a_corner(Random& random, bool with_others) {
  System system;
  system.set_default_law(any_law(random));
  system.add(planar::Block{.vertices = {{-0.5, -1.0}, {0.5, -1.0}, {0.0, 0.0}}});
  const double height = random.uniform(0.02, 0.09);
  add_disc(system, 0.1, {-1.0, height}, {2.0, 0.0});
  if (with_others) add_disc(system, 0.1, {0.0, 3.0}, {0.0, 0.0});
  return system;
}

/// Two discs graze each other.
System past_each_other(Random& random) {
  System system;
  system.set_default_law(any_law(random));
  add_disc(system, 0.1, {-1.0, random.uniform(0.1, 0.19)}, {1.0, 0.0});
  add_disc(system, 0.1, {1.0, 0.0}, {-1.0, 0.0});
  return system;
}

/// The end of a turning bar passes the ground within the step.
System over_the_floor(Random& random, bool with_others) {
  System system;
  system.set_default_law(any_law(random));
  system.add(HalfPlane{.normal = {0.0, 1.0}});
  add_bar(system, 1.0, {0.0, random.uniform(0.3, 0.48)}, 0.0, 3.0);
  if (with_others) add_disc(system, 0.1, {0.0, 3.0}, {0.0, 0.0});
  return system;
}

/// The end of a turning bar strikes a disc that is not in its way at either end of the step.
System against_a_disc(Random& random) {
  System system;
  system.set_default_law(any_law(random));
  add_bar(system, 1.0, {0.0, 0.0}, 0.0, 3.0);
  const double angle = random.uniform(1.0, 2.0), at = random.uniform(0.3, 0.55);
  add_disc(system, 0.05, at * Vec<2>(std::cos(angle), std::sin(angle)), {0.0, 0.0});
  return system;
}

TEST(Dips, AreHitWhereTheStepIsOpenAtBothEnds) {
  std::int64_t impacts = 0;
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    for (const bool with_others : {false, true}) {
      impacts += expect_same_end(over_a_corner(random, with_others), 1.0);
      impacts += expect_same_end(over_the_floor(random, with_others), 1.0);
    }
    impacts += expect_same_end(past_each_other(random), 2.0);
    impacts += expect_same_end(against_a_disc(random), 0.9);
  }
  EXPECT_GT(impacts, 200);  // else hardly anything was tried
}

// What closes more slowly than the capture speed, and is open again, is left: it comes a quarter of what that
// speed makes in a step deep at most.
TEST(Dips, ThatAreSlowAreShallow) {
  System system;
  system.set_default_law({.friction = 0.0, .normal_restitution = 1.0});
  add_disc(system, 0.1, {-1.0, 0.2 - 1e-6}, {1.0, 0.0});
  add_disc(system, 0.1, {1.0, 0.0}, {-1.0, 0.0});
  Simulation simulation(system, located(2.0));
  simulation.step();
  // They come 1e-6 m deep, at sqrt(2 x 1e-6 / 0.2) x 2 m/s = 6 mm/s.
  EXPECT_EQ(simulation.statistics().impacts, 0);
}

}  // namespace
