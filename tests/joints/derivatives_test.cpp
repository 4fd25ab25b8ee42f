// First derivatives of the elements' loads, in closed form against differences, on random states.

#include <carom/joints/actuator.h>
#include <carom/joints/applied_load.h>
#include <carom/joints/bushing.h>
#include <carom/joints/drag.h>
#include <carom/joints/follower_load.h>
#include <carom/joints/nonlinear_spring.h>
#include <carom/joints/one_sided_spring.h>
#include <carom/joints/spring_damper.h>
#include <carom/joints/torsional_spring.h>
#include <carom/testing/loaded_model.h>

#include "tests/derivative_check.h"
#include "tests/joints/element_pairs.h"
#include "tests/model_error.h"

#include <cmath>

namespace {

using namespace carom;
using namespace carom_test;

// Adds the element that `make(from, to, random)` describes between ends of every sort, in the plane.
template <class F>
void for_pairs(std::uint64_t seed, F&& make) {
  Random random(seed);
  for (int repeat = 0; repeat < 20; ++repeat) {
    const Bodies bodies(random);
    for (const auto& [from, to] : pairs_of_ends(bodies, random)) {
      System system = bodies.system;
      system.add(make(from, to, random));
      expect_derivatives_meet_differences(LoadedModel(system));
    }
  }
}

// In space there are particles and the ground.
template <class F>
void for_spatial_pairs(std::uint64_t seed, F&& make) {
  Random random(seed);
  for (int repeat = 0; repeat < 20; ++repeat) {
    System bodies;
    bodies.add(spatial::Particle{.mass = 1.0});
    const auto dot = [&](double x) {
      return bodies.add(spatial::Particle{
          .mass = 1.0, .position = Vec<3>(x, 0, 0) + random.vec<3>(), .velocity = random.vec<3>(2.0)});
    };
    const BodyId a = dot(0.0), b = dot(3.5);
    for (const End<3>& from : {End<3>(a), End<3>(ground, random.vec<3>())}) {
      System system = bodies;
      system.add(make(from, End<3>(b), random));
      expect_derivatives_meet_differences(LoadedModel(system));
    }
  }
}

template <class Part>
auto one_sided() {
  return [](const auto& from, const auto& to, Random& random) {
    return Part{.from = from,
                .to = to,
                .stiffness = random.uniform(0.5, 5.0),
                .damping = random.uniform(0.0, 5.0),
                .free_length = random.uniform(1.0, 5.0)};
  };
}

TEST(Derivatives, SpringDamper) {
  for_pairs(301, one_sided<planar::SpringDamper>());
  for_spatial_pairs(302, one_sided<spatial::SpringDamper>());
}

// Slack, free and clipped states all come.
TEST(Derivatives, Cable) {
  for_pairs(303, one_sided<planar::Cable>());
  for_spatial_pairs(304, one_sided<spatial::Cable>());
}

TEST(Derivatives, Bumper) {
  for_pairs(305, one_sided<planar::Bumper>());
  for_spatial_pairs(306, one_sided<spatial::Bumper>());
}

TEST(Derivatives, OneSidedSpringsInEachRegime) {
  struct Regime {
    double position, velocity, by_position, by_velocity;
  };
  // k = 10, L = 2, c = 4 along x; across, the tension over the length.
  for (const Regime& regime : {Regime{1.5, 3.0, 0.0, 0.0}, Regime{2.5, 0.5, -10.0, -4.0},
                               Regime{2.5, 3.0, -20.0, 0.0}, Regime{2.5, -3.0, 0.0, 0.0}}) {
    System system;
    const BodyId dot = system.add(
        planar::Particle{.mass = 1.0, .position = {regime.position, 0}, .velocity = {regime.velocity, 0}});
    system.add(
        planar::Cable{.from = ground, .to = dot, .stiffness = 10.0, .damping = 4.0, .free_length = 2.0});
    const LoadedModel model(system);
    const Eigen::MatrixXd own = load_derivatives(model, By::element);
    EXPECT_DOUBLE_EQ(own(0, 0), regime.by_position);
    EXPECT_DOUBLE_EQ(own(0, 2), regime.by_velocity);
    EXPECT_DOUBLE_EQ(own(1, 1), (model.conservative[0] + model.dissipative[0]) / regime.position);
  }
}

// T = 3 (l - 1) + (l - 1)^3.
template <class Part>
auto hardening(bool with_slope) {
  return [with_slope](const auto& from, const auto& to, Random& random) {
    Part part{
        .from = from,
        .to = to,
        .force = [](double l) { return 3.0 * (l - 1.0) + std::pow(l - 1.0, 3); },
        .potential_of = [](double l) { return 1.5 * std::pow(l - 1.0, 2) + 0.25 * std::pow(l - 1.0, 4); },
        .damping = random.uniform(0.0, 2.0)};
    if (with_slope) part.force_by_length = [](double l) { return 3.0 + 3.0 * std::pow(l - 1.0, 2); };
    return part;
  };
}

TEST(Derivatives, NonlinearSpring) {
  for (const bool with_slope : {false, true}) {
    for_pairs(307, hardening<planar::NonlinearSpring>(with_slope));
    for_spatial_pairs(308, hardening<spatial::NonlinearSpring>(with_slope));
  }
}

template <class Part>
auto servo(bool with_slopes) {
  return [with_slopes](const auto& from, const auto& to, Random&) {
    Part part{.from = from, .to = to, .force = [](double t, double l, double rate) {
                return std::cos(t) + std::sin(l) * (2.0 - rate) - 0.1 * std::pow(rate, 3);
              }};
    if (with_slopes) {
      part.force_by_length = [](double, double l, double rate) { return std::cos(l) * (2.0 - rate); };
      part.force_by_rate = [](double, double l, double rate) { return -std::sin(l) - 0.3 * rate * rate; };
    }
    return part;
  };
}

TEST(Derivatives, LinearActuator) {
  for (const bool with_slopes : {false, true}) {
    for_pairs(309, servo<planar::LinearActuator>(with_slopes));
    for_spatial_pairs(310, servo<spatial::LinearActuator>(with_slopes));
  }
}

// A law's own derivative is what is used: differences of it would not see this one.
TEST(Derivatives, OfLawsAreTheOnesGiven) {
  System system;
  const BodyId dot = system.add(planar::Particle{.mass = 1.0, .position = {2, 0}});
  system.add(planar::LinearActuator{.from = ground,
                                    .to = dot,
                                    .force = [](double, double, double) { return 0.0; },
                                    .force_by_length = [](double, double, double) { return 7.0; },
                                    .force_by_rate = [](double, double, double) { return 5.0; }});
  system.add(planar::NonlinearSpring{.from = ground,
                                     .to = dot,
                                     .force = [](double) { return 0.0; },
                                     .potential_of = [](double) { return 0.0; },
                                     .force_by_length = [](double) { return 11.0; }});
  const Eigen::MatrixXd own = load_derivatives(LoadedModel(system), By::element);
  EXPECT_EQ(own(0, 0), 7.0 - 11.0);
  EXPECT_EQ(own(0, 2), 5.0);
}

TEST(Derivatives, DragAndLoadsAtAnEnd) {
  Random random(311);
  for (int repeat = 0; repeat < 20; ++repeat) {
    const Bodies bodies(random);
    for (const End<2>& on :
         {End<2>(bodies.plates[0]), End<2>(bodies.plates[1], random.vec<2>()), End<2>(bodies.dots[0])}) {
      const Vec<2> force = random.vec<2>(5.0);
      System dragged = bodies.system, pushed = bodies.system, followed = bodies.system;
      dragged.add(
          planar::Drag{.on = on, .linear = random.uniform(0.0, 2.0), .quadratic = random.uniform(0.0, 2.0)});
      expect_derivatives_meet_differences(LoadedModel(dragged));
      pushed.add(planar::AppliedForce{.on = on, .force = [force](double) { return force; }});
      expect_derivatives_meet_differences(LoadedModel(pushed));
      if (on.body == bodies.dots[0]) continue;
      followed.add(planar::FollowerLoad{.on = on, .force = [force](double) { return force; }});
      followed.add(planar::AppliedTorque{.on = on.body, .torque = [](double) { return 3.0; }});
      expect_derivatives_meet_differences(LoadedModel(followed));
      EXPECT_GT(load_derivatives(LoadedModel(followed), By::element).norm(), 0.1);
    }
  }
}

TEST(Derivatives, DragAndLoadsInSpace) {
  Random random(312);
  System system;
  const BodyId dot = system.add(spatial::Particle{.mass = 1.0, .velocity = {1, -2, 0.5}});
  system.add(spatial::Drag{.on = dot, .linear = 0.3, .quadratic = 0.7});
  system.add(spatial::AppliedForce{.on = dot, .force = [](double) { return Vec<3>(1, 2, 3); }});
  expect_derivatives_meet_differences(LoadedModel(system));
}

TEST(Derivatives, DragAtRestIsItsLinearPart) {
  System system;
  const BodyId dot = system.add(planar::Particle{.mass = 1.0});
  system.add(planar::Drag{.on = dot, .linear = 0.3, .quadratic = 0.7});
  const Eigen::MatrixXd own = load_derivatives(LoadedModel(system), By::element);
  EXPECT_EQ(own(0, 2), -0.3);
  EXPECT_EQ(own(1, 3), -0.3);
  EXPECT_EQ(own(0, 3), 0.0);
}

TEST(Derivatives, AngularElements) {
  Random random(313);
  for (int repeat = 0; repeat < 20; ++repeat) {
    const Bodies bodies(random);
    const std::pair<BodyId, BodyId> pairs[] = {
        {bodies.plates[0], bodies.plates[1]}, {ground, bodies.plates[1]}, {bodies.plates[0], ground}};
    for (const auto& [from, to] : pairs) {
      System springs = bodies.system, motors = bodies.system, given = bodies.system;
      springs.add(planar::TorsionalSpring{
          .from = from, .to = to, .stiffness = 3.0, .damping = random.uniform(0.0, 2.0), .free_angle = 0.4});
      expect_derivatives_meet_differences(LoadedModel(springs));
      planar::RotaryActuator motor{.from = from, .to = to, .torque = [](double, double a, double rate) {
                                     return std::sin(a) * (1.0 + rate * rate);
                                   }};
      motors.add(motor);
      expect_derivatives_meet_differences(LoadedModel(motors));
      motor.torque_by_angle = [](double, double a, double rate) { return std::cos(a) * (1.0 + rate * rate); };
      motor.torque_by_rate = [](double, double a, double rate) { return 2.0 * std::sin(a) * rate; };
      given.add(motor);
      expect_derivatives_meet_differences(LoadedModel(given));
    }
  }
}

Mat<3> random_matrix(Random& random) {
  Mat<3> sum = Mat<3>::Zero();
  for (int i = 0; i < 3; ++i) {
    const Vec<3> a = random.vec<3>();
    sum += a * a.transpose();
  }
  return sum;
}

TEST(Derivatives, Bushing) {
  Random random(314);
  for (int repeat = 0; repeat < 40; ++repeat) {
    const Bodies bodies(random);
    const std::pair<End<2>, End<2>> pairs[] = {
        {{bodies.plates[0], random.vec<2>()}, {bodies.plates[1], random.vec<2>()}},
        {bodies.plates[0], bodies.plates[1]},
        {{ground, random.vec<2>()}, {bodies.plates[1], random.vec<2>()}},
        {{bodies.plates[0], random.vec<2>()}, {ground, random.vec<2>()}}};
    for (const auto& [from, to] : pairs) {
      for (const bool damped : {false, true}) {
        System system = bodies.system;
        system.add(planar::Bushing{.from = from,
                                   .to = to,
                                   .stiffness = random_matrix(random),
                                   .damping = damped ? random_matrix(random) : Mat<3>::Zero(),
                                   .rest = random.vec<3>()});
        const LoadedModel model(system);
        expect_derivatives_meet_differences(model);
        if (damped) continue;
        // Loads of a potential: symmetric up to the rounding of entries of size 10 to 100.
        const Eigen::MatrixXd own = load_derivatives(model, By::element);
        const Eigen::Index n = own.rows();
        EXPECT_LE((own.leftCols(n) - own.leftCols(n).transpose()).norm(), 1e-13 * (1.0 + own.norm()));
      }
    }
  }
}

TEST(Derivatives, WhereEndsCoincideThereAreNone) {
  System system;
  const BodyId a = system.add(planar::Particle{.mass = 1.0, .position = {1, 2}, .velocity = {3, 4}});
  const BodyId b = system.add(planar::Particle{.mass = 1.0, .position = {1, 2}});
  system.add(planar::Bumper{.from = a, .to = b, .stiffness = 2.0, .damping = 1.0, .free_length = 1.0});
  Random random(315);
  system.add(hardening<planar::NonlinearSpring>(true)(a, b, random));
  system.add(servo<planar::LinearActuator>(true)(a, b, random));
  EXPECT_EQ(load_derivatives(LoadedModel(system), By::element).norm(), 0.0);
}

TEST(Derivatives, OfLawsMustBeFiniteAtTheStart) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  System system;
  const BodyId dot = system.add(planar::Particle{.mass = 1.0, .position = {2, 0}});
  const BodyId plate = system.add(planar::RigidBody{.mass = planar::disc(1.0, 1.0)});
  const auto law = [](double, double, double) { return 1.0; };
  const auto bad = [](double, double, double) { return nan; };
  EXPECT_MODEL_ERROR(
      system.add(planar::LinearActuator{.from = ground, .to = dot, .force = law, .force_by_length = bad}),
      "linear actuator #0", "force_by_length at time 0, length 2 m, rate 0 m/s is nan");
  EXPECT_MODEL_ERROR(
      system.add(planar::LinearActuator{.from = ground, .to = dot, .force = law, .force_by_rate = bad}),
      "force_by_rate at time 0");
  EXPECT_MODEL_ERROR(
      system.add(planar::RotaryActuator{.from = ground, .to = plate, .torque = law, .torque_by_angle = bad}),
      "rotary actuator #0", "torque_by_angle at time 0, angle 0 rad, rate 0 rad/s is nan");
  EXPECT_MODEL_ERROR(
      system.add(planar::RotaryActuator{.from = ground, .to = plate, .torque = law, .torque_by_rate = bad}),
      "torque_by_rate at time 0");
  EXPECT_MODEL_ERROR(system.add(planar::NonlinearSpring{.from = ground,
                                                        .to = dot,
                                                        .force = [](double) { return 1.0; },
                                                        .potential_of = [](double l) { return l; },
                                                        .force_by_length = [](double) { return nan; }}),
                     "nonlinear spring #0", "force_by_length at length 2 m is nan");
}

}  // namespace
