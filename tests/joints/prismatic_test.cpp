#include <carom/core/assembly.h>
#include <carom/joints/applied_load.h>
#include <carom/joints/gravity.h>
#include <carom/joints/prismatic.h>

#include "tests/joints/element_pairs.h"
#include "tests/joints/joint_model.h"
#include "tests/model_error.h"

#include <limits>
#include <numbers>

namespace {

using namespace carom;
using namespace carom::planar;
using namespace carom_test;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double g = 9.81;

void expect_reaction(const JointReaction& found, const Vec<2>& force, double moment, double tolerance) {
  EXPECT_NEAR(found.force[0], force[0], tolerance);
  EXPECT_NEAR(found.force[1], force[1], tolerance);
  EXPECT_NEAR(found.moment, moment, tolerance);
}

TEST(Prismatic, ItsCoordinateIsTheDistanceAlongTheAxis) {
  System system;
  const double quarter = 0.5 * std::numbers::pi;
  // In the frame of the first, which is turned by 90 degrees, the second stands at (2, -1).
  const BodyId a = system.add(RigidBody{.mass = disc(1.0, 1.0), .position = {1, 1}, .angle = quarter});
  const BodyId b = system.add(RigidBody{.mass = disc(1.0, 1.0), .position = {2, 3}, .angle = quarter});
  const JointId described = system.add(Prismatic{.from = a, .to = b, .axis = {5, 0}});
  const JointId given = system.add(Prismatic{.from = a, .to = b, .axis = {3, -4}, .zero_distance = 0.5});
  const JointId pin = system.add(PointOnLine{.from = a, .to = b, .axis = {0, -2}});
  const JointId slot =
      system.add(PointOnLine{.from = {a, {1, 0}}, .to = b, .axis = {2, 0}, .zero_distance = 0});
  State state = Assembly(system).initial_state();
  EXPECT_NEAR(state.coordinate(described), 0.0, 1e-15);
  EXPECT_NEAR(state.coordinate(given), 0.6 * 2.0 + 0.8 - 0.5, 1e-15);
  EXPECT_NEAR(state.coordinate(pin), 0.0, 1e-15);
  EXPECT_NEAR(state.coordinate(slot), 1.0, 1e-15);
  state.position(b) += Vec<2>(0.25, 0.5);
  EXPECT_NEAR(state.coordinate(described), 0.5, 1e-15);
  EXPECT_NEAR(state.coordinate(given), 1.5 + 0.6 * 0.5 + 0.8 * 0.25, 1e-15);
  EXPECT_NEAR(state.coordinate(pin), 0.25, 1e-15);
  EXPECT_NEAR(state.coordinate(slot), 1.5, 1e-15);
  state.velocity(b) = Vec<2>(1.0, 2.0);
  EXPECT_NEAR(state.rate(described), 2.0, 1e-15);
  EXPECT_NEAR(state.rate(given), 0.6 * 2.0 + 0.8, 1e-15);
  EXPECT_NEAR(state.rate(pin), 1.0, 1e-15);
  // The axis turns with `from`: what stands across it comes nearer along it.
  state.velocity(b) = Vec<2>::Zero();
  state.spin(a) = 3.0;
  EXPECT_NEAR(state.rate(described), -3.0 * 1.25, 1e-14);
}

TEST(Prismatic, KeepsTheAngleAndTheDistanceFromTheLine) {
  System system;
  const BodyId a = system.add(RigidBody{.mass = disc(1.0, 1.0), .angle = 0.25});
  const BodyId b = system.add(RigidBody{.mass = disc(1.0, 1.0), .position = {2, 3}, .angle = 0.75});
  const JointId described = system.add(Prismatic{.from = {ground, {1, 1}}, .to = b, .axis = {2, 0}});
  const JointId given = system.add(Prismatic{.from = a, .to = b, .axis = {1, 0}, .angle = 0.125});
  const JointModel model(system);
  EXPECT_NEAR(model.rows(described)[0].gap, 2.0, 1e-15);
  EXPECT_EQ(model.rows(described)[1].gap, 0.0);
  EXPECT_NEAR(model.rows(given)[1].gap, 0.375, 1e-15);
}

TEST(Prismatic, CarriesAWeightOffTheLine) {
  // The end of the body lies left of its centre; the line is inclined, and the body slides down it.
  const double m = 2.0, incline = 0.3, d = 0.8;
  const Vec<2> along(std::cos(incline), -std::sin(incline)), across(std::sin(incline), std::cos(incline));
  System system;
  system.add(Gravity{{0, -g}});
  const BodyId a = system.add(RigidBody{.mass = box(m, 2.0, 1.0), .position = {d, 0}});
  const JointId slide = system.add(Prismatic{.from = ground, .to = {a, {-d, 0}}, .axis = along});
  JointModel model(system);
  const Vec<2> acceleration = g * std::sin(incline) * along;
  expect_near(model.acceleration(), {acceleration[0], acceleration[1], 0.0}, 1e-12);
  const double force = m * g * std::cos(incline);
  // About the centre of mass nothing turns.
  expect_reaction(model.reaction(slide), force * across, d * force * across[1], 1e-12);
}

TEST(Prismatic, HoldsABodyOnATurningArm) {
  // On an arm that turns at w the body at distance d needs 2 m w r' across, if the arm may not slow down.
  const double m = 0.5, w = 2.0, d = 1.5, rate = 0.75;
  System system;
  const BodyId arm = system.add(RigidBody{.mass = disc(1e12, 1.0), .spin = w});
  const BodyId a =
      system.add(RigidBody{.mass = disc(m, 0.1), .position = {d, 0}, .velocity = {rate, w * d}, .spin = w});
  const JointId slide = system.add(Prismatic{.from = arm, .to = a, .axis = {1, 0}});
  JointModel model(system);
  const std::vector<double> acceleration = model.acceleration();
  expect_reaction(model.reaction(slide), {0.0, 2.0 * m * w * rate}, 0.0, 1e-10);
  EXPECT_NEAR(acceleration[model.assembly.layout()->slot(a).v], 0.0, 1e-11);
  EXPECT_NEAR(model.state.rate(slide), rate, 1e-15);
}

TEST(PointOnLine, PushesAcrossTheLineOnly) {
  const double m = 2.0, incline = 0.3;
  const Vec<2> along(std::cos(incline), std::sin(incline)), across(-std::sin(incline), std::cos(incline));
  System system;
  system.add(Gravity{{0, -g}});
  const BodyId dot = system.add(Particle{.mass = m, .position = Vec<2>(0.5 * along)});
  const JointId pin = system.add(PointOnLine{.from = ground, .to = dot, .axis = along});
  JointModel model(system);
  const Vec<2> acceleration = -g * std::sin(incline) * along;
  expect_near(model.acceleration(), {acceleration[0], acceleration[1]}, 1e-13);
  expect_reaction(model.reaction(pin), m * g * std::cos(incline) * across, 0.0, 1e-12);
}

TEST(Rolling, ADiscRollsDownAnIncline) {
  const double m = 2.0, r = 0.4, incline = 0.5;
  const Vec<2> normal(std::sin(incline), std::cos(incline)), down(std::cos(incline), -std::sin(incline));
  System system;
  system.add(Gravity{{0, -g}});
  const BodyId a =
      system.add(RigidBody{.mass = disc(m, r), .position = Vec<2>(r * normal + 0.7 * down), .angle = 0.3});
  const JointId roll = system.add(Rolling{.from = ground, .to = a, .normal = 3.0 * normal, .radius = r});
  JointModel model(system);
  for (const JointRow& row : model.rows(roll)) EXPECT_NEAR(row.gap, 0.0, 1e-15);
  const double gain = 2.0 / 3.0 * g * std::sin(incline);
  const Vec<2> acceleration = gain * down;
  expect_near(model.acceleration(), {acceleration[0], acceleration[1], -gain / r}, 1e-12);
  const double friction = m * g * std::sin(incline) / 3.0;
  expect_reaction(model.reaction(roll), m * g * std::cos(incline) * normal - friction * down, -friction * r,
                  1e-12);
  // Its coordinate is how far it went down; it turned clockwise.
  model.state.position(a) += 0.25 * down;
  model.state.angle(a) -= 0.25 / r;
  model.update();
  EXPECT_NEAR(model.state.coordinate(roll), 0.25, 1e-15);
  for (std::size_t row = 0; row < 2; ++row) EXPECT_NEAR(model.rows(roll)[row].gap, 0.0, 1e-15);
  model.state.velocity(a) = 1.5 * down;
  EXPECT_NEAR(model.state.rate(roll), 1.5, 1e-15);
}

TEST(Rolling, OnAPlateThatMovesTheDiscGoesWithIt) {
  // A plate turns and shifts with a disc at rest on it as one body: nothing rolls.
  Random random(311);
  for (int repeat = 0; repeat < 20; ++repeat) {
    const auto at = [](double angle, const Vec<2>& local) {
      const std::array<double, 2> rotation{std::cos(angle), std::sin(angle)};
      return Space<2>::rotate(rotation.data(), local);
    };
    const double angle = random.uniform(-3.0, 3.0), r = random.uniform(0.2, 1.0);
    const Vec<2> place = random.vec<2>(), normal = random.vec<2>().normalized();
    const Vec<2> centre = r * normal + random.uniform(-1.0, 1.0) * Vec<2>(normal[1], -normal[0]);
    System system;
    const BodyId plate = system.add(RigidBody{.mass = disc(1.0, 1.0), .position = place, .angle = angle});
    const BodyId wheel = system.add(RigidBody{.mass = disc(1.0, r),
                                              .position = Vec<2>(place + at(angle, centre)),
                                              .angle = random.uniform(-3.0, 3.0)});
    const JointId roll = system.add(Rolling{.from = plate, .to = wheel, .normal = normal, .radius = r});
    JointModel model(system);
    const double turn = random.uniform(-3.0, 3.0), spin = random.uniform(-3.0, 3.0);
    model.state.position(plate) += Vec<2>(0.5, -2.0);
    model.state.angle(plate) += turn;
    model.state.position(wheel) = Vec<2>(model.state.position(plate)) + at(angle + turn, centre);
    model.state.angle(wheel) += turn;
    const Vec<2> lever = at(angle + turn, centre);
    model.state.spin(plate) = model.state.spin(wheel) = spin;
    model.state.velocity(wheel) = spin * Vec<2>(-lever[1], lever[0]);
    model.update();
    for (const JointRow& row : model.rows(roll)) {
      EXPECT_NEAR(row.gap, 0.0, 1e-14);
      EXPECT_NEAR(row.times(model.state.v.data()), 0.0, 1e-14);
    }
  }
}

TEST(Prismatic, ImpossibleParametersAreRefusedByName) {
  System system;
  const BodyId a = system.add(RigidBody{.mass = disc(1.0, 1.0)}, "wheel");
  EXPECT_MODEL_ERROR(system.add(Prismatic{.from = ground, .to = a}), "prismatic joint #0", "axis is nan",
                     "allowed: a finite number");
  EXPECT_MODEL_ERROR(system.add(Prismatic{.from = ground, .to = a, .axis = {0, 0}}, "slide"),
                     "prismatic joint 'slide'", "axis is (0, 0)", "allowed: an axis of any length > 0");
  EXPECT_MODEL_ERROR(system.add(Prismatic{.from = ground, .to = a, .axis = {1, infinity}}), "axis is inf");
  EXPECT_MODEL_ERROR(system.add(Prismatic{.from = ground, .to = a, .axis = {1, 0}, .angle = infinity}),
                     "angle is inf rad", "a finite number");
  EXPECT_MODEL_ERROR(
      system.add(Prismatic{.from = ground, .to = a, .axis = {1, 0}, .zero_distance = -infinity}),
      "zero_distance is -inf m", "a finite number");
  EXPECT_MODEL_ERROR(system.add(PointOnLine{.from = ground, .to = a}), "point-on-line joint #0",
                     "axis is nan", "a finite number");
  EXPECT_MODEL_ERROR(system.add(PointOnLine{.from = ground, .to = a, .axis = {0, 0}}), "axis is (0, 0)");
  EXPECT_MODEL_ERROR(
      system.add(PointOnLine{.from = ground, .to = a, .axis = {1, 0}, .zero_distance = infinity}),
      "zero_distance is inf m");
  EXPECT_MODEL_ERROR(system.add(Rolling{.from = ground, .to = a, .radius = 1.0}), "rolling joint #0",
                     "normal is nan", "a finite number");
  EXPECT_MODEL_ERROR(system.add(Rolling{.from = ground, .to = a, .normal = {0, 0}, .radius = 1.0}),
                     "normal is (0, 0)", "an axis of any length > 0");
  for (const double radius : {0.0, -1.0, nan, infinity}) {
    EXPECT_MODEL_ERROR(system.add(Rolling{.from = ground, .to = a, .normal = {0, 1}, .radius = radius}),
                       "radius is " + to_text(radius) + " m", "finite and > 0");
  }
  EXPECT_TRUE(system.joints().empty());
}

TEST(Prismatic, AnAxisMayHaveAnyLength) {
  for (const double length : {1e-300, 1e-160, 1.0, 1e160, 1e300}) {
    System system;
    const BodyId a = system.add(RigidBody{.mass = disc(1.0, 1.0)});
    const JointId slide =
        system.add(Prismatic{.from = ground, .to = a, .axis = Vec<2>(3.0 * length, 4.0 * length)});
    State state = Assembly(system).initial_state();
    state.position(a) = Vec<2>(3.0, 4.0);
    EXPECT_NEAR(state.coordinate(slide), 5.0, 1e-14) << length;
  }
}

TEST(Prismatic, FingerprintChangesWithEveryParameter) {
  const auto print = [](const auto& part) {
    System system;
    const BodyId a = system.add(RigidBody{.mass = disc(1.0, 1.0)});
    system.add(part(a));
    return system.fingerprint();
  };
  const Vec<2> x(1, 0), y(0, 1);
  const std::vector<std::uint64_t> prints{
      print([&](BodyId a) { return Prismatic{.from = ground, .to = a, .axis = x}; }),
      print([&](BodyId a) { return Prismatic{.from = ground, .to = a, .axis = y}; }),
      print([&](BodyId a) {
        return Prismatic{.from = {ground, {1, 0}}, .to = a, .axis = x, .zero_distance = 0};
      }),
      print([&](BodyId a) { return Prismatic{.from = ground, .to = a, .axis = x, .angle = 1.0}; }),
      print([&](BodyId a) { return Prismatic{.from = ground, .to = a, .axis = x, .zero_distance = 1.0}; }),
      print([&](BodyId a) { return PointOnLine{.from = ground, .to = a, .axis = x}; }),
      print([&](BodyId a) { return PointOnLine{.from = ground, .to = a, .axis = y}; }),
      print([&](BodyId a) { return PointOnLine{.from = ground, .to = a, .axis = x, .zero_distance = 1.0}; }),
      print([&](BodyId a) { return Rolling{.from = ground, .to = a, .normal = x, .radius = 1.0}; }),
      print([&](BodyId a) { return Rolling{.from = ground, .to = a, .normal = y, .radius = 1.0}; }),
      print([&](BodyId a) { return Rolling{.from = ground, .to = a, .normal = x, .radius = 2.0}; })};
  for (std::size_t i = 0; i < prints.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) EXPECT_NE(prints[i], prints[j]) << i << " and " << j;
  }
}

}  // namespace
