// Contacts of a large component are solved with its blocks; the few blocks that they upset sweep by
// themselves before all others do.

#include "examples/scenes/net.h"
#include "tests/integrators/same_run.h"
#include "tests/integrators/throws.h"

#include <carom/carom.h>
#include <carom/core/assembly.h>
#include <carom/core/workers.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

namespace {

using namespace carom;
using namespace carom::planar;

constexpr double epsilon = std::numeric_limits<double>::epsilon();
constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double tolerance = 1e-10;  // of every step [m]

/// Falls on the plane with its lowest row, which is in one block, or with its last column, which goes through
/// all of them: the same net, counted otherwise.
scenes::Net falling(bool on_its_column) {
  scenes::Net net{.k = 80, .tilt = 0.1, .height = 1e-3};
  if (on_its_column) net.tilt -= 0.5 * std::numbers::pi;
  return net;
}

struct NetRun {
  explicit NetRun(const scenes::Net& what, int threads = 1)
      : net(what),
        simulation(
            [&] {
              System system;
              scenes::add_net(system, what);
              return system;
            }(),
            TimeStepping{.step = 1e-4, .tolerance = tolerance, .threads = threads}) {}

  void go(int steps) {
    for (int i = 0; i < steps; ++i) {
      simulation.step();
      const StepReport& report = simulation.report();
      if (report.contacts.empty()) continue;
      ++steps_in_contact;
      sweeps += report.sweeps;
      local_sweeps += report.local_sweeps;
    }
  }
  [[nodiscard]] Vec<2> moved(int row, int column) const {
    const int particle = row * net.k + column;
    return simulation.state().position(simulation.assembly().layout()->id(static_cast<Index>(particle))) -
           scenes::start(net, particle);
  }

  scenes::Net net;
  Simulation simulation;
  int steps_in_contact = 0, sweeps = 0, local_sweeps = 0;
};

constexpr int fall_and_impact = 200;  // steps; the net arrives after 143

TEST(ContactsByBlock, UpsetBlocksSweepByThemselves) {
  NetRun on_row(falling(false)), on_column(falling(true));
  on_row.go(fall_and_impact);
  on_column.go(fall_and_impact);
  ASSERT_GT(on_row.steps_in_contact, 20);
  EXPECT_EQ(on_column.steps_in_contact, on_row.steps_in_contact);
  // A step in which the last contacts part may need one more.
  EXPECT_GT(on_row.local_sweeps, on_row.steps_in_contact);
  EXPECT_LE(on_row.sweeps, 2 * on_row.steps_in_contact + 2);
  // Here contacts are in every block, but for a few steps with one contact alone.
  EXPECT_LT(on_column.local_sweeps, on_column.steps_in_contact / 5);
  EXPECT_GE(on_column.sweeps, 3 * on_column.steps_in_contact);
  double apart = 0.0;
  const int k = on_row.net.k;
  for (int row = 0; row < k; ++row) {
    for (int column = 0; column < k; ++column) {
      apart = std::max(apart, (on_row.moved(row, column) - on_column.moved(column, k - 1 - row)).norm());
    }
  }
  EXPECT_LT(apart, fall_and_impact * tolerance);
  EXPECT_GT(apart, 0.0);
}

TEST(ContactsByBlock, MomentumIsThatOfWeightAndContacts) {
  // The last two sweeps go through all of the component, so that springs push their ends equally.
  NetRun run(falling(false));
  const Vec<2> normal = incline(run.net.slope), tangent(normal.y(), -normal.x());
  const double weight = scenes::particles(run.net) * run.net.mass * scenes::net_gravity;
  CompensatedSum x, y;
  for (int i = 0; i < fall_and_impact; ++i) {
    run.go(1);
    y.add(1e-4 * weight);
    for (const ContactRecord& contact : run.simulation.report().contacts) {
      const Vec<2> impulse = contact.impulse[0] * normal + contact.impulse[1] * tangent;
      x.add(-impulse.x());
      y.add(-impulse.y());
    }
  }
  ASSERT_GT(run.local_sweeps, 0);
  const std::vector<double>& v = run.simulation.state().v;
  for (std::size_t i = 0; i < v.size(); i += 2) {
    x.add(run.net.mass * v[i]);
    y.add(run.net.mass * v[i + 1]);
  }
  // Rounding of every step, in parts of what gravity gives in all.
  const double rounding = fall_and_impact * epsilon * fall_and_impact * 1e-4 * weight;
  EXPECT_LT(std::abs(x.value()), rounding);
  EXPECT_LT(std::abs(y.value()), rounding);
}

TEST(ContactsByBlock, SameBitsForAnyNumberOfThreads) {
  if (!Workers::several_available()) GTEST_SKIP() << "built without oneTBB";
  for (const bool on_its_column : {false, true}) {
    NetRun one(falling(on_its_column), 1), two(falling(on_its_column), 2);
    one.go(fall_and_impact);
    two.go(fall_and_impact);
    EXPECT_GT(one.steps_in_contact, 0);
    EXPECT_EQ(carom_test::bits_of(one.simulation), carom_test::bits_of(two.simulation)) << on_its_column;
  }
}

TEST(ContactsByBlock, AForceThatIsNoNumberIsNamed) {
  // On a body that touches, so that contact sees it first; at once, and while two sweeps go together.
  for (const int good_steps : {0, 90}) {
    System system;
    scenes::Net net = falling(false);
    net.height = good_steps == 0 ? -1e-6 : 2e-4;  // arrives after 64 steps
    scenes::add_net(system, net);
    const BodyId corner = Assembly(system).layout()->id(static_cast<Index>(net.k - 1));
    const double end = (good_steps + 0.5) * 1e-4;
    const auto blow = [end](double time) { return Vec<2>(time > end ? nan : 1.0, 0.0); };
    system.add(AppliedForce{.on = corner, .force = blow}, "gust");
    Simulation simulation(std::move(system), TimeStepping{.step = 1e-4, .tolerance = tolerance});
    for (int i = 0; i < good_steps; ++i) simulation.step();
    EXPECT_EQ(simulation.report().contacts.empty(), good_steps == 0);
    if (good_steps > 0) {
      EXPECT_EQ(simulation.report().sweeps, 2);
    }
    const auto before = carom_test::bits_of(simulation);
    EXPECT_THROWS(SolverError, simulation.step(), "'gust'", "not finite");
    EXPECT_EQ(carom_test::bits_of(simulation), before);
  }
}

TEST(ContactsByBlock, AContactWithoutSolutionIsNamed) {
  // Far below the net hangs a dot between two rough walls on which no impulses fulfil both laws.
  constexpr double half_opening = 0.21745938056855638;
  System system;
  scenes::Net net = falling(false);
  net.tilt = 0.0;
  net.height = 50.0;
  scenes::add_net(system, net);
  const BodyId corner = Assembly(system).layout()->id(static_cast<Index>(net.k - 1));
  const Vec<2> apex(0.0, 1.001);
  const double c = std::cos(half_opening), s = std::sin(half_opening);
  system.add(HalfPlane{.point = apex, .normal = {c, s}},
             Surface{.friction = 0.53987900831896096,
                     .normal_restitution = 0.74899078150499232,
                     .tangential_restitution = 0.30618667673745659},
             "left");
  system.add(HalfPlane{.point = apex, .normal = {-c, s}},
             Surface{.friction = 0.57208363070636237,
                     .normal_restitution = 0.45812455122160234,
                     .tangential_restitution = 0.32175910193758456},
             "right");
  const BodyId dot = system.add(
      Particle{.mass = 1.0, .position = {0.0, 1.0}, .velocity = {-0.77365183717370878, -0.2387063857347117}},
      "dot");
  system.add(SpringDamper{.from = dot, .to = corner, .stiffness = 1.0, .free_length = 49.0});
  for (const int threads : {1, 2}) {
    if (threads > 1 && !Workers::several_available()) continue;
    Simulation simulation(
        system,
        TimeStepping{
            .step = 1e-4, .tolerance = tolerance, .impact_rules = {.refuse_jams = true}, .threads = threads});
    ASSERT_EQ(simulation.assembly().components().size(), 1U);
    const auto before = carom_test::bits_of(simulation);
    EXPECT_THROWS(SolverError, simulation.step(), "particle 'dot' on half-plane 'left'", "'right'",
                  "no solution");
    EXPECT_EQ(carom_test::bits_of(simulation), before);
    simulation.switch_to(TimeStepping{.step = 1e-4, .tolerance = tolerance, .threads = threads});
    simulation.step();
    EXPECT_EQ(simulation.statistics().plastic_jams, 1);
  }
}

}  // namespace
