// Rolling resistance in other units: its row is a spin, beside velocities of places. In micrometres moments
// were 1e-6 of the forces that answers of contact problems are judged by, and the motion was another one: by
// 1 of the units within a second.

#include "tests/integrators/units.h"
#include "tests/random.h"

#include <carom/carom.h>

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace {

using namespace carom;
using namespace carom::planar;
using carom_test::end_in;
using carom_test::event_options_in;
using carom_test::Random;
using carom_test::Units;

/// Carts (a box on two discs) and discs fall onto a slope between two walls, and roll to rest.
System rolling_carts(std::uint64_t seed, const Units& units) {
  Random random(seed);
  System system;
  system.add(Gravity{Vec<2>(0.0, -9.8125) * units.acceleration()});
  const double e = random.uniform(0.0, 0.6);
  const Surface surface{.friction = random.uniform(0.1, 0.9),
                        .normal_restitution = e,
                        .tangential_restitution = e,
                        .rolling_resistance = random.uniform(0.001, 0.02) * units.length,
                        .rolling_restitution = random.below(2) * e};
  system.set_default_law(surface);
  system.add(HalfPlane{.normal = incline(random.uniform(-0.2, 0.2))});
  for (const double side : {-1.0, 1.0}) {
    system.add(HalfPlane{.point = Vec<2>(2.0 * side, 0.0) * units.length, .normal = {-side, 0.1}});
  }
  for (int i = 0; i < 3; ++i) {
    const double size = random.uniform(0.08, 0.17) * units.length;
    const double mass = random.uniform(0.3, 3.0) * units.mass;
    const bool is_cart = random.below(2) == 0;
    const BodyId body =
        system.add(RigidBody{.mass = is_cart ? box(mass, 2.0 * size, size) : disc(mass, size),
                             .position = (Vec<2>(0.5 * (i - 1), 0.7) + random.vec<2>(0.05)) * units.length,
                             .angle = random.uniform(-3.0, 3.0),
                             .velocity = random.vec<2>(2.0) * units.speed(),
                             .spin = random.uniform(-8.0, 8.0) / units.time});
    if (!is_cart) system.add(Disc{.body = body, .radius = size});
    for (const double side : {-0.8, 0.8}) {
      if (!is_cart) continue;
      system.add(Disc{.body = body, .radius = 0.3 * size, .centre = Vec<2>(side * size, -0.3 * size)});
    }
  }
  return system;
}

// Powers of two: numbers in steps of time are the same ones scaled, to the last bit.
constexpr Units others[] = {{0x1p10, 1.0, 1.0}, {0x1p-10, 1.0, 1.0}, {0x1p-20, 0x1p-40, 0x1p-10}};
constexpr Units usual{1.0, 1.0, 1.0};
constexpr double end = 1.0;

void expect_same(const std::vector<double>& is, const std::vector<double>& expected, double tolerance) {
  ASSERT_EQ(is.size(), expected.size());
  for (std::size_t i = 0; i < is.size(); ++i) EXPECT_NEAR(is[i], expected[i], tolerance) << i;
}

TEST(RollingUnits, StepsAreTheSameNumbers) {
  const auto options = [](const Units& units) {
    TimeStepping result{.step = 0x1p-10 * units.time};
    result.tolerance *= units.length;
    result.capture_speed *= units.speed();
    return result;
  };
  for (std::uint64_t seed = 1; seed < 9; ++seed) {
    const std::vector<double> expected = end_in(usual, rolling_carts(seed, usual), options(usual), end);
    for (const Units& units : others) {
      SCOPED_TRACE("seed " + std::to_string(seed) + ", in " + to_text(units.length) + " m");
      expect_same(end_in(units, rolling_carts(seed, units), options(units), end), expected, 0.0);
    }
  }
}

TEST(RollingUnits, EventsAreTheSame) {
  for (std::uint64_t seed = 1; seed < 9; ++seed) {
    const std::vector<double> expected =
        end_in(usual, rolling_carts(seed, usual), event_options_in(usual), end);
    for (const Units& units : others) {
      SCOPED_TRACE("seed " + std::to_string(seed) + ", in " + to_text(units.length) + " m");
      // Tolerances of 1e-9 of the steps, which some twenty impacts amplify.
      expect_same(end_in(units, rolling_carts(seed, units), event_options_in(units), end), expected, 1e-6);
    }
  }
}

}  // namespace
