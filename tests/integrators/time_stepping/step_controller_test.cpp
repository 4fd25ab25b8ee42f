// Step control: as long as the error allows, never silently across an impact.

#include "tests/energy/ledger_check.h"
#include "tests/integrators/same_run.h"
#include "tests/model_error.h"

#include <carom/carom.h>
#include <carom/integrators/time_stepping/step_controller.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

namespace {

using namespace carom;
using namespace carom::planar;
using carom_test::ledger_closes;

/// A comet: a heavy pull near the ground's origin, its speed varying by a factor of nine.
System comet() {
  System system;
  const BodyId body = system.add(Particle{.mass = 1.0, .position = {1.8, 0.0}, .velocity = {0.0, 1.0 / 3.0}});
  system.add(NonlinearSpring{.from = ground,
                             .to = body,
                             .force = [](double r) { return 1.0 / (r * r); },
                             .potential_of = [](double r) { return -1.0 / r; }});
  return system;
}

TimeStepping controlled(double tolerance, double step = 1e-3) {
  return {.step = step, .control = StepControl{.tolerance = tolerance, .smallest = 1e-7, .largest = 0.5}};
}

struct Steps {
  double shortest = 1e300, longest = 0.0, worst = 0.0;
  int count = 0, rejected = 0;
};
Steps watch(Simulation& simulation, double until) {
  Steps steps;
  simulation.observe([&](const Simulation& now) {
    const StepReport& report = now.report();
    // The last one is cut by the end of the run.
    if (report.time < until) steps.shortest = std::min(steps.shortest, report.step);
    steps.longest = std::max(steps.longest, report.step);
    steps.worst = std::max(steps.worst, report.control.error);
    steps.rejected += report.control.rejected;
    ++steps.count;
  });
  simulation.run_until(until);
  return steps;
}

TEST(StepController, StepsFollowTheMotion) {
  // One turn takes 2 pi (semi-axis 1, unit pull).
  Simulation simulation(comet(), controlled(1e-8));
  const Steps steps = watch(simulation, 6.283);
  EXPECT_GT(steps.longest, 5.0 * steps.shortest);
  EXPECT_LE(steps.worst, 1e-8);
  EXPECT_GT(steps.worst, 1e-9);  // not shorter than needed
  EXPECT_EQ(simulation.time(), 6.283);
  EXPECT_EQ(simulation.statistics().steps, 2 * steps.count);
  EXPECT_EQ(simulation.statistics().rejected_steps, steps.rejected);
  EXPECT_EQ(simulation.statistics().steps_across_impacts, 0);
  EXPECT_TRUE(ledger_closes(simulation.energy()));
}

TEST(StepController, TheEstimateIsTheError) {
  // One step of a linear oscillator, whose truth is known: the estimate is that of the two halves.
  for (const double step : {0.02, 0.01}) {
    System system;
    const BodyId body = system.add(Particle{.mass = 1.0, .position = {1.0, 0.0}, .velocity = {0.5, 0.0}});
    system.add(SpringDamper{.from = ground, .to = body, .stiffness = 1.0});
    Simulation simulation(std::move(system), controlled(1e-3, step));
    simulation.step();
    const double exact = std::cos(step) + 0.5 * std::sin(step);
    const double speed = -std::sin(step) + 0.5 * std::cos(step);
    const double truth =
        std::max(std::abs(simulation.state().q[0] - exact), step * std::abs(simulation.state().v[0] - speed));
    // The next term of either is of relative size h.
    EXPECT_NEAR(simulation.report().control.error, truth, 1.5 * step * truth);
  }
}

TEST(StepController, ASmallerToleranceIsASmallerError) {
  const auto end = [](double tolerance) {
    Simulation simulation(comet(), controlled(tolerance));
    simulation.run_until(3.0);
    return simulation.state().q;
  };
  const std::vector<double> truth = end(1e-12);
  std::vector<double> errors;
  for (const double tolerance : {1e-6, 1e-8, 1e-10}) {
    const std::vector<double> q = end(tolerance);
    errors.push_back(std::hypot(q[0] - truth[0], q[1] - truth[1]));
  }
  // Error per step h^3, global h^2: a tolerance smaller by 100 is an error smaller by 100^(2/3) = 21.5.
  for (std::size_t i = 0; i + 1 < errors.size(); ++i) {
    EXPECT_GT(errors[i] / errors[i + 1], 12.0);
    EXPECT_LT(errors[i] / errors[i + 1], 40.0);
  }
}

TEST(StepController, SaysWhereItCrossesAnImpact) {
  System system;
  system.add(Gravity{{0.0, -9.81}});
  system.add(HalfPlane{.point = {0.0, 0.0}, .normal = {0.0, 1.0}},
             Surface{.friction = 0.1, .normal_restitution = 0.8, .tangential_restitution = 0.8});
  const BodyId ball = system.add(Particle{.mass = 1.0, .position = {0.0, 1.0}, .velocity = {1.0, 0.0}});
  system.add(SpringDamper{.from = {ground, {0.0, 3.0}}, .to = ball, .stiffness = 2.0, .free_length = 1.0});
  Simulation simulation(std::move(system), controlled(1e-8));
  std::int64_t impacts = 0, across = 0;
  simulation.observe([&](const Simulation& now) {
    const StepReport& report = now.report();
    const bool impact = std::any_of(report.contacts.begin(), report.contacts.end(),
                                    [](const ContactRecord& contact) { return contact.impact; });
    if (impact) {
      ++impacts;
      EXPECT_TRUE(report.control.across_impact);
    }
    if (report.control.across_impact) {
      ++across;
      EXPECT_EQ(report.control.error, 0.0);
    }
  });
  simulation.run_until(2.0);
  EXPECT_GE(impacts, 2);
  EXPECT_EQ(simulation.statistics().impacts, impacts);
  EXPECT_EQ(simulation.statistics().steps_across_impacts, across);
  EXPECT_TRUE(ledger_closes(simulation.energy()));
}

/// Error of a place after a run under step control, against the event-driven mode. \param turns whether it is
/// an angle
double error_of(const System& system, double until, double tolerance, bool turns) {
  const auto place = [&](Simulation simulation) {
    simulation.run_until(until);
    const BodyId body = system.body("body");
    return turns ? simulation.state().angle(body) : simulation.state().position(body)[0];
  };
  const EventDriven exact{.relative_tolerance = 1e-11, .absolute_tolerance = 1e-11};
  TimeStepping options{.control = StepControl{.tolerance = tolerance}};
  return std::abs(place(Simulation(system, options)) - place(Simulation(system, exact)));
}

TEST(StepController, SeesThatSlidingEndsWithinAStep) {
  // A disc slides, then rolls: forces are constant before and after, so steps would be as long as they may,
  // and the whole step and the halves stick alike. While it slides it slows down at mu g. The change costs
  // one step of at most the tolerance, the rest of the motion is exact.
  for (const double from : {0.013, 0.05, 0.1, 0.17}) {
    System system;
    system.add(Gravity{{0.0, -9.81}});
    system.add(HalfPlane{.normal = {0.0, 1.0}}, Surface{.friction = 0.3, .normal_restitution = 0.0});
    const double speed = 3.0 * 0.3 * 9.81 * from;  // until the disc rolls after that time
    const BodyId body = system.add(
        RigidBody{.mass = disc(1.0, 0.1), .position = {0.0, 0.1}, .velocity = {speed, 0.0}}, "body");
    system.add(Disc{.body = body, .radius = 0.1});
    for (const double tolerance : {1e-4, 1e-6, 1e-8}) {
      EXPECT_LE(error_of(system, 1.5, tolerance, false), tolerance) << from << " " << tolerance;
    }
  }
}

TEST(StepController, SeesThatSlidingTurnsRoundWithinAStep) {
  // Up an incline and down again, and a pendulum with friction in its pin. What is left of a speed is an
  // error of the velocity that lasts: at most tolerance over step, sqrt(tolerance a/2) of the deceleration a,
  // here below 10 m/s^2, times what is left of the run.
  System slide;
  slide.add(Gravity{{0.0, -9.81}});
  slide.add(HalfPlane{.normal = incline(0.5)}, Surface{.friction = 0.3, .normal_restitution = 0.0});
  slide.add(Particle{.mass = 1.0, .velocity = 2.0 * Vec<2>(std::cos(0.5), std::sin(0.5))}, "body");
  System swing;
  swing.add(Gravity{{0.0, -9.81}});
  const BodyId rod = swing.add(RigidBody{.mass = planar::rod(1.0, 1.0), .position = {0.5, 0.0}}, "body");
  const JointId pin = swing.add(Revolute{.from = ground, .to = {rod, {-0.5, 0.0}}});
  swing.add(JointFriction{.joint = pin, .bound = 0.8});
  for (const double tolerance : {1e-4, 1e-6, 1e-8}) {
    const double left = std::sqrt(5.0 * tolerance);
    EXPECT_LE(error_of(slide, 1.3, tolerance, false), left) << tolerance;
    EXPECT_LE(error_of(swing, 1.5, tolerance, true), left) << tolerance;
  }
}

TEST(StepController, GoesOnAtTheSmallestStepWhereSlidingEnds) {
  // A shorter step would tell no more: the change is told as one that was not measured.
  System system;
  system.add(Gravity{{0.0, -9.81}});
  system.add(HalfPlane{.normal = {0.0, 1.0}}, Surface{.friction = 0.3, .normal_restitution = 0.0});
  system.add(Particle{.mass = 1.0, .velocity = {1.0, 0.0}});
  Simulation simulation(std::move(system),
                        TimeStepping{.control = StepControl{.tolerance = 1e-12, .smallest = 1e-4}});
  EXPECT_NO_THROW(simulation.run_until(1.0));
  EXPECT_EQ(simulation.statistics().steps_across_impacts, 1);
  EXPECT_EQ(simulation.state().v[0], 0.0);
}

TEST(StepController, TheSmallestStepIsAFloorThatSpeaks) {
  TimeStepping options = controlled(1e-12);
  options.control->smallest = 1e-3;
  Simulation simulation(comet(), options);
  const std::vector<double> before = simulation.state().q;
  try {
    simulation.step();
    FAIL();
  } catch (const SolverError& error) {
    const std::string text = error.what();
    EXPECT_NE(text.find("smallest step, 0.001 s"), std::string::npos) << text;
    EXPECT_GT(error.failure().residual, 1e-12);
  }
  EXPECT_EQ(simulation.state().q, before);
  EXPECT_EQ(simulation.time(), 0.0);
}

TEST(StepController, TheLargestStepIsACeiling) {
  System system;
  system.add(Particle{.mass = 1.0, .velocity = {1.0, 0.0}});
  TimeStepping options = controlled(1e-6);
  options.control->largest = 0.02;
  Simulation simulation(std::move(system), options);
  const Steps steps = watch(simulation, 1.0);
  EXPECT_EQ(steps.longest, 0.02);
  EXPECT_EQ(steps.rejected, 0);
}

TEST(StepController, AStepThatFailsIsTriedShorter) {
  // The described step is too long for plain sweeps.
  System system;
  const BodyId body = system.add(Particle{.mass = 1.0, .position = {1.0, 0.0}});
  system.add(
      SpringDamper{.from = ground, .to = body, .stiffness = 1e6, .damping = 100.0, .free_length = 0.99});
  Simulation simulation(std::move(system), controlled(1e-6, 0.05));
  EXPECT_NO_THROW(simulation.run_until(0.01));
  EXPECT_GT(simulation.statistics().rejected_steps, 0);
}

TEST(StepController, PeriodicEventsComeOnTime) {
  Simulation simulation(comet(), controlled(1e-8));
  std::vector<double> times;
  simulation.every(0.1, [&](const Simulation& now) { times.push_back(now.time()); });
  simulation.run_until(1.0);
  ASSERT_EQ(times.size(), 10U);
  for (std::size_t i = 0; i < times.size(); ++i) {
    EXPECT_DOUBLE_EQ(times[i], 0.1 * static_cast<double>(i + 1));
  }
}

TEST(StepController, GoesOnBitForBitFromACheckpoint) {
  const std::string path = testing::TempDir() + "controller.checkpoint";
  Simulation whole(comet(), controlled(1e-8));
  for (int i = 0; i < 50; ++i) whole.step();
  whole.save(path);
  for (int i = 0; i < 50; ++i) whole.step();
  Simulation loaded(whole.system(), controlled(1e-8));
  loaded.load(path);
  for (int i = 0; i < 50; ++i) loaded.step();
  EXPECT_EQ(carom_test::bits_of(loaded), carom_test::bits_of(whole));
  std::remove(path.c_str());
}

TEST(StepController, RefusesOptionsThatCannotBe) {
  const auto with = [](StepControl control, double step = 1e-3) {
    System system;
    system.add(Particle{.mass = 1.0});
    const Simulation simulation(std::move(system), TimeStepping{.step = step, .control = control});
  };
  EXPECT_MODEL_ERROR(with({.tolerance = 0.0}), "control.tolerance is 0", "> 0");
  EXPECT_MODEL_ERROR(with({.smallest = -1.0}), "control.smallest is -1", "> 0");
  EXPECT_MODEL_ERROR(with({.smallest = 1e-2, .largest = 1e-3}), "control.largest is 0.001",
                     "control.smallest");
  EXPECT_MODEL_ERROR(with({}, 1.0), "step is 1", "between");
}

}  // namespace
