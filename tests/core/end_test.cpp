#include <carom/bodies/particle.h>
#include <carom/bodies/rigid_body.h>
#include <carom/core/end.h>
#include <carom/core/system.h>

#include "tests/model_error.h"
#include "tests/random.h"
#include <carom/testing/loaded_model.h>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

namespace {

using namespace carom;
using namespace carom::planar;
using carom::energy_test::LoadedModel;

constexpr double epsilon = std::numeric_limits<double>::epsilon();
constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

class EndTest : public testing::Test {
protected:
  System system;
  BodyId dot = system.add(Particle{.mass = 1.0, .position = {5, 6}, .velocity = {7, 8}}, "dot");
  BodyId plate = system.add(RigidBody{.mass = disc(1.0, 1.0),
                                      .position = {1, 2},
                                      .angle = std::acos(0.0),
                                      .velocity = {3, 4},
                                      .spin = 2.0},
                            "plate");
};

TEST_F(EndTest, IsCheckedByName) {
  const PartCheck check("part", system);
  EXPECT_NO_THROW(check_end<2>(check, dot, "from"));
  EXPECT_NO_THROW(check_end<2>(check, {plate, {1, 2}}, "from"));
  EXPECT_NO_THROW(check_end<2>(check, ground, "from"));
  EXPECT_NO_THROW(check_end<2>(check, {ground, {1, 2}}, "from"));
  EXPECT_MODEL_ERROR(check_end<2>(check, {}, "from"), "part", "from is not given", "a body of this system");
  EXPECT_MODEL_ERROR(check_end<2>(check, {dot, {0, 1}}, "from"), "part",
                     "from, off the centre, is particle 'dot'", "a rigid body");
  for (const double bad : {nan, infinity, -infinity}) {
    for (const BodyId body : {plate, ground, dot}) {
      EXPECT_MODEL_ERROR(check_end<2>(check, {body, {bad, 0}}, "to"), "to.point is " + to_text(bad) + " m");
      EXPECT_MODEL_ERROR(check_end<2>(check, {body, {0, bad}}, "to"), "to.point is " + to_text(bad) + " m");
    }
  }
  System flying;
  const BodyId body = flying.add(spatial::Particle{.mass = 1.0}, "fly");
  const PartCheck spatial_check("part", flying);
  EXPECT_NO_THROW(check_end<3>(spatial_check, body, "from"));
  EXPECT_MODEL_ERROR(check_end<3>(spatial_check, {body, {0, 0, 1}}, "from"), "from, off the centre,",
                     "'fly'");
}

TEST_F(EndTest, AtACentreIsTheBody) {
  const LoadedModel model(system);
  const Attachment<2> at(dot, *model.assembly.layout());
  const Vec<2> lever = at.lever(model.evaluation);
  EXPECT_EQ(lever, Vec<2>(0, 0));
  EXPECT_EQ(at.position(model.state.view(), lever), Vec<2>(5, 6));
  EXPECT_EQ(at.velocity(model.state.view(), lever), Vec<2>(7, 8));
}

TEST_F(EndTest, OnTheGroundStandsStill) {
  const LoadedModel model(system);
  const Attachment<2> at({ground, {-3, 4}}, *model.assembly.layout());
  const Vec<2> lever = at.lever(model.evaluation);
  EXPECT_EQ(at.position(model.state.view(), lever), Vec<2>(-3, 4));
  EXPECT_EQ(at.velocity(model.state.view(), lever), Vec<2>(0, 0));
  std::vector<double> load(5, 0.0);
  at.add_force(load.data(), lever, {1, 1});
  EXPECT_EQ(load, std::vector<double>(5, 0.0));
}

TEST_F(EndTest, OffTheCentreTurnsWithTheBody) {
  const LoadedModel model(system);
  const Attachment<2> at({plate, {1, 0}}, *model.assembly.layout());  // the plate is turned by 90 degrees
  const Vec<2> lever = at.lever(model.evaluation);
  EXPECT_LE((lever - Vec<2>(0, 1)).norm(), 2 * epsilon);
  EXPECT_LE((at.position(model.state.view(), lever) - Vec<2>(1, 3)).norm(), 4 * epsilon);
  EXPECT_LE((at.velocity(model.state.view(), lever) - Vec<2>(1, 4)).norm(), 8 * epsilon);
  std::vector<double> load(5, 0.0);
  at.add_force(load.data(), lever, {10, 20});
  const Index v = model.assembly.layout()->slot(plate).v;
  EXPECT_EQ(load[v], 10.0);
  EXPECT_EQ(load[v + 1], 20.0);
  EXPECT_NEAR(load[v + 2], -10.0, 64 * epsilon);
}

TEST_F(EndTest, VelocityIsTheRateOfThePosition) {
  carom_test::Random random(81);
  LoadedModel model(system);
  const Index q = model.assembly.layout()->slot(plate).q;
  for (int repeat = 0; repeat < 50; ++repeat) {
    const Attachment<2> at({plate, random.vec<2>(2.0)}, *model.assembly.layout());
    for (double& x : model.state.q) x = random.uniform(-3.0, 3.0);
    for (double& x : model.state.v) x = random.uniform(-3.0, 3.0);
    model.update();
    const Vec<2> velocity = at.velocity(model.state.view(), at.lever(model.evaluation));
    const std::vector<double> q0 = model.state.q;
    const auto position_after = [&](double time) {
      for (Index i = 0; i < 3; ++i) model.state.q[q + i] = q0[q + i] + time * model.state.v[q + i];
      model.update();
      return at.position(model.state.view(), at.lever(model.evaluation));
    };
    const double step = 1e-5;
    const Vec<2> rate = (position_after(step) - position_after(-step)) / (2.0 * step);
    // Truncation step^2 spin^3 |r| / 6 = 1.3e-9, rounding epsilon |x| / step = 1e-10.
    EXPECT_LE((rate - velocity).norm(), 3e-9);
  }
}

TEST_F(EndTest, ForceAndVelocityAreAdjoint) {
  carom_test::Random random(82);
  LoadedModel model(system);
  for (int repeat = 0; repeat < 50; ++repeat) {
    for (double& x : model.state.q) x = random.uniform(-3.0, 3.0);
    for (double& x : model.state.v) x = random.uniform(-3.0, 3.0);
    model.update();
    for (const End<2>& end : {End<2>(dot), End<2>(plate), End<2>(plate, random.vec<2>(2.0))}) {
      const Attachment<2> at(end, *model.assembly.layout());
      const Vec<2> lever = at.lever(model.evaluation), force = random.vec<2>(5.0);
      std::vector<double> load(model.state.v.size(), 0.0);
      at.add_force(load.data(), lever, force);
      EXPECT_NEAR(model.power(load), force.dot(at.velocity(model.state.view(), lever)), 200 * epsilon);
    }
  }
}

TEST_F(EndTest, FingerprintSeesBodyAndPoint) {
  const auto print_of = [](const End<2>& end) {
    Fingerprint print;
    add_to(print, end);
    return print.value();
  };
  EXPECT_EQ(print_of({plate, {1, 2}}), print_of({plate, {1, 2}}));
  EXPECT_NE(print_of({plate, {1, 2}}), print_of({plate, {2, 1}}));
  EXPECT_NE(print_of(plate), print_of(dot));
}

}  // namespace
