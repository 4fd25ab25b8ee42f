// The page docs/elements.md: the element it shows, and the test of it that it shows.

#include <carom/carom.h>
#include <carom/testing/matchers.h>

#include "tests/page_blocks.h"
#include "tests/random.h"

#include <gtest/gtest.h>

#include <string>

using namespace carom;
using namespace carom::planar;

// The page shows from here...
struct Magnet {  // attracts with V = -s / sqrt(d^2 + a^2)
  static constexpr Role role = Role::force;
  static constexpr int dimension = 2;
  static constexpr std::string_view label = "magnet";
  End<2> from{}, to{};
  double strength = 0.0, core = 0.0;  // s [N m^2], a [m]

  std::vector<BodyId> bodies() const { return {from.body, to.body}; }
  void check(const PartCheck& check) const { check.positive(core, "core", "m"); }
  double potential(const ElementView<2>& at) const {
    return -strength / std::sqrt((at.position(to) - at.position(from)).squaredNorm() + core * core);
  }
  void loads(const ElementView<2>& at, ElementLoads<2>& out) const {
    const Vec<2> d = at.position(to) - at.position(from);
    const Vec<2> pull = strength * std::pow(d.squaredNorm() + core * core, -1.5) * d;
    out.conservative(from, pull);
    out.conservative(to, -pull);
  }
};
// ... to here, and from here...
TEST(Magnet, PullsDownThePotential) {
  carom_test::Random random(1);
  for (int repeat = 0; repeat < 100; ++repeat) {
    System system;
    const BodyId bar = system.add(RigidBody{.mass = rod(1.0, 2.0), .angle = random.uniform(-3, 3)});
    const BodyId dot = system.add(Particle{.mass = 1.0, .position = random.vec<2>(3.0)});
    system.add(Magnet{.from = {bar, {1.0, 0.0}}, .to = dot, .strength = 2.0, .core = 0.5});
    EXPECT_THAT(system, carom::energy_test::conservative_loads_follow_the_potential(1e-8));
  }
}
// ... to here.

namespace {

using carom_test::text_of;

TEST(ElementsPage, ShowsWhatIsTestedHere) {
  const std::string source = text_of("tests/joints/own_element_test.cpp");
  const auto blocks = carom_test::code_blocks("docs/elements.md", "cpp");
  for (const std::string& block : blocks) EXPECT_NE(source.find(block), std::string::npos) << block;
  EXPECT_EQ(blocks.size(), 2u);
}

TEST(ElementsPage, NamesEveryElement) {
  const std::string page = text_of("docs/elements.md");
  for (const char* name :
       {"Gravity", "SpringDamper", "AppliedForce", "AppliedTorque", "Cable", "Bumper", "NonlinearSpring",
        "TorsionalSpring", "Bushing", "Drag", "FollowerLoad", "LinearActuator", "RotaryActuator"}) {
    EXPECT_NE(page.find("`" + std::string(name) + "`"), std::string::npos) << name;
  }
}

}  // namespace
