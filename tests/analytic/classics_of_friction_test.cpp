// Classics of dry friction and of contact that lasts, against their closed forms, in each mode.

#include "tests/integrators/event_driven/body_scenes.h"

#include <carom/carom.h>

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

namespace {

using namespace carom;
using namespace carom::planar;
using body_scenes::add_box, body_scenes::add_disc, body_scenes::corners_of, body_scenes::g;

// Event-driven runs have 1e-9 relative to each unknown in a step; what follows from some ten steps and events
// is known to this.
constexpr double by_events = 1e-8;
// Motions of constant forces: steps have no error, rounding alone.
constexpr double by_rounding = 1e-11;

std::vector<Mode> modes(double step) {
  return {Mode(EventDriven{}), Mode(TimeStepping{.step = step}),
          Mode(TimeStepping{.step = step, .impacts = ImpactTimes::located})};
}

Surface rough(double friction) { return {.friction = friction, .normal_restitution = 0.0}; }

void push(System& system, BodyId body, const Vec<2>& force) {
  system.add(AppliedForce{.on = body, .force = [force](double) { return force; }});
}

// The first event of a kind; fails where there is none.
EventRecord first(const Simulation& simulation, EventKind kind) {
  for (const EventRecord& event : simulation.events()) {
    if (event.kind == kind) return event;
  }
  ADD_FAILURE() << "no " << to_string(kind);
  return {};
}

// A uniform ladder with friction at floor and wall stands where tan(angle) >= (1 - mu nu)/(2 mu).
TEST(ClassicsOfFriction, LadderStandsFromItsAngleOn) {
  constexpr double length = 3.0, mu = 0.3, nu = 0.4;
  const double critical = std::atan((1.0 - mu * nu) / (2.0 * mu));
  for (const double beyond : {1e-6, -1e-6}) {
    for (const Mode& mode : modes(2.5e-3)) {
      const double angle = critical + beyond;
      System system;
      system.add(Gravity{{0.0, -g}});
      system.add(HalfPlane{.normal = {0.0, 1.0}}, rough(mu), "floor");
      system.add(HalfPlane{.normal = {1.0, 0.0}}, rough(nu), "wall");
      const Vec<2> middle = 0.5 * length * Vec<2>(std::cos(angle), std::sin(angle));
      const BodyId ladder =
          system.add(RigidBody{.mass = rod(5.0, length), .position = middle, .angle = -angle});
      system.add(Segment{.body = ladder, .from = {-0.5 * length, 0.0}, .to = {0.5 * length, 0.0}});
      Simulation simulation(system, mode);
      simulation.run_until(0.5);
      const double turned = simulation.state().angle(ladder) + angle;
      // It begins with a'' = (g/l) 1e-6 or so: t^2/2 later it has turned by some 1e-6.
      if (beyond > 0.0) {
        EXPECT_NEAR(turned, 0.0, by_rounding);
      } else {
        EXPECT_GT(turned, 1e-7);
        EXPECT_LT(turned, 1e-5);
      }
    }
  }
}

// A rod that falls over on a rough floor: while its foot sticks, F/(m g) = 3/4 sin(a) (3 cos(a) - 2 cos(a0))
// and N/(m g) = 1 - 3/4 sin^2(a) - 3/2 cos(a) (cos(a0) - cos(a)). It slips backward below mu = 0.37, forward
// above (textbooks; T. McGeer and L. H. Palmer, Wobbling, toppling, and forces of contact, Am. J. Phys. 57
// (1989) 1089-1098).
TEST(ClassicsOfFriction, FootOfAFallingRodSlipsAtItsAngle) {
  constexpr double length = 1.0, start = 0.05;
  for (const double mu : {0.3, 0.5}) {
    System system;
    system.add(Gravity{{0.0, -g}});
    system.add(HalfPlane{.normal = {0.0, 1.0}}, rough(mu));
    const BodyId body =
        system.add(RigidBody{.mass = rod(1.0, length),
                             .position = 0.5 * length * Vec<2>(std::sin(start), std::cos(start)),
                             .angle = std::atan2(std::cos(start), std::sin(start))});
    system.add(Segment{.body = body, .from = {-0.5 * length, 0.0}, .to = {0.5 * length, 0.0}});
    Simulation simulation(system, EventDriven{});
    simulation.run_until(1.0);
    const EventMotion at = first(simulation, EventKind::slip).motions[0];
    const double s = std::cos(at.position[2]), c = std::sin(at.position[2]), c0 = std::cos(start);
    const double along = 0.75 * s * (3.0 * c - 2.0 * c0), normal = 1.0 - 0.75 * s * s - 1.5 * c * (c0 - c);
    EXPECT_NEAR(along, (mu < 0.37 ? mu : -mu) * normal, by_events);
  }
}

// A disc that rolls over the edge of a table: while it rolls w^2 = w0^2 + 4 g/(3 r) (1 - cos(a)), and it
// slips where m g sin(a)/3 = mu N, N = m g cos(a) - m r w^2.
TEST(ClassicsOfFriction, DiscRollsOverAnEdgeUntilItSlips) {
  constexpr double r = 0.3, speed = 0.3, mu = 0.4;
  System system;
  system.add(Gravity{{0.0, -g}});
  system.add(Block{.vertices = {{-3.0, 0.0}, {-3.0, -2.0}, {0.0, -2.0}, {0.0, 0.0}}}, rough(mu));
  add_disc(system, 1.0, r, {-0.05, r}, {speed, 0.0}, -speed / r);
  Simulation simulation(system, EventDriven{});
  simulation.run_until(0.75);
  const EventMotion at = first(simulation, EventKind::slip).motions[0];
  const double s = at.position[0] / r, c = at.position[1] / r;
  const double spin = std::sqrt(speed * speed / (r * r) + 4.0 * g / (3.0 * r) * (1.0 - c));
  EXPECT_NEAR(-at.velocity_before[2], spin, by_events);
  EXPECT_NEAR(g * s / 3.0, mu * (g * c - r * spin * spin), by_events);
  first(simulation, EventKind::lift_off);
}

// A block slides down a wedge that slides on the floor, without friction: the wedge has
// A = m g sin(a) cos(a)/(M + m sin^2(a)), the block along it (M + m) g sin(a)/(M + m sin^2(a)). The block
// lies on the wedge to rounding, and where rounding had opened that gap it fell for a step (1.8e-4 m here).
TEST(ClassicsOfFriction, WedgeGivesWayUnderABlock) {
  constexpr double slope = 0.5, heavy = 3.0, light = 1.0, end = 0.4, width = 2.0;
  const Vec<2> down(std::cos(slope), -std::sin(slope)), out(std::sin(slope), std::cos(slope));
  const double s = down[1] * -1.0, inertial = heavy + light * s * s, height = width * std::tan(slope);
  for (const Mode& mode : modes(1e-2)) {
    System system;
    system.add(Gravity{{0.0, -g}});
    system.set_default_law(rough(0.0));
    system.add(HalfPlane{.normal = {0.0, 1.0}});
    const Vec<2> centre(width / 3.0, height / 3.0);
    const BodyId wedge = system.add(RigidBody{.mass = {.mass = heavy, .inertia = 1.0}, .position = centre});
    const std::vector<Vec<2>> corners = {-centre, Vec<2>(width, 0.0) - centre, Vec<2>(0.0, height) - centre};
    system.add(Polygon{.body = wedge, .vertices = corners});
    const Vec<2> place = Vec<2>(0.0, height) + 0.3 * down + 0.05 * out;
    const BodyId block =
        system.add(RigidBody{.mass = box(light, 0.2, 0.1), .position = place, .angle = -slope});
    system.add(Polygon{.body = block, .vertices = corners_of(0.2, 0.1)});
    Simulation simulation(system, mode);
    simulation.run_until(end);
    const double back = light * g * s * down[0] / inertial * 0.5 * end * end;
    const double along = (heavy + light) * g * s / inertial * 0.5 * end * end;
    EXPECT_NEAR(simulation.state().position(wedge)[0], centre[0] - back, by_rounding);
    const Vec<2> expected = place - Vec<2>(back, 0.0) + along * down;
    EXPECT_NEAR((simulation.state().position(block) - expected).norm(), 0.0, by_rounding);
  }
}

// Of two blocks that lie on each other the lower one is pulled: both stay up to mu (m + M) g, go together up
// to (mu + nu) (m + M) g, and then the lower one is drawn from under the other.
TEST(ClassicsOfFriction, LowerBlockIsDrawnFromUnderTheOther) {
  constexpr double lower_mass = 2.0, upper_mass = 1.0, between = 0.3, below = 0.2, end = 0.5;
  constexpr double both = lower_mass + upper_mass, moves = below * both * g,
                   slips = (below + between) * both * g;
  for (const double pull : {0.99 * moves, 1.01 * moves, 0.99 * slips, 1.01 * slips}) {
    for (const Mode& mode : modes(1e-2)) {
      System system;
      system.add(Gravity{{0.0, -g}});
      const MaterialId floor = system.material("floor"), wood = system.material("wood");
      system.between(floor, wood, rough(below));
      system.between(wood, wood, rough(between));
      system.add(HalfPlane{.normal = {0.0, 1.0}, .material = floor});
      const auto add_block = [&](double mass, double width, double y) {
        const BodyId block = system.add(RigidBody{.mass = box(mass, width, 0.2), .position = {0.0, y}});
        system.add(Polygon{.body = block, .vertices = corners_of(width, 0.2), .material = wood});
        return block;
      };
      const BodyId lower = add_block(lower_mass, 2.0, 0.1), upper = add_block(upper_mass, 0.3, 0.3);
      push(system, lower, {pull, 0.0});
      Simulation simulation(system, mode);
      simulation.run_until(end);
      double first = pull > moves ? (pull - moves) / both : 0.0, second = first;
      if (pull > slips) second = between * g, first = (pull - moves - between * upper_mass * g) / lower_mass;
      EXPECT_NEAR(simulation.state().position(lower)[0], 0.5 * first * end * end, by_rounding);
      EXPECT_NEAR(simulation.state().position(upper)[0], 0.5 * second * end * end, by_rounding);
    }
  }
}

// A plank on two rollers is pulled: each roller has half its velocity and adds 3/8 of its mass.
TEST(ClassicsOfFriction, PlankGoesOnRollers) {
  constexpr double plank_mass = 4.0, roller_mass = 1.0, r = 0.1, pull = 3.0, end = 0.6;
  for (const Mode& mode : modes(1e-2)) {
    System system;
    system.add(Gravity{{0.0, -g}});
    system.set_default_law(rough(0.8));
    system.add(HalfPlane{.normal = {0.0, 1.0}});
    const BodyId plank = add_box(system, plank_mass, 2.0, 0.1, {0.0, 2.0 * r + 0.05});
    for (const double x : {-0.5, 0.1}) add_disc(system, roller_mass, r, {x, r});
    push(system, plank, {pull, 0.0});
    Simulation simulation(system, mode);
    simulation.run_until(end);
    const double acceleration = pull / (plank_mass + 2.0 * 3.0 / 8.0 * roller_mass);
    EXPECT_NEAR(simulation.state().position(plank)[0], 0.5 * acceleration * end * end, by_rounding);
    EXPECT_NEAR(simulation.state().angle(plank), 0.0, by_rounding);
  }
}

// A box on ground that is accelerated tips from a = g b/h on, if mu > b/h, and slides from mu g on else.
TEST(ClassicsOfFriction, BoxTipsOrSlidesOnAcceleratedGround) {
  constexpr double width = 0.4, height = 1.0, end = 0.5;
  for (const auto& [mu, share] : {std::pair{0.5, 0.999}, {0.5, 1.001}, {0.3, 1.3}}) {
    for (const Mode& mode : modes(1e-2)) {
      System system;
      system.add(Gravity{{0.0, -g}});
      const double a = share * g * width / height;
      PrescribedMotion motion;
      motion.displacement = [a](double t) { return Vec<2>(0.5 * a * t * t, 0.0); };
      motion.velocity = [a](double t) { return Vec<2>(a * t, 0.0); };
      motion.acceleration = [a](double) { return Vec<2>(a, 0.0); };
      system.add(HalfPlane{.normal = {0.0, 1.0}, .motion = motion}, rough(mu));
      const BodyId body = add_box(system, 2.0, width, height, {0.0, 0.5 * height});
      Simulation simulation(system, mode);
      simulation.run_until(end);
      if (mu > width / height && share > 1.0) {
        // (J + m r^2) a'' = m g b/2 (share - 1) at first, 8e-3 rad/s^2.
        EXPECT_GT(simulation.state().angle(body), 5e-4);
      } else {
        EXPECT_NEAR(simulation.state().angle(body), 0.0, by_rounding);
        const double x = 0.5 * std::min(a, mu * g) * end * end;
        EXPECT_NEAR(simulation.state().position(body)[0], x, by_rounding);
      }
    }
  }
}

// A disc in a right-angled groove turns under a torque from M = mu r m g sqrt(2)/(1 + mu^2) on.
TEST(ClassicsOfFriction, DiscInAGrooveTurnsFromItsTorqueOn) {
  constexpr double mu = 0.3, r = 0.2, mass = 2.0, end = 0.5;
  const double least = mu * r * mass * g * std::sqrt(2.0) / (1.0 + mu * mu);
  for (const double share : {0.999, 1.001, 1.5}) {
    for (const Mode& mode : modes(1e-2)) {
      System system;
      system.add(Gravity{{0.0, -g}});
      for (const double side : {1.0, -1.0}) system.add(HalfPlane{.normal = {side, 1.0}}, rough(mu));
      const BodyId body = add_disc(system, mass, r, {0.0, r * std::sqrt(2.0)});
      system.add(AppliedTorque{.on = body, .torque = [=](double) { return share * least; }});
      Simulation simulation(system, mode);
      simulation.run_until(end);
      const double spin = std::max(share - 1.0, 0.0) * least / (0.5 * mass * r * r) * end;
      EXPECT_NEAR(simulation.state().spin(body), spin, by_rounding);
    }
  }
}

// Bricks that overhang by the harmonic series (1/2, 1/4, 1/6 ... of their length) stand if each reaches a
// little less far, and fall if the lowest reaches beyond. In time stepping those that stand fell, or sank
// into each other, where rounding had opened their gaps.
TEST(ClassicsOfFriction, BricksOverhangByTheHarmonicSeries) {
  constexpr int count = 6;
  constexpr double length = 1.0, height = 0.1;
  for (const double lowest : {0.99, 1.1}) {  // of the others 0.99
    for (const Mode& mode : modes(1e-2)) {
      System system;
      system.add(Gravity{{0.0, -g}});
      system.set_default_law(rough(0.6));
      system.add(Block{.vertices = {{-2.0, -1.0}, {0.0, -1.0}, {0.0, 0.0}, {-2.0, 0.0}}});
      double x = -0.5 * length;
      BodyId top;
      for (int k = 0; k < count; ++k) {
        x += length / (2.0 * (count - k)) * (k == 0 ? lowest : 0.99);
        top = add_box(system, 1.0, length, height, {x, height * (k + 0.5)});
      }
      Simulation simulation(system, mode);
      simulation.run_until(1.0);
      const double sunk = height * (count - 0.5) - simulation.state().position(top)[1];
      if (lowest < 1.0) {
        // Contacts are solved to 1e-10 of their velocities, m g h: 1e-11 m in each of 100 steps at the most.
        EXPECT_NEAR(sunk, 0.0, 1e-9);
      } else {
        EXPECT_GT(sunk, 0.05);
      }
    }
  }
}

// A wedge under a load holds by itself if its angle is at most twice that of friction; else it is driven out,
// while friction acts on both of its faces: with e = (sin - mu cos)/(cos + mu sin) of the angle a it has
// A = g (e M - mu (M + m))/(m + (e - mu) M tan(a)).
// In time stepping it was driven out below that angle where rounding had opened its gaps (by 0.3 mm here).
TEST(ClassicsOfFriction, WedgeHoldsByItsFriction) {
  constexpr double mu = 0.2, end = 0.05, light = 0.1, heavy = 50.0;
  for (const double beyond : {-1e-4, 0.02}) {
    for (const Mode& mode : modes(1e-2)) {
      const double angle = 2.0 * std::atan(mu) + beyond, height = std::tan(angle);
      System system;
      system.add(Gravity{{0.0, -g}});
      system.set_default_law(rough(mu));
      system.add(HalfPlane{.normal = {0.0, 1.0}});
      const Vec<2> centre(2.0 / 3.0, height / 3.0);
      const BodyId wedge =
          system.add(RigidBody{.mass = {.mass = light, .inertia = 0.01}, .position = centre});
      system.add(Polygon{.body = wedge,
                         .vertices = {-centre, Vec<2>(1.0, 0.0) - centre, Vec<2>(1.0, height) - centre}});
      const Vec<2> from = 0.5 * Vec<2>(std::cos(angle), std::sin(angle)), to = 1.8 * from, up(0.0, 0.5);
      const Vec<2> middle = 0.5 * (from + to + up);
      const BodyId load = system.add(RigidBody{.mass = {.mass = heavy, .inertia = 1.0}, .position = middle});
      system.add(Polygon{.body = load,
                         .vertices = {from - middle, to - middle, to + up - middle, from + up - middle}});
      system.add(Prismatic{.from = {ground, middle}, .to = load, .axis = {0.0, 1.0}});
      Simulation simulation(system, mode);
      simulation.run_until(end);
      const double out = simulation.state().position(wedge)[0] - centre[0];
      const double s = std::sin(angle), c = std::cos(angle), e = (s - mu * c) / (c + mu * s);
      const double acceleration = g * (e * heavy - mu * (heavy + light)) / (light + (e - mu) * heavy * s / c);
      const double driven = beyond > 0.0 ? 0.5 * acceleration * end * end : 0.0;
      EXPECT_NEAR(out, driven, by_rounding);
    }
  }
}

// A lever that is pressed on a drum: N (b -+ mu p) = F L, with the pivot p above the place of contact. The
// drum stops after J w/(mu N r); where mu p > b it jams, and stops at once (Painleve).
TEST(ClassicsOfFriction, DrumBrakeStopsItsDrum) {
  constexpr double r = 0.3, inertia = 0.5, press = 20.0, b = 0.5, length = 1.2, p = 0.2, thick = 0.1;
  for (const auto& [spin, mu] : {std::pair{10.0, 0.5}, {-10.0, 0.5}, {10.0, 2.4}, {10.0, 2.6}}) {
    System system;
    system.set_default_law(rough(mu));
    const BodyId drum =
        system.add(RigidBody{.mass = {.mass = 10.0, .inertia = inertia}, .position = {b, -r}, .spin = spin});
    system.add(Disc{.body = drum, .radius = r});
    system.add(Revolute{.from = {ground, {b, -r}}, .to = drum});
    const BodyId lever = add_box(system, 2.0, length, thick, {0.5 * length, 0.5 * thick});
    system.add(Revolute{.from = {ground, {0.0, p}}, .to = {lever, {-0.5 * length, p - 0.5 * thick}}});
    system.add(AppliedForce{.on = {lever, {0.5 * length, 0.0}},
                            .force = [](double) { return Vec<2>(0.0, -press); }});
    Simulation simulation(system, EventDriven{});
    simulation.run_until(2.0);
    const double arm = b - std::copysign(mu, spin) * p;
    const double time = arm > 0.0 ? inertia * std::abs(spin) * arm / (mu * press * length * r) : 0.0;
    EXPECT_NEAR(simulation.state().spin(drum), 0.0, by_rounding);
    EXPECT_NEAR(simulation.state().angle(drum), 0.5 * spin * time, by_events);
    EXPECT_NEAR(simulation.state().angle(lever), 0.0, by_rounding);
  }
}

// A particle on a smooth plane that turns steadily: r'' = w^2 r - g sin(w t), which has the solution
// r = A cosh(w t) + B sinh(w t) + g/(2 w^2) sin(w t). Located steps are of second order: (w h)^2 of 1 m.
TEST(ClassicsOfFriction, ParticleIsDrivenOutOnAPlaneThatTurns) {
  constexpr double w = 0.8, start = 1.0, speed = 1.5, end = 0.5;
  for (const Mode& mode : {Mode(EventDriven{.longest_step = 0.02}),
                           Mode(TimeStepping{.step = 1e-3, .impacts = ImpactTimes::located})}) {
    System system;
    system.add(Gravity{{0.0, -g}});
    PrescribedMotion turning;
    turning.angle = [](double t) { return w * t; };
    turning.spin = [](double) { return w; };
    turning.angular_acceleration = [](double) { return 0.0; };
    system.add(HalfPlane{.normal = {0.0, 1.0}, .motion = turning}, rough(0.0));
    const BodyId body =
        system.add(Particle{.mass = 1.0, .position = {start, 0.0}, .velocity = {speed, w * start}});
    Simulation simulation(system, mode);
    simulation.run_until(end);
    const double gravity = 0.5 * g / (w * w), fast = speed / w - gravity;
    const double r = start * std::cosh(w * end) + fast * std::sinh(w * end) + gravity * std::sin(w * end);
    const Vec<2> place = r * Vec<2>(std::cos(w * end), std::sin(w * end));
    const bool event_driven = std::holds_alternative<EventDriven>(mode);
    EXPECT_NEAR((simulation.state().position(body) - place).norm(), 0.0, event_driven ? by_events : 1e-6);
  }
}

}  // namespace
