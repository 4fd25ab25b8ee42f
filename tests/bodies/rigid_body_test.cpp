#include <carom/bodies/rigid_body.h>
#include <carom/core/assembly.h>
#include <carom/core/system.h>

#include "tests/model_error.h"
#include "tests/random.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <vector>

namespace {

using namespace carom;
using namespace carom::planar;

constexpr double epsilon = std::numeric_limits<double>::epsilon();
constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

TEST(RigidBody, StartsWhereItWasDescribed) {
  System system;
  const BodyId id = system.add(
      RigidBody{.mass = rod(2.0, 3.0), .position = {1, 2}, .angle = 0.5, .velocity = {3, 4}, .spin = -6.0});
  const State state = Assembly(system).initial_state();
  EXPECT_EQ(state.q, (std::vector<double>{1.0, 2.0, 0.5}));
  EXPECT_EQ(state.v, (std::vector<double>{3.0, 4.0, -6.0}));
  EXPECT_TRUE(system.has_orientation(id));
}

TEST(RigidBody, TouchesNothingByItself) {
  System system;
  system.add(RigidBody{.mass = disc(1.0, 1.0)});
  EXPECT_FALSE(system.body_kinds().entries()[0].kind->has_contact_point(0));
}

TEST(RigidBody, MassAndItsInverseWorkOnARange) {
  System system;
  system.add(RigidBody{.mass = disc(1.0, 1.0)});
  system.add(RigidBody{.mass = {.mass = 2.0, .inertia = 8.0}});
  system.add(RigidBody{.mass = {.mass = 4.0, .inertia = 0.5}});
  const Assembly assembly(system);
  const BodyKind& kind = *assembly.body_kinds()[0];
  const std::vector<double> v{1, 2, 3, 4, 5, 6};
  std::vector<double> p(6), a(6);
  kind.apply_mass({1, 3}, v.data(), p.data());
  kind.apply_inverse_mass({1, 3}, v.data(), a.data());
  EXPECT_EQ(p, (std::vector<double>{2, 4, 24, 16, 20, 3}));
  EXPECT_EQ(a, (std::vector<double>{0.5, 1, 0.375, 1, 1.25, 12}));
  EXPECT_EQ(kind.kinetic_energy({1, 3}, v.data()), 0.5 * (2.0 * 5 + 8.0 * 9 + 4.0 * 41 + 0.5 * 36));
}

TEST(RigidBody, SpinsAreWeighedByTheRadiusOfGyration) {
  System system;
  system.add(RigidBody{.mass = ring(3.0, 0.25)});
  EXPECT_EQ(Assembly(system).length_scales(), (std::vector<double>{1.0, 1.0, 0.25}));
}

TEST(RigidBody, RotationsAndAdvanceWorkOnARange) {
  carom_test::Random random(71);
  System system;
  for (int i = 0; i < 4; ++i) system.add(RigidBody{.mass = disc(1.0, 1.0)});
  const Assembly assembly(system);
  const BodyKind& kind = *assembly.body_kinds()[0];
  std::vector<double> q0(6), delta(6), q1(6), rotation(4);
  for (double& x : q0) x = random.uniform(-4.0, 4.0);
  for (double& x : delta) x = random.uniform(-1.0, 1.0);
  kind.advance({1, 3}, q0.data(), delta.data(), q1.data());
  for (std::size_t i = 0; i < 6; ++i) EXPECT_EQ(q1[i], q0[i] + delta[i]);
  kind.rotations({1, 3}, q0.data(), rotation.data());
  EXPECT_EQ(rotation,
            (std::vector<double>{std::cos(q0[2]), std::sin(q0[2]), std::cos(q0[5]), std::sin(q0[5])}));
}

TEST(RigidBody, AnglesAreNotWrapped) {
  System system;
  const BodyId id = system.add(RigidBody{.mass = disc(1.0, 1.0), .angle = 100.0});
  EXPECT_EQ(Assembly(system).initial_state().angle(id), 100.0);
}

TEST(RigidBody, RefusesImpossibleNumbersByName) {
  const RigidBody good{.mass = disc(1.0, 1.0)};
  struct Field {
    std::string quantity, unit;
    std::function<double&(RigidBody&)> of;
    bool positive;
  };
  const std::vector<Field> fields{
      {"mass", "kg", [](RigidBody& b) -> double& { return b.mass.mass; }, true},
      {"moment of inertia", "kg m^2", [](RigidBody& b) -> double& { return b.mass.inertia; }, true},
      {"position", "m", [](RigidBody& b) -> double& { return b.position[0]; }, false},
      {"position", "m", [](RigidBody& b) -> double& { return b.position[1]; }, false},
      {"angle", "rad", [](RigidBody& b) -> double& { return b.angle; }, false},
      {"velocity", "m/s", [](RigidBody& b) -> double& { return b.velocity[0]; }, false},
      {"velocity", "m/s", [](RigidBody& b) -> double& { return b.velocity[1]; }, false},
      {"spin", "rad/s", [](RigidBody& b) -> double& { return b.spin; }, false},
  };
  System system;
  for (const Field& field : fields) {
    std::vector<double> bad_values{nan, infinity, -infinity};
    if (field.positive) bad_values.insert(bad_values.end(), {0.0, -1.0});
    for (const double bad : bad_values) {
      RigidBody body = good;
      field.of(body) = bad;
      EXPECT_MODEL_ERROR(system.add(body, "plate"), "rigid body 'plate'",
                         field.quantity + " is " + to_text(bad) + " " + field.unit, "allowed");
    }
  }
  EXPECT_MODEL_ERROR(system.add(RigidBody{}), "rigid body #0", "mass is nan kg");
  EXPECT_MODEL_ERROR(system.add(RigidBody{.mass = point_mass(1.0)}), "moment of inertia is 0 kg m^2", "> 0");
  EXPECT_TRUE(system.bodies().empty());
}

TEST(RigidBody, RefusesACentreOfMassAwayFromItsOrigin) {
  System system;
  const MassProperties<2> triangle = polygon(1.0, {{0, 0}, {3, 0}, {0, 3}});
  EXPECT_MODEL_ERROR(system.add(RigidBody{.mass = triangle}, "wedge"), "rigid body 'wedge'",
                     "centre of mass is (1, 1) m", "centred()", "shift the shapes");
  EXPECT_NO_THROW(system.add(RigidBody{.mass = centred(triangle)}));
  for (const double bad : {nan, infinity}) {
    MassProperties<2> mass = disc(1.0, 1.0);
    mass.centre[0] = bad;
    EXPECT_MODEL_ERROR(system.add(RigidBody{.mass = mass}), "centre of mass is (" + to_text(bad) + ", 0) m");
  }
}

TEST(RigidBody, ACentreMayBeOffByRounding) {
  System system;
  MassProperties<2> mass = ring(2.0, 4.0);  // radius of gyration 4
  mass.centre = {0.0, 3.9e3 * epsilon};
  EXPECT_NO_THROW(system.add(RigidBody{.mass = mass}));
  mass.centre = {0.0, 4.1e3 * epsilon};
  EXPECT_MODEL_ERROR(system.add(RigidBody{.mass = mass}), "centre of mass is");
  // Remainder of composing symmetric parts.
  const MassProperties<2> half = disc(0.1, 0.3);
  EXPECT_NO_THROW(
      system.add(RigidBody{.mass = compose({shifted(half, {0.7, 0.1}), half, shifted(half, {-0.7, -0.1})})}));
}

}  // namespace
