// Places where the loads of elements are not smooth: guards, breaks, dependence on time.

#include <carom/carom.h>

#include "tests/model_error.h"
#include <carom/testing/loaded_model.h>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

namespace {

using namespace carom;
using namespace carom::planar;
using carom::energy_test::LoadedModel;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

/// Guards of all elements of a model, kind by kind.
std::vector<double> guards_of(const System& system) {
  const LoadedModel model(system);
  std::vector<double> all;
  for (const auto& kind : model.assembly.force_kinds()) {
    std::vector<double> out(kind->size() * kind->guard_size(), nan);
    const EvaluationContext at{model.assembly, model.state.view(), model.evaluation, 0};
    kind->guards(at, {0, kind->size()}, out.data());
    all.insert(all.end(), out.begin(), out.end());
  }
  return all;
}

std::vector<double> breaks_of(const System& system, ElementId element) {
  const auto place = system.force_kinds().place(element.serial);
  std::vector<double> times;
  system.force_kinds().entries()[place.entry].kind->discontinuity_times(place.slot, times);
  return times;
}

bool asks_for_time(const System& system, ElementId element) {
  return system.force_kinds().kind_of(element.serial).depends_on_time();
}

/// Loads that depend on the side of x = 1 and y = 2, from t = 3 on.
struct Step {
  static constexpr Role role = Role::force;
  static constexpr int dimension = 2;
  static constexpr int guard_size = 2;
  BodyId body;
  std::vector<double> breaks{};

  std::vector<BodyId> bodies() const { return {body}; }
  void loads(const ElementView<2>& at, ElementLoads<2>& out) const {
    const Vec<2> x = at.position(body);
    if (at.time() >= 3.0) out.external(body, {x[0] > 1.0 ? 1.0 : 0.0, x[1] > 2.0 ? 1.0 : 0.0});
  }
  void guards(const ElementView<2>& at, double* out) const {
    const Vec<2> x = at.position(body);
    out[0] = x[0] - 1.0;
    out[1] = x[1] - 2.0;
  }
};

/// Says that it does not ask for the time.
struct Timeless {
  static constexpr Role role = Role::force;
  static constexpr int dimension = 2;
  static constexpr bool depends_on_time = false;
  BodyId body;

  std::vector<BodyId> bodies() const { return {body}; }
  void loads(const ElementView<2>& at, ElementLoads<2>& out) const {
    out.conservative(body, -at.position(body));
  }
  double potential(const ElementView<2>& at) const { return 0.5 * at.position(body).squaredNorm(); }
};

/// Says nothing.
struct Silent {
  static constexpr Role role = Role::force;
  static constexpr int dimension = 2;
  BodyId body;

  std::vector<BodyId> bodies() const { return {body}; }
  void loads(const ElementView<2>&, ElementLoads<2>&) const {}
};

TEST(Smoothness, OneSidedSpringsTellWhereTheyGoTaut) {
  System system;
  const BodyId a = system.add(Particle{.mass = 1.0, .position = {3.0, 4.0}});
  const BodyId b = system.add(RigidBody{.mass = disc(1.0, 1.0), .position = {0.0, 1.0}, .angle = 0.0});
  system.add(Cable{.from = ground, .to = a, .stiffness = 1.0, .free_length = 4.5});
  system.add(Cable{.from = {b, {0.0, -1.0}}, .to = a, .stiffness = 1.0, .free_length = 7.0});
  system.add(Bumper{.from = ground, .to = b, .stiffness = 1.0, .free_length = 1.25});
  // (l^2 - L^2)/(2 L) of the lengths 5, 5 and 1: exact in binary but for the quotients.
  EXPECT_EQ(guards_of(system), (std::vector<double>{4.75 / 9.0, -24.0 / 14.0, -0.5625 / 2.5}));
}

TEST(Smoothness, TheGuardOfACableChangesSignWhereItsLoadStarts) {
  for (const double x : {1.9, 2.0, 2.1}) {
    System system;
    const BodyId dot = system.add(Particle{.mass = 1.0, .position = {x, 0.0}});
    system.add(Cable{.from = ground, .to = dot, .stiffness = 1.0, .free_length = 2.0});
    EXPECT_EQ(guards_of(system)[0] > 0.0, LoadedModel(system).conservative[0] != 0.0) << x;
  }
}

TEST(Smoothness, OthersOfTheLibraryHaveNoGuards) {
  System system;
  const BodyId a = system.add(RigidBody{.mass = disc(1.0, 1.0), .position = {3.0, 4.0}});
  system.add(Gravity{{0.0, -9.81}});
  system.add(SpringDamper{.from = ground, .to = a, .stiffness = 1.0});
  system.add(Drag{.on = a, .linear = 1.0});
  system.add(AppliedForce{.on = a, .force = [](double) { return Vec<2>(1.0, 0.0); }});
  EXPECT_TRUE(guards_of(system).empty());
}

TEST(Smoothness, LawsOfTimeTellWhenTheyJump) {
  const std::vector<double> times{-1.0, 0.5, 2.0};
  System system;
  const BodyId a = system.add(RigidBody{.mass = disc(1.0, 1.0), .position = {3.0, 4.0}});
  const auto force = [](double t) { return Vec<2>(t < 0.5 ? 0.0 : 1.0, 0.0); };
  const auto law = [](double, double, double) { return 1.0; };
  const auto add_all = [&](const std::vector<double>& breaks, const auto& take) {
    take([&] { return system.add(AppliedForce{.on = a, .force = force, .breaks = breaks}); });
    take([&] {
      return system.add(AppliedTorque{.on = a, .torque = [](double) { return 1.0; }, .breaks = breaks});
    });
    take([&] { return system.add(FollowerLoad{.on = a, .force = force, .breaks = breaks}); });
    take([&] { return system.add(LinearActuator{.from = ground, .to = a, .force = law, .breaks = breaks}); });
    take(
        [&] { return system.add(RotaryActuator{.from = ground, .to = a, .torque = law, .breaks = breaks}); });
  };
  int count = 0;
  add_all(times, [&](const auto& add) {
    const ElementId element = add();
    EXPECT_EQ(breaks_of(system, element), times);
    EXPECT_TRUE(asks_for_time(system, element));
    ++count;
  });
  add_all({}, [&](const auto& add) { EXPECT_TRUE(breaks_of(system, add()).empty()); });
  EXPECT_EQ(count, 5);
  add_all({0.0, nan},
          [&](const auto& add) { EXPECT_MODEL_ERROR(add(), "#10", "breaks", "nan s", "finite"); });
  add_all({infinity},
          [&](const auto& add) { EXPECT_MODEL_ERROR(add(), "#10", "breaks", "inf s", "finite"); });
  add_all({1.0, 1.0},
          [&](const auto& add) { EXPECT_MODEL_ERROR(add(), "#10", "breaks", "1 s after 1 s", "ascending"); });
}

TEST(Smoothness, BreaksAreInTheFingerprint) {
  const auto print = [](const std::vector<double>& breaks) {
    System system;
    const BodyId a = system.add(Particle{.mass = 1.0});
    system.add(AppliedForce{.on = a, .force = [](double) { return Vec<2>(1.0, 0.0); }, .breaks = breaks});
    return system.fingerprint();
  };
  EXPECT_NE(print({}), print({1.0}));
  EXPECT_NE(print({1.0}), print({2.0}));
  EXPECT_EQ(print({1.0}), print({1.0}));
}

TEST(Smoothness, SpringsDoNotAskForTheTime) {
  System system;
  const BodyId a = system.add(RigidBody{.mass = disc(1.0, 1.0), .position = {3.0, 4.0}});
  const auto square = [](double l) { return l * l; };
  for (const ElementId element :
       {system.add(Gravity{{0.0, -9.81}}),
        system.add(SpringDamper{.from = ground, .to = a, .stiffness = 1.0}),
        system.add(Cable{.from = ground, .to = a, .stiffness = 1.0}),
        system.add(Bumper{.from = ground, .to = a, .stiffness = 1.0, .free_length = 1.0}),
        system.add(NonlinearSpring{.from = ground, .to = a, .force = square, .potential_of = square}),
        system.add(MaxwellElement{.from = ground, .to = a, .stiffness = 1.0, .damping = 1.0}),
        system.add(TorsionalSpring{.from = ground, .to = a, .stiffness = 1.0}),
        system.add(Bushing{.from = ground, .to = a}), system.add(Drag{.on = a, .linear = 1.0})}) {
    EXPECT_FALSE(asks_for_time(system, element)) << system.name(element);
  }
}

TEST(Smoothness, UsersElementsMayTell) {
  System system;
  const BodyId a = system.add(Particle{.mass = 1.0, .position = {3.0, -4.0}});
  const ElementId step = system.add(Step{.body = a, .breaks = {3.0}});
  EXPECT_EQ(guards_of(system), (std::vector<double>{2.0, -6.0}));
  EXPECT_EQ(breaks_of(system, step), std::vector<double>{3.0});
  EXPECT_TRUE(asks_for_time(system, step));
  EXPECT_MODEL_ERROR(system.add(Step{.body = a, .breaks = {2.0, 1.0}}), "force element #1", "breaks",
                     "1 s after 2 s");
  EXPECT_FALSE(asks_for_time(system, system.add(Timeless{.body = a})));
  const ElementId silent = system.add(Silent{.body = a});
  EXPECT_TRUE(asks_for_time(system, silent));
  EXPECT_TRUE(breaks_of(system, silent).empty());
  EXPECT_EQ(guards_of(system).size(), 2u);
}

}  // namespace
