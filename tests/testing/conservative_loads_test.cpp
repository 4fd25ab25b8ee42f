#include <carom/carom.h>
#include <carom/testing/matchers.h>

#include "tests/integrators/throws.h"
#include "tests/testing/verdict_of.h"

#include <gtest/gtest.h>

#include <cmath>

namespace {

using namespace carom;
using namespace carom::planar;
using namespace carom::energy_test;

/// V = k x^2 y, pulled down with a factor that should be 1.
struct Saddle {
  static constexpr Role role = Role::force;
  static constexpr int dimension = 2;
  static constexpr std::string_view label = "saddle";
  End<2> on{};
  double factor = 1.0;

  std::vector<BodyId> bodies() const { return {on.body}; }
  double potential(const ElementView<2>& at) const {
    const Vec<2> x = at.position(on);
    return 3.0 * x[0] * x[0] * x[1];
  }
  void loads(const ElementView<2>& at, ElementLoads<2>& out) const {
    const Vec<2> x = at.position(on);
    out.conservative(on, Vec<2>(-6.0 * x[0] * x[1], -3.0 * factor * x[0] * x[0]));
  }
};

System saddle_on_a_bar(double factor) {
  System system;
  const BodyId bar =
      system.add(RigidBody{.mass = rod(1.0, 2.0), .position = {1.0, 0.5}, .angle = 0.3}, "bar");
  system.add(Saddle{.on = {bar, {0.5, 0.2}}, .factor = factor});
  return system;
}

TEST(ConservativeLoads, FollowThePotential) {
  EXPECT_THAT(saddle_on_a_bar(1.0), conservative_loads_follow_the_potential(1e-10));
}

TEST(ConservativeLoads, ThatDoNotAreShown) {
  // The force along y and, by its lever, the torque are wrong; the force along x is not.
  const auto refused = carom_test::said(saddle_on_a_bar(1.1), conservative_loads_follow_the_potential(1e-10));
  EXPECT_FALSE(refused.matches);
  EXPECT_NE(refused.why.find("rigid body 'bar'         1"), std::string::npos) << refused.why;
  EXPECT_NE(refused.why.find("rigid body 'bar'         2"), std::string::npos) << refused.why;
  EXPECT_EQ(refused.why.find("rigid body 'bar'         0"), std::string::npos) << refused.why;
  EXPECT_THAT(saddle_on_a_bar(1.1), conservative_loads_follow_the_potential(10.0));
}

TEST(ConservativeLoads, RefuseAToleranceThatCannotBe) {
  EXPECT_THROWS(ModelError, check_conservative_loads(saddle_on_a_bar(1.0), -1.0), "tolerance is -1", ">= 0");
}

}  // namespace
