#include <carom/joints/bushing.h>
#include <carom/testing/loaded_model.h>

#include "tests/joints/element_pairs.h"
#include "tests/model_error.h"

#include <numbers>

namespace {

using namespace carom;
using namespace carom::planar;
using namespace carom_test;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

// Of full rank or less, with couplings of every pair of directions.
Mat<3> random_stiffness(Random& random, int rank = 3) {
  Mat<3> sum = Mat<3>::Zero();
  for (int i = 0; i < rank; ++i) {
    const Vec<3> a = random.vec<3>();
    sum += a * a.transpose();
  }
  return sum;
}

TEST(Bushing, ClosedFormInTheFrameOfFrom) {
  // `from` stands turned by a right angle: its x axis is up. The point of `to` is 2 to the right of that of
  // `from`: d = (0, -2, 0.5 - pi/2).
  System system;
  constexpr double right = 0.5 * std::numbers::pi;
  const BodyId a = system.add(RigidBody{.mass = disc(1.0, 1.0), .position = {1, 0}, .angle = right});
  const BodyId b =
      system.add(RigidBody{.mass = disc(1.0, 1.0), .position = {3, 1}, .angle = 0.5, .velocity = {3, 0}});
  Mat<3> stiffness, damping = Mat<3>::Zero();
  stiffness << 5, 0, 0, 0, 7, 0, 0, 0, 2;
  damping(1, 1) = 4.0;
  system.add(Bushing{.from = {a, {1, 0}}, .to = b, .stiffness = stiffness, .damping = damping});
  LoadedModel model(system);
  const double torque = 2.0 * (0.5 - right);
  // 14 N draw the ends together, along the level y = 1: lever -1 about the centre of `from`.
  expect_near(model.conservative, {14, 0, torque - 14, -14, 0, -torque}, 1e-13);
  expect_near(model.dissipative, {12, 0, -12, -12, 0, 0}, 1e-13);
  EXPECT_NEAR(model.energies()[StoredEnergy::elastic], 14.0 + std::pow(0.5 - right, 2), 1e-13);
}

TEST(Bushing, ObeysTheLawsOfElements) {
  Random random(231);
  for (int repeat = 0; repeat < 60; ++repeat) {
    const Bodies bodies(random);
    const std::pair<End<2>, End<2>> pairs[] = {
        {{bodies.plates[0], random.vec<2>()}, {bodies.plates[1], random.vec<2>()}},
        {bodies.plates[0], bodies.plates[1]},
        {{ground, random.vec<2>()}, {bodies.plates[1], random.vec<2>()}},
        {{bodies.plates[0], random.vec<2>()}, {ground, random.vec<2>()}}};
    for (const auto& [from, to] : pairs) {
      System system = bodies.system;
      system.add(Bushing{.from = from,
                         .to = to,
                         .stiffness = random_stiffness(random),
                         .damping = random_stiffness(random),
                         .rest = random.vec<3>()});
      LoadedModel model(system);
      expect_near(model.conservative, model.minus_gradient(), 1e-8);  // loads are below 300 N
      EXPECT_LT(model.power(model.dissipative), 0.0);
      if (from.body != ground && to.body != ground) expect_action_is_reaction(model);
    }
  }
}

TEST(Bushing, ItsDashpotFeelsNoMotionAsOneBody) {
  // Both bodies turn about the origin as one: no rate of d, no load.
  Random random(232);
  System system;
  const double spin = 1.7;
  const auto plate = [&](const Vec<2>& x) {
    return system.add(RigidBody{.mass = disc(1.0, 1.0),
                                .position = x,
                                .angle = random.uniform(-3, 3),
                                .velocity = {-spin * x[1], spin * x[0]},
                                .spin = spin});
  };
  const BodyId a = plate({1, 2}), b = plate({-2, 0.5});
  system.add(Bushing{.from = {a, {0.4, 0.1}}, .to = {b, {0.2, -0.3}}, .damping = Mat<3>::Identity()});
  EXPECT_LE(largest(LoadedModel(system).dissipative), 1e-14);
}

TEST(Bushing, ADampedOscillatorInEachDirectionWithOrderTwo) {
  // On the ground and at a centre of mass the directions are apart: m x'' = -k x - c x'.
  System system;
  const BodyId plate = system.add(RigidBody{
      .mass = disc(2.0, 1.0), .position = {0.3, -0.2}, .angle = 0.4, .velocity = {1, 0}, .spin = -0.5});
  const Vec<3> k(40.0, 90.0, 25.0), c(0.4, 0.8, 0.3), mass(2.0, 2.0, 1.0);
  system.add(Bushing{.from = ground, .to = plate, .stiffness = k.asDiagonal(), .damping = c.asDiagonal()});
  const auto error = [&](const Simulation& now) {
    const double start[] = {0.3, -0.2, 0.4}, rate[] = {1.0, 0.0, -0.5};
    double sum = 0.0;
    for (int i = 0; i < 3; ++i) {
      const double decay = 0.5 * c[i] / mass[i], w = std::sqrt(k[i] / mass[i] - decay * decay);
      const double t = now.time();
      const double exact = std::exp(-decay * t) *
                           (start[i] * std::cos(w * t) + (rate[i] + decay * start[i]) / w * std::sin(w * t));
      sum += std::abs(now.state().q[static_cast<std::size_t>(i)] - exact);
    }
    return sum;
  };
  EXPECT_NEAR(measured_order(system, 2.0, 1e-2, error), 2.0, 0.05);
  Simulation simulation(system, TimeStepping{.step = 1e-3});
  simulation.run_until(2.0);
  EXPECT_LE(error(simulation), 1e-4);
}

TEST(Bushing, RunsCloseTheirAccount) {
  Random random(233);
  const Bodies bodies(random);
  System system = bodies.system;
  system.add(Bushing{.from = {bodies.plates[0], {0.5, 0.2}},
                     .to = {bodies.plates[1], {-0.4, 0.3}},
                     .stiffness = 20.0 * random_stiffness(random),
                     .damping = random_stiffness(random)});
  expect_ledger_closes(system, 3.0);
}

TEST(Bushing, MatricesThatCannotBeAreRefusedByName) {
  System system;
  const BodyId dot = system.add(Particle{.mass = 1.0}, "dot");
  const BodyId plate = system.add(RigidBody{.mass = disc(1.0, 1.0)}, "plate");
  const auto with = [&](int i, int j, double value) {
    Mat<3> matrix = Mat<3>::Identity();
    matrix(i, j) = matrix(j, i) = value;
    return matrix;
  };
  const auto spring = [&](const Mat<3>& k) { return Bushing{.from = ground, .to = plate, .stiffness = k}; };
  const auto dashpot = [&](const Mat<3>& c) { return Bushing{.from = ground, .to = plate, .damping = c}; };
  EXPECT_MODEL_ERROR(system.add(Bushing{.to = plate}), "bushing #0", "from is not given");
  EXPECT_MODEL_ERROR(system.add(Bushing{.from = ground, .to = dot}), "bushing #0", "to is particle 'dot'");
  EXPECT_MODEL_ERROR(system.add(Bushing{.from = plate, .to = plate}), "bushing #0", "as from");
  EXPECT_MODEL_ERROR(system.add(spring(with(1, 1, -3)), "mount"), "bushing 'mount'",
                     "stiffness(1, 1) is -3; allowed: finite and >= 0");
  EXPECT_MODEL_ERROR(system.add(spring(with(0, 2, nan))), "bushing #0", "stiffness(0, 2) is nan");
  EXPECT_MODEL_ERROR(system.add(dashpot(with(2, 2, -1))), "bushing #0", "damping(2, 2) is -1");
  Mat<3> skew = Mat<3>::Identity();
  skew(1, 0) = 0.5;
  EXPECT_MODEL_ERROR(system.add(spring(skew)), "stiffness(1, 0) is 0.5", "stiffness(0, 1), 0: a symmetric");
  EXPECT_MODEL_ERROR(system.add(spring(with(2, 0, 1.5))), "stiffness(2, 0) is 1.5", "at most 1 in size",
                     "negative eigenvalue");
  Mat<3> flat = with(2, 0, 0.1);
  flat(0, 0) = 0.0;  // a coupling without a stiffness of its own
  EXPECT_MODEL_ERROR(system.add(spring(flat)), "stiffness(2, 0) is 0.1", "at most 0 in size");
  Mat<3> indefinite;  // every pair is possible, the three together are not
  indefinite << 1, -0.9, -0.9, -0.9, 1, -0.9, -0.9, -0.9, 1;
  EXPECT_MODEL_ERROR(system.add(dashpot(indefinite)), "scaled determinant of damping is -", ">= 0");
  EXPECT_MODEL_ERROR(system.add(Bushing{.from = ground, .to = plate, .rest = {0, nan, 0}}),
                     "rest[1] is nan m");
  EXPECT_TRUE(system.elements().empty());
  // Units far apart and matrices without full rank are no reason to refuse.
  Random random(234);
  const Vec<3> units(1e6, 1e-3, 1e2);
  for (int rank = 0; rank <= 3; ++rank) {
    for (int repeat = 0; repeat < 50; ++repeat) {
      const Mat<3> matrix = units.asDiagonal() * random_stiffness(random, rank) * units.asDiagonal();
      EXPECT_NO_THROW(system.add(spring(matrix)));
    }
  }
}

}  // namespace
