// Spring-dampers that cannot be: refused by the name of the part, the value and what is allowed.

#include <carom/bodies/particle.h>
#include <carom/bodies/rigid_body.h>
#include <carom/core/system.h>
#include <carom/joints/spring_damper.h>

#include "tests/model_error.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <vector>

namespace {

using namespace carom;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

TEST(SpringDamper, ImpossibleOnesAreRefusedByName) {
  using namespace planar;
  System system;
  const BodyId a = system.add(Particle{.mass = 1.0}, "a"), b = system.add(Particle{.mass = 1.0}, "b");
  const BodyId plate = system.add(RigidBody{.mass = disc(1.0, 1.0)}, "plate");
  const SpringDamper good{.from = a, .to = b};
  EXPECT_MODEL_ERROR(system.add(SpringDamper{.to = b}, "link"), "spring-damper 'link'", "from is not given");
  EXPECT_MODEL_ERROR(system.add(SpringDamper{.from = a}), "spring-damper #0", "to is not given");
  EXPECT_MODEL_ERROR(system.add(SpringDamper{.from = a, .to = a}), "to is particle 'a', as from",
                     "another body");
  EXPECT_MODEL_ERROR(system.add(SpringDamper{.from = {plate, {0, 1}}, .to = {plate, {1, 0}}}),
                     "to is rigid body 'plate', as from");
  EXPECT_MODEL_ERROR(system.add(SpringDamper{.from = ground, .to = {ground, {1, 0}}}),
                     "to is ground, as from");
  EXPECT_MODEL_ERROR(system.add(SpringDamper{.from = {a, {0, 1}}, .to = b}),
                     "from, off the centre, is particle 'a'");
  EXPECT_MODEL_ERROR(system.add(SpringDamper{.from = a, .to = {b, {0, 1}}}),
                     "to, off the centre, is particle 'b'");
  struct Field {
    std::string quantity;
    std::function<double&(SpringDamper&)> of;
  };
  const std::vector<Field> fields{{"stiffness", [](SpringDamper& s) -> double& { return s.stiffness; }},
                                  {"damping", [](SpringDamper& s) -> double& { return s.damping; }},
                                  {"free_length", [](SpringDamper& s) -> double& { return s.free_length; }}};
  for (const double bad : {nan, infinity, -infinity, -1.0}) {
    for (const Field& field : fields) {
      SpringDamper spring = good;
      field.of(spring) = bad;
      EXPECT_MODEL_ERROR(system.add(spring), "spring-damper #0", field.quantity + " is " + to_text(bad),
                         "finite and >= 0");
    }
    if (std::isfinite(bad)) continue;
    EXPECT_MODEL_ERROR(system.add(SpringDamper{.from = {ground, {0, bad}}, .to = a}),
                       "from.point is " + to_text(bad));
    EXPECT_MODEL_ERROR(system.add(SpringDamper{.from = a, .to = {plate, {bad, 0}}}),
                       "to.point is " + to_text(bad));
  }
  EXPECT_TRUE(system.elements().empty());
}

}  // namespace
