#include <carom/bodies/particle.h>
#include <carom/bodies/rigid_body.h>
#include <carom/core/assembly.h>
#include <carom/joints/gravity.h>

#include "tests/model_error.h"
#include "tests/random.h"
#include <carom/testing/loaded_model.h>

#include <gtest/gtest.h>

#include <array>
#include <limits>
#include <vector>

namespace {

using namespace carom;
using carom::energy_test::LoadedModel;

constexpr double epsilon = std::numeric_limits<double>::epsilon();
constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

TEST(Gravity, PullsAtEveryBodyAndTurnsNone) {
  using namespace planar;
  System system;
  system.add(Gravity{{1.0, -10.0}});
  system.add(Particle{.mass = 2.0});
  system.add(RigidBody{.mass = disc(3.0, 1.0), .angle = 1.0, .spin = 4.0});
  const LoadedModel model(system);
  EXPECT_EQ(model.conservative, (std::vector<double>{2, -20, 3, -30, 0}));
  EXPECT_EQ(model.dissipative, std::vector<double>(5, 0.0));
  EXPECT_EQ(model.external, std::vector<double>(5, 0.0));
}

TEST(Gravity, PotentialIsZeroAtTheOriginAndRisesWithHeight) {
  using namespace planar;
  System system;
  system.add(Gravity{{0.0, -10.0}});
  const BodyId body = system.add(Particle{.mass = 2.0});
  LoadedModel model(system);
  EXPECT_EQ(model.energies()[StoredEnergy::gravity], 0.0);
  model.state.position(body) << 5, 3;
  EXPECT_EQ(model.energies()[StoredEnergy::gravity], 60.0);
  EXPECT_EQ(model.energies()[StoredEnergy::potential], 0.0) << "gravity has a line of its own";
}

TEST(Gravity, FieldsAddUp) {
  using namespace spatial;
  System system;
  system.add(Particle{.mass = 2.0, .position = {1, 1, 1}});
  system.add(Gravity{{1, 2, 3}});
  const ElementId second = system.add(Gravity{{10, 20, 30}});
  LoadedModel both(system);
  EXPECT_EQ(both.conservative, (std::vector<double>{22, 44, 66}));
  EXPECT_EQ(both.energies().potential(), -132.0);
  system.remove(second);
  EXPECT_EQ(LoadedModel(system).conservative, (std::vector<double>{2, 4, 6}));
}

TEST(Gravity, ForceIsMinusTheGradientOfThePotential) {
  using namespace planar;
  carom_test::Random random(111);
  System system;
  system.add(Gravity{random.vec<2>(10.0)});
  for (int i = 0; i < 3; ++i) {
    system.add(Particle{.mass = random.uniform(0.1, 2.0), .position = random.vec<2>(3.0)});
    system.add(
        RigidBody{.mass = disc(random.uniform(0.1, 2.0), 1.0), .position = random.vec<2>(3.0), .angle = 2.0});
  }
  LoadedModel model(system);
  const std::vector<double> expected = model.minus_gradient();
  // The potential is linear, rounding of about 100 J over a step of 1e-3 remains.
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_NEAR(model.conservative[i], expected[i], 8 * epsilon * 100.0 / 1e-3);
  }
}

TEST(Gravity, DerivativesAreNone) {
  using namespace planar;
  System system;
  system.add(Gravity{{0.0, -1.0}});
  system.add(Particle{.mass = 1.0});
  const LoadedModel model(system);
  const EvaluationContext at{model.assembly, model.state.view(), model.evaluation, 0};
  std::vector<LoadDerivative> out;
  EXPECT_TRUE(model.assembly.force_kinds()[0]->has_derivatives());
  model.assembly.force_kinds()[0]->derivatives(at, 0, out);
  EXPECT_TRUE(out.empty());
}

TEST(Gravity, ImpossibleAccelerationsAreRefusedByName) {
  System plane, space;
  EXPECT_MODEL_ERROR(plane.add(planar::Gravity{}), "gravity #0", "acceleration is nan m/s^2", "finite");
  for (const double bad : {nan, infinity, -infinity}) {
    for (int i = 0; i < 2; ++i) {
      planar::Gravity gravity{{0.0, 0.0}};
      gravity.acceleration[i] = bad;
      EXPECT_MODEL_ERROR(plane.add(gravity, "moon"), "gravity 'moon'",
                         "acceleration is " + to_text(bad) + " m/s^2");
    }
    for (int i = 0; i < 3; ++i) {
      spatial::Gravity gravity{{0.0, 0.0, 0.0}};
      gravity.acceleration[i] = bad;
      EXPECT_MODEL_ERROR(space.add(gravity), "gravity #0", "acceleration is " + to_text(bad) + " m/s^2");
    }
  }
}

}  // namespace
