#include <carom/bodies/particle.h>
#include <carom/bodies/rigid_body.h>
#include <carom/core/part_check.h>
#include <carom/core/surface.h>
#include <carom/core/system.h>

#include "tests/model_error.h"
#include "tests/random.h"

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <limits>

namespace {

using namespace carom;
using namespace carom::planar;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

TEST(ToText, ReadsBackToTheSameNumber) {
  carom_test::Random random(41);
  for (int repeat = 0; repeat < 10'000; ++repeat) {
    const double value = std::bit_cast<double>(random.bits());
    if (!std::isfinite(value)) continue;
    EXPECT_EQ(std::strtod(to_text(value).c_str(), nullptr), value);
  }
  EXPECT_EQ(to_text(0.1), "0.1");
  EXPECT_EQ(to_text(-3.0), "-3");
  EXPECT_EQ(to_text(nan), "nan");
  EXPECT_EQ(to_text(-infinity), "-inf");
}

class PartCheckTest : public testing::Test {
protected:
  System system;
  BodyId particle = system.add(Particle{.mass = 1.0}, "dot");
  BodyId plate = system.add(RigidBody{.mass = disc(1.0, 1.0)}, "plate");
  PartCheck check{"part 'tested'", system};
};

TEST_F(PartCheckTest, MessageNamesPartQuantityValueAndWhatIsAllowed) {
  try {
    check.refuse("mass", "-1 kg", "finite and > 0");
  } catch (const ModelError& error) {
    EXPECT_STREQ(error.what(), "part 'tested': mass is -1 kg; allowed: finite and > 0");
  }
  EXPECT_EQ(check.part(), "part 'tested'");
}

TEST_F(PartCheckTest, Finite) {
  EXPECT_NO_THROW(check.finite(-1e150, "value", "m"));
  EXPECT_MODEL_ERROR(check.finite(-1.01e150, "value", "m"), "value is -1.01e+150 m",
                     "allowed: a number of a magnitude up to 1e+150");
  EXPECT_MODEL_ERROR(check.positive(1e300, "mass", "kg"), "mass is 1e+300 kg", "a magnitude up to 1e+150");
  EXPECT_MODEL_ERROR(check.non_negative(1e151, "k", "N/m"), "k is 1e+151 N/m", "a magnitude up to 1e+150");
  // Directions are of any length.
  EXPECT_NO_THROW(check.direction(std::array{1e300, 0.0}, "axis"));
  EXPECT_MODEL_ERROR(check.direction(std::array{nan, 0.0}, "axis"), "axis is nan", "finite");
  EXPECT_MODEL_ERROR(check.finite(nan, "angle", "rad"), "part 'tested'", "angle is nan rad", "finite");
  EXPECT_MODEL_ERROR(check.finite(-infinity, "angle", ""), "angle is -inf;");
  const std::array<double, 3> numbers{1.0, infinity, 2.0};
  EXPECT_MODEL_ERROR(check.finite(numbers, "position", "m"), "part 'tested'", "position is inf m");
}

TEST_F(PartCheckTest, Positive) {
  EXPECT_NO_THROW(check.positive(std::numeric_limits<double>::denorm_min(), "mass", "kg"));
  for (const double bad : {0.0, -0.0, -2.0, nan, infinity, -infinity}) {
    EXPECT_MODEL_ERROR(check.positive(bad, "mass", "kg"), "part 'tested'", "mass is " + to_text(bad) + " kg",
                       "finite and > 0");
  }
}

TEST_F(PartCheckTest, NonNegative) {
  EXPECT_NO_THROW(check.non_negative(0.0, "damping", "N s/m"));
  for (const double bad : {-1e-300, nan, infinity, -infinity}) {
    EXPECT_MODEL_ERROR(check.non_negative(bad, "damping", "N s/m"), "part 'tested'",
                       "damping is " + to_text(bad) + " N s/m", "finite and >= 0");
  }
}

TEST_F(PartCheckTest, Between) {
  EXPECT_NO_THROW(check.between(0.0, 0.0, 1.0, "e"));
  EXPECT_NO_THROW(check.between(1.0, 0.0, 1.0, "e"));
  for (const double bad : {-0.25, 1.5, nan, infinity}) {
    EXPECT_MODEL_ERROR(check.between(bad, 0.0, 1.0, "e"), "part 'tested'", "e is " + to_text(bad),
                       "in [0, 1]");
  }
}

TEST_F(PartCheckTest, NumbersLeftOutAreSaidToBe) {
  const char* left_out = ", perhaps not given; allowed: ";
  EXPECT_MODEL_ERROR(check.positive(nan, "mass", "kg"), "mass is nan kg", left_out);
  EXPECT_MODEL_ERROR(check.non_negative(nan, "friction", ""), "friction is nan", left_out);
  EXPECT_MODEL_ERROR(check.between(nan, 0.0, 1.0, "normal_restitution"), "normal_restitution is nan",
                     left_out);
  EXPECT_MODEL_ERROR(check.direction(std::array{nan, nan}, "axis"), "axis is nan", left_out);
  EXPECT_MODEL_ERROR(check.positive(infinity, "mass", "kg"), "mass is inf kg; allowed: ");
}

TEST_F(PartCheckTest, SurfaceChecksEveryCoefficient) {
  const Surface good{.friction = 3.0, .normal_restitution = 0.0, .tangential_restitution = 1.0};
  EXPECT_NO_THROW(check.surface(good));
  EXPECT_MODEL_ERROR(check.surface(Surface{}), "friction is nan");
  for (const double bad : {nan, infinity, -infinity, -0.5}) {
    Surface surface = good;
    surface.friction = bad;
    EXPECT_MODEL_ERROR(check.surface(surface), "part 'tested'", "friction is " + to_text(bad), ">= 0");
  }
  for (const double bad : {nan, infinity, -infinity, -0.5, 1.25}) {
    Surface surface = good;
    surface.normal_restitution = bad;
    EXPECT_MODEL_ERROR(check.surface(surface), "normal_restitution is " + to_text(bad), "[0, 1]");
    surface = good;
    surface.tangential_restitution = bad;
    EXPECT_MODEL_ERROR(check.surface(surface), "tangential_restitution is " + to_text(bad), "[0, 1]");
  }
}

TEST_F(PartCheckTest, Body) {
  EXPECT_NO_THROW(check.body(particle, "from", false));
  EXPECT_NO_THROW(check.body(ground, "from", true));
  EXPECT_MODEL_ERROR(check.body(ground, "from", false), "part 'tested'", "from is ground",
                     "a body of this system");
  EXPECT_MODEL_ERROR(check.body(BodyId{}, "from", true), "part 'tested'", "from is not given");
  System other;
  const BodyId foreign = other.add(Particle{.mass = 1.0});
  EXPECT_MODEL_ERROR(check.body(foreign, "from", true), "from is a body of another system");
  system.remove(particle);
  EXPECT_MODEL_ERROR(check.body(particle, "from", true), "from is a body that was removed");
}

TEST_F(PartCheckTest, OrientedBody) {
  EXPECT_NO_THROW(check.oriented_body(plate, "body"));
  EXPECT_MODEL_ERROR(check.oriented_body(particle, "body"), "part 'tested'", "body is particle 'dot'",
                     "a rigid body");
  EXPECT_MODEL_ERROR(check.oriented_body(ground, "body"), "body is ground");
}

TEST_F(PartCheckTest, DifferentEnds) {
  EXPECT_NO_THROW(check.different_ends(particle, plate));
  EXPECT_NO_THROW(check.different_ends(ground, plate));
  EXPECT_MODEL_ERROR(check.different_ends(plate, plate), "part 'tested'",
                     "to is rigid body 'plate', as from");
  EXPECT_MODEL_ERROR(check.different_ends(ground, ground), "to is ground, as from", "another body");
}

TEST_F(PartCheckTest, Material) {
  EXPECT_NO_THROW(check.material(MaterialId{}));
  EXPECT_NO_THROW(check.material(system.material("steel")));
  System other;
  EXPECT_MODEL_ERROR(check.material(other.material("steel")), "part 'tested'", "material is unknown");
  EXPECT_MODEL_ERROR(check.material(MaterialId{99, system.token()}), "material is unknown");
}

}  // namespace
