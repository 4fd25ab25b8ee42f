#include <carom/bodies/particle.h>
#include <carom/bodies/rigid_body.h>
#include <carom/core/force_element.h>

#include "tests/model_error.h"
#include "tests/random.h"
#include <carom/testing/loaded_model.h>

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <string_view>
#include <vector>

namespace {

using namespace carom;
using namespace carom::planar;
using carom::energy_test::LoadedModel;

constexpr double epsilon = std::numeric_limits<double>::epsilon();

// A hardening coupling of a point on a rigid body to a particle, with all a user's element may have: force
// -(k + h |d|^2) d, drag, a drive.
struct Coupling {
  static constexpr Role role = Role::force;
  static constexpr int dimension = 2;
  static constexpr std::string_view label = "magnet";
  End<2> from{};
  BodyId to{};
  double stiffness = 1.0;
  double hardening = 0.0;
  double potential_factor = 1.0;  // anything but 1 is a wrong potential

  std::vector<BodyId> bodies() const { return {from.body, to}; }
  Vec<2> distance(const ElementView<2>& at) const { return at.position(to) - at.position(from); }
  void loads(const ElementView<2>& at, ElementLoads<2>& out) const {
    const Vec<2> d = distance(at);
    const Vec<2> pull = (stiffness + hardening * d.squaredNorm()) * d;
    out.conservative(from, pull);
    out.conservative(to, -pull);
    const Vec<2> drag = 0.3 * (at.velocity(to) - at.velocity(from));
    out.dissipative(from, drag);
    out.dissipative(to, -drag);
    out.external(to, {at.time(), 0.0});
  }
  double potential(const ElementView<2>& at) const {
    const double square = distance(at).squaredNorm();
    return potential_factor * (0.5 * stiffness * square + 0.25 * hardening * square * square);
  }
  void check(const PartCheck& check) const {
    check_end(check, from, "from");
    check.positive(stiffness, "stiffness", "N/m");
  }
  void fingerprint(Fingerprint& print) const { print.add(stiffness); }
};

// The least that an element needs.
struct Push {
  static constexpr Role role = Role::force;
  static constexpr int dimension = 2;
  std::vector<BodyId> on{};
  End<2> at{};  // what it pushes, among `on` if it is honest

  std::vector<BodyId> bodies() const { return on; }
  void loads(const ElementView<2>&, ElementLoads<2>& out) const { out.external(at, {1.0, 2.0}); }
};

static_assert(Part<Coupling> && Part<Push>);

struct Scene {
  System system;
  BodyId plate = system.add(
      RigidBody{
          .mass = disc(1.0, 1.0), .position = {1, 2}, .angle = 0.4, .velocity = {0.1, 0.2}, .spin = 0.5},
      "plate");
  BodyId dot = system.add(Particle{.mass = 2.0, .position = {3, -1}, .velocity = {-1, 1}}, "dot");
};

void expect_loads_near(const std::vector<double>& found, const std::vector<double>& expected,
                       double tolerance) {
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t i = 0; i < found.size(); ++i)
    EXPECT_NEAR(found[i], expected[i], tolerance) << "load " << i;
}

TEST(ForceElement, BooksItsLoadsByCause) {
  Scene scene;
  scene.system.add(Coupling{.from = scene.plate, .to = scene.dot, .stiffness = 2.0});
  LoadedModel model(scene.system);
  model.state.time = 7.0;
  model.update();
  // d = (2, -3), relative velocity (-1.1, 0.8); the plate comes first.
  expect_loads_near(model.conservative, {4, -6, 0, -4, 6}, 16 * epsilon);
  expect_loads_near(model.dissipative, {-0.33, 0.24, 0, 0.33, -0.24}, 16 * epsilon);
  expect_loads_near(model.external, {0, 0, 0, 7, 0}, 0.0);
  EXPECT_NEAR(model.energies()[StoredEnergy::potential], 0.5 * 2.0 * 13.0, 64 * epsilon);
}

TEST(ForceElement, ConservativePartIsMinusTheGradientOfItsPotential) {
  carom_test::Random random(91);
  for (int repeat = 0; repeat < 50; ++repeat) {
    Scene scene;
    scene.system.add(Coupling{.from = {scene.plate, random.vec<2>()},
                              .to = scene.dot,
                              .stiffness = random.uniform(0.1, 2.0),
                              .hardening = random.uniform(0.0, 1.0)});
    LoadedModel model(scene.system);
    expect_loads_near(model.minus_gradient(), model.conservative, 1e-9);  // forces are below 200 N
  }
}

TEST(ForceElement, AWrongPotentialIsDetected) {
  Scene scene;
  scene.system.add(Coupling{.from = scene.plate, .to = scene.dot, .potential_factor = 1.0 + 1e-6});
  LoadedModel model(scene.system);
  const std::vector<double> gradient = model.minus_gradient();
  double largest = 0.0;
  for (std::size_t i = 0; i < gradient.size(); ++i) {
    largest = std::max(largest, std::abs(gradient[i] - model.conservative[i]));
  }
  EXPECT_GT(largest, 1e-6);  // a millionth of 3 N, a thousand times the tolerance above
}

TEST(ForceElement, ActionIsReactionAndDragTakesEnergyOut) {
  carom_test::Random random(92);
  for (int repeat = 0; repeat < 50; ++repeat) {
    Scene scene;
    scene.system.add(Coupling{.from = {scene.plate, random.vec<2>()}, .to = scene.dot, .hardening = 1.0});
    LoadedModel model(scene.system);
    for (double& x : model.state.q) x = random.uniform(-2.0, 2.0);
    for (double& x : model.state.v) x = random.uniform(-2.0, 2.0);
    model.update();
    // The conservative pair is central; the drag is a pair of opposite forces off their line.
    for (const double sum : model.resultant(model.conservative)) EXPECT_NEAR(sum, 0.0, 1e3 * epsilon * 100.0);
    EXPECT_NEAR(model.resultant(model.dissipative)[0], 0.0, 16 * epsilon);
    EXPECT_NEAR(model.resultant(model.dissipative)[1], 0.0, 16 * epsilon);
    EXPECT_LE(model.power(model.dissipative), 0.0);
  }
}

TEST(ForceElement, TheLeastElementHasNoPotential) {
  Scene scene;
  scene.system.add(Push{.on = {scene.plate}, .at = {scene.plate, {0, 1}}});
  LoadedModel model(scene.system);
  EXPECT_EQ(model.energies().potential(), 0.0);
  EXPECT_EQ(model.external[0], 1.0);
  EXPECT_EQ(model.external[1], 2.0);
  // Lever (-sin 0.4, cos 0.4) x (1, 2).
  EXPECT_NEAR(model.external[2], -2.0 * std::sin(0.4) - std::cos(0.4), 8 * epsilon);
  EXPECT_EQ(scene.system.name(scene.system.elements()[0]), "force element #0");
}

// Three bodies pulled to their common centre.
struct Cluster {
  static constexpr Role role = Role::force;
  static constexpr int dimension = 2;
  std::array<BodyId, 3> on{};
  std::vector<BodyId> bodies() const { return {on.begin(), on.end()}; }
  void loads(const ElementView<2>& at, ElementLoads<2>& out) const {
    const Vec<2> centre = (at.position(on[0]) + at.position(on[1]) + at.position(on[2])) / 3.0;
    for (const BodyId body : on) out.conservative(body, centre - at.position(body));
  }
};

TEST(ForceElement, JoinsAllItsBodiesToOneComponent) {
  System system;
  std::vector<BodyId> dots;
  for (int i = 0; i < 4; ++i) dots.push_back(system.add(Particle{.mass = 1.0, .position = {i, i * i}}));
  system.add(Cluster{.on = {dots[3], dots[0], dots[2]}});
  const LoadedModel model(system);
  ASSERT_EQ(model.assembly.components().size(), 2U);
  EXPECT_EQ(model.assembly.components()[0].bodies.size(), 3U);
  for (const double sum : model.resultant(model.conservative)) EXPECT_NEAR(sum, 0.0, 64 * epsilon);
}

TEST(ForceElement, ImpossibleOnesAreRefusedByName) {
  Scene scene;
  System& system = scene.system;
  EXPECT_MODEL_ERROR(system.add(Push{}), "force element #0", "number of bodies is 0", "at least one");
  EXPECT_MODEL_ERROR(system.add(Push{.on = {ground, ground}}), "force element #0", "body is ground",
                     "at least one body of this system");
  EXPECT_MODEL_ERROR(system.add(Push{.on = {scene.dot, BodyId{}}}), "force element #0", "body is not given");
  EXPECT_MODEL_ERROR(system.add(Coupling{.from = scene.plate, .to = scene.dot, .stiffness = -1.0}, "north"),
                     "magnet 'north'", "stiffness is -1 N/m", "finite and > 0");
  EXPECT_MODEL_ERROR(system.add(Coupling{.from = {scene.dot, {1, 0}}, .to = scene.plate}), "magnet #0",
                     "from, off the centre, is particle 'dot'", "a rigid body");
  System other;
  const BodyId foreign = other.add(Particle{.mass = 1.0});
  EXPECT_MODEL_ERROR(system.add(Coupling{.from = scene.plate, .to = foreign}), "magnet #0",
                     "body is a body of another system");
  EXPECT_TRUE(system.elements().empty());
}

TEST(ForceElement, PushesOnlyWhatItNames) {
  Scene scene;
  scene.system.add(Push{.on = {scene.dot}, .at = scene.plate});
  EXPECT_MODEL_ERROR(LoadedModel(scene.system), "rigid body 'plate'", "does not name", "bodies()");
}

TEST(ForceElement, AParticleHasNoPointOffItsCentreAndNoAngle) {
  Scene scene;
  scene.system.add(Push{.on = {scene.dot}, .at = {scene.dot, {0, 1}}});
  EXPECT_MODEL_ERROR(LoadedModel(scene.system), "particle 'dot'", "has no orientation", "a rigid body");

  Scene free;
  const LoadedModel model(free.system);
  const EvaluationContext context{model.assembly, model.state.view(), model.evaluation, 1};
  const ElementView<2> view(context);
  EXPECT_MODEL_ERROR(view.angle(free.dot), "particle 'dot'", "has no orientation");
  EXPECT_MODEL_ERROR(view.spin(free.dot), "particle 'dot'", "has no orientation");
  EXPECT_MODEL_ERROR(view.spin(ground), "ground");
  ElementLoads<2> loads(view, {});
  EXPECT_MODEL_ERROR(loads.external_torque(free.dot, 1.0), "particle 'dot'", "has no orientation");
}

TEST(ForceElement, ViewShowsAnglesAndSpins) {
  Scene scene;
  const LoadedModel model(scene.system);
  const EvaluationContext context{model.assembly, model.state.view(), model.evaluation, 0};
  const ElementView<2> view(context);
  EXPECT_EQ(view.angle(scene.plate), 0.4);
  EXPECT_EQ(view.spin(scene.plate), 0.5);
  EXPECT_EQ(view.position(scene.plate), Vec<2>(1, 2));
  EXPECT_EQ(view.position({ground, {8, 9}}), Vec<2>(8, 9));
}

TEST(ForceElement, FingerprintSeesItsBodiesAndWhatItReports) {
  const auto print_of = [](double stiffness, bool swapped) {
    System system;
    const BodyId a = system.add(Particle{.mass = 1.0}), b = system.add(Particle{.mass = 1.0});
    system.add(Coupling{.from = swapped ? b : a, .to = swapped ? a : b, .stiffness = stiffness});
    return system.fingerprint();
  };
  EXPECT_EQ(print_of(1.0, false), print_of(1.0, false));
  EXPECT_NE(print_of(1.0, false), print_of(2.0, false));
  EXPECT_NE(print_of(1.0, false), print_of(1.0, true));

  const auto groups = [](std::size_t first) {  // three bodies, split differently over two elements
    System system;
    std::vector<BodyId> all;
    for (int i = 0; i < 3; ++i) all.push_back(system.add(Particle{.mass = 1.0}));
    const auto at = all.begin() + static_cast<std::ptrdiff_t>(first);
    system.add(Push{.on = {all.begin(), at}, .at = all[0]});
    system.add(Push{.on = {at, all.end()}, .at = all[2]});
    return system.fingerprint();
  };
  EXPECT_NE(groups(1), groups(2));
}

}  // namespace
