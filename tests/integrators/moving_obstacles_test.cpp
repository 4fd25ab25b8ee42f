// Time stepping against obstacles that move as prescribed: the ledger closes with their work, a uniform
// motion cannot be told from rest, impacts on a vibrating table are where they must be.

#include "tests/allocation_counter.h"
#include "tests/energy/ledger_check.h"
#include "tests/integrators/same_run.h"
#include "tests/integrators/throws.h"
#include "tests/reference/reference_data.h"

#include <carom/carom.h>
#include <carom/contact/detection/detector.h>
#include <carom/core/assembly.h>
#include <carom/core/constraint_set.h>
#include <carom/testing/refinement.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace {

using namespace carom;
using namespace carom::planar;
using carom_test::ledger_closes;

constexpr double g = 9.81;

/// Up and down by A sin(w t), all in closed form.
PrescribedMotion vibration(double a, double w) {
  return {.displacement = [=](double t) { return Vec<2>(0.0, a * std::sin(w * t)); },
          .velocity = [=](double t) { return Vec<2>(0.0, a * w * std::cos(w * t)); },
          .acceleration = [=](double t) { return Vec<2>(0.0, -a * w * w * std::sin(w * t)); }};
}

void add_brick(System& system, const Vec<2>& position, double angle, const char* name) {
  const BodyId brick =
      system.add(RigidBody{.mass = box(1.0, 0.4, 0.2), .position = position, .angle = angle}, name);
  system.add(Polygon{.body = brick, .vertices = {{-0.2, -0.1}, {0.2, -0.1}, {0.2, 0.1}, {-0.2, 0.1}}});
}

/// A brick on a plane that swings about the origin by 0.4 rad.
System brick_on_swing(double friction) {
  System system;
  system.add(Gravity{{0.0, -g}});
  system.add(HalfPlane{.normal = {0.0, 1.0},
                       .motion = {.angle = [](double t) { return 0.4 * std::sin(3.0 * t); },
                                  .spin = [](double t) { return 1.2 * std::cos(3.0 * t); },
                                  .angular_acceleration = [](double t) { return -3.6 * std::sin(3.0 * t); }}},
             Surface{.friction = friction, .normal_restitution = 0.3}, "swing");
  add_brick(system, {0.3, 0.1}, 0.0, "brick");
  return system;
}

System ball_on_table(const PrescribedMotion& motion) {
  System system;
  system.add(Gravity{{0.0, -g}});
  system.add(HalfPlane{.normal = {0.0, 1.0}, .motion = motion},
             Surface{.friction = 0.3, .normal_restitution = 0.8, .tangential_restitution = 0.4}, "table");
  const BodyId ball = system.add(
      RigidBody{.mass = disc(0.2, 0.05), .position = {0.0, 0.2}, .velocity = {0.5, 0.0}, .spin = 20.0},
      "ball");
  system.add(Disc{.body = ball, .radius = 0.05});
  return system;
}

TEST(MovingObstacles, TheAccountClosesOnAVibratingTable) {
  for (const double step : {1e-3, 7e-3}) {
    for (const Iteration iteration : {Iteration::fixed_point, Iteration::linearly_implicit}) {
      Simulation simulation(ball_on_table(vibration(0.01, 40.0)),
                            TimeStepping{.step = step, .iteration = iteration});
      simulation.run_until(3.0);
      EXPECT_TRUE(ledger_closes(simulation.energy())) << simulation.energy();
      EXPECT_GT(simulation.statistics().impacts, 5);
      EXPECT_GT(std::abs(simulation.energy().flow(EnergyFlow::external)), 0.01);
    }
  }
}

TEST(MovingObstacles, TheAccountClosesOnASwingingPlane) {
  for (const double friction : {0.1, 1.0}) {
    Simulation simulation(brick_on_swing(friction), TimeStepping{.step = 2e-3});
    simulation.run_until(4.0);
    EXPECT_TRUE(ledger_closes(simulation.energy())) << simulation.energy();
    EXPECT_GT(simulation.statistics().contact_steps, 1000);
    EXPECT_GT(std::abs(simulation.energy().flow(EnergyFlow::external)), 0.01);
  }
}

TEST(MovingObstacles, TheAccountClosesForARodHitByATurningPlane) {
  System system;
  system.add(
      HalfPlane{.point = {-2.0, 0.0},
                .normal = {0.0, 1.0},
                .motion = {.angle = [](double t) { return 2.0 * t; }, .spin = [](double) { return 2.0; }}},
      Surface{.friction = 0.4, .normal_restitution = 0.7, .tangential_restitution = 0.7});
  const BodyId rod_ = system.add(RigidBody{.mass = rod(1.0, 1.0), .position = {0.0, 0.5}}, "rod");
  system.add(Segment{.body = rod_, .from = {-0.5, 0.0}, .to = {0.5, 0.0}});
  Simulation simulation(std::move(system), TimeStepping{.step = 1e-3});
  simulation.run_until(0.5);
  EXPECT_TRUE(ledger_closes(simulation.energy())) << simulation.energy();
  EXPECT_GE(simulation.statistics().impacts, 1);
  // All that the rod has now came from the plane, less what was lost; it flies away with an upward velocity.
  EXPECT_GT(simulation.energy().kinetic(), 0.5);
  EXPECT_NEAR(simulation.energy().flow(EnergyFlow::external),
              simulation.energy().kinetic() + simulation.energy().lost(), 1e-13);
  EXPECT_GT(simulation.state().velocity(rod_)[1], 1.0);
}

TEST(MovingObstacles, UniformMotionCannotBeToldFromRest) {
  // The same seen from a frame that moves with the table, by a ball that first bounces, then rolls and
  // slides.
  const Vec<2> frame(0.7, -0.4);
  Simulation rest(ball_on_table({}), TimeStepping{.step = 1e-3});
  Simulation moving(ball_on_table({.displacement = [frame](double t) { return Vec<2>(t * frame); },
                                   .velocity = [frame](double) { return frame; }}),
                    TimeStepping{.step = 1e-3});
  const BodyId ball = rest.system().body("ball"), same = moving.system().body("ball");
  State start = moving.state();
  start.velocity(same) = Vec<2>(Vec<2>(start.velocity(same)) + frame);
  moving.set_state(start);
  for (const double t : {0.3, 1.0, 2.0}) {
    rest.run_until(t);
    moving.run_until(t);
    const Vec<2> seen = Vec<2>(moving.state().position(same)) - t * frame;
    const Vec<2> speed = Vec<2>(moving.state().velocity(same)) - frame;
    // Rounding of positions (eps of 1 m), which each bounce passes on to a speed, over 2000 steps.
    EXPECT_LE((seen - Vec<2>(rest.state().position(ball))).norm(), 1e-12) << t;
    EXPECT_LE((speed - Vec<2>(rest.state().velocity(ball))).norm(), 1e-11) << t;
    EXPECT_NEAR(moving.state().spin(same), rest.state().spin(ball), 1e-10) << t;
  }
  EXPECT_EQ(moving.statistics().impacts, rest.statistics().impacts);
  EXPECT_GT(rest.statistics().impacts, 3);
  EXPECT_TRUE(ledger_closes(moving.energy()));
}

TEST(MovingObstacles, AStickingParticleGoesWithItsPlaceOnASwingingPlane) {
  // The velocities at the ends of steps are those of the place that is touched, so the way has the error of
  // the trapezoidal rule: order 2.
  const auto farthest_off = [](double step) {
    System system;
    system.add(Gravity{{0.0, -g}});
    system.add(HalfPlane{.normal = {0.0, 1.0},
                         .motion = {.angle = [](double t) { return 0.4 * std::sin(3.0 * t); },
                                    .spin = [](double t) { return 1.2 * std::cos(3.0 * t); }}},
               Surface{.friction = 1.5, .normal_restitution = 0.0});
    // A little inside, so that errors of the way do not open the contact.
    const Vec<2> place(0.3, -1e-4);
    const BodyId body = system.add(
        Particle{.mass = 1.0, .position = place, .velocity = Vec<2>(-1.2 * place[1], 1.2 * place[0])});
    Simulation simulation(std::move(system), TimeStepping{.step = step});
    double worst = 0.0;
    while (simulation.time() < 2.0) {
      simulation.step();
      const double turn = 0.4 * std::sin(3.0 * simulation.time());
      const Vec<2> now(std::cos(turn) * place[0] - std::sin(turn) * place[1],
                       std::sin(turn) * place[0] + std::cos(turn) * place[1]);
      worst = std::max(worst, (Vec<2>(simulation.state().position(body)) - now).norm());
    }
    return worst;
  };
  const double coarse = farthest_off(4e-3), fine = farthest_off(1e-3);
  // h^2/12 of the change of the acceleration (below 5 m/s^2).
  EXPECT_LE(coarse, 16e-6 / 12.0 * 5.0);
  EXPECT_NEAR(coarse / fine, 16.0, 2.0);
}

TEST(MovingObstacles, ImpactsOnAVibratingTableConvergeWithOrderOne) {
  // Period-1 orbit of a ball on A sin(w t), started on the way down; closed form in contacts_planar.json.
  const auto example = carom_test::reference_data("contacts_planar.json")["vibrating_table"]["example"];
  const double w = example["w"], a = example["A"], e = example["e"];
  const double impact = example["first_impact_time"], take_off = example["take_off_speed"];
  const double height = example["height_at_take_off"];
  std::vector<double> steps, late, slow;
  for (double h = 2e-3; h > 1e-5; h *= 0.55) {
    System system;
    system.add(Gravity{{0.0, -g}});
    system.add(HalfPlane{.normal = {0.0, 1.0}, .motion = vibration(a, w)},
               Surface{.friction = 0.0, .normal_restitution = e});
    const double start = height + take_off * impact - 0.5 * g * impact * impact;
    const BodyId ball = system.add(
        Particle{.mass = 1.0, .position = {0.0, start}, .velocity = {0.0, -take_off + g * impact}});
    Simulation simulation(std::move(system), TimeStepping{.step = h});
    while (simulation.statistics().impacts == 0) simulation.step();
    const double noticed = simulation.report().time - h;
    // Noticed in the first step that begins after it.
    EXPECT_GE(noticed, impact - 1e-12);
    EXPECT_LE(noticed, impact + h + 1e-12);
    const double error = std::abs(simulation.state().velocity(ball)[1] - take_off);
    // (1 + e) times the table's acceleration and twice g, over two steps at most.
    EXPECT_LE(error, 2.0 * h * ((1.0 + e) * a * w * w + 2.0 * g));
    steps.push_back(h);
    late.push_back(noticed + h - impact);
    slow.push_back(error);
  }
  // Single errors scatter with the place of the impact in its step, by a factor of a few over 10 steps that
  // span a factor of 200: slopes within 0.25 of one.
  EXPECT_NEAR(energy_test::fitted_order(steps, late), 1.0, 0.25);
  EXPECT_NEAR(energy_test::fitted_order(steps, slow), 1.0, 0.35);
}

TEST(MovingObstacles, ARestingBodyEndsEachStepWithTheTablesVelocity) {
  // A w^2 = 0.5 g: it never leaves. e = 0.
  constexpr double a = 0.005, h = 1e-3;
  const double w = std::sqrt(0.5 * g / a);
  System system;
  system.add(Gravity{{0.0, -g}});
  system.add(HalfPlane{.normal = {0.0, 1.0}, .motion = vibration(a, w)},
             Surface{.friction = 0.2, .normal_restitution = 0.0}, "table");
  const BodyId body = system.add(Particle{.mass = 1.0, .position = {0.0, -1e-5}, .velocity = {0.0, a * w}});
  Simulation simulation(std::move(system), TimeStepping{.step = h});
  for (int i = 0; i < 2000; ++i) {
    simulation.step();
    const double t = simulation.time();
    ASSERT_NEAR(simulation.state().velocity(body)[1], a * w * std::cos(w * t), 1e-14);
    // The trapezoidal rule makes h^2/12 times the change of the table's acceleration of the way.
    ASSERT_NEAR(simulation.state().position(body)[1] - a * std::sin(w * t), -1e-5, h * h / 12.0 * g);
  }
  EXPECT_TRUE(ledger_closes(simulation.energy()));
}

TEST(MovingObstacles, ABeltDragsABlock) {
  // A plane that moves along itself at 1 m/s: the block gains mu g t, then goes with the belt; the belt does
  // the work m u^2, half of which becomes heat.
  System system;
  system.add(Gravity{{0.0, -g}});
  system.add(HalfPlane{.normal = {0.0, 1.0},
                       .motion = {.displacement = [](double t) { return Vec<2>(t, 0.0); },
                                  .velocity = [](double) { return Vec<2>(1.0, 0.0); }}},
             Surface{.friction = 0.2, .normal_restitution = 0.0});
  const BodyId block = system.add(Particle{.mass = 2.0});
  Simulation simulation(std::move(system), TimeStepping{.step = 1e-3});
  simulation.run_until(0.25);
  EXPECT_NEAR(simulation.state().velocity(block)[0], 0.2 * g * 0.25, 1e-13);
  simulation.run_until(1.0);
  EXPECT_NEAR(simulation.state().velocity(block)[0], 1.0, 1e-15 * 10);
  EXPECT_NEAR(simulation.energy().flow(EnergyFlow::external), 2.0, 1e-12);
  EXPECT_NEAR(simulation.energy().flow(EnergyFlow::sliding), 1.0, 1e-12);
  EXPECT_TRUE(ledger_closes(simulation.energy()));
}

TEST(MovingObstacles, GapsAreProjectedToWhereThePlaneIs) {
  Simulation simulation(brick_on_swing(1.0), TimeStepping{.step = 2e-3, .project_gaps = true});
  Simulation without(brick_on_swing(1.0), TimeStepping{.step = 2e-3});
  const Detector detector(simulation.assembly());
  const auto depth_of = [&detector](const Simulation& run) {
    Evaluation evaluation = make_evaluation(run.assembly());
    evaluate_positions(run.assembly(), 0, run.state().view(), evaluation);
    ConstraintSet contacts;
    detector.find(0, run.state().view(), evaluation, 0.0, contacts);
    double depth = 0.0;
    for (const Constraint& contact : contacts) {
      for (const ContactRecord& record : run.report().contacts) {
        if (record.key == contact.key) depth = std::max(depth, -contact.gap);
      }
    }
    return depth;
  };
  double deepest = 0.0, deepest_without = 0.0;
  for (int i = 0; i < 1000; ++i) {
    simulation.step();
    without.step();
    deepest = std::max(deepest, depth_of(simulation));
    deepest_without = std::max(deepest_without, depth_of(without));
  }
  EXPECT_LE(deepest, 1e-13);  // rounding of coordinates
  EXPECT_GE(deepest_without, 1e-7);
  EXPECT_TRUE(ledger_closes(simulation.energy()));
}

TEST(MovingObstacles, StepControlFollowsThem) {
  Simulation controlled(
      ball_on_table(vibration(0.01, 40.0)),
      TimeStepping{.step = 1e-3, .control = StepControl{.tolerance = 1e-7, .largest = 1e-2}});
  Simulation fine(ball_on_table(vibration(0.01, 40.0)), TimeStepping{.step = 1e-5});
  // To a little after the first impact (at 0.17 s), which is noticed late by at most a step of 1e-2 s.
  controlled.run_until(0.25);
  fine.run_until(0.25);
  EXPECT_LE((Vec<2>(controlled.state().position(controlled.system().body("ball"))) -
             Vec<2>(fine.state().position(fine.system().body("ball"))))
                .norm(),
            0.05);
  EXPECT_GE(fine.statistics().impacts, 1);
  EXPECT_TRUE(ledger_closes(controlled.energy()));
}

TEST(MovingObstacles, MotionsThatAreNotFiniteEndTheStepByName) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  Simulation simulation(
      ball_on_table({.displacement = [](double) { return Vec<2>(0.0, 0.0); },
                     .velocity = [nan](double t) { return Vec<2>(0.0, t > 0.0105 ? nan : 0.0); },
                     .acceleration = [](double) { return Vec<2>(0.0, 0.0); }}),
      TimeStepping{.step = 1e-3});
  simulation.run_until(0.01);
  const auto before = carom_test::bits_of(simulation);
  EXPECT_THROWS(SolverError, simulation.step(), "t = 0.01 s", "step 0.001 s", "half-plane 'table'",
                "velocity", "at t = 0.011 s", "nan m/s", "allowed");
  EXPECT_EQ(carom_test::bits_of(simulation), before);
  try {
    simulation.step();
  } catch (const SolverError& error) {
    EXPECT_EQ(error.failure().parts, std::vector<std::string>{"half-plane 'table'"});
    EXPECT_EQ(error.failure().time, simulation.time());
  }
}

TEST(MovingObstacles, CheckpointsAndRepeatedRunsAgreeToTheBit) {
  Simulation one(brick_on_swing(0.5), TimeStepping{.step = 1e-3});
  Simulation two(brick_on_swing(0.5), TimeStepping{.step = 1e-3});
  one.run_until(1.0);
  // Jumps to and fro leave places of other times in the workspace.
  const State start = two.state();
  two.run_until(0.3);
  two.set_state(start);
  Simulation three(brick_on_swing(0.5), TimeStepping{.step = 1e-3});
  two.run_until(1.0);
  three.run_until(1.0);
  EXPECT_EQ(carom_test::bits_of(one), carom_test::bits_of(three));
  EXPECT_EQ(two.state().q, one.state().q);
  EXPECT_EQ(two.state().v, one.state().v);
}

TEST(MovingObstacles, StepsAllocateNothing) {
  Simulation simulation(brick_on_swing(0.5), TimeStepping{.step = 1e-3});
  simulation.run_until(1.0);
  const std::int64_t before = carom_test::allocations();
  for (int i = 0; i < 500; ++i) simulation.step();
  EXPECT_EQ(carom_test::allocations() - before, 0);
}

}  // namespace
