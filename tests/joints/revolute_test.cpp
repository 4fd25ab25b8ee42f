#include <carom/core/assembly.h>
#include <carom/joints/applied_load.h>
#include <carom/joints/gravity.h>
#include <carom/joints/prismatic.h>
#include <carom/joints/revolute.h>

#include "tests/joints/element_pairs.h"
#include "tests/joints/joint_model.h"
#include "tests/model_error.h"

#include <limits>
#include <numbers>

namespace {

using namespace carom;
using namespace carom::planar;
using namespace carom_test;

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double g = 9.81;

void expect_reaction(const JointReaction& found, const Vec<2>& force, double moment, double tolerance) {
  EXPECT_NEAR(found.force[0], force[0], tolerance);
  EXPECT_NEAR(found.force[1], force[1], tolerance);
  EXPECT_EQ(found.force[2], 0.0);
  EXPECT_NEAR(found.moment, moment, tolerance);
}

TEST(Revolute, ItsCoordinateIsTheAngleOfToAgainstFrom) {
  System system;
  const BodyId a = system.add(RigidBody{.mass = disc(1.0, 1.0), .angle = 1.0, .spin = 0.5});
  const BodyId b = system.add(RigidBody{.mass = disc(1.0, 1.0), .angle = 3.0, .spin = 2.0});
  const JointId described = system.add(Revolute{.from = a, .to = b});
  const JointId given = system.add(Revolute{.from = {a, {1, 0}}, .to = b, .zero_angle = 0.5});
  const JointId onto_ground = system.add(Revolute{.from = b, .to = ground});
  const JointId off_ground = system.add(Revolute{.from = ground, .to = b, .zero_angle = 0.0});
  State state = Assembly(system).initial_state();
  EXPECT_EQ(state.coordinate(described), 0.0);
  EXPECT_EQ(state.coordinate(given), 1.5);
  EXPECT_EQ(state.coordinate(onto_ground), 0.0);
  EXPECT_EQ(state.coordinate(off_ground), 3.0);
  // Turns are counted.
  state.angle(b) += 20.0;
  EXPECT_EQ(state.coordinate(described), 20.0);
  EXPECT_EQ(state.coordinate(given), 21.5);
  EXPECT_EQ(state.coordinate(onto_ground), -20.0);
  EXPECT_EQ(state.coordinate(off_ground), 23.0);
  EXPECT_EQ(state.rate(described), 1.5);
  EXPECT_EQ(state.rate(given), 1.5);
  EXPECT_EQ(state.rate(onto_ground), -2.0);
  EXPECT_EQ(state.rate(off_ground), 2.0);
}

TEST(Revolute, ForParticlesTheCoordinateIsZero) {
  System system;
  const BodyId dot = system.add(Particle{.mass = 1.0, .velocity = {1, 2}});
  const JointId pin = system.add(Revolute{.from = ground, .to = dot});
  State state = Assembly(system).initial_state();
  state.position(dot) = Vec<2>(3, 4);
  EXPECT_EQ(state.coordinate(pin), 0.0);
  EXPECT_EQ(state.rate(pin), 0.0);
}

TEST(Revolute, ItsGapIsTheDistanceOfTheEndsInTheFixedFrame) {
  System system;
  const BodyId a = system.add(RigidBody{.mass = disc(1.0, 1.0), .angle = 0.3});
  const JointId pin = system.add(Revolute{.from = {ground, {1, 2}}, .to = {a, {0.5, 0.25}}});
  const JointModel model(system);
  const std::vector<JointRow> rows = model.rows(pin);
  const double c = std::cos(0.3), s = std::sin(0.3);
  EXPECT_NEAR(rows[0].gap, 0.5 * c - 0.25 * s - 1.0, 1e-15);
  EXPECT_NEAR(rows[1].gap, 0.5 * s + 0.25 * c - 2.0, 1e-15);
}

TEST(Revolute, CarriesAHangingBody) {
  System system;
  system.add(Gravity{{0, -g}});
  const double w = 3.0, m = 2.0, l = 1.5;
  const BodyId a = system.add(RigidBody{.mass = rod(m, 2.0 * l), .position = {0, -l}, .spin = w});
  const JointId pin = system.add(Revolute{.from = ground, .to = {a, {0, l}}});
  JointModel model(system);
  const std::vector<double> acceleration = model.acceleration();
  expect_reaction(model.reaction(pin), {0.0, m * (g + w * w * l)}, 0.0, 1e-12);
  expect_near(acceleration, {0.0, w * w * l, 0.0}, 1e-13);
  // The same pin the other way round: what acts on the ground.
  System turned;
  turned.add(Gravity{{0, -g}});
  const BodyId b = turned.add(RigidBody{.mass = rod(m, 2.0 * l), .position = {0, -l}});
  const JointId other = turned.add(Revolute{.from = {b, {0, l}}, .to = ground});
  JointModel at_rest(turned);
  at_rest.acceleration();
  expect_reaction(at_rest.reaction(other), {0.0, -m * g}, 0.0, 1e-12);
}

TEST(Revolute, APendulumTurnsAsItShould) {
  const double m = 2.0, l = 1.5, angle = 0.7;
  System system;
  system.add(Gravity{{0, -g}});
  const BodyId a = system.add(RigidBody{
      .mass = rod(m, 2.0 * l), .position = {l * std::sin(angle), -l * std::cos(angle)}, .angle = angle});
  system.add(Revolute{.from = ground, .to = {a, {0, l}}});
  JointModel model(system);
  const double turning = -m * g * l * std::sin(angle) / (m * l * l * 4.0 / 3.0);
  EXPECT_NEAR(model.acceleration()[2], turning, 1e-12);
}

TEST(Revolute, ABeamOnTwoSupports) {
  const double m = 3.0;
  System system;
  system.add(Gravity{{0, -g}});
  const BodyId beam = system.add(RigidBody{.mass = rod(m, 4.0)});
  system.add(AppliedForce{.on = {beam, {0.5, 0.0}}, .force = [](double) { return Vec<2>(5.0, -7.0); }});
  const JointId left = system.add(Revolute{.from = {ground, {-1.5, 0}}, .to = {beam, {-1.5, 0}}});
  const JointId right =
      system.add(PointOnLine{.from = {ground, {1, 0}}, .to = {beam, {1, 0}}, .axis = {1, 0}});
  JointModel model(system);
  expect_near(model.acceleration(), {0.0, 0.0, 0.0}, 1e-12);
  const double on_right = (m * g * 1.5 + 7.0 * 2.0) / 2.5;
  expect_reaction(model.reaction(right), {0.0, on_right}, 0.0, 1e-12);
  expect_reaction(model.reaction(left), {-5.0, m * g + 7.0 - on_right}, 0.0, 1e-12);
}

TEST(Revolute, AHangingChainOfLinks) {
  constexpr int count = 50;
  const double m = 0.3, l = 0.2;
  System system;
  system.add(Gravity{{0, -g}});
  std::vector<JointId> pins;
  BodyId above = ground;
  for (int i = 0; i < count; ++i) {
    const BodyId link = system.add(RigidBody{.mass = rod(m, l), .position = {0, -l * (i + 0.5)}});
    pins.push_back(
        system.add(Revolute{.from = {above, {0, i == 0 ? 0.0 : -0.5 * l}}, .to = {link, {0, 0.5 * l}}}));
    above = link;
  }
  JointModel model(system);
  EXPECT_LE(largest(model.acceleration()), 1e-10);
  for (int i = 0; i < count; ++i) {
    expect_reaction(model.reaction(pins[static_cast<std::size_t>(i)]), {0.0, (count - i) * m * g}, 0.0,
                    1e-10);
  }
}

TEST(Weld, ACantileverIsHeldByForceAndMoment) {
  const double m = 3.0, l = 2.0;
  for (const double angle : {0.0, 0.4}) {
    System system;
    system.add(Gravity{{0, -g}});
    const Vec<2> along(std::cos(angle), std::sin(angle));
    const BodyId beam =
        system.add(RigidBody{.mass = rod(m, l), .position = Vec<2>(0.5 * l * along), .angle = angle});
    system.add(AppliedForce{.on = {beam, {0.5 * l, 0}}, .force = [](double) { return Vec<2>(0.0, -7.0); }});
    const JointId weld = system.add(Weld{.from = ground, .to = {beam, {-0.5 * l, 0}}});
    JointModel model(system);
    expect_near(model.acceleration(), {0.0, 0.0, 0.0}, 1e-12);
    expect_reaction(model.reaction(weld), {0.0, m * g + 7.0}, (0.5 * m * g + 7.0) * l * along[0], 1e-12);
  }
}

TEST(Weld, TheGroundTakesItsMoment) {
  // The same the other way round: what acts on the ground.
  System system;
  system.add(Gravity{{0, -g}});
  const BodyId beam = system.add(RigidBody{.mass = rod(3.0, 2.0), .position = {1.0, 0.0}});
  const JointId weld = system.add(Weld{.from = {beam, {-1.0, 0}}, .to = ground});
  JointModel model(system);
  expect_near(model.acceleration(), {0.0, 0.0, 0.0}, 1e-12);
  expect_reaction(model.reaction(weld), {0.0, -3.0 * g}, -3.0 * g, 1e-12);
}

TEST(Weld, KeepsTheAngleAsDescribedOrAsGiven) {
  System system;
  const BodyId a = system.add(RigidBody{.mass = disc(1.0, 1.0), .angle = 1.0});
  const BodyId b = system.add(RigidBody{.mass = disc(1.0, 1.0), .angle = 3.5});
  const JointId described = system.add(Weld{.from = a, .to = b});
  const JointId given = system.add(Weld{.from = a, .to = b, .angle = 2.25});
  const JointModel model(system);
  EXPECT_EQ(model.rows(described)[2].gap, 0.0);
  EXPECT_EQ(model.rows(given)[2].gap, 0.25);
  EXPECT_FALSE(model.kind(given).has_coordinate());
}

TEST(Revolute, ImpossibleParametersAreRefusedByName) {
  System system;
  const BodyId a = system.add(RigidBody{.mass = disc(1.0, 1.0)});
  EXPECT_MODEL_ERROR(system.add(Revolute{.from = ground, .to = a, .zero_angle = infinity}, "hip"),
                     "revolute joint 'hip'", "zero_angle is inf rad", "allowed: a finite number");
  EXPECT_MODEL_ERROR(system.add(Weld{.from = ground, .to = a, .angle = -infinity}), "weld #0",
                     "angle is -inf rad", "allowed: a finite number");
}

TEST(Revolute, FingerprintChangesWithEveryParameter) {
  const auto print = [](const auto& change) {
    System system;
    const BodyId a = system.add(RigidBody{.mass = disc(1.0, 1.0)});
    const BodyId b = system.add(RigidBody{.mass = disc(1.0, 1.0)});
    change(system, a, b);
    return system.fingerprint();
  };
  const std::vector<std::uint64_t> prints{
      print([](System&, BodyId, BodyId) {}),
      print([](System& s, BodyId a, BodyId b) { s.add(Revolute{.from = a, .to = b}); }),
      print([](System& s, BodyId a, BodyId b) { s.add(Revolute{.from = b, .to = a}); }),
      print([](System& s, BodyId a, BodyId) { s.add(Revolute{.from = ground, .to = a}); }),
      print([](System& s, BodyId a, BodyId b) {
        s.add(Revolute{.from = {a, {1, 0}}, .to = b});
      }),
      print([](System& s, BodyId a, BodyId b) {
        s.add(Revolute{.from = a, .to = {b, {0, 1}}});
      }),
      print([](System& s, BodyId a, BodyId b) { s.add(Revolute{.from = a, .to = b, .zero_angle = 1.0}); }),
      print([](System& s, BodyId a, BodyId b) { s.add(Weld{.from = a, .to = b}); }),
      print([](System& s, BodyId a, BodyId b) { s.add(Weld{.from = a, .to = b, .angle = 1.0}); })};
  for (std::size_t i = 0; i < prints.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) EXPECT_NE(prints[i], prints[j]) << i << " and " << j;
  }
}

}  // namespace
