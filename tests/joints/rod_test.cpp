#include <carom/joints/gravity.h>
#include <carom/joints/revolute.h>
#include <carom/joints/rod.h>

#include "tests/joints/element_pairs.h"
#include "tests/joints/joint_model.h"
#include "tests/model_error.h"

#include <limits>

namespace {

using namespace carom;
using namespace carom::planar;
using namespace carom_test;

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double g = 9.81;

void expect_force(const JointReaction& found, const Vec<2>& force, double tolerance) {
  EXPECT_NEAR(found.force[0], force[0], tolerance);
  EXPECT_NEAR(found.force[1], force[1], tolerance);
  EXPECT_EQ(found.moment, 0.0);
}

TEST(Rod, KeepsTheLengthAsDescribedOrAsGiven) {
  System system;
  const BodyId dot = system.add(Particle{.mass = 1.0, .position = {3, 4}});
  const JointId described = system.add(Rod{.from = ground, .to = dot});
  const JointId given = system.add(Rod{.from = {ground, {0, 4}}, .to = dot, .length = 2.5});
  const JointModel model(system);
  EXPECT_EQ(model.rows(described)[0].gap, 0.0);
  EXPECT_EQ(model.rows(given)[0].gap, 0.5);
  EXPECT_FALSE(model.kind(given).has_coordinate());
}

TEST(Rod, CarriesAHangingParticle) {
  const double m = 2.0;
  System system;
  system.add(Gravity{{0, -g}});
  const BodyId dot = system.add(Particle{.mass = m, .position = {1, -2}, .velocity = {3, 0}});
  const JointId rod = system.add(Rod{.from = {ground, {1, 0}}, .to = dot});
  JointModel model(system);
  expect_near(model.acceleration(), {0.0, 4.5}, 1e-13);  // 3^2/2
  expect_force(model.reaction(rod), {0.0, m * (g + 4.5)}, 1e-12);
}

TEST(Rod, TwoRodsShareAWeight) {
  // Rods at right angles to each other: each carries its part of the weight.
  const double m = 2.0, c = std::cos(0.5), s = std::sin(0.5);
  System system;
  system.add(Gravity{{0, -g}});
  const BodyId dot = system.add(Particle{.mass = m});
  const JointId left = system.add(Rod{.from = {ground, {-3.0 * s, 3.0 * c}}, .to = dot});
  const JointId right = system.add(Rod{.from = {ground, {2.0 * c, 2.0 * s}}, .to = dot});
  JointModel model(system);
  expect_near(model.acceleration(), {0.0, 0.0}, 1e-13);
  expect_force(model.reaction(left), m * g * c * Vec<2>(-s, c), 1e-12);
  expect_force(model.reaction(right), m * g * s * Vec<2>(c, s), 1e-12);
}

TEST(Rod, AHangingChain) {
  for (const int count : {1, 10, 200}) {
    const double m = 0.25;
    System system;
    system.add(Gravity{{0, -g}});
    std::vector<JointId> rods;
    BodyId above = ground;
    for (int i = 0; i < count; ++i) {
      const BodyId dot = system.add(Particle{.mass = m, .position = {0, -0.5 * (i + 1)}});
      rods.push_back(system.add(Rod{.from = above, .to = dot}));
      above = dot;
    }
    JointModel model(system);
    EXPECT_LE(largest(model.acceleration()), 1e-10);
    for (int i = 0; i < count; ++i) {
      expect_force(model.reaction(rods[static_cast<std::size_t>(i)]), {0.0, (count - i) * m * g}, 1e-10);
    }
  }
}

TEST(Rod, ImpossibleParametersAreRefusedByName) {
  System system;
  const BodyId a = system.add(Particle{.mass = 1.0});
  const BodyId b = system.add(Particle{.mass = 1.0, .position = {3, 4}});
  EXPECT_MODEL_ERROR(system.add(Rod{.from = ground, .to = a}, "arm"), "rod 'arm'", "length is 0 m",
                     "allowed: finite and > 0");
  for (const double length : {0.0, -1.0, infinity}) {
    EXPECT_MODEL_ERROR(system.add(Rod{.from = a, .to = b, .length = length}), "rod #0",
                       "length is " + to_text(length) + " m", "allowed: finite and > 0");
  }
  EXPECT_MODEL_ERROR(system.add(Rod{.from = ground, .to = a, .length = 1.0}), "rod #0",
                     "distance of the ends as described is 0 m", "allowed: a distance > 0");
}

/// Two wheels, and an arm that carries both.
struct Wheels {
  System system;
  BodyId a, b, arm;
  Wheels() {
    a = system.add(RigidBody{.mass = disc(2.0, 1.0), .angle = 0.5}, "a");
    b = system.add(RigidBody{.mass = disc(3.0, 1.0), .angle = 1.25}, "b");
    arm = system.add(RigidBody{.mass = disc(5.0, 1.0), .angle = -0.25}, "arm");
  }
};

TEST(Gear, RowsMeetDifferences) {
  Random random(321);
  for (const double ratio : {2.0, 0.3, -0.5, -1.0}) {
    Wheels wheels;
    const JointId fixed = wheels.system.add(Gear{.from = wheels.a, .to = wheels.b, .ratio = ratio});
    const JointId carried =
        wheels.system.add(Gear{.from = wheels.a, .to = wheels.b, .ratio = ratio, .carrier = wheels.arm});
    JointModel model(wheels.system);
    for (const JointId gear : {fixed, carried}) {
      EXPECT_NEAR(model.rows(gear)[0].gap, 0.0, 1e-15);  // as described
      expect_pattern_fits(model, gear);
      expect_rows_meet_differences(model, gear, random);
    }
  }
}

TEST(Gear, KeepsTheRatioAgainstTheCarrier) {
  // A turn of all together changes nothing; against the arm the wheels turn as their radii say.
  Random random(322);
  for (int repeat = 0; repeat < 20; ++repeat) {
    Wheels wheels;
    const double ratio = random.uniform(-3.0, 3.0), turn = random.uniform(-9.0, 9.0);
    const double by = random.uniform(-9.0, 9.0);
    const JointId gear =
        wheels.system.add(Gear{.from = wheels.a, .to = wheels.b, .ratio = ratio, .carrier = wheels.arm});
    JointModel model(wheels.system);
    model.state.angle(wheels.arm) += turn;
    model.state.angle(wheels.a) += turn + by;
    model.state.angle(wheels.b) += turn - ratio * by;
    EXPECT_NEAR(model.rows(gear)[0].gap, 0.0, 1e-13);
  }
}

TEST(Gear, AMomentAcceleratesBothWheels) {
  // Reduced to `from`: (I_a + ratio^2 I_b) a' = M.
  const double ratio = 0.5;
  Wheels wheels;
  const JointId gear = wheels.system.add(Gear{.from = wheels.a, .to = wheels.b, .ratio = ratio});
  JointModel model(wheels.system);
  const Index from = model.assembly.layout()->slot(wheels.a).v + 2,
              to = model.assembly.layout()->slot(wheels.b).v + 2;
  model.external[from] = 7.0;
  const std::vector<double> acceleration = model.acceleration();
  const double expected = 7.0 / (1.0 + ratio * ratio * 1.5);
  EXPECT_NEAR(acceleration[from], expected, 1e-12);
  EXPECT_NEAR(acceleration[to], -ratio * expected, 1e-12);
  // The moment on `to` turns it.
  EXPECT_NEAR(model.reaction(gear).moment, -1.5 * ratio * expected, 1e-12);
}

TEST(Gear, ImpossibleParametersAreRefusedByName) {
  Wheels wheels;
  System& system = wheels.system;
  const BodyId dot = system.add(Particle{.mass = 1.0}, "dot");
  const BodyId a = wheels.a, b = wheels.b;
  EXPECT_MODEL_ERROR(system.add(Gear{.from = a, .to = b}), "gear pair #0", "ratio is nan",
                     "allowed: a finite number");
  EXPECT_MODEL_ERROR(system.add(Gear{.from = a, .to = b, .ratio = infinity}), "ratio is inf");
  EXPECT_MODEL_ERROR(system.add(Gear{.from = a, .to = b, .ratio = 0.0}, "pair"), "gear pair 'pair'",
                     "ratio is 0", "allowed: a ratio that is not 0");
  EXPECT_MODEL_ERROR(system.add(Gear{.to = b, .ratio = 1.0}), "from is not given");
  EXPECT_MODEL_ERROR(system.add(Gear{.from = a, .ratio = 1.0}), "to is not given");
  EXPECT_MODEL_ERROR(system.add(Gear{.from = a, .to = a, .ratio = 1.0}), "to is rigid body 'a', as from");
  EXPECT_MODEL_ERROR(system.add(Gear{.from = ground, .to = a, .ratio = 1.0}), "from is ground");
  EXPECT_MODEL_ERROR(system.add(Gear{.from = a, .to = dot, .ratio = 1.0}), "to is particle 'dot'",
                     "allowed: a rigid body");
  EXPECT_MODEL_ERROR(system.add(Gear{.from = a, .to = b, .ratio = 1.0, .carrier = dot}),
                     "carrier is particle 'dot'", "allowed: a rigid body");
  EXPECT_MODEL_ERROR(system.add(Gear{.from = a, .to = b, .ratio = 1.0, .carrier = b}),
                     "carrier is rigid body 'b'", "allowed: another body than from and to");
  EXPECT_MODEL_ERROR(system.add(Gear{.from = a, .to = b, .ratio = 1.0, .carrier = BodyId{}}),
                     "carrier is not given");
  EXPECT_TRUE(system.joints().empty());
}

TEST(Rod, FingerprintChangesWithEveryParameter) {
  const auto print = [](const auto& part) {
    Wheels wheels;
    const BodyId dot = wheels.system.add(Particle{.mass = 1.0, .position = {1, 1}});
    wheels.system.add(part(wheels, dot));
    return wheels.system.fingerprint();
  };
  const std::vector<std::uint64_t> prints{
      print([](const Wheels&, BodyId dot) { return Rod{.from = ground, .to = dot, .length = 1.0}; }),
      print([](const Wheels&, BodyId dot) { return Rod{.from = ground, .to = dot, .length = 2.0}; }),
      print([](const Wheels& w, BodyId dot) { return Rod{.from = w.a, .to = dot, .length = 1.0}; }),
      print([](const Wheels& w, BodyId) { return Gear{.from = w.a, .to = w.b, .ratio = 1.0}; }),
      print([](const Wheels& w, BodyId) { return Gear{.from = w.b, .to = w.a, .ratio = 1.0}; }),
      print([](const Wheels& w, BodyId) { return Gear{.from = w.a, .to = w.b, .ratio = 2.0}; }),
      print([](const Wheels& w, BodyId) {
        return Gear{.from = w.a, .to = w.b, .ratio = 1.0, .carrier = w.arm};
      }),
      // Where the ratio is -1 the carrier does not enter, but it is bound.
      print([](const Wheels& w, BodyId) { return Gear{.from = w.a, .to = w.b, .ratio = -1.0}; }),
      print([](const Wheels& w, BodyId) {
        return Gear{.from = w.a, .to = w.b, .ratio = -1.0, .carrier = w.arm};
      })};
  for (std::size_t i = 0; i < prints.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) EXPECT_NE(prints[i], prints[j]) << i << " and " << j;
  }
}

}  // namespace
