// Lasting contacts of bodies that both turn, with impacts located: they sink by errors of second order, gain
// no energy, and follow the exact motion.

#include "tests/allocation_counter.h"
#include "tests/integrators/event_driven/body_scenes.h"

#include <carom/carom.h>
#include <carom/core/constraint_set.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

namespace {

using namespace body_scenes;

struct Scene {
  std::string name;
  System system;
  double end;
};

/// A disc rolls down on another one that turns about its centre.
Scene disc_on_a_turning_disc() {
  Scene scene{"disc on a disc in a bearing", {}, 0.8};
  scene.system.add(Gravity{{0.0, -g}});
  scene.system.set_default_law({.friction = 0.5, .normal_restitution = 0.0});
  const BodyId below = add_disc(scene.system, 4.0, 0.5, {0.0, 0.0});
  scene.system.add(Revolute{.from = ground, .to = below});
  add_disc(scene.system, 1.0, 0.2, 0.7 * Vec<2>(std::sin(0.1), std::cos(0.1)));
  return scene;
}

/// A box that stands on a corner tips on a slab that slides without friction.
Scene box_on_a_sliding_slab() {
  Scene scene{"box on a slab", {}, 0.25};
  scene.system.add(Gravity{{0.0, -g}});
  scene.system.set_default_law({.friction = 0.4, .normal_restitution = 0.0});
  scene.system.add(HalfPlane{.normal = {0.0, 1.0}}, Surface{.friction = 0.0, .normal_restitution = 0.0});
  add_box(scene.system, 5.0, 6.0, 0.4, {0.0, 0.2});
  const double angle = 0.6, c = std::cos(angle), s = std::sin(angle);
  add_box(scene.system, 1.0, 0.3, 0.6, {0.15 * c - 0.3 * s, 0.4 + 0.15 * s + 0.3 * c}, angle);
  return scene;
}

/// A disc slides down on another one, which slides away on the ground.
Scene discs_without_friction() {
  Scene scene{"discs without friction", {}, 0.3};
  scene.system.add(Gravity{{0.0, -g}});
  const Surface law{.friction = 0.0, .normal_restitution = 0.0};
  scene.system.set_default_law(law);
  scene.system.add(HalfPlane{.point = {0.0, -0.4}, .normal = {0.0, 1.0}}, law);
  add_disc(scene.system, 2.0, 0.4, {0.0, 0.0});
  add_disc(scene.system, 1.0, 0.2, 0.6 * Vec<2>(std::sin(0.3), std::cos(0.3)));
  return scene;
}

struct Course {
  double deepest = 0.0, rise = 0.0, lost = 0.0, residual = 0.0;
  State end;
};

Course follow(const Scene& scene, double step) {
  Simulation simulation(scene.system, TimeStepping{.step = step, .impacts = ImpactTimes::located});
  const double start = simulation.energy().total();
  double before = start;
  Course result;
  while (simulation.state().time < scene.end - 0.5 * step) {
    simulation.step();
    for (const ContactRecord& contact : simulation.report().contacts)
      result.deepest = std::max(result.deepest, -contact.gap);
    result.rise = std::max(result.rise, simulation.energy().total() - before);
    before = simulation.energy().total();
  }
  result.lost = start - before;
  result.residual = std::abs(simulation.energy().residual());
  result.end = simulation.state();
  return result;
}

class ContactTurning : public testing::TestWithParam<int> {
protected:
  static Scene scene() {
    return GetParam() == 0   ? disc_on_a_turning_disc()
           : GetParam() == 1 ? box_on_a_sliding_slab()
                             : discs_without_friction();
  }
};

TEST_P(ContactTurning, SinksBySecondOrderAndGainsNothing) {
  const Scene scene = ContactTurning::scene();
  const Course coarse = follow(scene, 2e-3), fine = follow(scene, 5e-4);
  for (const Course& each : {coarse, fine}) {
    EXPECT_LE(each.rise, 1e-13) << scene.name;  // rounding of some 40 J
    EXPECT_LE(each.residual, 1e-13) << scene.name;
  }
  EXPECT_LT(fine.deepest, 2e-7) << scene.name;
  // Order 2 over the same time: a factor of 16, of which the steps that impacts part leave a part open.
  EXPECT_NEAR(coarse.deepest / fine.deepest, 16.0, 2.0) << scene.name;
  if (GetParam() == 1) return;  // it slides
  EXPECT_NEAR(coarse.lost / fine.lost, 16.0, 1.0) << scene.name;
}

TEST_P(ContactTurning, FollowsTheExactMotion) {
  const Scene scene = ContactTurning::scene();
  Simulation exact(scene.system, EventDriven{.relative_tolerance = 1e-11, .absolute_tolerance = 1e-13});
  exact.run_until(scene.end);
  std::vector<double> errors;
  for (const double step : {2e-3, 5e-4}) {
    const State end = follow(scene, step).end;
    double error = 0.0;
    for (std::size_t i = 0; i < end.q.size(); ++i)
      error = std::max(error, std::abs(end.q[i] - exact.state().q[i]));
    errors.push_back(error);
  }
  EXPECT_LT(errors[1], 1e-5) << scene.name;
  EXPECT_GT(errors[0] / errors[1], 12.0) << scene.name;  // 16 of order 2
}

TEST_P(ContactTurning, TakesNoMemoryOnceContactsLast) {
  const Scene scene = ContactTurning::scene();
  Simulation simulation(scene.system, TimeStepping{.step = 1e-3, .impacts = ImpactTimes::located});
  for (int i = 0; i < 100; ++i) simulation.step();
  const std::int64_t before = carom_test::allocations();
  for (int i = 0; i < 100; ++i) simulation.step();
  EXPECT_EQ(carom_test::allocations() - before, 0) << scene.name;
}

INSTANTIATE_TEST_SUITE_P(Scenes, ContactTurning, testing::Values(0, 1, 2));

TEST(Turning, CountsByHowFarItMovesInAStep) {
  SingleConstraint contact;
  EXPECT_FALSE(contact.turns(1.0, 0.0));
  contact.drift[1] = -2.0;
  EXPECT_TRUE(contact.turns(1e-3, 1.9e-6));
  EXPECT_FALSE(contact.turns(1e-3, 2.1e-6));
  EXPECT_TRUE(contact.turns(1e-9, 0.0));
  contact.drift[1] = std::nan("");
  EXPECT_TRUE(contact.turns(1e-3, 1.0));
}

// At rest bodies turn by rounding. Steps that follow that would solve their contacts several times.
TEST(Turning, OfBodiesAtRestIsNotFollowed) {
  constexpr int boxes = 3, steps = 100;
  System system;
  system.add(Gravity{{0.0, -g}});
  system.add(HalfPlane{.normal = {0.0, 1.0}}, Surface{.friction = 0.3, .normal_restitution = 0.5});
  for (int i = 0; i < boxes; ++i) {
    const BodyId body = system.add(RigidBody{
        .mass = box(1.0, 0.02, 0.02), .position = {i * 0.5, 0.1}, .angle = 0.3 + 0.1 * i, .spin = 3.0});
    system.add(Polygon{.body = body,
                       .vertices = {{-0.01, -0.01}, {0.01, -0.01}, {0.01, 0.01}, {-0.01, 0.01}},
                       .filter = {.groups = 2, .touches = 1}});
  }
  Simulation simulation(system, TimeStepping{.step = 1e-3, .impacts = ImpactTimes::located});
  simulation.run_until(1.5);
  const std::int64_t before = simulation.contact_statistics().problems;
  for (int i = 0; i < steps; ++i) EXPECT_EQ(simulation.step().contacts.size(), 2U * boxes);
  EXPECT_EQ(simulation.contact_statistics().problems - before, std::int64_t{boxes} * steps);
}

/// A bar that tips over about an end on the ground, and a disc that a spring joins it to. \param rod whether
/// the disc hangs on a rod
System tipping_bar(bool rod_to_disc, double stiffness) {
  System system;
  system.add(Gravity{{0.0, -9.81}});
  system.set_default_law({.friction = 1.0, .normal_restitution = 0.0, .tangential_restitution = 0.0});
  system.add(HalfPlane{.normal = {0.0, 1.0}});
  constexpr double length = 0.4, angle = 1.0;
  const BodyId bar =
      system.add(RigidBody{.mass = rod(1.0, length),
                           .position = {0.5 * length * std::cos(angle), 0.5 * length * std::sin(angle)},
                           .angle = angle});
  system.add(Segment{.body = bar, .from = {-0.5 * length, 0.0}, .to = {0.5 * length, 0.0}});
  const BodyId other = system.add(RigidBody{.mass = disc(1.0, 0.1), .position = {2.5, 2.0}});
  if (rod_to_disc) system.add(Rod{.from = {ground, {2.0, 2.0}}, .to = other});
  system.add(SpringDamper{.from = bar, .to = other, .stiffness = stiffness, .free_length = 1.0});
  return system;
}

// A body without joints is followed by itself unless others of its component have some: then its contacts
// turn with the step. (They did neither: errors of first order, 3.5e-3 rad at 4 ms.)
TEST(ContactTurningOf, ABodyWithoutJointsInAComponentThatHasSomeIsOfSecondOrder) {
  for (const bool rod_to_disc : {false, true}) {
    for (const double stiffness : {1e-12, 1.0}) {
      const auto angle = [&](const Mode& mode) {
        Simulation simulation(tipping_bar(rod_to_disc, stiffness), mode);
        simulation.run_until(0.2);
        return simulation.state().angle(simulation.system().bodies().front());
      };
      const double exact = angle(EventDriven{});
      double before = 0.0;
      for (const double step : {4e-3, 2e-3, 1e-3}) {
        const double error =
            std::abs(angle(TimeStepping{.step = step, .impacts = ImpactTimes::located}) - exact);
        // 1.2e-5 to 2.5e-5 rad at 4 ms; one of first order is 3.5e-3.
        EXPECT_LT(error, 4e-5 * std::pow(step / 4e-3, 2)) << rod_to_disc << stiffness;
        // The error of the contact alone; those of the spring have another sign.
        if (before > 0.0 && stiffness < 1.0) {
          EXPECT_NEAR(before / error, 4.0, 0.5) << rod_to_disc;
        }
        before = error;
      }
    }
  }
}

}  // namespace
