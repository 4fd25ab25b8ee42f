// Contacts that last while bodies turn take part in every step, so that impacts elsewhere are solved with
// them, at any step length; they leave when they are pulled away.

#include "tests/integrators/lasting_scenes.h"

#include "tests/allocation_counter.h"
#include "tests/integrators/same_run.h"
#include "tests/shares.h"
#include "tests/temporary_folder.h"

#include <carom/carom.h>
#include <carom/contact/detection/lasting_contacts.h>
#include <carom/core/assembly.h>
#include <carom/integrators/run/companion.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>

namespace {

using namespace lasting_scenes;

// Errors of position by step length. An impact is noticed up to a step late and a corner stands h^2 d over
// the floor: first order, with speeds of a few metres a second. Without the contact that lasts velocities are
// wrong after the impact, by metres a second too, which is 0.05 s old at the end of the runs.
constexpr double first_order = 20.0;  // [m/s]

double error_at(const System& system, const Simulation& exact, double step) {
  Simulation stepped(system, TimeStepping{.step = step});
  stepped.run_until(exact.time());
  return apart(stepped, exact);
}

TEST(LastingContact, BoxOnItsCornerGoesTheSameWayAtEveryStep) {
  const System system = tilted({});
  Simulation exact(system, EventDriven{});
  exact.run_until(0.45);
  EXPECT_NEAR(exact.state().angle(exact.assembly().layout()->id(0)), 0.05285, 5e-6);
  // Half of them see 0.0495 rad.
  for (const double step : step_lengths(5e-4, 5e-5, 40)) {
    EXPECT_LT(error_at(system, exact, step), first_order * step) << step;
  }
}

/// Runs random bodies to 0.05 s after the first impact beside the corner they stand on.
void none_goes_astray(const carom_test::SeedRange& seeds, double largest, double smallest) {
  int scenes = 0;
  for (std::uint64_t seed = seeds.first; seed < seeds.last; ++seed) {
    const Tilted what = random_tilted(seed);
    const System system = tilted(what);
    const std::optional<double> strike = strike_while_closed(system, 2.0);
    if (!strike) continue;  // it slides off or lifts
    ++scenes;
    Simulation exact(system, EventDriven{.relative_tolerance = 1e-10});
    exact.run_until(*strike + 0.05);
    for (const double step : step_lengths(largest, smallest, 40)) {
      EXPECT_LT(error_at(system, exact, step), first_order * step) << "seed " << seed << ", step " << step;
    }
  }
  EXPECT_GT(2 * scenes, seeds.count());
}

TEST(LastingContact, NoneOfSomeGoesAstray) { none_goes_astray({0, 3}, 5e-4, 5e-5); }

TEST(LastingContactLong, NoneGoesAstrayAtAnyStep) {
  none_goes_astray(carom_test::seeds_from(100, 60, 1000), 3e-4, 1e-5);
}

/// Steps of a run up to `end` that its contact does not take part in.
int steps_without_contact(const System& system, const TimeStepping& mode, double end) {
  Simulation simulation(system, mode);
  int missing = 0;
  bool begun = false;  // rounding may leave it open at the start
  while (simulation.time() < end) {
    const StepReport& report = simulation.step();
    const bool touches = std::any_of(report.contacts.begin(), report.contacts.end(),
                                     [](const ContactRecord& contact) { return contact.impulse[0] > 0.0; });
    begun = begun || touches;
    missing += begun && !touches ? 1 : 0;
  }
  EXPECT_TRUE(begun);
  return missing;
}

/// Steps of a run up to shortly before another corner strikes that its contact does not take part in.
int steps_without_contact(const System& system, const TimeStepping& mode) {
  const std::optional<double> strike = strike_while_closed(system, 1.0);
  EXPECT_TRUE(strike);
  return steps_without_contact(system, mode, *strike - 2.0 * mode.step);
}

TEST(LastingContact, TakesPartInEveryStep) {
  const Surface rough{.friction = 0.4, .normal_restitution = 0.3};
  for (const double step : {1e-3, 3.3e-4, 1e-4}) {
    EXPECT_EQ(steps_without_contact(tilted({}), {.step = step}), 0) << step;
    EXPECT_EQ(steps_without_contact(tilted({.height = 0.0}), {.step = step}), 0) << step;
    EXPECT_EQ(steps_without_contact(tilted({.surface = rough}), {.step = step}), 0) << step;
  }
}

/// A box on its corner, tied to a particle.
System tied(bool by_rod) {
  System system;
  system.add(Gravity{{0.0, -9.81}});
  system.add(HalfPlane{.normal = {0.0, 1.0}}, Surface{.friction = 0.2, .normal_restitution = 0.4}, "floor");
  const BodyId box = add(system, {});
  const BodyId ball = system.add(Particle{.mass = 0.2, .position = {1.0, 1.5}, .contact = false}, "ball");
  const Vec<2> at = Vec<2>(0.6, 0.3);
  if (by_rod) {
    system.add(Rod{.from = {box, at}, .to = ball});
  } else {
    system.add(
        SpringDamper{.from = {box, at}, .to = ball, .stiffness = 20.0, .damping = 0.1, .free_length = 0.8});
  }
  return system;
}

TEST(LastingContact, TakesPartInEveryStepOfBodiesThatAreTied) {
  for (const bool by_rod : {false, true}) {
    for (const Iteration iteration :
         {Iteration::fixed_point, Iteration::anderson, Iteration::linearly_implicit}) {
      EXPECT_EQ(steps_without_contact(tied(by_rod), {.step = 3e-4, .iteration = iteration}), 0)
          << by_rod << ' ' << to_string(iteration);
    }
    EXPECT_EQ(steps_without_contact(tied(by_rod), {.step = 3e-4, .control = StepControl{}}), 0);
  }
}

// A particle on a plank that turns down with it: only the obstacle turns.
TEST(LastingContact, TakesPartWhereTheObstacleTurns) {
  System system;
  system.add(Gravity{{0.0, -9.81}});
  HalfPlane plank{.point = {0.0, 0.0}, .normal = {0.0, 1.0}};
  plank.motion.angle = [](double t) { return -0.5 * t; };
  system.add(plank, Surface{.friction = 0.0, .normal_restitution = 0.0}, "plank");
  system.add(Particle{.mass = 1.0, .position = {0.0, 0.0}, .velocity = {1.0, 0.0}}, "bead");
  Simulation exact(system, EventDriven{});
  exact.run_until(0.5);
  ASSERT_EQ(exact.companion().modes.size(), 1U);  // it stays on the plank
  for (const double step : {1e-3, 1e-4}) EXPECT_EQ(steps_without_contact(system, {.step = step}, 0.5), 0);
}

// How far it stands over the floor: h^2 d once the steps have found it, with d = w^2 times the height of the
// centre of mass.
TEST(LastingContact, StandsOverTheFloorByOneStepOfTurning) {
  for (const double step : {1e-3, 2e-4}) {
    Simulation simulation(tilted({}), TimeStepping{.step = step});
    simulation.run_until(0.2);
    const StepReport& report = simulation.step();
    ASSERT_EQ(report.contacts.size(), 1U);
    const BodyId body = report.contacts[0].body;
    const double w = simulation.state().spin(body), d = w * w * simulation.state().position(body)[1];
    EXPECT_NEAR(report.contacts[0].gap / (step * step * d), 1.0, 20.0 * step);
    // Its velocities: what turning has added, and what brings it back.
    EXPECT_NEAR(report.contacts[0].velocity_before[0], 0.0, 20.0 * step * step * d);
    EXPECT_NEAR(report.contacts[0].velocity_after[0], -step * d, 20.0 * step * step * d);
  }
}

TEST(LastingContact, LeavesWhenItIsPulledAway) {
  // d is 19 times g: it cannot last.
  constexpr double step = 1e-4, spin = 20.0;
  Simulation simulation(tilted({}), TimeStepping{.step = step});
  State state = simulation.state();
  const BodyId body = simulation.assembly().layout()->id(0);
  const double c = std::cos(0.3), s = std::sin(0.3);
  const Vec<2> corner(-0.6 * c + 0.3 * s, -0.6 * s - 0.3 * c);
  state.position(body)[1] -= 1e-9;
  state.spin(body) = spin;
  state.velocity(body) = Vec<2>(spin * corner[1], -spin * corner[0]);
  simulation.set_state(state);
  bool touched = false;
  for (int i = 0; i < 100; ++i) {
    for (const ContactRecord& contact : simulation.step().contacts) {
      touched = true;
      if (i > 0) {
        EXPECT_EQ(contact.impulse[0], 0.0);
      }  // the first step does not see it turn
      EXPECT_LE(contact.gap, LastingContacts::most_opening * step * step * spin * spin * corner.lpNorm<1>());
    }
  }
  EXPECT_TRUE(touched);
  EXPECT_TRUE(simulation.report().contacts.empty());
}

TEST(LastingContact, IsRememberedByCheckpointsEditsAndModeSwitches) {
  const TimeStepping mode{.step = 1e-3};
  const carom_test::TemporaryFolder folder;
  const std::string file = folder / "lasting.checkpoint";
  Simulation simulation(tilted({}), mode);
  simulation.run_until(0.15);
  simulation.save(file);
  Simulation resumed(tilted({}), mode);
  resumed.load(file);
  Simulation edited(tilted({}), mode);
  edited.load(file);
  edited.edit([](System& system) { system.add(Particle{.mass = 1.0, .contact = false}); });
  const auto held = [](const Simulation& run) {
    const auto& contacts = run.report().contacts;
    return contacts.size() == 1 && contacts[0].gap > 0.0 && contacts[0].impulse[0] > 0.0;
  };
  for (Simulation* const run : {&simulation, &resumed, &edited}) {
    run->step();
    EXPECT_TRUE(held(*run));
  }
  simulation.run_until(0.45);
  resumed.run_until(0.45);
  EXPECT_EQ(carom_test::bits_of(resumed), carom_test::bits_of(simulation));

  // Closed contacts of the event-driven mode are not lost either, whatever rounding makes of their gaps.
  for (const double start : {0.1, 0.15, 0.2}) {
    Simulation switched(tilted({}), EventDriven{});
    switched.run_until(start);
    switched.switch_to(mode);
    ASSERT_EQ(switched.step().contacts.size(), 1U);
    EXPECT_GT(switched.report().contacts[0].impulse[0], 0.0);
  }
}

// A cut step is shorter than the one that has opened the contact.
TEST(LastingContact, TakesPartInStepsThatAreCutShort) {
  Simulation simulation(tilted({}), TimeStepping{.step = 1e-3});
  simulation.run_until(0.1);
  for (int i = 1; i <= 30; ++i) {
    const double time = 0.1 + 0.00351 * i;  // steps of 0.51 ms, 0.02 ms and so on among whole ones
    while (simulation.time() < time) {
      simulation.run_until(std::min(simulation.time() + 1e-3, time));
      ASSERT_EQ(simulation.report().contacts.size(), 1U) << simulation.time();
      EXPECT_GT(simulation.report().contacts[0].impulse[0], 0.0) << simulation.time();
    }
  }
}

TEST(LastingContact, AllocatesNothing) {
  Simulation simulation(tilted({}), TimeStepping{.step = 1e-4});
  simulation.run_until(0.1);
  const std::int64_t before = carom_test::allocations();
  for (int i = 0; i < 500; ++i) simulation.step();
  EXPECT_EQ(carom_test::allocations(), before);
  ASSERT_EQ(simulation.report().contacts.size(), 1U);
}

}  // namespace
