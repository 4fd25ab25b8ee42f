// The page docs/elements.md: the element it shows, and the test of it that it shows.

#include <carom/carom.h>

#include "tests/loaded_model.h"
#include "tests/random.h"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
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
    carom_test::LoadedModel model(system);
    const std::vector<double> expected = model.minus_gradient();
    for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_NEAR(model.conservative[i], expected[i], 1e-8);
  }
}
// ... to here.

namespace {

std::string text_of(const std::string& file) {
  std::ifstream in(std::string(CAROM_SOURCE_DIR) + "/" + file);
  return {std::istreambuf_iterator<char>(in), {}};
}

TEST(ElementsPage, ShowsWhatIsTestedHere) {
  const std::string page = text_of("docs/elements.md");
  const std::string source = text_of("tests/joints/own_element_test.cpp");
  const std::string fence = "```cpp\n";
  int blocks = 0;
  for (std::size_t at = page.find(fence); at != std::string::npos; at = page.find(fence, at)) {
    at += fence.size();
    const std::size_t end = page.find("```", at);
    ASSERT_NE(end, std::string::npos);
    const std::string block = page.substr(at, end - at);
    EXPECT_NE(source.find(block), std::string::npos) << block;
    ++blocks;
    at = end + 3;
  }
  EXPECT_EQ(blocks, 2);
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
