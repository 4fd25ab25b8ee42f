// The same scene in other units. Where these are powers of two, numbers are the same ones scaled, to the last
// bit: so a number of metres, or a speed that is compared with a rate of an angle, shows at once.

#include "tests/integrators/units.h"
#include "tests/shares.h"

#include <carom/carom.h>

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

namespace {

using namespace carom;
using namespace carom::planar;
using carom_test::end_in;
using carom_test::Units;

/// Options in units.
TimeStepping scaled(TimeStepping options, const Units& units) {
  options.step *= units.time;
  options.tolerance *= units.length;
  options.capture_speed *= units.speed();
  if (options.control) {
    options.control->tolerance *= units.length;
    options.control->smallest *= units.time;
    options.control->largest *= units.time;
  }
  return options;
}

/// Numbers of a scene.
class Numbers {
public:
  explicit Numbers(std::uint32_t seed) : random_(seed) {}
  double between(double a, double b) {
    constexpr double numbers = 0x1p32;
    return a + (b - a) * static_cast<double>(random_()) / numbers;
  }

private:
  std::mt19937 random_;
};

void add_boxes(System& system, Numbers& of, const Units& units, int count) {
  for (int i = 0; i < count; ++i) {
    const double width = of.between(0.2, 0.5) * units.length, height = of.between(0.1, 0.3) * units.length;
    const double x = of.between(-1.0, 1.0), u = of.between(-2.0, 2.0), w = of.between(-2.0, 1.0);
    const BodyId body = system.add(RigidBody{.mass = box(of.between(0.5, 2.0) * units.mass, width, height),
                                             .position = Vec<2>(x, 0.5 + 0.6 * i) * units.length,
                                             .angle = of.between(-3.0, 3.0),
                                             .velocity = Vec<2>(u, w) * units.speed(),
                                             .spin = of.between(-6.0, 6.0) / units.time});
    const double x1 = 0.5 * width, y1 = 0.5 * height;
    system.add(Polygon{.body = body,
                       .vertices = {{-x1, -y1}, {x1, -y1}, {x1, y1}, {-x1, y1}},
                       .radius = i % 2 == 0 ? 0.0 : 0.02 * units.length});
  }
}

/// Links on hinges with limits and friction, which hit what falls.
void add_chain(System& system, Numbers& of, const Units& units, const Vec<2>& at) {
  const double length = of.between(0.4, 0.7) * units.length;
  Vec<2> pin = at * units.length;
  BodyId before = ground;
  double angle = of.between(-3.0, 3.0);
  for (int i = 0; i < 3; ++i) {
    const Vec<2> along(std::cos(angle), std::sin(angle));
    const BodyId link = system.add(RigidBody{.mass = rod(of.between(0.3, 2.0) * units.mass, length),
                                             .position = pin + 0.5 * length * along,
                                             .angle = angle});
    system.add(Segment{.body = link,
                       .from = {-0.4 * length, 0.0},
                       .to = {0.4 * length, 0.0},
                       .radius = 0.03 * units.length});
    const Vec<2> end(0.5 * length, 0.0);
    const JointId hinge = before == ground ? system.add(Revolute{.from = {ground, pin}, .to = {link, -end}})
                                           : system.add(Revolute{.from = {before, end}, .to = {link, -end}});
    system.add(Stop{.joint = hinge,
                    .lower = -of.between(0.2, 1.5),
                    .upper = of.between(0.2, 1.5),
                    .restitution = of.between(0.0, 0.8)});
    system.add(JointFriction{.joint = hinge,
                             .bound = of.between(0.01, 1.0) * units.force() * units.length,
                             .static_factor = 1.25});
    pin += length * along;
    angle += of.between(-1.0, 1.0);
    before = link;
  }
}

enum class Scene : std::uint8_t { boxes, chains };

System scene(Scene which, std::uint32_t seed, const Units& units) {
  Numbers of(seed);
  System system;
  system.add(Gravity{Vec<2>(0.0, -9.8125) * units.speed() / units.time});
  const double e = of.between(0.0, 0.8), friction = of.between(0.0, 0.8);
  system.set_default_law({.friction = friction,
                          .normal_restitution = e,
                          .tangential_restitution = e,
                          .static_friction = 1.25 * friction});
  system.add(BoxInside{.lower = Vec<2>(-2.0, 0.0) * units.length, .upper = Vec<2>(2.0, 4.0) * units.length});
  add_boxes(system, of, units, 3);
  if (which == Scene::chains) {
    add_chain(system, of, units, {-1.0, 1.5});
    add_chain(system, of, units, {0.8, 2.0});
  }
  return system;
}

constexpr std::uint32_t seeds = carom_test::usual_or(4U, 1U);

void expect_same(Scene which, const TimeStepping& options, double tolerance, const std::string& what) {
  for (std::uint32_t seed = 1; seed <= seeds; ++seed) {
    const Units usual{1.0, 1.0, 1.0};
    const std::vector<double> expected = end_in(usual, scene(which, seed, usual), options, 0.6);
    for (const Units& units :
         {Units{0x1p10, 1.0, 1.0}, Units{0x1p-20, 0x1p-40, 0x1p-10}, Units{0x1p13, 0x1p30, 0x1p6}}) {
      const std::vector<double> end = end_in(units, scene(which, seed, units), scaled(options, units), 0.6);
      for (std::size_t i = 0; i < end.size(); ++i) {
        EXPECT_NEAR(end[i], expected[i], tolerance)
            << what << ", seed " << seed << ", " << i << ", in " << units.length << " m";
      }
    }
  }
}

constexpr double h = 0x1p-10;
constexpr double exactly = 0.0;

TEST(StepUnits, OfBoxes) {
  expect_same(Scene::boxes, {.step = h}, exactly, "steps");
  expect_same(Scene::boxes, {.step = h, .impacts = ImpactTimes::located}, exactly, "located");
  expect_same(Scene::boxes, {.step = h, .overlaps = {.never_tunnel = true}}, exactly, "never_tunnel");
  expect_same(Scene::boxes, {.step = h, .control = StepControl{}}, exactly, "control");
}

// Limits and friction in hinges went by rates in rad/s: whether they were impacts, stuck or parted was judged
// against speeds in m/s, and answers by the largest impulse of the problem, in N s or N m s.
TEST(StepUnits, OfChainsWithLimitsAndFriction) {
  expect_same(Scene::chains, {.step = h}, exactly, "steps");
  expect_same(Scene::chains, {.step = h, .impacts = ImpactTimes::located}, exactly, "located");
  expect_same(Scene::chains, {.step = h, .impact_rules = {.order = ImpactOrder::sequential}}, exactly,
              "sequential");
  expect_same(Scene::chains, {.step = h, .overlaps = {.never_tunnel = true}}, exactly, "never_tunnel");
}

}  // namespace
