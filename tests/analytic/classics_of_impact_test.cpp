// More classics of mechanics with impact and friction: impact oscillators, billiards, pendulums at a wall,
// moving ground, each against its closed form.

#include <carom/carom.h>

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace {

using namespace carom;
using namespace carom::planar;

constexpr double pi = std::numbers::pi, g = 9.81;
// Event-driven runs have 1e-9 relative to each unknown in a step; what follows from some ten steps and events
// is known to this.
constexpr double by_events = 1e-8;

// Flights under constant loads and their ends are exact in these modes, to rounding.
std::array<Mode, 2> exact_in_flight() {
  return {Mode(EventDriven{}), Mode(TimeStepping{.step = 2e-3, .impacts = ImpactTimes::located})};
}

// An oscillator that is driven against a stop at x = 0, once in each period of the drive, undamped: with
// x = a cos(w0 t) + b sin(w0 t) + p cos(w t) - q sin(w t) between impacts, x(0) = x(T) = 0 and x'(0) = -e
// x'(T) give b/a, q/a and p = -a (S. W. Shaw and P. J. Holmes, A periodically forced piecewise linear
// oscillator, J. Sound Vib. 90 (1983) 129-155).
TEST(ClassicsOfImpact, DrivenOscillatorAtAStopHasItsPeriodicOrbit) {
  constexpr double mass = 1.0, k = 100.0, force = 20.0, w0 = 10.0, w = 28.0, e = 0.6, period = 2.0 * pi / w;
  const double b_of_a = (1.0 - std::cos(w0 * period)) / std::sin(w0 * period);
  const double q_of_a = b_of_a * w0 / w * (1.0 - e) / (1.0 + e);
  const double driven = force / mass / (w0 * w0 - w * w);  // sqrt(p^2 + q^2), with its sign
  const double a = driven / std::sqrt(1.0 + q_of_a * q_of_a);
  const double phase = std::atan2(q_of_a * a / driven, -a / driven);
  const double start = a * (b_of_a * w0 - q_of_a * w);
  ASSERT_LT(start, 0.0);
  System system;
  system.set_default_law(Surface{.friction = 0.0, .normal_restitution = e});
  system.add(HalfPlane{.normal = {-1.0, 0.0}});
  const BodyId body = system.add(Particle{.mass = mass, .velocity = {start, 0.0}});
  system.add(SpringDamper{.from = {ground, {-5.0, 0.0}}, .to = body, .stiffness = k, .free_length = 5.0});
  system.add(AppliedForce{.on = body,
                          .force = [=](double t) { return Vec<2>(force * std::cos(w * t + phase), 0.0); }});
  Simulation simulation(system, EventDriven{});
  simulation.run_until(5.5 * period);
  int impacts = 0;
  for (const EventRecord& event : simulation.events()) {
    if (event.kind != EventKind::impact || !(event.impulse[0] > 0.0)) continue;
    ++impacts;
    EXPECT_NEAR(event.time, impacts * period, by_events);
    EXPECT_NEAR(event.velocity_after[0], -start, 10.0 * by_events);  // 25 m/s^2 of acceleration there
  }
  EXPECT_EQ(impacts, 5);
}

// A driven mass with dry friction F that never sticks: its amplitude is P/k sqrt(V^2 - (F/P)^2 U^2) with
// V = 1/(1 - r^2), U = sin(pi/r)/(r (1 + cos(pi/r))), r = w/w0 (J. P. Den Hartog, Forced vibrations with
// combined Coulomb and viscous friction, Trans. ASME 53 (1931) 107-115). Friction of a joint and of ground.
TEST(ClassicsOfImpact, DryFrictionOscillatorHasDenHartogsAmplitude) {
  constexpr double mass = 1.0, k = 100.0, force = 20.0, friction = 6.0, w0 = 10.0, ratio = 0.7;
  constexpr double w = ratio * w0;
  const double v = 1.0 / (1.0 - ratio * ratio);
  const double u = std::sin(pi / ratio) / (ratio * (1.0 + std::cos(pi / ratio)));
  const double amplitude = force / k * std::sqrt(v * v - friction * friction / (force * force) * u * u);
  // At its turning point: p = amplitude, q = -F/k U of the drive's part.
  const double phase = std::atan2(-friction / k * u, amplitude);
  for (const bool of_joint : {true, false}) {
    System system;
    const BodyId body = system.add(RigidBody{.mass = box(mass, 0.4, 0.2), .position = {amplitude, 0.0}});
    if (of_joint) {
      const JointId guide = system.add(Prismatic{.from = ground, .to = body, .axis = {1.0, 0.0}});
      system.add(JointFriction{.joint = guide, .bound = friction});
    } else {
      system.add(Gravity{{0.0, -g}});
      system.add(HalfPlane{.point = {0.0, -0.1}, .normal = {0.0, 1.0}},
                 Surface{.friction = friction / (mass * g), .normal_restitution = 0.0});
      for (const double x : {-0.2, 0.2}) system.add(Point{.body = body, .position = {x, -0.1}});
    }
    system.add(SpringDamper{.from = {ground, {-5.0, 0.0}}, .to = body, .stiffness = k, .free_length = 5.0});
    system.add(AppliedForce{.on = body,
                            .force = [=](double t) { return Vec<2>(force * std::cos(w * t + phase), 0.0); }});
    Simulation simulation(system, EventDriven{});
    for (int half = 1; half <= 8; ++half) {
      simulation.run_until(half * pi / w);
      EXPECT_NEAR(simulation.state().position(body)[0], half % 2 == 0 ? amplitude : -amplitude, by_events);
    }
  }
}

// A ball between a wall and one that comes nearer at V gains 2 V at each impact there, and flies on straight
// lines in between (S. Ulam, On some statistical properties of dynamical systems, 4th Berkeley Symp. (1961)
// 315-320).
TEST(ClassicsOfImpact, BallBetweenConvergingWallsGainsItsSpeed) {
  constexpr double approach = 0.2, v0 = 1.1, end = 3.0;
  for (const Mode& mode : exact_in_flight()) {
    System system;
    system.set_default_law(Surface{.friction = 0.0, .normal_restitution = 1.0});
    system.add(HalfPlane{.normal = {1.0, 0.0}});
    PrescribedMotion coming;
    coming.displacement = [](double t) { return Vec<2>(-approach * t, 0.0); };
    coming.velocity = [](double) { return Vec<2>(-approach, 0.0); };
    coming.acceleration = [](double) { return Vec<2>(0.0, 0.0); };
    system.add(HalfPlane{.point = {1.0, 0.0}, .normal = {-1.0, 0.0}, .motion = coming});
    const BodyId ball = system.add(Particle{.mass = 0.3, .position = {0.5, 0.0}, .velocity = {v0, 0.0}});
    // From wall to wall: x = L_k after k impacts at the moving wall, and back by the other one, 2 L_k away.
    double v = v0, hit = 0.5 / (v0 + approach), place = 1.0 - approach * hit, next = 0.0;
    for (;;) {
      v += 2.0 * approach;
      next = hit + 2.0 * place / (v + approach);
      if (next > end) break;
      hit = next;
      place = 1.0 - approach * hit;
    }
    const double left = place - v * (end - hit);  // negative: behind the mirror of the wall at rest
    Simulation simulation(system, mode);
    simulation.run_until(end);
    EXPECT_NEAR(simulation.state().position(ball)[0], std::abs(left), 1e-12);
    EXPECT_NEAR(simulation.state().velocity(ball)[0], left > 0.0 ? -v : v, 1e-13);
  }
}

// A ball that falls into a wedge of 90 degrees: along each side it is a ball of its own that bounces under
// g/sqrt(2) (H. E. Lehtihet and B. N. Miller, Numerical study of a billiard in a gravitational field,
// Physica D 21 (1986) 93-104: integrable there). Two half-planes, and a terrain with its inner corner.
TEST(ClassicsOfImpact, WedgeBilliardOf90DegreesIsTwoBalls) {
  const double c = std::sqrt(0.5), fall = g * c, end = 2.9;
  const std::array<Vec<2>, 2> sides{Vec<2>(c, c), Vec<2>(-c, c)};
  const std::array<double, 2> place{0.3, 0.5}, speed{0.4, -0.9};
  for (const Mode& mode : exact_in_flight()) {
    for (const bool terrain : {false, true}) {
      System system;
      system.add(Gravity{{0.0, -g}});
      system.set_default_law(Surface{.friction = 0.0, .normal_restitution = 1.0});
      if (terrain) {
        system.add(Terrain{.vertices = {{-5.0, 5.0}, {0.0, 0.0}, {5.0, 5.0}}, .depth = 1.0});
      } else {
        for (const Vec<2>& normal : sides) system.add(HalfPlane{.normal = normal});
      }
      const BodyId ball = system.add(Particle{.mass = 0.7,
                                              .position = place[0] * sides[0] + place[1] * sides[1],
                                              .velocity = speed[0] * sides[0] + speed[1] * sides[1]});
      Simulation simulation(system, mode);
      simulation.run_until(end);
      for (std::size_t i = 0; i < 2; ++i) {
        const double fastest = std::sqrt(speed[i] * speed[i] + 2.0 * fall * place[i]);
        const double since = std::fmod(end - (speed[i] + fastest) / fall, 2.0 * fastest / fall);
        EXPECT_NEAR(simulation.state().position(ball).dot(sides[i]),
                    fastest * since - 0.5 * fall * since * since, 1e-11);
        EXPECT_NEAR(simulation.state().velocity(ball).dot(sides[i]), fastest - fall * since, 1e-11);
      }
    }
  }
}

// A pendulum that hits a wall where it hangs: its speed there falls by e each time, with the sine of half its
// amplitude, and it is away for half a period, 2 K(k e^n)/w0. A disc at a wall, and a stop of the pin.
TEST(ClassicsOfImpact, PendulumAtAWallComesBackAfterHalfPeriods) {
  constexpr double mass = 1.0, length = 0.8, inertia = 0.03, e = 0.8, start = 1.1, radius = 0.1;
  const double w0 = std::sqrt(mass * g * length / (inertia + mass * length * length));
  for (const bool stop : {true, false}) {
    System system;
    system.add(Gravity{{0.0, -g}});
    const BodyId bob = system.add(RigidBody{.mass = {.mass = mass, .inertia = inertia},
                                            .position = length * Vec<2>(std::sin(start), -std::cos(start)),
                                            .angle = start});
    const JointId pin = system.add(Revolute{.from = ground, .to = {bob, {0.0, length}}, .zero_angle = 0.0});
    if (stop) {
      system.add(Stop{.joint = pin, .lower = 0.0, .restitution = e});
    } else {
      system.add(HalfPlane{.point = {-radius, 0.0}, .normal = {1.0, 0.0}},
                 Surface{.friction = 0.0, .normal_restitution = e});
      system.add(Disc{.body = bob, .radius = radius});
    }
    Simulation simulation(system, EventDriven{});
    simulation.run_until(6.0);
    double k = std::sin(0.5 * start), time = std::comp_ellint_1(k) / w0;
    int impacts = 0;
    for (const EventRecord& event : simulation.events()) {
      if (event.kind != EventKind::impact || !(event.impulse[0] > 0.0)) continue;
      EXPECT_NEAR(event.time, time, by_events);
      EXPECT_NEAR(event.motions[0].velocity_before[2], -2.0 * w0 * k, by_events);
      k *= e;
      time += 2.0 * std::comp_ellint_1(k) / w0;
      ++impacts;
    }
    EXPECT_GE(impacts, 5);
  }
}

// Atwood's machine with a stop under the heavier mass: all turn round with e, and it bounces under
// (m1 - m2) g/(m1 + m2 + J/r^2) like a ball. The racks on both sides of the pulley have redundant rows.
TEST(ClassicsOfImpact, AtwoodsMachineBouncesOnItsStop) {
  constexpr double m1 = 2.0, m2 = 1.5, r = 0.1, inertia = 0.01, e = 0.5, drop = 0.3;
  constexpr double a = (m1 - m2) * g / (m1 + m2 + inertia / (r * r));
  for (const Mode& mode : exact_in_flight()) {
    System system;
    system.add(Gravity{{0.0, -g}});
    const BodyId pulley = system.add(RigidBody{.mass = {.mass = 0.7, .inertia = inertia}});
    const BodyId heavy = system.add(RigidBody{.mass = box(m1, 0.1, 0.1), .position = {-r, -1.0}});
    const BodyId light = system.add(RigidBody{.mass = box(m2, 0.1, 0.1), .position = {r, -1.0}});
    system.add(Revolute{.from = ground, .to = pulley});
    const JointId guide =
        system.add(Prismatic{.from = {ground, {-r, -1.0}}, .to = heavy, .axis = {0.0, 1.0}});
    system.add(Prismatic{.from = {ground, {r, -1.0}}, .to = light, .axis = {0.0, 1.0}});
    system.add(Rolling{.from = heavy, .to = pulley, .normal = {1.0, 0.0}, .radius = r});
    system.add(Rolling{.from = light, .to = pulley, .normal = {-1.0, 0.0}, .radius = r});
    system.add(Stop{.joint = guide, .lower = -drop, .restitution = e});
    Simulation simulation(system, mode);
    const double fast = std::sqrt(2.0 * a * drop), landed = fast / a * (1.0 + 2.0 * e), since = 0.1;
    simulation.run_until(landed + since);  // in the second flight
    const double v = e * e * fast - a * since, y = -drop + e * e * fast * since - 0.5 * a * since * since;
    EXPECT_NEAR(simulation.state().velocity(heavy)[1], v, 1e-11);
    EXPECT_NEAR(simulation.state().position(heavy)[1], -1.0 + y, 1e-11);
    EXPECT_NEAR(simulation.state().position(light)[1], -1.0 - y, 1e-11);
    EXPECT_NEAR(simulation.state().spin(pulley), -v / r, 1e-10);
  }
}

// A ball that goes down stairs, once on each tread: v^2 = 2 g rise/(1 - e^2) before each impact.
TEST(ClassicsOfImpact, BallGoesDownStairsInItsPeriodicOrbit) {
  constexpr double rise = 0.2, tread = 0.3, e = 0.7, r = 0.02;
  const double down = std::sqrt(2.0 * g * rise / (1.0 - e * e)), period = (1.0 + e) * down / g;
  for (const Mode& mode : exact_in_flight()) {
    System system;
    system.add(Gravity{{0.0, -g}});
    system.set_default_law(Surface{.friction = 0.0, .normal_restitution = e});
    system.add(stairs({0.0, 0.0}, 14, tread, -rise));
    const BodyId ball = system.add(RigidBody{
        .mass = disc(0.1, r), .position = {0.13 - tread, r}, .velocity = {tread / period, e * down}});
    system.add(Disc{.body = ball, .radius = r});
    Simulation simulation(system, mode);
    for (int step = 1; step <= 10; ++step) {
      simulation.run_until((step - 0.5) * period);
      const double since = 0.5 * period;
      EXPECT_NEAR(simulation.state().position(ball)[1],
                  r - (step - 1) * rise + e * down * since - 0.5 * g * since * since, 1e-11);
      EXPECT_NEAR(simulation.state().position(ball)[0], 0.13 - tread + (step - 0.5) * tread, 1e-11);
    }
  }
}

// A body falls on a buffer and through it to a stop, which leaves e of its speed; then the buffer gives back
// what it took, so that the body rises to a height of its own. Under step control the flight before may have
// made steps so long that buffer and stop are in one: it was taken as it was, whatever the tolerance, and a
// smaller one brought nothing.
TEST(ClassicsOfImpact, StepControlResolvesABufferAroundAnImpact) {
  constexpr double mass = 1.3, k = 200.0, from = 1.2, length = 0.5, stop = 0.38, e = 0.6, dip = length - stop;
  constexpr double speed2 = 2.0 * g * (from - stop) - k / mass * dip * dip;
  constexpr double top = stop + (e * e * speed2 + k / mass * dip * dip) / (2.0 * g);
  for (const double tolerance : {1e-6, 1e-8, 1e-10}) {
    System system;
    system.add(Gravity{{0.0, -g}});
    system.add(HalfPlane{.point = {0.0, stop}, .normal = {0.0, 1.0}},
               Surface{.friction = 0.0, .normal_restitution = e});
    const BodyId body = system.add(Particle{.mass = mass, .position = {0.0, from}});
    system.add(Bumper{.from = ground, .to = body, .stiffness = k, .free_length = length});
    Simulation simulation(system, TimeStepping{.impacts = ImpactTimes::located,
                                               .control = StepControl{.tolerance = tolerance}});
    simulation.run_until(0.6);  // on its way up again
    const double v = simulation.state().velocity(body)[1];
    // The error of a run goes with tolerance^(2/3), 1e-4 m at 1e-6 m, times some number of steps that are not
    // smooth: at both ends of the buffer, and at the stop.
    EXPECT_NEAR(simulation.state().position(body)[1] + v * v / (2.0 * g), top,
                4.0 * std::pow(tolerance, 2.0 / 3.0))
        << tolerance;
  }
}

// A ball without rebound on a table of 1.3 g leaves it and lands in each period. Steps with a landing were
// kept however long they were: after five periods it was 1e-4 m beside the table at a tolerance of 1e-8 m.
TEST(ClassicsOfImpact, StepControlFollowsABallThatLandsOnAVibratingTable) {
  constexpr double w = 30.0, amplitude = 1.3 * g / (w * w), end = 1.0;
  for (const double tolerance : {1e-6, 1e-8, 1e-10}) {
    System system;
    system.add(Gravity{{0.0, -g}});
    PrescribedMotion shaking;
    shaking.displacement = [](double t) { return Vec<2>(0.0, amplitude * std::sin(w * t)); };
    shaking.velocity = [](double t) { return Vec<2>(0.0, amplitude * w * std::cos(w * t)); };
    shaking.acceleration = [](double t) { return Vec<2>(0.0, -amplitude * w * w * std::sin(w * t)); };
    system.add(HalfPlane{.normal = {0.0, 1.0}, .motion = shaking},
               Surface{.friction = 0.3, .normal_restitution = 0.0});
    const BodyId ball = system.add(Particle{.mass = 0.2, .velocity = {0.0, amplitude * w}});
    Simulation simulation(system, TimeStepping{.impacts = ImpactTimes::located,
                                               .control = StepControl{.tolerance = tolerance}});
    simulation.run_until(end);  // when the table is low, and the ball on it
    EXPECT_NEAR(simulation.state().position(ball)[1], amplitude * std::sin(w * end),
                std::pow(tolerance, 2.0 / 3.0))
        << tolerance;
  }
}

// Ball on a table that shakes sinusoidally: the exact map from one impact to the next. Orbits of one impact a
// period are stable for pi (1 - e)/(1 + e) < G < sqrt((pi (1 - e)/(1 + e))^2 + (2 (1 + e^2)/(1 + e)^2)^2), G
// the acceleration of the table over g: 1.047 and 1.527 for e = 1/2. Behind it periods double (P. J. Holmes,
// The dynamics of repeated impacts with a sinusoidally vibrating table, J. Sound Vib. 84 (1982) 173-189).
struct TableMap {
  double amplitude, frequency, e;

  [[nodiscard]] double height(double t) const { return amplitude * std::sin(frequency * t); }
  [[nodiscard]] double speed(double t) const { return amplitude * frequency * std::cos(frequency * t); }
  /// From an impact at t with the velocity v behind it to the next one, by bisection.
  void go_on(double& t, double& v) const {
    const auto gap = [&](double since) {
      return height(t) + v * since - 0.5 * g * since * since - height(t + since);
    };
    double before = 1e-3 / frequency, after = before;
    for (; gap(after) > 0.0; after += 1e-3 / frequency) before = after;
    for (int halving = 0; halving < 60; ++halving) {
      const double middle = 0.5 * (before + after);
      (gap(middle) > 0.0 ? before : after) = middle;
    }
    t += after;
    v = -e * (v - g * after) + (1.0 + e) * speed(t);
  }
};

TEST(ClassicsOfImpact, BallOnAVibratingTableFollowsTheMapOfItsImpacts) {
  constexpr double e = 0.5, w = 40.0, period = 2.0 * pi / w, off = 1e-3;
  constexpr int impacts = 60;
  for (const double acceleration : {1.1, 1.3, 1.45, 1.6}) {
    const TableMap map{acceleration * g / (w * w), w, e};
    // Behind an impact of the orbit of one impact a period, a millisecond late.
    const double start = std::acos(pi * (1.0 - e) / ((1.0 + e) * acceleration)) / w + off;
    for (const Mode& mode : exact_in_flight()) {
      System system;
      system.add(Gravity{{0.0, -g}});
      PrescribedMotion shaking;
      shaking.displacement = [=](double t) { return Vec<2>(0.0, map.height(t + start)); };
      shaking.velocity = [=](double t) { return Vec<2>(0.0, map.speed(t + start)); };
      shaking.acceleration = [=](double t) { return Vec<2>(0.0, -w * w * map.height(t + start)); };
      system.add(HalfPlane{.normal = {0.0, 1.0}, .motion = shaking},
                 Surface{.friction = 0.0, .normal_restitution = e});
      const BodyId ball = system.add(
          Particle{.mass = 0.2, .position = {0.0, map.height(start)}, .velocity = {0.0, 0.5 * g * period}});
      Simulation simulation(system, mode);
      double t = start, v = 0.5 * g * period, last = 0.0, before_last = 0.0;
      for (int impact = 1; impact <= impacts; ++impact) {
        before_last = last;
        last = t;
        map.go_on(t, v);
        const double since = 1e-3;  // no impact is as near to the next
        simulation.run_until(t + since - start);
        // Flights and their ends are exact; rounding grows by what one impact makes of the error of the
        // last.
        EXPECT_NEAR(simulation.state().position(ball)[1], map.height(t) + v * since - 0.5 * g * since * since,
                    1e-11)
            << acceleration << ", impact " << impact;
      }
      const double difference = std::abs((t - last) - (last - before_last));
      EXPECT_EQ(difference <= 1e-6 * period, acceleration < 1.527) << difference / period;
    }
  }
}

}  // namespace
