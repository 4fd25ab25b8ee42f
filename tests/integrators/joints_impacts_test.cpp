// Impacts of mechanisms in the event-driven mode, at obstacles and at stops, against closed forms with dense
// matrices.

#include "tests/integrators/dense_mechanism.h"
#include "tests/integrators/joint_run.h"
#include "tests/random.h"

#include <carom/carom.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <utility>
#include <vector>

namespace {

using namespace joint_scenes;
using carom_test::events_of;

Vec<2> turned(double angle, const Vec<2>& v) {
  return {std::cos(angle) * v[0] - std::sin(angle) * v[1], std::sin(angle) * v[0] + std::cos(angle) * v[1]};
}

/// Velocities of all bodies, (x, y, spin) each.
Eigen::VectorXd velocities(const State& state, const std::vector<BodyId>& bodies) {
  Eigen::VectorXd all(3 * static_cast<Eigen::Index>(bodies.size()));
  Eigen::Index i = 0;
  for (const BodyId body : bodies) {
    all.segment(i, 3) << state.velocity(body)[0], state.velocity(body)[1], state.spin(body);
    i += 3;
  }
  return all;
}

void set_velocities(State& state, const std::vector<BodyId>& bodies, const Eigen::VectorXd& all) {
  Eigen::Index i = 0;
  for (const BodyId body : bodies) {
    state.velocity(body) = Vec<2>(all[i], all[i + 1]);
    state.spin(body) = all[i + 2];
    i += 3;
  }
}

/// The largest difference of two states.
double difference(const State& a, const State& b) {
  double largest = 0.0;
  for (std::size_t i = 0; i < a.q.size(); ++i) largest = std::max(largest, std::abs(a.q[i] - b.q[i]));
  for (std::size_t i = 0; i < a.v.size(); ++i) largest = std::max(largest, std::abs(a.v[i] - b.v[i]));
  return largest;
}

TEST(JointImpacts, PinnedRodHitsAtADistance) {
  // About the pin I dw = P d with I = m l^2/3; the pin gives what m (l/2) dw lacks of P: nothing at the
  // centre of percussion, d = 2 l/3.
  const double m = 3.0, l = 2.0, spin = -1.5, inertia = m * l * l / 3.0;
  for (const double e : {1.0, 0.6, 0.0}) {
    for (const double d : {0.5, 1.0, 2.0 * l / 3.0, 1.9}) {
      Scene scene;
      const BodyId bar = scene.system.add(RigidBody{
          .mass = rod(m, l), .position = {0.5 * l, 0.0}, .velocity = {0.0, 0.5 * l * spin}, .spin = spin});
      scene.system.add(Revolute{.from = ground, .to = {bar, {-0.5 * l, 0.0}}});
      scene.system.add(Point{.body = bar, .position = {d - 0.5 * l, 0.0}});
      scene.system.add(HalfPlane{.normal = {0.0, 1.0}}, Surface{.friction = 0.4, .normal_restitution = e});
      WatchedRun run(scene);
      const double short_time = 1e-6;
      run.simulation.run_until(short_time);
      const double jump = -(1.0 + e) * spin;
      EXPECT_NEAR(run.simulation.state().spin(bar), -e * spin, 1e-13);
      const auto impacts = events_of(run.simulation, EventKind::impact);
      ASSERT_EQ(impacts.size(), 1U);
      EXPECT_NEAR(impacts[0].velocity_before[0], spin * d, 1e-14);
      EXPECT_NEAR(impacts[0].velocity_after[0], -e * spin * d, 1e-14);
      EXPECT_NEAR(impacts[0].impulse[0], inertia * jump / d, 1e-13);
      EXPECT_NEAR(impacts[0].impulse[1], 0.0, 1e-14);  // nothing slides
      // Read a moment later, when the rod has turned by 1e-6 w, which enters squared.
      const double pin =
          m * (run.simulation.state().velocity(bar)[1] - 0.5 * l * spin) - impacts[0].impulse[0];
      EXPECT_NEAR(pin, m * jump * (0.5 * l - l * l / (3.0 * d)), 1e-11);
      const std::vector<JointImpulse>& told = run.simulation.report().joint_impulses;
      ASSERT_EQ(told.size(), 1U);
      EXPECT_NEAR(told[0].impulse.force[1], m * jump * (0.5 * l - l * l / (3.0 * d)), 1e-13);
      EXPECT_NEAR(told[0].impulse.force[0], 0.0, 1e-13);
      EXPECT_NEAR(run.simulation.energy().flow(EnergyFlow::impact_normal),
                  0.5 * inertia * spin * spin * (1.0 - e * e), 1e-13);
    }
  }
}

TEST(JointImpacts, PinnedRodFallsOnAFloor) {
  // From level to where the tip is half a metre lower: w^2 = 3 g sin(30 deg)/l.
  const double e = 0.7;
  Scene scene = rod_pendulum(1);
  const BodyId bar = scene.bodies[0];
  scene.system.add(Point{.body = bar, .position = {0.5, 0.0}});
  scene.system.add(HalfPlane{.point = {0.0, -0.5}, .normal = {0.0, 1.0}},
                   Surface{.friction = 0.0, .normal_restitution = e});
  WatchedRun run(scene);
  run.simulation.run_until(6.0);
  const double spin = std::sqrt(1.5 * g), lever = std::sqrt(0.75);
  const auto impacts = events_of(run.simulation, EventKind::impact);
  ASSERT_GE(impacts.size(), 3U);
  double expected = spin;
  for (std::size_t i = 0; i < 3; ++i, expected *= e) {
    EXPECT_NEAR(impacts[i].velocity_before[0], -expected * lever, 1e-10);
    EXPECT_NEAR(impacts[i].velocity_after[0], e * expected * lever, 1e-10);
    EXPECT_NEAR(impacts[i].impulse[0], (1.0 + e) * expected / 3.0 / lever, 1e-10);
  }
  EXPECT_EQ(events_of(run.simulation, EventKind::accumulation).size(), 1U);
  EXPECT_NEAR(run.simulation.state().angle(bar), -std::asin(0.5), 1e-12);
  EXPECT_NEAR(run.simulation.state().spin(bar), 0.0, 1e-12);
  // All that falling brought is gone.
  EXPECT_NEAR(run.simulation.energy().lost(), 0.25 * g, 1e-10);
}

/// Two rods with given angles and spins, pinned to the origin and to each other; the second ends in a point.
Scene double_rod(double first, double second, double w1, double w2) {
  Scene scene;
  System& system = scene.system;
  system.add(Gravity{{0.0, -g}});
  const Vec<2> a = turned(first, {0.5, 0.0}), b = turned(second, {0.5, 0.0});
  const Vec<2> va(-w1 * a[1], w1 * a[0]), vb(-w2 * b[1], w2 * b[0]);
  const BodyId upper =
      system.add(RigidBody{.mass = rod(1.0, 1.0), .position = a, .angle = first, .velocity = va, .spin = w1});
  const BodyId lower = system.add(RigidBody{.mass = rod(2.0, 1.0),
                                            .position = 2.0 * a + b,
                                            .angle = second,
                                            .velocity = 2.0 * va + vb,
                                            .spin = w2});
  system.add(Revolute{.from = ground, .to = {upper, {-0.5, 0.0}}});
  system.add(Revolute{.from = {upper, {0.5, 0.0}}, .to = {lower, {-0.5, 0.0}}});
  system.add(Point{.body = lower, .position = {0.5, 0.0}});
  scene.bodies = {upper, lower};
  return scene;
}

TEST(JointImpacts, DoublePendulumStruckAtItsTip) {
  carom_test::Random random(20);
  const double e = 0.5;
  int sticking = 0, slipping = 0;
  for (int trial = 0; trial < 40; ++trial) {
    const double mu = trial % 2 == 0 ? 0.0 : 0.5;
    const double first = random.uniform(-2.5, -0.6), second = first + random.uniform(-1.2, 1.2);
    const Vec<2> a = turned(first, {0.5, 0.0}), b = turned(second, {0.5, 0.0});
    const double w1 = random.uniform(-4.0, 4.0), w2 = random.uniform(-4.0, 4.0);
    const double tilt = random.uniform(-3.0, 3.0);
    const Vec<2> normal = turned(tilt, {0.0, 1.0}), tangent(normal[1], -normal[0]);
    DenseMechanism dense(2);
    dense.body(0, 1.0, 1.0 / 12.0);
    dense.body(1, 2.0, 2.0 / 12.0);
    dense.pin(DenseMechanism::fixed, Vec<2>::Zero(), 0, -a);
    dense.pin(0, a, 1, -b);
    DenseMechanism::Rows axes(2, 2);
    axes << normal.transpose(), tangent.transpose();
    const DenseMechanism::Rows h = axes * dense.point(1, b);
    const Vec<2> tip(-2.0 * (w1 * a[1] + w2 * b[1]), 2.0 * (w1 * a[0] + w2 * b[0]));
    const double sign = tip.dot(normal) > 0.0 ? -1.0 : 1.0;  // it approaches
    Scene scene = double_rod(first, second, sign * w1, sign * w2);
    const Scene free = scene;
    scene.system.add(HalfPlane{.point = 2.0 * a + 2.0 * b, .normal = normal},
                     Surface{.friction = mu, .normal_restitution = e});
    WatchedRun run(scene);
    Simulation after(free.system, fine());
    const Eigen::VectorXd before = velocities(after.state(), scene.bodies);
    const Eigen::Vector2d gamma = h * before;
    const Eigen::MatrixXd inverse = dense.inverse_mass();
    const SingleImpact expected(h * inverse * h.transpose(), gamma, e, mu);
    ASSERT_EQ(expected.solutions, 1) << trial;
    (expected.sticks ? sticking : slipping) += 1;
    State struck = after.state();
    set_velocities(struck, scene.bodies, before + inverse * h.transpose() * expected.impulse);
    after.set_state(struck);

    const double end = 1e-3;
    run.simulation.run_until(end);
    after.run_until(end);
    const auto impacts = events_of(run.simulation, EventKind::impact);
    ASSERT_EQ(impacts.size(), 1U) << trial;
    const Eigen::Vector2d gamma_after = gamma + h * inverse * h.transpose() * expected.impulse;
    for (int row = 0; row < 2; ++row) {
      const auto at = static_cast<std::size_t>(row);
      EXPECT_NEAR(impacts[0].velocity_before[at], gamma[row], 1e-13) << trial;
      EXPECT_NEAR(impacts[0].velocity_after[at], gamma_after[row], 1e-12) << trial;
      EXPECT_NEAR(impacts[0].impulse[at], expected.impulse[row], 1e-12) << trial;
    }
    // Afterwards it flies on as one that starts with the velocities of the closed form.
    EXPECT_LE(difference(run.simulation.state(), after.state()), 1e-11) << trial;
  }
  EXPECT_GE(sticking, 3);
  EXPECT_GE(slipping, 3);
}

/// A block on a slide that goes down an incline; coordinate 0 at the start, downwards.
struct SlideScene : Scene {
  JointId slide;
};
SlideScene block_on_slide(double slope, double speed) {
  SlideScene scene;
  System& system = scene.system;
  system.add(Gravity{{0.0, -g}});
  const Vec<2> down(std::cos(slope), -std::sin(slope));
  scene.bodies.push_back(
      system.add(RigidBody{.mass = box(2.0, 0.2, 0.1), .position = {1.0, 2.0}, .velocity = speed * down}));
  scene.slide = system.add(Prismatic{.from = {ground, {1.0, 2.0}}, .to = scene.bodies[0], .axis = down});
  return scene;
}

TEST(JointStops, SlideBouncesOnItsStopUntilItRests) {
  // The bouncing ball: after the first impact at t1 with speed v they follow each other by 2 e^k v/a, all of
  // them within t1 + 2 v e/(a (1 - e)).
  const double slope = 0.4, e = 0.6, way = 0.5, a = g * std::sin(slope);
  SlideScene scene = block_on_slide(slope, 0.0);
  const JointId stop = scene.system.add(Stop{.joint = scene.slide, .upper = way, .restitution = e}, "bumper");
  WatchedRun run(scene);
  const double v = std::sqrt(2.0 * a * way), first = v / a, last = first + 2.0 * v * e / (a * (1.0 - e));
  run.simulation.run_until(first + 0.3 * v / a);
  const double since = 0.3 * v / a, up = e * v;
  EXPECT_NEAR(run.simulation.state().coordinate(scene.slide), way - up * since + 0.5 * a * since * since,
              1e-11);
  EXPECT_NEAR(run.simulation.state().rate(scene.slide), -up + a * since, 1e-11);
  run.simulation.run_until(3.0);
  const auto impacts = events_of(run.simulation, EventKind::impact);
  ASSERT_GE(impacts.size(), 10U);
  double time = first, speed = v;
  for (std::size_t i = 0; i < 10; ++i) {
    EXPECT_NEAR(impacts[i].time, time, 1e-10) << i;
    EXPECT_NEAR(impacts[i].velocity_before[0], -speed, 1e-10) << i;
    EXPECT_NEAR(impacts[i].impulse[0], 2.0 * (1.0 + e) * speed, 1e-10) << i;
    EXPECT_EQ(impacts[i].contact.a.serial, stop.serial);
    speed *= e;
    time += 2.0 * speed / a;
  }
  const auto accumulations = events_of(run.simulation, EventKind::accumulation);
  ASSERT_EQ(accumulations.size(), 1U);
  // Captured at 1e-4 m/s, the last hops take 2 (1e-4)/(a (1 - e)) = 1.3e-4 s.
  EXPECT_NEAR(accumulations[0].time, last, 1.4e-4);
  EXPECT_NEAR(accumulations[0].accumulation_time, last, 1e-9);
  EXPECT_EQ(run.simulation.state().rate(scene.slide), 0.0);
  EXPECT_NEAR(run.simulation.state().coordinate(scene.slide), way, 1e-14);
  EXPECT_NEAR(run.simulation.energy().lost(), 2.0 * a * way, 1e-10);
}

TEST(JointStops, BetweenTwoStops) {
  const double e = 0.8, way = 0.3;
  SlideScene scene = block_on_slide(0.0, 2.0);
  scene.system.add(Stop{.joint = scene.slide, .lower = -way, .upper = way, .restitution = e});
  WatchedRun run(scene);
  run.simulation.run_until(2.0);
  const auto impacts = events_of(run.simulation, EventKind::impact);
  double speed = 2.0, time = way / speed;
  std::size_t expected = 0;
  for (; time < 2.0; ++expected) {
    ASSERT_LT(expected, impacts.size());
    EXPECT_NEAR(impacts[expected].time, time, 1e-12);
    EXPECT_NEAR(impacts[expected].velocity_after[0], e * speed, 1e-12);
    speed *= e;
    time += 2.0 * way / speed;
  }
  EXPECT_GE(expected, 4U);
  EXPECT_EQ(impacts.size(), expected);
}

TEST(JointStops, PinnedRodStopsByItsAngle) {
  // As the rod that falls on a floor, but the impulse is a moment: I (1 + e) w.
  const double e = 0.7;
  Scene scene = rod_pendulum(1);
  const JointId pin = scene.system.joints()[0];
  scene.system.add(Stop{.joint = pin, .lower = -std::asin(0.5), .restitution = e});
  WatchedRun run(scene);
  run.simulation.run_until(6.0);
  const auto impacts = events_of(run.simulation, EventKind::impact);
  ASSERT_GE(impacts.size(), 3U);
  double spin = std::sqrt(1.5 * g);
  for (std::size_t i = 0; i < 3; ++i, spin *= e) {
    EXPECT_NEAR(impacts[i].velocity_before[0], -spin, 1e-10);
    EXPECT_NEAR(impacts[i].velocity_after[0], e * spin, 1e-10);
    EXPECT_NEAR(impacts[i].impulse[0], (1.0 + e) * spin / 3.0, 1e-10);
  }
  EXPECT_EQ(events_of(run.simulation, EventKind::accumulation).size(), 1U);
  EXPECT_NEAR(run.simulation.state().coordinate(pin), -std::asin(0.5), 1e-14);
  EXPECT_EQ(run.simulation.state().rate(pin), 0.0);
  EXPECT_NEAR(run.simulation.energy().lost(), 0.25 * g, 1e-10);
}

TEST(JointStops, RestsUntilItIsPulledAway) {
  // The motor presses on the stop until t = 1/2, then x = -(1/m) times the double integral of cos(pi t).
  SlideScene scene = block_on_slide(0.0, 0.0);
  const double pi = std::numbers::pi;
  scene.system.add(Stop{.joint = scene.slide, .upper = 0.0, .restitution = 0.5});
  scene.system.add(Motor{.joint = scene.slide,
                         .torque = [pi](double t, double, double) { return 3.0 * std::cos(pi * t); }});
  WatchedRun run(scene);
  run.simulation.run_until(0.45);
  EXPECT_EQ(run.simulation.state().coordinate(scene.slide), 0.0);
  EXPECT_EQ(run.simulation.state().rate(scene.slide), 0.0);
  run.simulation.run_until(1.0);
  const auto lifts = events_of(run.simulation, EventKind::lift_off);
  ASSERT_EQ(lifts.size(), 1U);
  EXPECT_NEAR(lifts[0].time, 0.5, 1e-10);
  EXPECT_NEAR(run.simulation.state().rate(scene.slide), -1.5 / pi, 1e-10);
  EXPECT_NEAR(run.simulation.state().coordinate(scene.slide), 1.5 * (1.0 / pi / pi - 0.5 / pi), 1e-10);
}

TEST(JointStops, SliderCrankHitsAStop) {
  // The slider meets a stop when the crank has turned by about 1.5 rad.
  const double e = 0.5;
  const Scene free = slider_crank();
  Scene scene = free;
  const JointId guide = scene.system.joint("guide");
  scene.system.add(Stop{.joint = guide, .lower = -0.2, .restitution = e});
  EventDriven options = fine();
  options.interval = 1e-3;
  WatchedRun run(scene, options);
  run.simulation.run_until(0.025);
  const auto impacts = events_of(run.simulation, EventKind::impact);
  ASSERT_GE(impacts.size(), 1U);
  const EventRecord& impact = impacts[0];

  // Up to the impact the free mechanism moves alike.
  Simulation without(free.system, options);
  without.run_until(impact.time);
  const State at = without.state();
  EXPECT_NEAR(at.coordinate(guide), -0.2, 1e-12);
  const auto data = carom_test::reference_data("smooth_planar.json").at("slider_crank").at("parameters");
  const auto number = [&](const char* name) { return data.at(name).get<double>(); };
  const Vec<2> a = turned(at.angle(free.bodies[0]), {0.5 * number("l1"), 0.0});
  const Vec<2> b = turned(at.angle(free.bodies[1]), {0.5 * number("l2"), 0.0});
  DenseMechanism dense(3);
  dense.body(0, number("m1"), number("J1"));
  dense.body(1, number("m2"), number("J2"));
  dense.body(2, number("m3"), 1e-4);
  dense.pin(DenseMechanism::fixed, Vec<2>::Zero(), 0, -a);
  dense.pin(0, a, 1, -b);
  dense.pin(1, b, 2, Vec<2>::Zero());
  DenseMechanism::Rows slides = DenseMechanism::Rows::Zero(2, 9);
  slides(0, 7) = slides(1, 8) = 1.0;
  dense.constrain(slides);
  const DenseMechanism::Rows h = dense.point(2, Vec<2>::Zero()).row(0);
  const Eigen::VectorXd before = velocities(at, free.bodies);
  const Eigen::VectorXd answer = dense.inverse_mass() * h.transpose();
  const double gamma = (h * before)(0), impulse = -(1.0 + e) * gamma / (h * answer)(0);
  EXPECT_NEAR(impact.velocity_before[0], gamma, 1e-10);
  EXPECT_NEAR(impact.velocity_after[0], -e * gamma, 1e-10);
  EXPECT_NEAR(impact.impulse[0], impulse, 1e-11);

  State struck = at;
  set_velocities(struck, free.bodies, before + answer * impulse);
  without.set_state(struck);
  const double later = impact.time + 2e-3;
  ASSERT_TRUE(impacts.size() == 1 || impacts[1].time > later);
  Simulation with(scene.system, options);
  with.run_until(later);
  without.run_until(later);
  EXPECT_LE(difference(with.state(), without.state()), 1e-9);
}

TEST(JointImpacts, OneCoefficientEverywhereNeverGainsEnergy) {
  carom_test::Random random(7);
  std::int64_t impacts = 0;
  for (int trial = 0; trial < 20; ++trial) {
    const double e = random.uniform(0.0, 0.95), mu = random.uniform(0.0, 0.8);
    Scene scene = rod_pendulum(2 + trial % 3);
    System& system = scene.system;
    const std::vector<JointId> pins = system.joints();
    for (const JointId pin : pins) {
      const double range = random.uniform(0.3, 1.0);
      system.add(Stop{.joint = pin, .lower = -range, .upper = range, .restitution = e});
    }
    for (const BodyId body : scene.bodies) system.add(Point{.body = body, .position = {0.5, 0.0}});
    system.add(
        HalfPlane{.point = {0.0, -random.uniform(0.7, 1.5)}, .normal = incline(random.uniform(-0.15, 0.15))},
        Surface{.friction = mu, .normal_restitution = e, .tangential_restitution = e});
    WatchedRun run(scene, {.relative_tolerance = 1e-10, .absolute_tolerance = 1e-11});
    double least = run.simulation.energy().total();
    run.simulation.observe([&](const Simulation& now) {
      // Gravity and impacts only; the flow keeps the energy to its tolerance.
      EXPECT_LE(now.energy().total(), least + 1e-7) << trial;
      least = std::min(least, now.energy().total());
    });
    try {
      run.simulation.run_until(2.0);
    } catch (const SolverError& error) {
      ADD_FAILURE() << trial << ": " << error.what();
    }
    EXPECT_EQ(run.simulation.statistics().energy_gains, 0) << trial;
    impacts += run.simulation.statistics().impacts;
  }
  EXPECT_GE(impacts, 100);
}

}  // namespace
