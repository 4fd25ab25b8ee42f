// The page docs/elements.md: the elements it shows, and the test of one that it shows.

#include <carom/carom.h>
#include <carom/testing/loaded_model.h>
#include <carom/testing/matchers.h>

#include "tests/derivative_check.h"
#include "tests/page_blocks.h"
#include "tests/random.h"

#include <gtest/gtest.h>

#include <cmath>
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
// ... to here, and from here...
struct SmoothMagnet : Magnet {
  void derivatives(const ElementView<2>& at, ElementDerivatives<2>& out) const {
    const Vec<2> d = at.position(to) - at.position(from);
    const double square = d.squaredNorm() + core * core, pull = strength * std::pow(square, -1.5);
    const Mat<2> by_distance = 3.0 * pull / square * d * d.transpose() - pull * Mat<2>::Identity();
    out.opposite_forces(from, to, -pull * d, by_distance, Mat<2>::Zero());
  }
};
// ... to here, and from here...
struct Fan {  // blows upward where a particle is nearer than `reach` to the ground, y = 0
  static constexpr Role role = Role::force;
  static constexpr int dimension = 2;
  static constexpr int guard_size = 1;
  static constexpr bool depends_on_time = false;
  BodyId body;
  double force = 0.0, reach = 0.0;  // [N], [m]

  std::vector<BodyId> bodies() const { return {body}; }
  double height(const ElementView<2>& at) const { return at.position(body)[1]; }
  void loads(const ElementView<2>& at, ElementLoads<2>& out) const {
    if (height(at) < reach) out.external(body, {0.0, force});
  }
  void guards(const ElementView<2>& at, double* out) const { out[0] = height(at) - reach; }
  void guard_motion(const ElementMotion<2>& at, GuardMotion* out) const {
    out[0] = {.value = height(at) - reach, .first = at.velocity(body)[1], .second = at.acceleration(body)[1]};
  }
};
// ... to here.

namespace {

using carom_test::text_of;

TEST(SmoothMagnet, DerivativesMeetDifferences) {
  carom_test::Random random(2);
  for (int repeat = 0; repeat < 20; ++repeat) {
    System system;
    const BodyId bar = system.add(
        RigidBody{.mass = rod(1.0, 2.0), .angle = random.uniform(-3, 3), .spin = random.uniform(-3, 3)});
    const BodyId dot = system.add(Particle{.mass = 1.0, .position = random.vec<2>(3.0)});
    SmoothMagnet magnet;
    magnet.from = {bar, {1.0, 0.0}};
    magnet.to = dot;
    magnet.strength = 2.0;
    magnet.core = 0.5;
    system.add(magnet);
    carom_test::expect_derivatives_meet_differences(carom::energy_test::LoadedModel(system));
  }
}

// A particle falls through the fan's reach: y = 1 - g t^2/2 until it is there.
TEST(Fan, StartsToBlowWhereItsGuardChangesSign) {
  constexpr double gravity = 9.81, reach = 0.4;
  System system;
  system.add(Gravity{{0.0, -gravity}});
  const BodyId dot = system.add(Particle{.mass = 1.0, .position = {0.0, 1.0}});
  const ElementId fan = system.add(Fan{.body = dot, .force = 100.0, .reach = reach});
  Simulation simulation(system, EventDriven{});
  simulation.run_until(1.0);
  ASSERT_GE(simulation.events().size(), 2U);  // in, and thrown out again
  for (const EventRecord& event : simulation.events()) EXPECT_EQ(event.element, fan);
  // Phases are parabolas: the time is known to rounding of its square.
  const double in = std::sqrt(2.0 * (1.0 - reach) / gravity);
  EXPECT_NEAR(simulation.events()[0].time, in, 1e-12);
  EXPECT_NEAR(simulation.events()[1].time, in + 2.0 * gravity * in / (100.0 - gravity), 1e-12);
}

TEST(ElementsPage, ShowsWhatIsTestedHere) {
  const std::string source = text_of("tests/joints/own_element_test.cpp");
  const auto blocks = carom_test::code_blocks("docs/elements.md", "cpp");
  for (const std::string& block : blocks) EXPECT_NE(source.find(block), std::string::npos) << block;
  EXPECT_EQ(blocks.size(), 4u);
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
