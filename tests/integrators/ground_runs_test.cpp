// Runs over every shape on ground beside the half-plane, at rest or moved: checkpoints in mid-contact,
// changes of mode on the way, impacts that are located within the step.

#include "tests/integrators/ground_runs.h"
#include "tests/analytic/convergence.h"
#include "tests/energy/ledger_check.h"
#include "tests/integrators/event_run.h"
#include "tests/integrators/same_run.h"
#include "tests/temporary_folder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace {

using namespace ground_runs;
using carom_test::bits_of;
using carom_test::ledger_closes;
using carom_test::LedgerWatch;
using carom_test::tight;

TimeStepping located(double step) { return {.step = step, .impacts = ImpactTimes::located}; }

Surface law(double restitution) {
  return {.friction = 0.3, .normal_restitution = restitution, .tangential_restitution = restitution};
}

const Swing at_rest{}, swinging{.reach = 0.01, .turn = 0.02, .rate = 20.0};

double distance(const State& a, const State& b) {
  double most = 0.0;
  for (std::size_t i = 0; i < a.q.size(); ++i) most = std::max(most, std::abs(a.q[i] - b.q[i]));
  return most;
}

/// Calls f(title, shape, form, motion) for every form of body on a shape, at rest and moved.
template <class F>
void for_all_on(Ground ground, F&& f) {
  for (const bool moved : {false, true}) {
    for (const Form form : forms) {
      f(title(ground, form) + (moved ? ", moved" : ""), ground, form, moved ? swinging : at_rest);
    }
  }
}

/// The same on every shape.
template <class F>
void for_all(F&& f) {
  for (const Ground ground : grounds) for_all_on(ground, f);
}

/// Saves a run at some times and goes on; another one loads what was saved. \return in how many of them
/// something touched
int go_on_from_checkpoints(const System& system, const Mode& mode, const std::string& title) {
  const carom_test::TemporaryFolder folder;
  Simulation whole(system, mode);
  int touching = 0;
  for (const double time : {0.27, 0.45}) {
    whole.run_until(time);
    whole.save(folder / "on_the_way");
    Simulation rest(system, mode);
    rest.load(folder / "on_the_way");
    touching += whole.companion().modes.empty() ? 0 : 1;
    whole.run_until(time + 0.15);
    rest.run_until(time + 0.15);
    EXPECT_EQ(bits_of(rest), bits_of(whole)) << title << " from " << time;
    EXPECT_EQ(rest.statistics().events, whole.statistics().events) << title << " from " << time;
  }
  return touching;
}

TEST(GroundRuns, GoOnBitForBitFromCheckpointsInMidContact) {
  for (const Mode& mode : {Mode(TimeStepping{.step = 1e-3}), Mode(located(1e-3)), Mode(EventDriven{})}) {
    int touching = 0, all = 0;
    for_all([&](const std::string& title, Ground ground, Form form, const Swing& swing) {
      touching += go_on_from_checkpoints(falling(ground, form, law(0.0), swing), mode, title);
      all += 2;
    });
    // All but those that a moved shape has thrown up, or that turn in between on an edge.
    EXPECT_GT(touching, 3 * all / 4);
  }
}

// From step to step, event to event and back, the energy account goes on; where the run ends is as exact as
// the part of it that is stepped.
class GroundRunsOn : public testing::TestWithParam<Ground> {};

TEST_P(GroundRunsOn, ChangeTheModeOnTheWay) {
  for_all_on(GetParam(), [](const std::string& title, Ground ground, Form form, const Swing& swing) {
    for (const double restitution : {0.5, 0.0}) {
      const System system = falling(ground, form, law(restitution), swing);
      Simulation events(system, tight());
      events.run_until(0.5);
      for (const bool locates : {false, true}) {
        const TimeStepping stepping = locates ? located(1e-4) : TimeStepping{.step = 1e-4};
        Simulation changed(system, stepping);
        changed.run_until(0.2);
        changed.switch_to(tight());
        changed.run_until(0.3);
        changed.switch_to(stepping);
        changed.run_until(0.4);
        changed.switch_to(tight());
        changed.run_until(0.5);
        // Time stepping of first order across an impact at 3 m/s is off by up to h v, and the angle by ten
        // times that; located it is of second order, (w h)^2 r with w = 10/s, and on a peg, where an edge
        // of a brick rolls off, a hundred times that.
        const double off = distance(changed.state(), events.state());
        EXPECT_LT(off, locates ? 1e-4 : 3e-3) << title << ", e = " << restitution;
        EXPECT_LT(std::abs(changed.energy().residual()), 1e-10) << title << ", e = " << restitution;
      }
    }
  });
}

// Flights between isolated impacts are exact, so that only the search for their instants is left.
TEST(GroundRuns, IsolatedImpactsThatAreLocatedAreExact) {
  for_all([](const std::string& title, Ground ground, Form form, const Swing& swing) {
    const System system = falling(ground, form, law(0.5), swing);
    Simulation events(system, tight());
    const LedgerWatch watch(events);
    events.run_until(0.45);
    EXPECT_TRUE(watch.closes()) << title;
    EXPECT_GT(events.statistics().impacts, 0) << title;
    for (const double step : {4e-3, 7e-4}) {
      Simulation steps(system, located(step));
      steps.run_until(0.45);
      EXPECT_LT(distance(steps.state(), events.state()), 1e-12) << title << ", step " << step;
      EXPECT_TRUE(ledger_closes(steps.energy())) << title << ", step " << step;
    }
  });
}

/// A box that comes to lie on a corner and tumbles. Without friction, whose reversals are not located.
System tumbling_box(Ground ground, const Swing& swing) {
  System system;
  system.add(Gravity{{0.0, -g}});
  add_ground(system, ground, {.friction = 0.0, .normal_restitution = 0.0}, swing);
  const BodyId body = system.add(RigidBody{
      .mass = box(1.0, 0.5, 0.3), .position = {0.1, 0.5}, .angle = 0.3, .velocity = {0.6, 0.0}, .spin = 1.0});
  system.add(Polygon{.body = body, .vertices = {{-0.25, -0.15}, {0.25, -0.15}, {0.25, 0.15}, {-0.25, 0.15}}});
  return system;
}

/// A ball that rolls, or slides, where it falls.
System rolling_ball(Ground ground, const Swing& swing) {
  return falling(ground, Form::disc, law(0.0), swing);
}

// As on a half-plane, at an end before an edge lies on a curve: where the contact of a body goes on from a
// corner to an edge its normal turns at another rate, which no step locates. The error scatters with where
// the grid of steps lies, as the deviation says.
TEST_P(GroundRunsOn, LocatedStepsAreOfSecondOrder) {
  struct Scene {
    System (*make)(Ground, const Swing&);
    double end;
  };
  const auto expect_order = [](const Scene& scene, Ground ground, const Swing& swing) {
    const System system = scene.make(ground, swing);
    Simulation events(system, tight());
    events.run_until(scene.end);
    const analytic::MeanOrder order = analytic::mean_order(8e-3, 4, 8, [&](double step) {
      Simulation steps(system, located(step));
      steps.run_until(scene.end);
      return distance(steps.state(), events.state());
    });
    const bool is_exact = order.errors.front() < 1e-12;
    EXPECT_TRUE(is_exact || order.slope > 1.8)
        << name_of(ground) << ": " << order.slope << ", deviation " << order.deviation;
  };
  for (const Swing& swing : {at_rest, swinging}) {
    expect_order({rolling_ball, 0.45}, GetParam(), swing);
    expect_order({tumbling_box, 0.3}, GetParam(), swing);
  }
}

std::string ground_of(const testing::TestParamInfo<Ground>& each) {
  std::string name = name_of(each.param);
  std::replace(name.begin(), name.end(), ' ', '_');
  return name;
}

INSTANTIATE_TEST_SUITE_P(Shapes, GroundRunsOn, testing::Values(Ground::terrain), ground_of);
INSTANTIATE_TEST_SUITE_P(ShapesLong, GroundRunsOn,
                         testing::Values(Ground::box_inside, Ground::circle_inside, Ground::wall,
                                         Ground::block, Ground::peg),
                         ground_of);

// Of contacts that last while a body turns, on curved shapes too.
TEST(GroundRuns, LocatedStepsNeitherSinkNorGainEnergy) {
  for (const Ground ground : grounds) {
    for (System (*make)(Ground, const Swing&) : {rolling_ball, tumbling_box}) {
      Simulation simulation(make(ground, at_rest), located(1e-3));
      double before = simulation.energy().total();
      for (int i = 0; i < 300; ++i) {
        simulation.step();
        // The error of a step is of third order: (w h)^3 m v^2, w = 20/s, v = 1 m/s.
        EXPECT_LT(simulation.energy().total() - before, 1e-5) << name_of(ground) << " at " << i;
        before = simulation.energy().total();
        for (const ContactRecord& contact : simulation.report().contacts) {
          EXPECT_GT(contact.gap, -2e-6) << name_of(ground) << " at " << i;
        }
      }
    }
  }
}

}  // namespace
