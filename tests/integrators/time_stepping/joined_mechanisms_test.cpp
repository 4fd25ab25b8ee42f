// Mechanisms that hit other bodies and each other: the same as one component, and the account closes.

#include <carom/carom.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace {

using namespace carom;
using namespace carom::planar;

constexpr double gravity = 9.81;  // [m/s^2]

BodyId add_bar(System& system, const Vec<2>& from, const Vec<2>& to) {
  const Vec<2> along = to - from;
  const double length = along.norm();
  const BodyId bar = system.add(RigidBody{
      .mass = rod(1.0, length), .position = 0.5 * (from + to), .angle = std::atan2(along[1], along[0])});
  system.add(Segment{.body = bar, .from = {-0.5 * length, 0.0}, .to = {0.5 * length, 0.0}, .radius = 0.02});
  return bar;
}

/// A double pendulum that swings against a free disc and another pendulum. \param weakest stiffness of
/// springs that make one component of all, without doing anything to speak of; 0: none
System pendulums(double restitution, double weakest) {
  System system;
  system.set_default_law(
      {.friction = 0.3, .normal_restitution = restitution, .tangential_restitution = restitution});
  system.add(Gravity{{0.0, -gravity}});
  system.add(HalfPlane{.point = {0.0, -1.6}, .normal = {0.0, 1.0}});
  const BodyId upper = add_bar(system, {0.0, 0.0}, {-0.8, 0.0}),
               lower = add_bar(system, {-0.8, 0.0}, {-1.5, 0.0});
  system.add(Revolute{.from = ground, .to = {upper, {-0.4, 0.0}}});
  system.add(Revolute{.from = {upper, {0.4, 0.0}}, .to = {lower, {-0.35, 0.0}}});
  const BodyId ball = system.add(RigidBody{.mass = disc(0.5, 0.1), .position = {0.05, -1.5}});
  system.add(Disc{.body = ball, .radius = 0.1});
  const BodyId other = add_bar(system, {0.5, 0.0}, {0.5, -1.45});
  system.add(Revolute{.from = {ground, {0.5, 0.0}}, .to = {other, {-0.725, 0.0}}});
  if (weakest > 0.0) {
    system.add(SpringDamper{.from = lower, .to = ball, .stiffness = weakest});
    system.add(SpringDamper{.from = ball, .to = other, .stiffness = weakest});
  }
  return system;
}

TEST(JoinedMechanisms, MoveAsOneComponentDoes) {
  // Springs of 1e-12 N/m join all: other paths of the code, the same equations.
  for (const double restitution : {0.0, 0.5}) {
    Simulation apart(pendulums(restitution, 0.0), TimeStepping{.step = 1e-3});
    Simulation together(pendulums(restitution, 1e-12), TimeStepping{.step = 1e-3});
    std::size_t joined = 0;
    for (int i = 0; i < 700; ++i) {
      apart.step();
      together.step();
      joined += static_cast<std::size_t>(
          std::count_if(apart.report().contacts.begin(), apart.report().contacts.end(),
                        [](const ContactRecord& contact) { return contact.other.valid(); }));
      const std::vector<BodyId> bodies = apart.system().bodies(), same = together.system().bodies();
      for (std::size_t b = 0; b < bodies.size(); ++b) {
        // The iteration ends at 1e-12 m, and impacts hand on what it left.
        const Vec<2> one = apart.state().position(bodies[b]), all = together.state().position(same[b]);
        ASSERT_LT((one - all).norm(), 1e-9) << i;
      }
    }
    EXPECT_GT(joined, 3U) << restitution;
  }
}

TEST(JoinedMechanisms, TheAccountClosesAndNoImpactGains) {
  for (const double restitution : {0.0, 0.5, 1.0}) {
    Simulation simulation(pendulums(restitution, 0.0), TimeStepping{.step = 5e-4});
    const double energy = simulation.energy().total();
    for (int i = 0; i < 3000; ++i) {
      simulation.step();
      // Joints leave errors of O(h^2) in the energy of a step, which do not add up: 1e-4 of the 20 J in
      // motion.
      ASSERT_LE(simulation.energy().total(), energy + 2e-3) << restitution << " " << i;
      // One e for all contacts: no impact gains.
      ASSERT_LE(simulation.report().energy_gain - simulation.report().lasting_gain, 0.0) << i;
    }
    // 1e3 epsilon of the largest term, 20 J.
    EXPECT_NEAR(simulation.energy().residual(), 0.0, 5e-12) << restitution;
    EXPECT_GE(simulation.statistics().impacts, 2) << restitution;
  }
}

TEST(JoinedMechanisms, FrictionInJointsIsRefusedByName) {
  System system = pendulums(0.5, 0.0);
  system.add(JointFriction{.joint = system.joints().front(), .bound = 0.1});
  Simulation simulation(system, TimeStepping{.step = 1e-3});
  try {
    simulation.run_until(1.0);
    FAIL() << "no contact";
  } catch (const SolverError& error) {
    EXPECT_NE(std::string(error.what()).find("without friction in joints"), std::string::npos)
        << error.what();
    EXPECT_NE(std::string(error.what()).find("on"), std::string::npos);
  }
}

}  // namespace
