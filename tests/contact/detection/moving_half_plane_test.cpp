// Half-planes that move as prescribed: what is refused, where they are, and the contact velocities and their
// rates against differences along a motion of body and plane.

#include "tests/model_error.h"
#include "tests/random.h"

#include <carom/carom.h>
#include <carom/contact/detection/detector.h>
#include <carom/core/assembly.h>
#include <carom/core/constraint_set.h>
#include <carom/core/discontinuity.h>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

namespace {

using namespace carom;
using namespace carom::planar;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();
const Surface law{.friction = 0.5, .normal_restitution = 0.5};

/// A motion of the plane and one of a body, with all derivatives in closed form.
struct Course {
  double size, frequency, phase;
  double operator()(double t) const { return size * std::sin(frequency * t + phase); }
  double rate(double t) const { return size * frequency * std::cos(frequency * t + phase); }
  double second(double t) const { return -size * frequency * frequency * std::sin(frequency * t + phase); }
};
Course random_course(carom_test::Random& random) {
  return {random.uniform(-1.0, 1.0), random.uniform(0.5, 3.0), random.uniform(0.0, 6.0)};
}
struct Motion {
  explicit Motion(carom_test::Random& random)
      : x(random_course(random)), y(random_course(random)), angle(random_course(random)) {}
  Course x, y, angle;
};

PrescribedMotion all_of(const Motion& m) {
  return {.displacement = [m](double t) { return Vec<2>(m.x(t), m.y(t)); },
          .velocity = [m](double t) { return Vec<2>(m.x.rate(t), m.y.rate(t)); },
          .acceleration = [m](double t) { return Vec<2>(m.x.second(t), m.y.second(t)); },
          .angle = [m](double t) { return m.angle(t); },
          .spin = [m](double t) { return m.angle.rate(t); },
          .angular_acceleration = [m](double t) { return m.angle.second(t); }};
}

/// One rigid body with one disc (or point), one particle, one moving plane.
class MovingPlane {
public:
  MovingPlane(carom_test::Random& random, double radius, const Motion& plane)
      : point(random.vec<2>()),
        body_(random),
        assembly_(make(random, point, radius, plane)),
        detector_(assembly_),
        state_(assembly_.initial_state()),
        evaluation_(make_evaluation(assembly_)) {
    for (Index component = 0; component < assembly_.components().size(); ++component) {
      for (const ContactPair& pair : detector_.pairs(component)) pairs_.push_back({component, pair});
    }
  }

  const Vec<2> point;  // that the plane turns about, as described

  std::size_t pairs() const { return pairs_.size(); }
  /// The contact of a pair at a time, body and particle moving along their course.
  SingleConstraint contact(std::size_t pair, double t) {
    go_to(t);
    GroundPlaces places;
    detector_.place(t, places);
    SingleConstraint contact;
    detector_.contact(pairs_[pair].pair, state_.view(), evaluation_, places, contact);
    return contact;
  }
  /// The same from a step of length h that begins there.
  SingleConstraint contact_of_step(std::size_t pair, double t, double h) {
    go_to(t);
    GroundPlaces now, after;
    detector_.place(t, now);
    detector_.place(t + h, after);
    ConstraintSet found;
    for (Index component = 0; component < assembly_.components().size(); ++component) {
      detector_.find(component, state_.view(), evaluation_, now, &after, infinity, found);
    }
    return SingleConstraint(found[pair]);
  }
  const State& state() const { return state_; }
  std::vector<double> accelerations(double t) const {
    std::vector<double> a(state_.v.size());
    for (const BodySlot& slot : state_.layout()->bodies()) {
      a[slot.v] = body_.x.second(t);
      a[slot.v + 1] = body_.y.second(t);
      if (slot.rotation != none) a[slot.v + 2] = body_.angle.second(t);
    }
    return a;
  }

private:
  struct Pair {
    Index component;
    ContactPair pair;
  };

  static System make(carom_test::Random& random, const Vec<2>& point, double radius, const Motion& plane) {
    System system;
    const BodyId body = system.add(RigidBody{.mass = box(1.0, 1.0, 1.0)});
    if (radius > 0.0) {
      system.add(Disc{.body = body, .radius = radius, .centre = random.vec<2>()});
    } else {
      system.add(Point{.body = body, .position = random.vec<2>()});
    }
    system.add(Particle{.mass = 1.0});
    system.add(HalfPlane{.point = point, .normal = random.vec<2>(), .motion = all_of(plane)}, law);
    return system;
  }
  void go_to(double t) {
    state_.time = t;
    for (const BodySlot& slot : state_.layout()->bodies()) {
      state_.q[slot.q] = body_.x(t);
      state_.q[slot.q + 1] = body_.y(t);
      state_.v[slot.v] = body_.x.rate(t);
      state_.v[slot.v + 1] = body_.y.rate(t);
      if (slot.rotation == none) continue;
      state_.q[slot.q + 2] = body_.angle(t);
      state_.v[slot.v + 2] = body_.angle.rate(t);
    }
    for (Index component = 0; component < assembly_.components().size(); ++component) {
      evaluate_positions(assembly_, component, state_.view(), evaluation_);
    }
  }

  Motion body_;
  Assembly assembly_;
  Detector detector_;
  State state_;
  Evaluation evaluation_;
  std::vector<Pair> pairs_;
};

/// df/dt by differences of fourth order; with steps of 1e-3 s and rates of order 3/s the error is about
/// (3e-3)^4/30 = 3e-12 of f, and eps/1e-3 = 2e-13 of it by rounding.
template <class F>
double rate(const F& f, double t) {
  constexpr double h = 1e-3;
  return (8.0 * (f(t + h) - f(t - h)) - (f(t + 2 * h) - f(t - 2 * h))) / (12.0 * h);
}
/// Sizes reach 10 to 100 (positions of 3 m, spins and accelerations of 3 to 9), with room.
constexpr double by_differences = 2e-9;

TEST(MovingHalfPlane, NormalVelocityIsTheRateOfTheGap) {
  carom_test::Random random(401);
  for (int repeat = 0; repeat < 100; ++repeat) {
    MovingPlane model(random, repeat % 2 == 0 ? 0.3 : 0.0, Motion(random));
    ASSERT_EQ(model.pairs(), 2u);
    const double t = random.uniform(-2.0, 2.0);
    for (std::size_t pair = 0; pair < model.pairs(); ++pair) {
      const double expected = rate([&](double time) { return model.contact(pair, time).gap; }, t);
      const SingleConstraint contact = model.contact(pair, t);
      EXPECT_NEAR(contact.velocity(0, model.state().v.data()), expected, by_differences);
    }
  }
}

TEST(MovingHalfPlane, AccelerationIsTheRateOfTheContactVelocity) {
  carom_test::Random random(402);
  for (int repeat = 0; repeat < 100; ++repeat) {
    MovingPlane model(random, repeat % 2 == 0 ? 0.3 : 0.0, Motion(random));
    const double t = random.uniform(-2.0, 2.0);
    const std::vector<double> a = model.accelerations(t);
    for (std::size_t pair = 0; pair < model.pairs(); ++pair) {
      for (int row = 0; row < 2; ++row) {
        const double expected = rate(
            [&](double time) {
              const SingleConstraint contact = model.contact(pair, time);
              return contact.velocity(row, model.state().v.data());
            },
            t);
        EXPECT_NEAR(model.contact(pair, t).acceleration(row, a.data()), expected, by_differences);
      }
    }
  }
}

TEST(MovingHalfPlane, ItsVelocityIsThatOfThePlaceThatIsTouched) {
  // A place of the obstacle x = o + R y, y fixed: where it is now, by differences; and a step later the place
  // that is touched then, which the feature has slid to.
  carom_test::Random random(403);
  for (int repeat = 0; repeat < 100; ++repeat) {
    const double radius = repeat % 2 == 0 ? 0.3 : 0.0;
    const Motion plane(random);
    MovingPlane model(random, radius, plane);
    const double t = random.uniform(-2.0, 2.0), h = random.uniform(0.0, 0.1);
    const SingleConstraint contact = model.contact_of_step(0, t, h);
    const Vec<2> n(contact.row(0)[0], contact.row(0)[1]);
    // The arm from the centre of mass to the place that is touched, from the rows of the jacobian.
    const double rx = contact.row(0)[2], ry = -contact.row(1)[2];
    const Vec<2> tangent(n[1], -n[0]);
    const Vec<2> touched = Vec<2>(model.state().q[0], model.state().q[1]) + rx * tangent + ry * n;
    const Vec<2> from(plane.x(t), plane.y(t));
    // Of the feature's centre C, against the plane's velocity there.
    const double spin = plane.angle.rate(t), above_c = ry + radius;
    const Vec<2> moved(model.state().v[0] - plane.x.rate(t), model.state().v[1] - plane.y.rate(t));
    const double above = n.dot(touched - (model.point + from)) + radius;
    const double slide = tangent.dot(moved) - model.state().v[2] * above_c + spin * above;
    const auto where = [&](double time, double slid) {
      const Vec<2> o(plane.x(time), plane.y(time));
      const Vec<2> arm = touched - (model.point + from) + slid * tangent;
      const double turn = plane.angle(time) - plane.angle(t);
      return Vec<2>(model.point + o +
                    Vec<2>(std::cos(turn) * arm[0] - std::sin(turn) * arm[1],
                           std::sin(turn) * arm[0] + std::cos(turn) * arm[1]));
    };
    for (int row = 0; row < 2; ++row) {
      const auto at = static_cast<std::size_t>(row);
      const Vec<2> direction = row == 0 ? n : tangent;
      EXPECT_NEAR(contact.surface_velocity[at],
                  rate([&](double time) { return direction.dot(where(time, 0.0)); }, t), by_differences);
      const double turned = row == 0 ? spin * h * (slide - spin * radius) : 0.0;
      EXPECT_NEAR(contact.surface_velocity_after[at],
                  rate([&](double time) { return direction.dot(where(time, h * slide)); }, t + h) + turned,
                  by_differences);
    }
  }
}

TEST(MovingHalfPlane, WhatSlidesAlongItWhileItTurnsIsFollowedThroughAStep) {
  carom_test::Random random(404);
  for (int repeat = 0; repeat < 100; ++repeat) {
    const Motion plane(random);
    MovingPlane model(random, 0.3, plane);
    const double t = random.uniform(-2.0, 2.0);
    const auto error = [&](double h) {
      const SingleConstraint contact = model.contact_of_step(1, t, h);  // of the particle
      const State& state = model.state();
      const Vec<2> v(state.v[3], state.v[4]), o_rate(plane.x.rate(t + h), plane.y.rate(t + h));
      const Vec<2> n(contact.row(0)[0], contact.row(0)[1]);
      const double turn = plane.angle(t + h) - plane.angle(t), spin = plane.angle.rate(t + h);
      const Vec<2> n1(std::cos(turn) * n[0] - std::sin(turn) * n[1],
                      std::sin(turn) * n[0] + std::cos(turn) * n[1]);
      const Vec<2> arm =
          Vec<2>(state.q[3], state.q[4]) + h * v - model.point - Vec<2>(plane.x(t + h), plane.y(t + h));
      const double at_end = n1.dot(v - o_rate) - spin * Vec<2>(n1[1], -n1[0]).dot(arm);
      return contact.velocity_after(0, state.v.data()) - at_end;
    };
    // Second order: with spins of 3 and their rates, velocities of 9 and places of 10 the factor of h^2 is a
    // few hundred; an error of first order, twice the spin times the slide, would be up to 5e-3.
    EXPECT_NEAR(error(1e-4), 0.0, 1e-5);
    EXPECT_NEAR(error(1e-4), 4.0 * error(5e-5), 1e-7);
  }
}

TEST(MovingHalfPlane, StandsWhereItsFunctionsSay) {
  constexpr double t = 0.7;
  System system;
  system.add(HalfPlane{.point = {1.0, 2.0},
                       .normal = {0.0, 3.0},
                       .motion = {.displacement = [](double time) { return Vec<2>(time, -2.0 * time); },
                                  .angle = [](double time) { return 0.3 * time; }}});
  const GroundShapeKind& kind = *system.ground_shape_kinds().entries()[0].kind;
  ASSERT_TRUE(kind.moves(0));
  const GroundMotion motion = kind.place(0, t);
  const Vec<2> normal(-std::sin(0.21), std::cos(0.21)), o(1.7, 0.6), x(-3.0, 4.0);
  const Gap gap = kind.moved_gap(0, motion, x.data());
  EXPECT_NEAR(gap.distance, normal.dot(x - o), 1e-15 * 10);
  EXPECT_NEAR(gap.normal[0], normal[0], 1e-15);
  EXPECT_NEAR(gap.normal[1], normal[1], 1e-15);
  EXPECT_EQ(kind.points_within_moved(0, motion, {x.data(), 2, 1}, gap.distance), 1U);
  EXPECT_EQ(kind.points_within_moved(0, motion, {x.data(), 2, 1}, std::nextafter(gap.distance, -infinity)),
            0U);
  // Rates by differences: linear functions of size 1, rounded, over steps of 1/4096 s.
  EXPECT_NEAR(motion.velocity[0], 1.0, 1e-11);
  EXPECT_NEAR(motion.velocity[1], -2.0, 1e-11);
  EXPECT_NEAR(motion.spin, 0.3, 1e-11);
  EXPECT_NEAR(motion.acceleration[1], 0.0, 1e-8);
  EXPECT_NEAR(motion.angular_acceleration, 0.0, 1e-8);
}

TEST(MovingHalfPlane, RatesThatAreNotGivenFollowFromThoseThatAre) {
  // Given rates are believed, whatever the positions: so it shows which were used.
  PrescribedMotion motion{.displacement = [](double t) { return Vec<2>(t * t, 0.0); },
                          .velocity = [](double t) { return Vec<2>(5.0 + 3.0 * t, 0.0); },
                          .angle = [](double t) { return t * t; }};
  GroundMotion at = motion.at(1.0, {0.0, 0.0});
  EXPECT_EQ(at.velocity[0], 8.0);
  EXPECT_NEAR(at.acceleration[0], 3.0, 1e-10);  // of the velocity, not 2
  EXPECT_NEAR(at.spin, 2.0, 1e-11);
  EXPECT_NEAR(at.angular_acceleration, 2.0, 1e-8);
  motion.acceleration = [](double) { return Vec<2>(-7.0, 0.0); };
  motion.spin = [](double t) { return 4.0 * t; };
  at = motion.at(1.0, {0.0, 0.0});
  EXPECT_EQ(at.acceleration[0], -7.0);
  EXPECT_EQ(at.spin, 4.0);
  EXPECT_NEAR(at.angular_acceleration, 4.0, 1e-10);
}

TEST(MovingHalfPlane, DoesNotLookAcrossBreaks) {
  // A table that starts at t = 1 with 2 m/s.
  System system;
  system.add(Particle{.mass = 1.0});
  const ObstacleId table = system.add(
      HalfPlane{
          .normal = {0.0, 1.0},
          .motion = {.displacement = [](double t) { return Vec<2>(0.0, t < 1.0 ? 0.0 : 2.0 * (t - 1.0)); },
                     .breaks = {1.0}}},
      law, "table");
  const ObstacleId drum =
      system.add(HalfPlane{.normal = {1.0, 0.0},
                           .motion = {.angle = [](double t) { return t; }, .breaks = {-1.0, 0.5, 1.0}}},
                 law);
  const GroundShapeKind& kind = *system.ground_shape_kinds().entries()[0].kind;
  EXPECT_EQ(kind.place(0, std::nextafter(1.0, 0.0)).velocity[1], 0.0);
  EXPECT_NEAR(kind.place(0, 1.0).velocity[1], 2.0, 1e-11);
  const Assembly assembly(system);
  const std::vector<Discontinuity> expected{{.time = 1.0, .obstacle = table},
                                            {.time = -1.0, .obstacle = drum},
                                            {.time = 0.5, .obstacle = drum},
                                            {.time = 1.0, .obstacle = drum}};
  EXPECT_EQ(Detector(assembly).shapes().discontinuities(), expected);
}

TEST(MovingHalfPlane, ImpossibleMotionsAreRefusedByName) {
  System system;
  const auto refused = [&](const PrescribedMotion& motion, const char* quantity, const char* value) {
    EXPECT_MODEL_ERROR(system.add(HalfPlane{.normal = {0.0, 1.0}, .motion = motion}, "table"),
                       "half-plane 'table'", quantity, value, "allowed");
  };
  const auto still = [](double) { return Vec<2>(0.0, 0.0); };
  const auto zero = [](double) { return 0.0; };
  refused({.velocity = still}, "motion.displacement", "motion.velocity is");
  refused({.acceleration = still}, "motion.displacement", "motion.acceleration is");
  refused({.displacement = still, .spin = zero}, "motion.angle", "motion.spin is");
  refused({.displacement = still, .angular_acceleration = zero}, "motion.angle", "angular_acceleration is");
  refused({.breaks = {1.0}}, "motion.breaks", "without a motion");
  refused({.displacement = still, .breaks = {1.0, nan}}, "motion.breaks", "nan");
  refused({.displacement = still, .breaks = {infinity}}, "motion.breaks", "inf");
  refused({.displacement = still, .breaks = {2.0, 1.0}}, "motion.breaks", "1 s after 2 s");
  refused({.displacement = still, .breaks = {1.0, 1.0}}, "motion.breaks", "1 s after 1 s");
  for (const double bad : {nan, infinity}) {
    const std::string value = to_text(bad);
    const auto vector = [bad](double) { return Vec<2>(0.0, bad); };
    const auto number = [bad](double) { return bad; };
    refused({.displacement = vector}, "position of its motion at time 0", value.c_str());
    refused({.displacement = still, .velocity = vector}, "velocity of its motion", value.c_str());
    refused({.displacement = still, .acceleration = vector}, "acceleration of its motion", value.c_str());
    refused({.angle = number}, "angle of its motion", value.c_str());
    refused({.angle = zero, .spin = number}, "spin of its motion", value.c_str());
    refused({.angle = zero, .angular_acceleration = number}, "angular acceleration of its", value.c_str());
  }
  EXPECT_TRUE(system.obstacles().empty());
  EXPECT_NO_THROW(
      system.add(HalfPlane{.normal = {0.0, 1.0}, .motion = {.angle = zero, .breaks = {-1.0, 0.0}}}));
}

TEST(MovingHalfPlane, FingerprintTellsMotionAndBreaks) {
  const auto print = [](const PrescribedMotion& motion) {
    System system;
    system.add(HalfPlane{.normal = {0.0, 1.0}, .motion = motion});
    return system.fingerprint();
  };
  const auto zero = [](double) { return 0.0; };
  EXPECT_NE(print({}), print({.angle = zero}));
  EXPECT_NE(print({.angle = zero}), print({.angle = zero, .breaks = {1.0}}));
  EXPECT_EQ(print({.angle = zero}), print({.angle = [](double t) { return t; }}));  // functions it cannot
}

}  // namespace
