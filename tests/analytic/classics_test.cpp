// Classics of mechanics with impact and friction, against their closed forms.

#include <carom/carom.h>

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

namespace {

using namespace carom;
using namespace carom::planar;

constexpr double pi = std::numbers::pi, g = 9.81;
// Event-driven runs have 1e-9 relative to each unknown in a step; what follows from some ten steps and events
// is known to this.
constexpr double by_events = 1e-8;

TimeStepping located(double step) { return {.step = step, .impacts = ImpactTimes::located}; }

// Impacts whose normal is not upright, with an impulse: those that are counted.
int count_impacts(const Simulation& simulation) {
  int count = 0;
  for (const ContactRecord& contact : simulation.report().contacts) {
    if (contact.impact && std::abs(contact.normal[0]) > 0.5 && contact.impulse[0] > 0.0) ++count;
  }
  return count;
}

// Two discs and a wall with the ratio of masses 100^k: the number of impacts has the first digits of pi, and
// the velocities follow from the reflections of one ray in a wedge (G. Galperin, Playing pool with pi, Regul.
// Chaotic Dyn. 8 (2003) 375-394).
TEST(Classics, GalperinsBilliardCountsPi) {
  for (const bool event_driven : {true, false}) {
    for (const auto& [ratio, impacts] : {std::pair{1.0, 3}, std::pair{100.0, 31}, std::pair{1e4, 314}}) {
      System system;
      system.set_default_law(Surface{.friction = 0.0, .normal_restitution = 1.0});
      system.add(HalfPlane{.normal = {1.0, 0.0}}, "wall");
      const BodyId light = system.add(RigidBody{.mass = disc(1.0, 0.1), .position = {1.0, 0.0}});
      const BodyId heavy =
          system.add(RigidBody{.mass = disc(ratio, 0.1), .position = {2.0, 0.0}, .velocity = {-1.0, 0.0}});
      for (const BodyId body : {light, heavy}) system.add(Disc{.body = body, .radius = 0.1});
      const Mode mode = event_driven ? Mode(EventDriven{}) : Mode(located(1e-3));  // ten impacts in a step
      Simulation simulation(system, mode);
      int count = 0;
      simulation.observe([&](const Simulation& of) { count += count_impacts(of); });
      simulation.run_until(8.0);  // the last one is at the wall, at 0.17 m/s
      EXPECT_EQ(count, impacts) << ratio;
      // Every impact turns (V sqrt(M), v sqrt(m)) by the angle of the wedge and reflects it.
      const double angle = (impacts % 2 == 0 ? impacts : impacts + 1) * std::atan(std::sqrt(1.0 / ratio));
      EXPECT_NEAR(simulation.state().velocity(heavy)[0], -std::cos(angle), 1e-11);
      EXPECT_NEAR(std::abs(simulation.state().velocity(light)[0]),
                  std::abs(std::sqrt(ratio) * std::sin(angle)), 1e-9);
    }
  }
}

// A regular polygon that rolls down an incline on its corners, without rebound and without slip: an impact
// leaves eta = (J + m l^2 cos(2 pi/n))/(J + m l^2) of its spin, and the steps in between give back what that
// takes (T. McGeer, Passive dynamic walking, Int. J. Robot. Res. 9 (1990) 62-82; M. J. Coleman, thesis,
// Cornell 1998, rimless wheel).
TEST(Classics, RimlessWheelRollsAtItsSteadySpeed) {
  constexpr int n = 8;
  constexpr double mass = 1.0, inertia = 0.5, l = 1.0, slope = 0.2;
  System system;
  system.add(Gravity{{g * std::sin(slope), -g * std::cos(slope)}});
  system.add(HalfPlane{.normal = {0.0, 1.0}}, Surface{.friction = 3.0, .normal_restitution = 0.0});
  const double half = pi / n, spin = 2.0;
  const BodyId wheel =
      system.add(RigidBody{.mass = {.mass = mass, .inertia = inertia},
                           .position = {0.0, l * std::cos(half)},
                           .velocity = {spin * l * std::cos(half), spin * l * std::sin(half)},
                           .spin = -spin});
  std::vector<Vec<2>> corners;
  for (int i = 0; i < n; ++i) {
    const double angle = -0.5 * pi + half * (2 * i + 1);
    corners.emplace_back(l * std::cos(angle), l * std::sin(angle));
  }
  system.add(Polygon{.body = wheel, .vertices = corners});
  Simulation simulation(system, EventDriven{});
  simulation.run_until(12.0);
  const double about_corner = inertia + mass * l * l;
  const double eta = (inertia + mass * l * l * std::cos(2.0 * half)) / about_corner;
  double before = 0.0;
  std::int64_t instant = -1;
  int impacts = 0;
  for (const EventRecord& event : simulation.events()) {
    if (event.kind != EventKind::impact || event.instant == instant) continue;
    instant = event.instant;
    before = event.motions[0].velocity_before[2];
    EXPECT_NEAR(event.motions[0].velocity_after[2] / before, eta, by_events);
    ++impacts;
  }
  EXPECT_GT(impacts, 25);
  // The way to the steady speed shrinks by eta^2 in each step: 0.65^30 = 2e-6.
  const double steady =
      std::sqrt(4.0 * mass * g * l * std::sin(half) * std::sin(slope) / (about_corner * (1.0 - eta * eta)));
  EXPECT_NEAR(-before, steady, 1e-5);
}

// An eccentric disc of constant spin lifts a flat follower on a preloaded spring: y = R + a sin(theta), and
// the follower leaves it where m y'' + m g + F0 + k (y - R) = 0, sin(theta) = (F0 + m g)/((m w^2 - k) a).
// Then it is an oscillator until it meets the disc again.
struct Cam {
  double spin = 120.0, eccentricity = 0.01, radius = 0.04, mass = 0.5, stiffness = 2000.0, preload = 10.0;

  double height(double t) const { return radius + eccentricity * std::sin(spin * t); }
  double rate(double t) const { return eccentricity * spin * std::cos(spin * t); }
  double jump() const {
    const double inertial = (mass * spin * spin - stiffness) * eccentricity;
    return std::asin((preload + mass * g) / inertial) / spin;
  }
  // Height of the follower in the air.
  double flight(double t) const {
    const double w = std::sqrt(stiffness / mass), rest = radius - (preload + mass * g) / stiffness;
    const double since = t - jump();
    return rest + (height(jump()) - rest) * std::cos(w * since) + rate(jump()) / w * std::sin(w * since);
  }
  double landing() const {
    const double step = 0.01 / spin;
    double late = 0.5 * pi / spin;
    while (flight(late) > height(late)) late += step;
    double early = late - step;
    for (int i = 0; i < 60; ++i) {
      const double middle = 0.5 * (early + late);
      (flight(middle) > height(middle) ? early : late) = middle;
    }
    return late;
  }
  System system() const {
    System system;
    system.add(Gravity{{0.0, -g}});
    PrescribedMotion turning;
    turning.angle = [w = spin](double t) { return w * t; };
    turning.spin = [w = spin](double) { return w; };
    turning.angular_acceleration = [](double) { return 0.0; };
    system.add(Peg{.centre = {eccentricity, 0.0}, .radius = radius, .motion = turning},
               Surface{.friction = 0.3, .normal_restitution = 0.0}, "cam");
    const BodyId follower = system.add(
        RigidBody{.mass = box(mass, 0.4, 0.04), .position = {0.0, height(0.0)}, .velocity = {0.0, rate(0.0)}},
        "follower");
    system.add(Segment{.body = follower, .from = {-0.2, 0.0}, .to = {0.2, 0.0}});
    system.add(Prismatic{.from = ground, .to = follower, .axis = {0.0, 1.0}});
    system.add(SpringDamper{.from = {ground, {0.0, radius + 1.0}},
                            .to = follower,
                            .stiffness = stiffness,
                            .free_length = 1.0 + preload / stiffness});
    return system;
  }
};

TEST(Classics, FollowerLeavesItsCamAndMeetsItAgain) {
  const Cam cam;
  Simulation simulation(cam.system(), EventDriven{.longest_step = 1e-3});
  simulation.run_until(cam.landing() + 1e-3);
  ASSERT_EQ(simulation.statistics().events[static_cast<std::size_t>(EventKind::lift_off)], 1);
  for (const EventRecord& event : simulation.events()) {
    if (event.kind == EventKind::lift_off) {
      EXPECT_NEAR(event.time, cam.jump(), by_events);
    } else if (event.kind == EventKind::impact) {
      EXPECT_NEAR(event.time, cam.landing(), by_events);
    }
  }
  // Steps of 1e-5 s of second order: (w h)^2 = 1.4e-6 of the flight, which is 0.04 s long.
  Simulation stepped(cam.system(), located(1e-5));
  double met = 0.0;
  stepped.observe([&](const Simulation& of) {
    for (const ContactRecord& contact : of.report().contacts) {
      if (contact.impact && met == 0.0) met = contact.time;
    }
  });
  stepped.run_until(cam.landing() + 1e-3);
  EXPECT_NEAR(met, cam.landing(), 5e-8);
}

// Dominoes without friction between them, e = 0: the wave goes on while those behind it come to lie flat on
// each other. When the first two did, at 4e-7 m/s, all were stopped with them, at 20 rad/s, and the energy of
// the wave, 2 mJ, was booked as that of slow impacts. These, slower than 1e-4 m/s, have ½ m v^2 = 5e-11 J
// each.
TEST(Classics, DominoesThatComeToLieDoNotStopTheWave) {
  constexpr int count = 14;
  constexpr double height = 0.041, width = 0.0076, apart = 0.02, push = 4.0;
  System system;
  system.add(Gravity{{0.0, -g}});
  system.set_default_law(Surface{.friction = 0.0, .normal_restitution = 0.0});
  system.add(HalfPlane{.normal = {0.0, 1.0}}, Surface{.friction = 2.0, .normal_restitution = 0.0});
  for (int i = 0; i < count; ++i) {
    const double spin = i == 0 ? push : 0.0;  // about its lower corner
    const BodyId domino = system.add(RigidBody{.mass = box(0.01, width, height),
                                               .position = {i * (width + apart), 0.5 * height},
                                               .velocity = 0.5 * spin * Vec<2>(height, width),
                                               .spin = -spin});
    system.add(Polygon{.body = domino,
                       .vertices = {{-0.5 * width, -0.5 * height},
                                    {0.5 * width, -0.5 * height},
                                    {0.5 * width, 0.5 * height},
                                    {-0.5 * width, 0.5 * height}}});
  }
  Simulation simulation(system, EventDriven{});
  simulation.run_until(0.72);
  EXPECT_LT(simulation.energy().flow(EnergyFlow::accumulation), 1e-7);
}

// A plate under which a peg turns is as high after a second as before, though each place of the peg goes
// down: it sank by R w^2 h t, 0.2 m. What is left is of third order in w h = 0.02, (w h)^3 R per radian of
// the turn.
TEST(Classics, NothingSinksOnAPegThatSpins) {
  constexpr double spin = 20.0, radius = 0.5;
  for (const TimeStepping& mode : {TimeStepping{.step = 1e-3}, located(1e-3)}) {
    System system;
    system.add(Gravity{{0.0, -g}});
    PrescribedMotion turning;
    turning.angle = [](double t) { return spin * t; };
    turning.spin = [](double) { return spin; };
    system.add(Peg{.radius = radius, .motion = turning}, Surface{.friction = 0.3, .normal_restitution = 0.0});
    const BodyId plate = system.add(RigidBody{.mass = box(1.0, 1.0, 0.1), .position = {0.0, radius}});
    system.add(Segment{.body = plate, .from = {-0.5, 0.0}, .to = {0.5, 0.0}});
    system.add(Prismatic{.from = ground, .to = plate, .axis = {0.0, 1.0}});
    Simulation simulation(system, mode);
    simulation.run_until(1.0);
    EXPECT_NEAR(simulation.state().position(plate)[1], radius, 4e-5);
    // The work of the spin is that of friction, mu m g R w.
    EXPECT_NEAR(simulation.energy().flow(EnergyFlow::external), 0.3 * g * radius * spin, 3e-3);
  }
}

// A disc that rolls against a step of the height s, without rebound and slip: it turns about the edge with
// w' = v/r (1 - m r s/(J + m r^2)), and comes up if (J + m r^2) w'^2/2 > m g s.
TEST(Classics, DiscRollsUpAStepFromItsLeastSpeedOn) {
  constexpr double r = 0.1, s = 0.03, mass = 1.0, inertia = 0.5 * mass * r * r;
  constexpr double about_edge = inertia + mass * r * r;
  const double least = r * std::sqrt(2.0 * mass * g * s / about_edge) / (1.0 - mass * r * s / about_edge);
  for (const double share : {0.999, 1.001}) {
    const double v = share * least;
    System system;
    system.add(Gravity{{0.0, -g}});
    system.add(Terrain{.vertices = {{-5.0, 0.0}, {0.0, 0.0}, {0.0, s}, {5.0, s}}, .depth = 0.5},
               Surface{.friction = 8.0, .normal_restitution = 0.0});
    const double before_edge = std::sqrt(r * r - (r - s) * (r - s));
    const BodyId wheel = system.add(RigidBody{.mass = {.mass = mass, .inertia = inertia},
                                              .position = {-before_edge - 0.05, r},
                                              .velocity = {v, 0.0},
                                              .spin = -v / r});
    system.add(Disc{.body = wheel, .radius = r});
    Simulation simulation(system, EventDriven{});
    simulation.run_until(3.0);
    EXPECT_EQ(simulation.state().position(wheel)[0] > 0.0, share > 1.0);
    for (const EventRecord& event : simulation.events()) {
      if (event.kind != EventKind::impact || !(event.impulse[0] > 0.0)) continue;
      EXPECT_NEAR(event.time, 0.05 / v, by_events);
      EXPECT_NEAR(-event.motions[0].velocity_after[2], v / r * (1.0 - mass * r * s / about_edge), by_events);
      break;
    }
  }
}

// A ladder without friction leaves the wall when its top has come down to two thirds of its height, and goes
// on with the horizontal velocity that it has there (textbooks; S. Kapranidis and R. Koo, Variations of the
// sliding ladder problem, Coll. Math. J. 39 (2008) 374-379).
TEST(Classics, LadderLeavesTheWallAtTwoThirds) {
  constexpr double length = 3.0, start = 0.5;  // [rad] from the wall
  System system;
  system.add(Gravity{{0.0, -g}});
  system.set_default_law(Surface{.friction = 0.0, .normal_restitution = 0.0});
  system.add(HalfPlane{.normal = {0.0, 1.0}}, "floor");
  const ObstacleId wall = system.add(HalfPlane{.normal = {1.0, 0.0}}, "wall");
  const BodyId ladder =
      system.add(RigidBody{.mass = rod(5.0, length),
                           .position = 0.5 * length * Vec<2>(std::sin(start), std::cos(start)),
                           .angle = std::atan2(-std::cos(start), std::sin(start))});
  system.add(Segment{.body = ladder, .from = {-0.5 * length, 0.0}, .to = {0.5 * length, 0.0}});
  Simulation simulation(system, EventDriven{});
  simulation.run_until(1.0);
  bool left = false;
  for (const EventRecord& event : simulation.events()) {
    if (event.kind != EventKind::lift_off || event.obstacle != wall) continue;
    EXPECT_NEAR(2.0 * event.motions[0].position[1], length * std::cos(start) * 2.0 / 3.0, by_events);
    left = true;
  }
  EXPECT_TRUE(left);
  const double speed =
      length / 3.0 * std::cos(start) * std::sqrt(g / length * std::cos(start));  // l/2 cos(th) th'
  EXPECT_NEAR(simulation.state().velocity(ladder)[0], speed, by_events);
}

// Two flywheels and a clutch of the torque M: they lock after (w1 - w2)/(M (1/J1 + 1/J2)).
TEST(Classics, ClutchLocksFlywheels) {
  constexpr double j1 = 1.0, j2 = 0.01, w1 = 10.0, w2 = -3.0, torque = 0.5;
  const double locked = (w1 - w2) / (torque * (1.0 / j1 + 1.0 / j2)), w = (j1 * w1 + j2 * w2) / (j1 + j2);
  for (const bool event_driven : {true, false}) {
    System system;
    const BodyId one = system.add(RigidBody{.mass = {.mass = 1.0, .inertia = j1}, .spin = w1});
    const BodyId two = system.add(RigidBody{.mass = {.mass = 1.0, .inertia = j2}, .spin = w2});
    system.add(Revolute{.from = ground, .to = one});
    const JointId clutch = system.add(Revolute{.from = one, .to = two});
    system.add(JointFriction{.joint = clutch, .bound = torque, .static_factor = 1.5});
    const Mode mode = event_driven ? Mode(EventDriven{}) : Mode(TimeStepping{.step = 1e-3});
    Simulation simulation(system, mode);
    simulation.run_until(0.6);
    for (const EventRecord& event : simulation.events()) {
      if (event.kind == EventKind::stick) {
        EXPECT_NEAR(event.time, locked, by_events);
      }
    }
    for (const BodyId body : {one, two}) EXPECT_NEAR(simulation.state().spin(body), w, 1e-11);
    EXPECT_NEAR(simulation.energy().flow(EnergyFlow::joint_friction),
                0.5 * j1 * j2 / (j1 + j2) * (w1 - w2) * (w1 - w2), 1e-10);
  }
}

// A superball between two plates, with both restitutions 1: each bounce turns the velocity u of the point
// that touches round, by the impulse -2 u/(1/m + r^2/J) (R. L. Garwin, Kinematics of an ultraelastic rough
// ball, Am. J. Phys. 37 (1969) 88-92). After three it comes back.
TEST(Classics, SuperballComesBack) {
  constexpr double r = 0.05, share = 0.4, vx = 1.5, vy = 2.0;  // J = share m r^2
  for (const bool event_driven : {true, false}) {
    System system;
    system.set_default_law(
        Surface{.friction = 100.0, .normal_restitution = 1.0, .tangential_restitution = 1.0});
    system.add(HalfPlane{.normal = {0.0, 1.0}}, "floor");
    system.add(HalfPlane{.point = {0.0, 1.0}, .normal = {0.0, -1.0}}, "ceiling");
    const BodyId ball = system.add(RigidBody{.mass = {.mass = 0.1, .inertia = share * 0.1 * r * r},
                                             .position = {0.0, 0.5},
                                             .velocity = {vx, -vy}});
    system.add(Disc{.body = ball, .radius = r});
    const Mode mode = event_driven ? Mode(EventDriven{}) : Mode(located(1e-2));
    Simulation simulation(system, mode);
    double v = vx, spin_r = 0.0, x = vx * 0.45 / vy;
    for (int bounce = 0; bounce < 3; ++bounce) {
      const double side = bounce % 2 == 0 ? 1.0 : -1.0,
                   change = -2.0 * (v + side * spin_r) / (1.0 + 1.0 / share);
      v += change;
      spin_r += side * change / share;
      x += v * (bounce < 2 ? 0.9 : 0.45) / vy;
    }
    simulation.run_until(2.7 / vy);
    EXPECT_LT(v, 0.0);
    EXPECT_NEAR(simulation.state().velocity(ball)[0], v, 1e-12);
    EXPECT_NEAR(simulation.state().spin(ball) * r, spin_r, 1e-12);
    EXPECT_NEAR(simulation.state().position(ball)[0], x, 1e-11);
  }
}

// A block on a belt and a spring, with mu_s > mu_k: with D = (mu_s - mu_k) m g/k and w^2 = k/m it sticks for
// 2 D/V and slides for 2/w (pi - atan(w D/V)), with the amplitude sqrt(D^2 + V^2/w^2) (J. P. Den Hartog,
// Mechanical Vibrations, chapter 7; R. I. Leine et al., Nonlinear Dyn. 16 (1998) 41-54).
TEST(Classics, StickSlipHasItsPeriod) {
  constexpr double mass = 2.0, k = 1000.0, belt = 0.05, at_rest = 0.6, sliding = 0.2;
  System system;
  system.add(Gravity{{0.0, -g}});
  system.add(HalfPlane{.normal = {0.0, 1.0}, .surface_speed = belt},
             Surface{.friction = sliding, .normal_restitution = 0.0, .static_friction = at_rest}, "belt");
  const BodyId block = system.add(Particle{.mass = mass, .velocity = {belt, 0.0}}, "block");
  system.add(SpringDamper{.from = {ground, {-1.0, 0.0}}, .to = block, .stiffness = k, .free_length = 1.0});
  Simulation simulation(system, EventDriven{});
  simulation.run_until(2.0);
  const double w = std::sqrt(k / mass), drop = (at_rest - sliding) * mass * g / k;
  const double slides = 2.0 / w * (pi - std::atan(w * drop / belt)), sticks = 2.0 * drop / belt;
  double stuck = 0.0, slipped = 0.0;
  int periods = 0;
  for (const EventRecord& event : simulation.events()) {
    if (event.kind == EventKind::slip) {
      if (stuck > 0.0) {
        EXPECT_NEAR(event.time - stuck, sticks, by_events);
      }
      slipped = event.time;
    } else if (event.kind == EventKind::stick) {
      EXPECT_NEAR(event.time - slipped, slides, by_events);
      stuck = event.time;
      ++periods;
    }
  }
  EXPECT_GE(periods, 2);
}

}  // namespace
