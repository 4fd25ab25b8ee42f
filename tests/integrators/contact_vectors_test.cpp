// Records of contacts as vectors in the fixed frame: impulses against the change of momentum, velocities
// against those of the places that touch, in the plane and in space; limits of joints, which have no
// direction there.

#include "tests/integrators/event_driven/body_scenes.h"

#include <carom/carom.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

namespace {

using namespace body_scenes;

constexpr double rounding = 1e-14;  // of numbers up to ten

Vec<3> in_space(const Vec<2>& of_plane) { return {of_plane[0], of_plane[1], 0.0}; }

/// Directions of a frame: unit vectors at right angles, of as many as there are.
void expect_frame(const ContactFrame& frame, int directions) {
  std::vector<Vec<3>> axes{Vec<3>(frame.normal.data())};
  for (const Vec<3>& tangent : frame.tangents()) axes.push_back(tangent);
  for (std::size_t i = 0; i < axes.size(); ++i) {
    const bool is_there = static_cast<int>(i) < directions;
    EXPECT_NEAR(axes[i].norm(), is_there ? 1.0 : 0.0, rounding);
    for (std::size_t j = 0; j < i; ++j) EXPECT_NEAR(axes[i].dot(axes[j]), 0.0, rounding);
  }
}

/// Sum of the impulses of contact on a body [N s].
Vec<3> impulse_on(const StepReport& report, BodyId body) {
  Vec<3> sum = Vec<3>::Zero();
  for (const ContactRecord& contact : report.contacts) {
    if (contact.body == body) sum += contact.vector_of(contact.impulse);
    if (contact.other == body) sum -= contact.vector_of(contact.impulse);
  }
  return sum;
}

TEST(ContactFrame, TangentOfThePlaneIsTheNormalTurnedClockwise) {
  ContactFrame frame;
  frame.normal = {0.6, 0.8, 0.0};
  EXPECT_EQ(frame.vector_of({1.0, 0.0, 0.0}), Vec<3>(0.6, 0.8, 0.0));
  EXPECT_EQ(frame.vector_of({0.0, 10.0, 0.0}), Vec<3>(8.0, -6.0, 0.0));
  EXPECT_EQ(ContactFrame{}.vector_of({1.0, 2.0, 3.0}), Vec<3>::Zero());
}

/// Two discs, one on the other, between two oblique half-planes, with friction and resistance to rolling.
struct Wedge {
  Wedge() {
    const Surface law{.friction = 0.4, .normal_restitution = 0.3, .rolling_resistance = 0.01};
    system.set_default_law(law);
    system.add(Gravity{gravity});
    system.add(HalfPlane{.normal = Vec<2>(0.6, 0.8)}, law);
    system.add(HalfPlane{.normal = Vec<2>(-0.8, 0.6)}, law);
    // A radius above both planes, at (0.6, 0.8) radius + (-0.8, 0.6) radius.
    lower = add_disc(system, masses[0], 0.5, {-0.1, 0.7}, {0.3, -1.0}, 2.0);
    upper =
        add_disc(system, masses[1], 0.3, Vec<2>(-0.1, 0.7) + 0.8 * Vec<2>(0.28, 0.96), {-0.5, -2.0}, -3.0);
  }
  std::vector<double> masses{2.0, 0.7};
  Vec<2> gravity{0.5, -g};
  System system;
  BodyId lower, upper;
};

TEST(ContactVectors, OfAStepChangeTheMomentumOfEachBody) {
  const Wedge wedge;
  constexpr double h = 1e-3;
  Simulation simulation(wedge.system, TimeStepping{.step = h});
  std::size_t most = 0;
  for (int step = 0; step < 100; ++step) {
    const State before = simulation.state();
    const StepReport& report = simulation.step();
    most = std::max(most, report.contacts.size());
    for (const ContactRecord& contact : report.contacts) {
      expect_frame(contact, 2);
      EXPECT_EQ(contact.tangents()[0][0], contact.normal[1]);
      EXPECT_EQ(contact.tangents()[0][1], -contact.normal[0]);
    }
    for (std::size_t i = 0; i < 2; ++i) {
      const BodyId body = i == 0 ? wedge.lower : wedge.upper;
      const Vec<2> gained = simulation.state().velocity(body) - before.velocity(body);
      const Vec<3> expected = wedge.masses[i] * in_space(gained - h * wedge.gravity);
      EXPECT_LE((impulse_on(report, body) - expected).norm(), rounding) << step;
    }
    // Mean forces of the contacts that last are their impulses over the step.
    Vec<3> force = Vec<3>::Zero();
    for (const LastingContact& contact : lasting_forces(report)) {
      if (contact.body == wedge.lower) force += contact.vector_of(contact.force);
      if (contact.other == wedge.lower) force -= contact.vector_of(contact.force);
    }
    const Vec<2> sum = force_on(report, wedge.lower).mean_force;
    EXPECT_LE((force - in_space(sum)).norm(), 1e-12 * force.norm());
  }
  EXPECT_GE(most, 3U);
}

TEST(ContactVectors, OfEventDrivenImpactsChangeTheMomentum) {
  const Wedge wedge;
  Simulation simulation(wedge.system, EventDriven{.interval = 0.5});
  simulation.run_until(0.5);
  int alone = 0, oblique = 0;
  const std::vector<EventRecord>& events = simulation.events();
  for (std::size_t e = 0; e < events.size(); ++e) {
    const EventRecord& event = events[e];
    if (!is_impulsive(event.kind)) continue;
    expect_frame(event, 2);
    // Of an impact of several contacts the sum of all acts on a body.
    const std::size_t begin = e;
    while (e + 1 < events.size() && events[e + 1].instant == event.instant) ++e;
    if (e > begin) continue;
    ++alone;
    const Vec<3> impulse = event.vector_of(event.impulse);
    if (std::abs(impulse[0]) > 1e-3 && std::abs(impulse[1]) > 1e-3) ++oblique;
    double sign = 1.0;
    for (const EventMotion& motion : event.motions) {
      if (!motion.body.valid()) continue;
      const double mass = motion.body == wedge.lower ? wedge.masses[0] : wedge.masses[1];
      const Vec<3> gained(motion.velocity_after[0] - motion.velocity_before[0],
                          motion.velocity_after[1] - motion.velocity_before[1], 0.0);
      EXPECT_LE((mass * gained - sign * impulse).norm(), rounding) << begin;
      sign = -1.0;
    }
  }
  EXPECT_GE(alone, 5);
  EXPECT_GE(oblique, 3);
  for (const ContactRecord& contact : simulation.report().contacts) expect_frame(contact, 2);
}

TEST(ContactVectors, VelocityIsThatOfThePlaceThatTouches) {
  const Wedge wedge;
  for (const bool events : {false, true}) {
    Simulation simulation = events ? Simulation(wedge.system, EventDriven{.interval = 0.01})
                                   : Simulation(wedge.system, TimeStepping{.step = 1e-3});
    const StepReport& report = simulation.step();
    const auto found =
        std::find_if(report.contacts.begin(), report.contacts.end(),
                     [&](const ContactRecord& at) { return at.body == wedge.lower && at.obstacle.valid(); });
    ASSERT_NE(found, report.contacts.end()) << events;
    const ContactRecord& contact = *found;
    // v + omega x r at the start, r = -0.5 n.
    const Vec<2> r(-0.5 * contact.normal[0], -0.5 * contact.normal[1]);
    const Vec<2> expected = Vec<2>(0.3, -1.0) + 2.0 * Vec<2>(-r[1], r[0]);
    EXPECT_LE((contact.vector_of(contact.velocity_before) - in_space(expected)).norm(), rounding) << events;
  }
}

TEST(ContactVectors, OfAParticleInSpaceChangeItsMomentum) {
  constexpr double mass = 1.7, h = 1e-3;
  const Vec<3> normal = Vec<3>(0.3, -0.5, 0.9).normalized(), gravity(0.4, 0.2, -g);
  const Vec<3> fast(1.0, 2.0, -3.0), slow(-0.5, 0.1, -0.2);
  for (const auto& [velocity, restitution] :
       {std::pair(fast, 0.3), std::pair(fast, 0.0), std::pair(slow, 0.0)}) {
    System system;
    system.add(carom::spatial::Gravity{gravity});
    system.add(carom::spatial::HalfSpace{.point = {1.0, 2.0, 3.0}, .normal = normal},
               Surface{.friction = 0.2, .normal_restitution = restitution});
    const BodyId body =
        system.add(carom::spatial::Particle{.mass = mass, .position = {1.0, 2.0, 3.0}, .velocity = velocity});
    Simulation simulation(std::move(system), TimeStepping{.step = h});
    int touched = 0;
    for (int step = 0; step < 50; ++step) {
      const Vec<3> before = simulation.state().velocity(body);
      const StepReport& report = simulation.step();
      const Vec<3> gained = Vec<3>(simulation.state().velocity(body)) - before - h * gravity;
      EXPECT_LE((impulse_on(report, body) - mass * gained).norm(), rounding) << step;
      for (const ContactRecord& contact : report.contacts) {
        ++touched;
        expect_frame(contact, 3);
        const Vec<3> after = simulation.state().velocity(body);
        EXPECT_LE((contact.vector_of(contact.velocity_after) - after).norm(), rounding) << step;
        EXPECT_LE((contact.vector_of(contact.velocity_before) - before).norm(), rounding) << step;
      }
    }
    EXPECT_GE(touched, restitution > 0.0 ? 1 : 50);
  }
}

TEST(ContactVectors, OfLimitsOfJointsAreZero) {
  for (const bool events : {false, true}) {
    System system;
    system.add(Gravity{{0.0, -g}});
    const BodyId bar = system.add(RigidBody{.mass = rod(1.0, 2.0), .position = {1.0, 0.0}, .spin = -1.0});
    const JointId pin = system.add(Revolute{.from = ground, .to = {bar, {-1.0, 0.0}}});
    system.add(Stop{.joint = pin, .lower = -0.05, .restitution = 0.5});
    Simulation simulation = events ? Simulation(system, EventDriven{.interval = 0.2})
                                   : Simulation(system, TimeStepping{.step = 1e-3});
    int limits = 0, pushes = 0;
    simulation.observe([&](const Simulation& run) {
      for (const ContactRecord& contact : run.report().contacts) {
        ++limits;
        EXPECT_EQ(contact.directions, 1);
        pushes += contact.impulse[0] > 0.0 ? 1 : 0;
        expect_frame(contact, 0);
        EXPECT_EQ(contact.vector_of(contact.impulse), Vec<3>::Zero());
        EXPECT_EQ(contact.vector_of(contact.velocity_before), Vec<3>::Zero());
      }
    });
    simulation.run_until(0.2);
    EXPECT_GE(limits, 1) << events;
    EXPECT_GE(pushes, 1) << events;
    for (const EventRecord& event : simulation.events()) expect_frame(event, 0);
  }
}

}  // namespace
