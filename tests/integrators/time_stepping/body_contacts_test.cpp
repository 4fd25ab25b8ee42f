// Bodies that touch each other in time stepping: impacts against closed form, momentum, static forces.

#include "tests/reference/reference_data.h"

#include <carom/carom.h>
#include <carom/core/assembly.h>
#include <carom/core/dynamics/total_momentum.h>

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

namespace {

using namespace carom;
using namespace carom::planar;
using carom_test::reference_data;

constexpr double gravity = 9.81;  // [m/s^2]

/// A disc of uniform density with its outline.
BodyId add_disc(System& system, double mass, double radius, const Vec<2>& place,
                const Vec<2>& velocity = {0, 0}, double spin = 0.0, MaterialId material = {}) {
  const BodyId body = system.add(
      RigidBody{.mass = disc(mass, radius), .position = place, .velocity = velocity, .spin = spin});
  system.add(Disc{.body = body, .radius = radius, .material = material});
  return body;
}

BodyId add_box(System& system, double mass, double width, double height, const Vec<2>& place) {
  const BodyId body = system.add(RigidBody{.mass = box(mass, width, height), .position = place});
  const double x = 0.5 * width, y = 0.5 * height;
  system.add(Polygon{.body = body, .vertices = {{-x, -y}, {x, -y}, {x, y}, {-x, y}}});
  return body;
}

TEST(BodyContacts, DiscsThatCollideFollowTheLawOfWalton) {
  // Two discs just overlapping: theory as one body of the reduced masses against a wall. With n from b to a,
  // 1/m_n = 1/m_a + 1/m_b, 1/m_t = 3 (1/m_a + 1/m_b) (uniform discs: 1/m + r^2/I = 3/m).
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  int sticks = 0, slips = 0;
  for (int i = 0; i < 200; ++i) {
    const double mu = unit(random), e_n = unit(random), e_t = unit(random);
    const double m_a = 0.1 + unit(random), m_b = 0.1 + unit(random);
    const double r_a = 0.1 + unit(random), r_b = 0.1 + unit(random);
    const double angle = 6.28 * unit(random);
    const Vec<2> n(std::cos(angle), std::sin(angle)), t(n[1], -n[0]);
    System system;
    system.set_default_law({.friction = mu, .normal_restitution = e_n, .tangential_restitution = e_t});
    const auto any = [&] { return 2.0 * unit(random) - 1.0; };
    const Vec<2> v_a = Vec<2>(any(), any()) - n, v_b = Vec<2>(any(), any()) + n;
    if (n.dot(v_a - v_b) > -0.01) continue;  // they part, or hardly touch
    const double w_a = any(), w_b = any();
    // Levers reach the middle of the overlap, which is hardly more than rounding.
    constexpr double overlap = 1e-14;
    const Vec<2> apart = (r_a + r_b - overlap) * n;
    const BodyId a = add_disc(system, m_a, r_a, apart, v_a, w_a),
                 b = add_disc(system, m_b, r_b, {0, 0}, v_b, w_b);
    const double step = 1e-6;
    Simulation simulation(system, TimeStepping{.step = step});
    simulation.step();
    const double normal = n.dot(v_a - v_b);
    const double tangential = t.dot(v_a - v_b) + r_a * w_a + r_b * w_b;
    const double mass = 1.0 / (1.0 / m_a + 1.0 / m_b);
    const double P_n = -mass * (1.0 + e_n) * normal;
    const double to_stick = -mass / 3.0 * (1.0 + e_t) * tangential;
    const bool stick = std::abs(to_stick) <= mu * P_n;
    (stick ? sticks : slips) += 1;
    const double P_t = stick ? to_stick : -mu * P_n * std::copysign(1.0, tangential);
    const State& end = simulation.state();
    const Vec<2> impulse = P_n * n + P_t * t;
    // The overlap changes levers by 5e-15; impulses are up to 10, masses from 0.1 on.
    EXPECT_LT((end.velocity(a) - (v_a + impulse / m_a)).norm(), 1e-12);
    EXPECT_LT((end.velocity(b) - (v_b - impulse / m_b)).norm(), 1e-12);
    EXPECT_NEAR(end.spin(a), w_a + r_a * P_t / (0.5 * m_a * r_a * r_a), 1e-12);
    EXPECT_NEAR(end.spin(b), w_b + r_b * P_t / (0.5 * m_b * r_b * r_b), 1e-12);
    EXPECT_NEAR(simulation.energy().residual(), 0.0, 1e-14);
  }
  EXPECT_GT(sticks, 20);
  EXPECT_GT(slips, 20);
}

TEST(BodyContacts, TheReportNamesBothBodies) {
  System system;
  system.set_default_law({.friction = 0.0, .normal_restitution = 1.0});
  const BodyId a = add_disc(system, 1.0, 1.0, {0.0, 0.0}),
               b = add_disc(system, 1.0, 1.0, {1.9, 0.0}, {-1.0, 0.0});
  Simulation simulation(system, TimeStepping{.step = 1e-3});
  simulation.step();
  const auto& contacts = simulation.report().contacts;
  ASSERT_EQ(contacts.size(), 1U);
  EXPECT_EQ(contacts[0].body, a);
  EXPECT_EQ(contacts[0].other, b);
  EXPECT_FALSE(contacts[0].obstacle.valid());
  EXPECT_EQ(simulation.name(contacts[0].key),
            "disc #0 (feature 0) of rigid body #0 on disc #1 (feature 1) of rigid body #1");
  EXPECT_NEAR(contacts[0].gap, -0.1, 1e-15);
  EXPECT_TRUE(contacts[0].impact);
}

TEST(BodyContacts, WithoutALawBodiesPassThroughEachOther) {
  System system;
  const BodyId a = add_disc(system, 1.0, 1.0, {0.0, 0.0});
  add_disc(system, 1.0, 1.0, {1.9, 0.0}, {-1.0, 0.0});
  Simulation simulation(system, TimeStepping{.step = 1e-3});
  simulation.step();
  EXPECT_TRUE(simulation.report().contacts.empty());
  EXPECT_EQ(simulation.state().velocity(a).norm(), 0.0);
}

TEST(BodyContacts, BodiesAtAJointDoNotTouch) {
  System system;
  system.set_default_law({.friction = 0.5, .normal_restitution = 0.0});
  system.add(Gravity{{0.0, -gravity}});
  const BodyId a = add_box(system, 1.0, 1.0, 0.1, {0.5, 0.0}), b = add_box(system, 1.0, 1.0, 0.1, {1.5, 0.0});
  system.add(Revolute{.from = ground, .to = {a, {-0.5, 0.0}}});
  system.add(Revolute{.from = {a, {0.5, 0.0}}, .to = {b, {-0.5, 0.0}}});
  Simulation simulation(system, TimeStepping{.step = 1e-3});
  simulation.run_until(0.3);
  EXPECT_EQ(simulation.statistics().contact_steps, 0);
}

TEST(BodyContacts, AParticleHitsADiscAndPointsDoNotTouch) {
  System system;
  system.set_default_law({.friction = 0.0, .normal_restitution = 1.0});
  const BodyId ball = add_disc(system, 1.0, 0.5, {0.0, 0.0});
  const BodyId p = system.add(Particle{.mass = 1.0, .position = {0.4999, 0.0}, .velocity = {-1.0, 0.0}});
  system.add(Particle{.mass = 1.0, .position = {0.4999, 0.0}, .velocity = {1.0, 0.0}});
  Simulation simulation(system, TimeStepping{.step = 1e-3});
  simulation.step();
  ASSERT_EQ(simulation.report().contacts.size(), 2U);  // both particles are in the disc; one leaves
  EXPECT_NEAR(simulation.state().velocity(ball)[0], -1.0, 1e-14);
  EXPECT_NEAR(simulation.state().velocity(p)[0], 0.0, 1e-14);
}

TEST(BodyContacts, DiscsAndBlocksInAStackCarryTheirWeights) {
  const auto data = reference_data("contacts_planar.json").at("static_stack");
  for (const bool blocks : {false, true}) {
    System system;
    system.set_default_law({.friction = 0.3, .normal_restitution = 0.0});
    system.add(Gravity{{0.0, -gravity}});
    system.add(HalfPlane{.normal = {0.0, 1.0}});
    constexpr double size = 0.1;
    for (int i = 0; i < 10; ++i) {
      const Vec<2> place(0.0, (2.0 * i + 1.0) * size);
      if (blocks) {
        add_box(system, 1.0, 2.0 * size, 2.0 * size, place);
      } else {
        add_disc(system, 1.0, size, place);
      }
    }
    constexpr double step = 1e-3;
    Simulation simulation(system, TimeStepping{.step = step});
    for (int i = 0; i < 100; ++i) simulation.step();
    std::vector<double> level(11, 0.0);  // normal force below each body, from the ground up
    for (const ContactRecord& contact : simulation.report().contacts) {
      const Index upper = contact.other.valid() ? std::max(contact.body.serial, contact.other.serial) : 0;
      level[upper] += contact.impulse[0] / step;
    }
    const auto& forces = data.at(blocks ? "block_corner_forces_bottom_up" : "disc_contact_forces_bottom_up");
    for (std::size_t i = 0; i < 10; ++i) {
      // Round-off: 1e3 epsilon of the largest force.
      EXPECT_NEAR(level[i], forces.at(i).get<double>() * (blocks ? 2.0 : 1.0), 2e-11) << i << blocks;
    }
    for (const double v : simulation.state().v) EXPECT_NEAR(v, 0.0, 1e-12);
    EXPECT_NEAR(simulation.energy().residual(), 0.0, 1e-12);
  }
}

TEST(BodyContacts, APyramidOfThreeDiscsLeansOnTheWalls) {
  const auto data = reference_data("contacts_planar.json").at("three_disc_pyramid");
  constexpr double r = 0.1, gap = 1e-3 * r, step = 1e-4;
  System system;
  system.set_default_law({.friction = 0.0, .normal_restitution = 0.0});
  system.add(Gravity{{0.0, -gravity}});
  system.add(HalfPlane{.normal = {0.0, 1.0}});
  const double x = r + 0.5 * gap;
  system.add(HalfPlane{.point = {-x - r, 0.0}, .normal = {1.0, 0.0}});
  system.add(HalfPlane{.point = {x + r, 0.0}, .normal = {-1.0, 0.0}});
  add_disc(system, 1.0, r, {-x, r});
  add_disc(system, 1.0, r, {x, r});
  const BodyId top = add_disc(system, 1.0, r, {0.0, r + std::sqrt(4.0 * r * r - x * x)});
  Simulation simulation(system, TimeStepping{.step = step});
  for (int i = 0; i < 20; ++i) simulation.step();
  for (const ContactRecord& contact : simulation.report().contacts) {
    const double force = contact.impulse[0] / step;
    const bool pair = contact.body == top || contact.other == top;
    const char* const name = pair                           ? "top_pair_each"
                             : contact.obstacle.serial == 0 ? "floor_each"
                                                            : "wall_each";
    // Places are those described to rounding; 1e3 epsilon of the weight, magnified by the flat angle.
    EXPECT_NEAR(force, data.at(name).get<double>(), 1e-10) << name;
  }
  EXPECT_EQ(simulation.report().contacts.size(), 6U);
}

/// Bodies of all shapes thrown at each other without loads.
System crowd(std::uint32_t seed, bool springs) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  const auto any = [&] { return 2.0 * unit(random) - 1.0; };
  System system;
  system.set_default_law(
      {.friction = unit(random), .normal_restitution = 0.7, .tangential_restitution = 0.7});
  std::vector<BodyId> bodies;
  for (int i = 0; i < 12; ++i) {
    const Vec<2> place(0.5 * (i % 4), 0.5 * (i / 4));
    const BodyId body =
        system.add(RigidBody{.mass = {.mass = 0.5 + unit(random), .inertia = 0.01 + 0.01 * unit(random)},
                             .position = place,
                             .angle = any(),
                             .velocity = {any(), any()},
                             .spin = any()});
    bodies.push_back(body);
    if (i % 3 == 0) {
      system.add(Disc{.body = body, .radius = 0.2});
    } else if (i % 3 == 1) {
      system.add(Polygon{.body = body, .vertices = {{-0.2, -0.1}, {0.2, -0.1}, {0.1, 0.2}}});
    } else {
      system.add(
          Polygon{.body = body, .vertices = {{-0.15, -0.15}, {0.15, -0.15}, {0.15, 0.15}, {-0.15, 0.15}}});
    }
    if (springs && i > 0) {
      system.add(SpringDamper{.from = bodies[static_cast<std::size_t>(i) - 1],
                              .to = body,
                              .stiffness = 20.0,
                              .free_length = 0.5});
    }
  }
  return system;
}

double cross(const Vec<2>& a, const Vec<2>& b) { return a[0] * b[1] - a[1] * b[0]; }

TEST(BodyContacts, MomentumIsKept) {
  // Impulses act at the start of a step, where they change p and L about the origin by nothing, since both
  // bodies are pushed at one point. Positions move with mean velocities, q' = q + h (v + v')/2, so that
  //   L' - L = sum (q' - q) x (p' - p)/2 = (h/2) sum m v x v'.
  constexpr double step = 1e-3;
  for (const bool springs : {false, true}) {
    std::int64_t contacts = 0;
    for (std::uint32_t seed = 0; seed < 10; ++seed) {
      const System system = crowd(seed, springs);
      Simulation simulation(system, TimeStepping{.step = step});
      for (int i = 0; i < 500; ++i) {
        const State before = simulation.state();
        const TotalMomentum p0 = total_momentum(simulation.assembly(), before);
        simulation.step();
        const TotalMomentum p1 = total_momentum(simulation.assembly(), simulation.state());
        // Numbers are of order 10.
        ASSERT_NEAR(p1.linear[0], p0.linear[0], 1e-13);
        ASSERT_NEAR(p1.linear[1], p0.linear[1], 1e-13);
        if (springs) continue;
        double turned = 0.0;
        for (const BodyId body : system.bodies()) {
          const BodySlot slot =
              simulation.assembly().layout()->bodies()[simulation.assembly().layout()->index(body)];
          const double mass = simulation.assembly().body_kinds()[slot.kind]->mass(slot.slot);
          turned += 0.5 * step * mass * cross(before.velocity(body), simulation.state().velocity(body));
        }
        ASSERT_NEAR(p1.angular[2] - p0.angular[2], turned, 1e-13);
      }
      contacts += simulation.statistics().contact_steps;
      EXPECT_NEAR(simulation.energy().residual(), 0.0, 1e-11);
    }
    EXPECT_GT(contacts, 300);
  }
}

TEST(BodyContacts, ThreadsDoNotChangeTheBits) {
  for (const bool springs : {false, true}) {
    State one;
    for (const int threads : {1, 2}) {
      Simulation simulation(crowd(3, springs), TimeStepping{.step = 1e-3, .threads = threads});
      simulation.run_until(1.0);
      if (threads == 1) {
        one = simulation.state();
      } else {
        EXPECT_EQ(simulation.state().q, one.q);
        EXPECT_EQ(simulation.state().v, one.v);
      }
    }
  }
}

TEST(BodyContacts, AnImpactIsTheSameFromACheckpoint) {
  const std::string path = testing::TempDir() + "body_contacts.checkpoint";
  Simulation whole(crowd(5, true), TimeStepping{.step = 1e-3});
  whole.run_until(0.3);
  whole.save(path);
  whole.run_until(1.0);
  Simulation later(crowd(5, true), TimeStepping{.step = 1e-3});
  later.load(path);
  later.run_until(1.0);
  EXPECT_EQ(later.state().q, whole.state().q);
  EXPECT_EQ(later.state().v, whole.state().v);
}

}  // namespace
