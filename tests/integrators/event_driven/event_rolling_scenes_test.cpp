// Rolling resistance in event-driven mode: random discs and boxes in a box, agreement with time stepping,
// Painleve's rod, implicit flows, checkpoints and changes of the mode.

#include "tests/contact/random_problems.h"
#include "tests/integrators/event_driven/body_scenes.h"
#include "tests/temporary_folder.h"

#include <carom/carom.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace {

using namespace body_scenes;
using contact_test::Random;

/// Discs and boxes that fly about in a box.
struct Box {
  System system;
  Surface law;

  Box(std::uint64_t seed, bool boxes) {
    Random random(seed);
    law = {.friction = random.uniform(0.1, 1.1),
           .normal_restitution = random.uniform(0.0, 0.8),
           .rolling_resistance = random.uniform(0.0, 0.04)};
    // One e for all rows: then no impact gains energy.
    law.tangential_restitution = law.rolling_restitution = law.normal_restitution;
    system.add(Gravity{{0.0, -g}});
    system.set_default_law(law);
    add_walls(system, 1.0, law);
    const int bodies = random.integer(1, 5);
    for (int i = 0; i < bodies; ++i) {
      const Vec<2> place(-0.7 + 0.4 * (i % 4), -0.6 + 0.4 * (i / 4));
      const Vec<2> velocity(random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0));
      const double mass = random.uniform(0.5, 1.5), spin = random.uniform(-10.0, 10.0);
      if (boxes && i % 2 == 0) {
        add_box(system, mass, 0.2, 0.15, place, random.uniform(0.0, 1.0), velocity, spin);
      } else {
        add_disc(system, mass, 0.15, place, velocity, spin);
      }
    }
  }
};

TEST(EventRollingScenes, EnergyFallsAndIsAccountedFor) {
  int moments = 0, holds = 0;
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    const Box scene(seed, seed % 2 == 1);
    Simulation simulation(scene.system, EventDriven{});
    double before = simulation.energy().total();
    for (int i = 1; i <= 30; ++i) {
      simulation.run_until(0.1 * i);
      const EnergyLedger& energy = simulation.energy();
      ASSERT_LE(std::abs(energy.residual()), 1e-9) << seed;
      // Rounding of some 50 J, and the tolerance of works.
      ASSERT_LE(energy.total(), before + 1e-9) << seed << " " << i;
      before = energy.total();
      for (const ContactRecord& contact : simulation.report().contacts) {
        const double bound = scene.law.rolling_resistance * contact.impulse[0];
        // Answers are certified to 1e-12 of the impulses.
        ASSERT_LE(std::abs(contact.rolling_moment), bound + 1e-11 * contact.impulse[0]) << seed;
        moments += contact.rolling_moment != 0.0 ? 1 : 0;
      }
    }
    for (const EventRecord& event : simulation.events()) holds += event.kind == EventKind::hold ? 1 : 0;
  }
  EXPECT_GT(moments, 100);
  EXPECT_GT(holds, 10);
}

/// Drop of a disc with spin that bounces, slides, rolls and comes to rest.
struct Drop {
  System system;
  BodyId disc;

  explicit Drop(double height, double e = 0.5) {
    system.add(Gravity{{0.0, -g}});
    system.add(HalfPlane{.normal = {0.0, 1.0}},
               Surface{.friction = 0.3, .normal_restitution = e, .rolling_resistance = 0.01});
    disc = add_disc(system, 1.5, 0.2, {0.0, 0.2 + height}, {1.0, 0.0}, 20.0);
  }
};

TEST(EventRollingScenes, ModesAgreeAtFirstOrder) {
  constexpr int drops = 12;
  std::vector<double> means;
  for (const double step : {4e-3, 1e-3, 2.5e-4}) {
    double sum = 0.0;
    for (int i = 0; i < drops; ++i) {
      const Drop scene(0.2 + 0.013 * i);
      Simulation exact(scene.system, EventDriven{}), stepped(scene.system, TimeStepping{.step = step});
      exact.run_until(4.0);
      stepped.run_until(4.0);
      EXPECT_NEAR(exact.state().spin(scene.disc), 0.0, 1e-12);
      EXPECT_NEAR(stepped.state().spin(scene.disc), 0.0, 1e-12);
      sum += std::abs(exact.state().position(scene.disc)[0] - stepped.state().position(scene.disc)[0]);
    }
    means.push_back(sum / drops);
  }
  // Errors of single runs scatter by where in a step they hit: means of twelve, by the factor 16 in the step.
  EXPECT_LT(means[2], means[0] / 8.0);
  EXPECT_LT(means[1], means[0] / 2.0);
  EXPECT_LT(means[2], 1e-3);
}

/// Painleve's rod of half length 1 and mass 1, whose lower left tip slides on the floor.
System rod(double theta, double friction, double omega, double tip_speed, double rho) {
  const Vec<2> lever(std::cos(theta), std::sin(theta));
  System system;
  system.add(Gravity{{0.0, -g}});
  system.add(HalfPlane{.normal = {0.0, 1.0}},
             Surface{.friction = friction, .normal_restitution = 0.0, .rolling_resistance = rho});
  const BodyId body =
      system.add(RigidBody{.mass = planar::rod(1.0, 2.0),
                           .position = lever,
                           .angle = theta,
                           .velocity = Vec<2>(tip_speed, 0.0) + omega * Vec<2>(-lever[1], lever[0]),
                           .spin = omega});
  system.add(Point{.body = body, .position = {-1.0, 0.0}});
  return system;
}

TEST(EventRollingScenes, PainlevesRodIsThatWithoutResistanceInTheLimit) {
  // p = W_nn - s mu W_nt < 0 with loads that press (none) or part (several); the resistance adds
  // -s_r rho r_x/I to it, of order 1e-6.
  constexpr double theta = 1.0, friction = 2.5, small = 1e-6;
  int impacts = 0, several = 0;
  for (const double omega : {1.0, 5.0}) {
    for (const double tip_speed : {1.0, -1.0}) {
      Simulation with(rod(theta, friction, omega, tip_speed, small), EventDriven{});
      Simulation without(rod(theta, friction, omega, tip_speed, 0.0), EventDriven{});
      with.run_until(1e-6);
      without.run_until(1e-6);
      ASSERT_EQ(with.events().empty(), without.events().empty()) << omega << " " << tip_speed;
      if (without.events().empty()) continue;
      const EventRecord &a = with.events()[0], &b = without.events()[0];
      EXPECT_EQ(a.kind, b.kind) << omega << " " << tip_speed;
      impacts += a.kind == EventKind::impact_without_collision ? 1 : 0;
      several += a.kind == EventKind::several_accelerations ? 1 : 0;
      EXPECT_NEAR(a.stiffness, b.stiffness, 10.0 * small) << omega << " " << tip_speed;
      EXPECT_NEAR(a.free_acceleration, b.free_acceleration, 1e-9);
      for (std::size_t row = 0; row < 2; ++row) EXPECT_NEAR(a.impulse[row], b.impulse[row], 100.0 * small);
      EXPECT_LE(std::abs(a.rolling_moment), small * a.impulse[0] + 1e-12 * a.impulse[0]);
    }
  }
  EXPECT_EQ(impacts, 1);
  EXPECT_EQ(several, 1);
}

TEST(EventRollingScenes, JointsWithFrictionAndAFallingLawOfFriction) {
  // Two wheels on a rod roll down a slope; forces in the bearing, which friction there depends on, follow
  // from those of contact.
  const Vec<2> normal = Vec<2>(0.05, 1.0).normalized(), along(normal[1], -normal[0]);
  System system;
  system.add(Gravity{{0.0, -g}});
  system.add(HalfPlane{.normal = normal}, Surface{.friction = 0.3,
                                                  .normal_restitution = 0.0,
                                                  .static_friction = 0.5,
                                                  .stribeck_speed = 0.2,
                                                  .rolling_resistance = 0.01});
  const BodyId first = add_disc(system, 1.0, 0.2, 0.2 * normal, along, -5.0);
  const BodyId second = add_disc(system, 1.0, 0.2, 0.2 * normal + 0.6 * along, along);
  const BodyId bar = system.add(RigidBody{.mass = {.mass = 0.5, .inertia = 0.05},
                                          .position = 0.2 * normal + 0.3 * along,
                                          .angle = std::atan2(along[1], along[0]),
                                          .velocity = along});
  const JointId bearing = system.add(Revolute{.from = first, .to = {bar, {-0.3, 0.0}}});
  system.add(Revolute{.from = {bar, {0.3, 0.0}}, .to = second});
  system.add(JointFriction{.joint = bearing, .bound = 0.01, .coefficient = 0.005});
  Simulation events(system, EventDriven{}), steps(system, TimeStepping{.step = 5e-4});
  events.run_until(1.0);
  steps.run_until(1.0);
  // Errors of a step of 0.5 ms, of first order where sliding ends.
  EXPECT_NEAR(events.state().position(bar)[0], steps.state().position(bar)[0], 1e-4);
  for (const EnergyFlow flow : {EnergyFlow::rolling, EnergyFlow::joint_friction, EnergyFlow::sliding}) {
    EXPECT_NEAR(events.energy().flow(flow), steps.energy().flow(flow), 1e-3);
    EXPECT_GT(events.energy().flow(flow), 0.01);
  }
  EXPECT_LE(std::abs(events.energy().residual()), 1e-9);
}

TEST(EventRollingScenes, AccumulationsEndInRolling) {
  const Drop scene(0.5, 0.7);
  Simulation simulation(scene.system, EventDriven{});
  simulation.run_until(10.0);
  const auto count = [&](EventKind kind) {
    return std::count_if(simulation.events().begin(), simulation.events().end(),
                         [&](const EventRecord& event) { return event.kind == kind; });
  };
  EXPECT_EQ(count(EventKind::accumulation), 1);
  EXPECT_EQ(count(EventKind::hold), 1);
  EXPECT_NEAR(simulation.state().velocity(scene.disc).norm(), 0.0, 1e-30);
  EXPECT_LE(std::abs(simulation.energy().residual()), 1e-12);
}

TEST(EventRollingScenes, ImplicitFlowsDoTheSame) {
  const Drop scene(0.4);
  Simulation exact(scene.system, EventDriven{});
  exact.run_until(10.0);
  for (const FlowMethod method : {FlowMethod::bdf, FlowMethod::adams, FlowMethod::one_step}) {
    Simulation simulation(scene.system, EventDriven{.method = method});
    simulation.run_until(10.0);
    EXPECT_NEAR(simulation.state().position(scene.disc)[0], exact.state().position(scene.disc)[0], 1e-6);
    EXPECT_NEAR(simulation.state().spin(scene.disc), 0.0, 1e-30);
    EXPECT_EQ(simulation.events().size(), exact.events().size());
  }
}

TEST(EventRollingScenes, CheckpointsAndModesGoOn) {
  const Drop scene(0.4);
  Simulation whole(scene.system, EventDriven{});
  whole.run_until(10.0);
  double hold = 0.0, stick = 0.0;
  for (const EventRecord& event : whole.events()) {
    if (event.kind == EventKind::hold) hold = event.time;
    if (event.kind == EventKind::closing) stick = event.time;
  }
  ASSERT_GT(hold, stick);
  const carom_test::TemporaryFolder folder;
  const std::string path = folder / "rolling.checkpoint";
  // While it rolls, and at rest.
  for (const double time : {0.5 * (stick + hold), hold + 0.5}) {
    Simulation first(scene.system, EventDriven{}), second(scene.system, EventDriven{});
    first.run_until(time);
    first.save(path);
    second.load(path);
    const std::size_t events = second.events().size();
    second.run_until(10.0);
    EXPECT_NEAR(second.state().position(scene.disc)[0], whole.state().position(scene.disc)[0], 1e-12);
    EXPECT_NEAR(second.energy().flow(EnergyFlow::rolling), whole.energy().flow(EnergyFlow::rolling), 1e-12);
    // Nothing begins anew but that it is held.
    EXPECT_EQ(second.events().size() - events, time < hold ? 1U : 0U) << time;
  }
  // Time stepping leaves a disc that rolls, with a gap and a slip of its own.
  Simulation changed(scene.system, TimeStepping{.step = 1e-4});
  changed.run_until(0.5 * (stick + hold));
  const double speed = changed.state().velocity(scene.disc)[0], begin = changed.state().time;
  changed.switch_to(EventDriven{});
  changed.run_until(10.0);
  const double deceleration = 0.01 * g / (0.2 * 1.5);
  ASSERT_FALSE(changed.events().empty());
  EXPECT_EQ(changed.events().back().kind, EventKind::hold);
  EXPECT_NEAR(changed.events().back().time, begin + std::abs(speed) / deceleration, 1e-3);
  EXPECT_LE(std::abs(changed.energy().residual()), 1e-11);
  changed.switch_to(TimeStepping{.step = 1e-3});
  changed.run_until(11.0);
  EXPECT_NEAR(changed.state().spin(scene.disc), 0.0, 1e-12);
}

}  // namespace
