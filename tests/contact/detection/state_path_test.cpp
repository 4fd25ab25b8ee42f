// The path between two states, against closed forms of bodies that are accelerated evenly.

#include "tests/contact/detection/moved_model.h"
#include "tests/random.h"

#include <carom/carom.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace {

using namespace carom;
using namespace carom::planar;
using carom_test::body_outline;
using carom_test::ground_outline;
using carom_test::MovedModel;
using carom_test::OwnedOutline;
using carom_test::Random;
using carom_test::random_accelerations;

// Places, velocities and turns are below 100, and a few roundings away from the closed form.
constexpr double rounding = 1e-13;

/// Three boxes, a particle between them in the order of assembly, and a block on ground that moves.
System boxes_and_particle(Random& random) {
  System system;
  system.set_default_law({.friction = 0.1, .normal_restitution = 0.0});
  const auto add_box = [&] {
    const Vec<2> place = random.vec<2>(3.0), velocity = random.vec<2>(4.0);
    const BodyId body = system.add(RigidBody{.mass = box(1.0, 0.4, 0.2),
                                             .position = place,
                                             .angle = random.uniform(-3.0, 3.0),
                                             .velocity = velocity,
                                             .spin = random.uniform(-5.0, 5.0)});
    system.add(Polygon{.body = body, .vertices = {{-0.2, -0.1}, {0.2, -0.1}, {0.2, 0.1}, {-0.2, 0.1}}});
  };
  add_box();
  system.add(Particle{.mass = 1.0, .position = {0.3, 0.4}, .velocity = {-1.0, 2.0}});
  add_box();
  add_box();
  system.add(planar::Block{.vertices = {{-1.0, -0.1}, {1.0, -0.1}, {1.0, 0.1}, {-1.0, 0.1}},
                           .pivot = {-1.0, 0.0},
                           .motion = {.displacement = [](double t) { return Vec<2>(std::sin(t), 2.0 * t); },
                                      .velocity = [](double t) { return Vec<2>(std::cos(t), 2.0); },
                                      .angle = [](double t) { return t * t; },
                                      .spin = [](double t) { return 2.0 * t; }}});
  return system;
}

constexpr double begin = 0.7, span = 0.6;

/// The scene on a path; \param seed of the scene
MovedModel moved(Random& random) {
  System system = boxes_and_particle(random);
  std::vector<double> accelerations = random_accelerations(random, 4, 6.0);
  accelerations.pop_back();  // the particle does not turn
  return {std::move(system), span, std::move(accelerations), begin};
}

/// Vertices of an outline of a body as a sample has them.
std::vector<Vec<2>> placed(const MovedModel& model, Index outline, const PathSample& at) {
  const BodyOutlines& bodies = model.detector.outlines().of_bodies();
  const BodyOutline& of = bodies.list()[outline];
  std::vector<Vec<2>> out(of.vertices.size());
  bodies.place(of, model.detector.outlines().slots()[of.body], at.state, at.evaluation, out.data());
  return out;
}

/// Expects that a sample shows some bodies as a state has them.
void expect_shows(const MovedModel& model, const PathSample& sample, const State& expected,
                  const std::vector<Index>& bodies) {
  EXPECT_EQ(sample.state.time, expected.time);
  for (const Index body : bodies) {
    const BodySlot slot = model.assembly.layout()->bodies()[body];
    for (Index i = 0; i < slot.v_size; ++i) {
      EXPECT_NEAR(sample.state.q[slot.q + i], expected.q[slot.q + i], rounding) << body << ' ' << i;
      EXPECT_NEAR(sample.state.v[slot.v + i], expected.v[slot.v + i], rounding) << body << ' ' << i;
      EXPECT_NEAR(sample.acceleration[slot.v + i], model.acceleration[slot.v + i], rounding) << body;
    }
  }
  const std::vector<BodyOutline>& list = model.detector.outlines().of_bodies().list();
  for (Index outline = 0; outline < list.size(); ++outline) {
    if (std::find(bodies.begin(), bodies.end(), list[outline].body) == bodies.end()) continue;
    const std::vector<Vec<2>> found = placed(model, outline, sample);
    const OwnedOutline exact = body_outline(model, outline, expected);
    for (std::size_t i = 0; i < found.size(); ++i)
      EXPECT_LT((found[i] - exact.vertices[i]).norm(), rounding) << outline;
  }
}

TEST(StatePath, BeginsAndEndsWithTheGivenStates) {
  Random random(1);
  MovedModel model = moved(random);
  EXPECT_EQ(model.path.length(), model.end.time - model.start.time);
  expect_shows(model, model.path.begin(), model.start, {0, 1, 2, 3});
  expect_shows(model, model.path.end(), model.end, {0, 1, 2, 3});
  for (std::size_t i = 0; i < model.start.q.size(); ++i) {  // to the bit
    EXPECT_EQ(model.path.begin().state.q[i], model.start.q[i]);
    EXPECT_EQ(model.path.end().state.q[i], model.end.q[i]);
  }
}

TEST(StatePath, SamplesOfWhatIsWatchedAreTheClosedForm) {
  Random random(2);
  for (int trial = 0; trial < 20; ++trial) {
    MovedModel model = moved(random);
    for (const std::vector<Index>& watched : {std::vector<Index>{0, 1, 3}, {2}, {1, 2}}) {
      model.path.watch(watched);
      for (const double share : {0.0, 0.01, 0.37, 0.5, 0.93, 1.0}) {
        const double time = begin + share * span;
        expect_shows(model, model.path.sample(time, PathLook::exact), model.at(time), watched);
      }
    }
  }
}

TEST(StatePath, GroundIsWhereItIsPrescribed) {
  Random random(3);
  MovedModel model = moved(random);
  const GroundShapes& shapes = model.detector.shapes();
  ASSERT_TRUE(shapes.moves(0));
  const auto expect_placed = [&](const PathSample& at) {
    const double t = at.state.time;
    const GroundMotion& motion = *shapes.motion(0, at.places);
    EXPECT_NEAR(motion.point[0], -1.0 + std::sin(t), rounding);
    EXPECT_NEAR(motion.point[1], 2.0 * t, rounding);
    EXPECT_NEAR(motion.angle, t * t, rounding);
    EXPECT_NEAR(motion.velocity[0], std::cos(t), rounding);
    EXPECT_NEAR(motion.spin, 2.0 * t, rounding);
  };
  model.path.watch(std::vector<Index>{0});
  for (const double share : {0.2, 0.8}) {
    expect_placed(model.path.sample(begin + share * span, PathLook::exact));
    expect_placed(model.path.begin());
    expect_placed(model.path.end());
  }
  EXPECT_EQ(model.path.begin().state.time, begin);
}

TEST(StatePath, DisplacementsAreThoseOfTheCoordinates) {
  Random random(4);
  const MovedModel model = moved(random);
  for (const BodySlot slot : model.assembly.layout()->bodies()) {
    for (Index i = 0; i < slot.v_size; ++i)
      EXPECT_EQ(model.path.displacement(slot.v + i), model.end.q[slot.q + i] - model.start.q[slot.q + i]);
  }
}

// A path is given by its ends, whatever velocities they have: those of the path are the ones that lead there.
TEST(StatePath, VelocitiesFollowFromPlacesAndTheirChange) {
  Random random(5);
  MovedModel model = moved(random);
  for (State* const state : {&model.start, &model.end}) {
    for (double& v : state->v) v = random.uniform(-50.0, 50.0);
  }
  StatePath path(model.assembly, model.detector);
  path.set(model.start, model.end, model.change.data());
  for (std::size_t v = 0; v < model.change.size(); ++v) {
    const double mean = path.displacement(static_cast<Index>(v)) / span;
    EXPECT_NEAR(path.begin().state.v[v], mean - 0.5 * model.change[v], rounding);
    EXPECT_NEAR(path.end().state.v[v], mean + 0.5 * model.change[v], rounding);
  }
}

TEST(StatePath, ChordsAreStraight) {
  Random random(6);
  MovedModel model = moved(random);
  model.path.set(model.start, model.end, nullptr);
  model.path.watch(std::vector<Index>{0, 1, 2});
  for (const double share : {0.0, 0.2, 0.7, 1.0}) {
    const PathSample at = model.path.sample(begin + share * span, PathLook::exact);
    for (Index v = 0; v < 8; ++v) {  // q and v are alike in the plane
      EXPECT_NEAR(at.state.q[v], model.start.q[v] + share * (model.end.q[v] - model.start.q[v]), rounding);
      EXPECT_NEAR(at.state.v[v], model.path.displacement(v) / span, rounding);
      EXPECT_EQ(at.acceleration[v], 0.0);
      EXPECT_EQ(model.path.bend(v), 0.0);
    }
  }
}

TEST(StatePath, BendIsTheLargestDistanceFromTheChord) {
  Random random(7);
  for (int trial = 0; trial < 20; ++trial) {
    MovedModel model = moved(random);
    model.path.watch(std::vector<Index>{0, 1, 2});
    std::array<double, 8> most{};
    for (int i = 0; i <= 64; ++i) {  // the middle is one of them
      const double share = i / 64.0;
      const PathSample at = model.path.sample(begin + share * span, PathLook::exact);
      for (Index v = 0; v < 8; ++v) {
        const double chord = model.start.q[v] + share * model.path.displacement(v);
        most[v] = std::max(most[v], std::abs(at.state.q[v] - chord));
        EXPECT_LE(most[v], model.path.bend(v) + rounding) << v << ' ' << share;
      }
    }
    for (Index v = 0; v < 8; ++v) EXPECT_NEAR(most[v], model.path.bend(v), rounding) << v;
  }
}

TEST(StatePath, AllLooksAreExact) {
  Random random(8);
  MovedModel model = moved(random);
  model.path.watch(std::vector<Index>{2});
  const double time = begin + 0.3 * span;
  const BodySlot slot = model.assembly.layout()->bodies()[2];
  std::vector<std::array<double, 9>> seen;
  for (const PathLook how : {PathLook::between, PathLook::exact, PathLook::exact_rates}) {
    // A look elsewhere between them leaves nothing behind.
    EXPECT_NE(model.path.sample(begin, how).state.q[slot.q], model.at(time).q[slot.q]);
    const PathSample at = model.path.sample(time, how);
    std::array<double, 9> all{};
    for (Index i = 0; i < 3; ++i) {
      all[i] = at.state.q[slot.q + i];
      all[3 + i] = at.state.v[slot.v + i];
      all[6 + i] = at.acceleration[slot.v + i];
    }
    seen.push_back(all);
  }
  EXPECT_EQ(seen[0], seen[1]);
  EXPECT_EQ(seen[1], seen[2]);
}

TEST(StatePath, IsSetAnew) {
  Random random(9);
  MovedModel model = moved(random);
  model.path.watch(std::vector<Index>{0});
  expect_shows(model, model.path.sample(begin + 0.5 * span, PathLook::exact), model.at(begin + 0.5 * span),
               {0});
  // The second half of it is the same motion.
  const State middle = model.at(begin + 0.5 * span);
  std::vector<double> half = model.change;
  for (double& by : half) by *= 0.5;
  model.path.set(middle, model.end, half.data());
  EXPECT_NEAR(model.path.length(), 0.5 * span, rounding);
  model.path.watch(std::vector<Index>{0, 3});
  const double later = begin + 0.8 * span;
  expect_shows(model, model.path.begin(), middle, {0, 1, 2, 3});
  expect_shows(model, model.path.sample(later, PathLook::exact), model.at(later), {0, 3});
}

}  // namespace
