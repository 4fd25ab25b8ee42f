#include <carom/carom.h>
#include <carom/core/assembly.h>

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "tests/model_error.h"
#include "tests/reference/reference_data.h"

namespace {

using namespace carom;
using namespace carom::planar;

constexpr double g = 9.81;

/// The message of a SolverError, empty if there is none.
std::string failure_of(const System& system, const EquilibriumOptions& options = {}) {
  try {
    static_cast<void>(find_equilibrium(system, options));
  } catch (const SolverError& error) {
    EXPECT_FALSE(error.failure().parts.empty());
    return error.what();
  }
  return {};
}

#define EXPECT_SAYS(text, part) EXPECT_NE((text).find(part), std::string::npos) << (text)

// Links of equal length and weight between two supports: with the horizontal force H and the vertical forces
// V_i at the pins, V_i - V_(i+1) = m g, the moments of a uniform link say tan theta_i = (V_i + V_(i+1))/(2
// H). H is chosen and the supports are put where the links then end.
TEST(Equilibrium, ChainOfRodsHangsAsItsPolygon) {
  constexpr int links = 9;
  constexpr double mass = 0.7, horizontal = 11.0;
  const auto angle_at = [](int i, double force) {
    return -std::atan2(mass * g * (0.5 * links - i - 0.5), force);
  };
  double x = 0.0, y = 0.0;
  for (int i = 0; i < links; ++i) {
    x += std::cos(angle_at(i, horizontal));
    y += std::sin(angle_at(i, horizontal));
  }
  EXPECT_NEAR(y, 0.0, 1e-14);

  System system;
  system.add(Gravity{{0.0, -g}});
  std::vector<BodyId> chain;
  std::vector<JointId> pins;
  Vec<2> end = Vec<2>::Zero();
  for (int i = 0; i < links; ++i) {
    // Another shape than that of equilibrium, which does not even reach the second support.
    const double angle = angle_at(i, 1.7 * horizontal) + 0.05 * (i % 2);
    const Vec<2> along(std::cos(angle), std::sin(angle));
    chain.push_back(
        system.add(RigidBody{.mass = rod(mass, 1.0), .position = end + 0.5 * along, .angle = angle}));
    const End<2> before = i == 0 ? End<2>(ground) : End<2>(chain[chain.size() - 2], {0.5, 0.0});
    pins.push_back(system.add(Revolute{.from = before, .to = {chain.back(), {-0.5, 0.0}}}));
    end += along;
  }
  pins.push_back(system.add(Revolute{.from = {chain.back(), {0.5, 0.0}}, .to = {ground, {x, 0.0}}}));

  system.close_joints();  // the chain is drawn straight
  const Equilibrium found = find_equilibrium(system);
  for (int i = 0; i < links; ++i) {
    const auto k = static_cast<std::size_t>(i);
    EXPECT_NEAR(found.state.angle(chain[k]), angle_at(i, horizontal), 1e-9) << i;
    // On the link, from what holds its left end.
    const JointReaction left = found.force(pins[k]).reaction;
    EXPECT_NEAR(left.force[0], -horizontal, 1e-9) << i;
    EXPECT_NEAR(left.force[1], mass * g * (0.5 * links - i), 1e-9) << i;
  }
  EXPECT_LT(found.residual, 1e-11);
  EXPECT_LT(found.gap, 1e-12);
  EXPECT_LT(found.steps, 30);
  // A simulation takes the state, and stays there.
  Simulation simulation(system, EventDriven{});
  simulation.set_state(find_equilibrium(simulation.assembly(), simulation.state()).state);
  simulation.run_until(0.5);
  EXPECT_NEAR(simulation.state().angle(chain[4]), found.state.angle(chain[4]), 1e-8);
}

// Particles on rods without mass: tan theta_i = V_i/H.
TEST(Equilibrium, ParticlesOnRods) {
  constexpr int links = 6;
  constexpr double mass = 1.3, horizontal = 20.0;
  const auto angle_at = [](int i, double force) {
    return -std::atan2(mass * g * (0.5 * (links - 1) - i), force);
  };
  System system;
  system.add(Gravity{{0.0, -g}});
  std::vector<BodyId> particles;
  std::vector<JointId> rods;
  Vec<2> start = Vec<2>::Zero(), end = Vec<2>::Zero();
  End<2> before(ground);
  for (int i = 0; i < links; ++i) {
    const double angle = angle_at(i, horizontal);
    start += Vec<2>(std::cos(angle_at(i, 15.0)), std::sin(angle_at(i, 15.0)));
    end += Vec<2>(std::cos(angle), std::sin(angle));
    const bool last = i == links - 1;
    if (!last) particles.push_back(system.add(Particle{.mass = mass, .position = start}));
    const End<2> to = last ? End<2>(ground, end) : End<2>(particles.back());
    rods.push_back(system.add(Rod{.from = before, .to = to, .length = 1.0}));
    before = to;
  }
  const Equilibrium found = find_equilibrium(system);
  end.setZero();
  for (int i = 0; i + 1 < links; ++i) {
    const auto k = static_cast<std::size_t>(i);
    end += Vec<2>(std::cos(angle_at(i, horizontal)), std::sin(angle_at(i, horizontal)));
    EXPECT_LT((found.state.position(particles[k]) - end).norm(), 1e-9) << i;
    const double tension = horizontal / std::cos(angle_at(i, horizontal));
    EXPECT_NEAR(std::abs(found.force(rods[k]).multipliers[0]), tension, 1e-9) << i;
  }
}

// Two springs that sag: 2 k (l - L) sin(angle) = m g. The sag is chosen, and the mass found from it.
TEST(Equilibrium, MassOnSprings) {
  constexpr double k = 300.0, free_length = 0.8, half = 1.0, sag = 0.35;
  const double length = std::hypot(half, sag);
  const double mass = 2.0 * k * (length - free_length) * sag / (length * g);
  System system;
  system.add(Gravity{{0.0, -g}});
  const BodyId body = system.add(Particle{.mass = mass, .position = {0.2, 0.1}});
  for (const double x : {-half, half}) {
    system.add(SpringDamper{
        .from = {ground, {x, 0.0}}, .to = body, .stiffness = k, .damping = 5.0, .free_length = free_length});
  }
  const Equilibrium found = find_equilibrium(system);
  EXPECT_NEAR(found.state.position(body)[0], 0.0, 1e-9);
  EXPECT_NEAR(found.state.position(body)[1], -sag, 1e-9);
  EXPECT_TRUE(found.joints.empty());
}

// Vertical reactions of a beam on two pins are determined, horizontal ones only in their sum.
TEST(Equilibrium, BeamOnTwoPins) {
  constexpr double mass = 3.0, length = 4.0, load = 50.0, place = 1.2;
  System system;
  system.add(Gravity{{0.0, -g}});
  const BodyId beam = system.add(RigidBody{.mass = rod(mass, length), .position = {0.5 * length, 0.0}});
  const JointId left = system.add(Revolute{.from = ground, .to = {beam, {-0.5 * length, 0.0}}});
  const JointId right =
      system.add(Revolute{.from = {ground, {length, 0.0}}, .to = {beam, {0.5 * length, 0.0}}});
  system.add(AppliedForce{.on = {beam, {place - 0.5 * length, 0.0}},
                          .force = [](double) { return Vec<2>(8.0, -load); }});
  const Equilibrium found = find_equilibrium(system);
  const JointReaction a = found.force(left).reaction, b = found.force(right).reaction;
  EXPECT_NEAR(b.force[1], 0.5 * mass * g + load * place / length, 1e-9);
  EXPECT_NEAR(a.force[1], 0.5 * mass * g + load * (1.0 - place / length), 1e-9);
  EXPECT_NEAR(a.force[0] + b.force[0], -8.0, 1e-9);
  EXPECT_NEAR(a.force[0], b.force[0], 1e-9);  // the smallest
}

System ladder(double theta, double friction) {
  constexpr double length = 2.0;
  System system;
  system.add(Gravity{{0.0, -g}});
  system.add(HalfPlane{.normal = {0.0, 1.0}}, Surface{.friction = friction, .normal_restitution = 0.0},
             "floor");
  system.add(HalfPlane{.normal = {1.0, 0.0}}, Surface{.friction = 0.0, .normal_restitution = 0.0}, "wall");
  const double angle = std::numbers::pi - theta;
  const BodyId body =
      system.add(RigidBody{.mass = rod(1.0, length),
                           .position = {0.5 * length * std::cos(theta), 0.5 * length * std::sin(theta)},
                           .angle = angle});
  system.add(Segment{.body = body, .from = {-0.5 * length, 0.0}, .to = {0.5 * length, 0.0}});
  return system;
}

TEST(Equilibrium, Ladder) {
  const auto data = carom_test::reference_data("contacts_planar.json").at("ladder");
  const double theta = data.at("theta").get<double>(), least = data.at("mu_min").get<double>();
  const Equilibrium found = find_equilibrium(ladder(theta, least + 1e-6));
  ASSERT_EQ(found.contacts.size(), 2U);
  for (const ContactForce& force : found.contacts) {
    if (force.friction > 0.0) {
      EXPECT_SAYS(force.name, "floor");
      EXPECT_NEAR(force.normal, data.at("floor_normal").get<double>(), 1e-9);
      EXPECT_NEAR(std::abs(force.tangential[0]), data.at("floor_friction").get<double>(), 1e-9);
    } else {
      EXPECT_SAYS(force.name, "wall");
      EXPECT_NEAR(force.normal, data.at("wall").get<double>(), 1e-9);
    }
  }
  const std::string message = failure_of(ladder(theta, least - 1e-6));
  EXPECT_SAYS(message, "floor");
  EXPECT_SAYS(message, "would slip");
}

// A box that sticks with two corners: normal forces are determined, of the friction the sum. Equal parts
// would be beyond the cone of the upper corner.
TEST(Equilibrium, BoxOnARampSharesItsFriction) {
  constexpr double slope = 0.3, friction = 0.312;
  System system;
  system.add(Gravity{{0.0, -g}});
  system.add(HalfPlane{.normal = incline(slope)}, Surface{.friction = friction, .normal_restitution = 0.0});
  const Vec<2> up(-std::sin(slope), std::cos(slope));
  const BodyId body = system.add(RigidBody{.mass = box(2.0, 1.0, 1.0), .position = 0.5 * up, .angle = slope});
  system.add(Segment{.body = body, .from = {-0.5, -0.5}, .to = {0.5, -0.5}});
  const Equilibrium found = find_equilibrium(system);
  ASSERT_EQ(found.contacts.size(), 2U);
  double along = 0.0, normal = 0.0;
  for (const ContactForce& force : found.contacts) {
    along += force.tangential[0];
    normal += force.normal;
    EXPECT_LE(std::abs(force.tangential[0]), friction * force.normal + 1e-7);
  }
  EXPECT_NEAR(std::abs(along), 2.0 * g * std::sin(slope), 1e-9);
  EXPECT_NEAR(normal, 2.0 * g * std::cos(slope), 1e-9);
}

// A wheel that sticks rolls to where its spring is free.
TEST(Equilibrium, WheelRolls) {
  constexpr double radius = 0.4, away = 0.7;
  System system;
  system.add(Gravity{{0.0, -g}});
  system.add(HalfPlane{.normal = {0.0, 1.0}}, Surface{.friction = 0.5, .normal_restitution = 0.0});
  const BodyId wheel =
      system.add(RigidBody{.mass = disc(1.0, radius), .position = {1.0 + away, radius}, .angle = 0.1});
  system.add(Disc{.body = wheel, .radius = radius});
  system.add(
      SpringDamper{.from = {ground, {0.0, radius}}, .to = wheel, .stiffness = 40.0, .free_length = 1.0});
  const Equilibrium found = find_equilibrium(system);
  EXPECT_NEAR(found.state.position(wheel)[0], 1.0, 1e-9);
  EXPECT_NEAR(found.state.angle(wheel), 0.1 + away / radius, 1e-9);
}

// In space friction has two directions.
TEST(Equilibrium, ParticleOnARampInSpace) {
  System system;
  system.add(spatial::Gravity{{1.0, 2.0, -g}});
  system.add(spatial::HalfSpace{.normal = {0.0, 0.0, 1.0}},
             Surface{.friction = 0.25, .normal_restitution = 0.0});
  system.add(spatial::Particle{.mass = 2.0});
  const Equilibrium found = find_equilibrium(system);
  ASSERT_EQ(found.contacts.size(), 1U);
  EXPECT_NEAR(found.contacts[0].normal, 2.0 * g, 1e-12);
  EXPECT_NEAR(std::hypot(found.contacts[0].tangential[0], found.contacts[0].tangential[1]),
              2.0 * std::sqrt(5.0), 1e-12);
}

TEST(Equilibrium, StopHolds) {
  System system;
  system.add(Gravity{{0.0, -g}});
  const BodyId arm = system.add(RigidBody{.mass = rod(2.0, 1.0), .position = {0.5, 0.0}});
  const JointId pin = system.add(Revolute{.from = ground, .to = {arm, {-0.5, 0.0}}});
  system.add(Stop{.joint = pin, .lower = 0.0});
  const Equilibrium found = find_equilibrium(system);
  ASSERT_EQ(found.contacts.size(), 1U);
  EXPECT_NEAR(found.contacts[0].normal, 2.0 * g * 0.5, 1e-9);
}

// A spring without tension has no stiffness sideways, where the load pulls: 2 k (l - 1) y = m g l.
TEST(Equilibrium, LoadAcrossSlackSprings) {
  System system;
  system.add(Gravity{{0.0, -g}});
  const BodyId body = system.add(Particle{.mass = 1.0});
  for (const double x : {-1.0, 1.0}) {
    system.add(SpringDamper{.from = {ground, {x, 0.0}}, .to = body, .stiffness = 100.0, .free_length = 1.0});
  }
  const Equilibrium found = find_equilibrium(system);
  const double y = found.state.position(body)[1], length = std::hypot(1.0, y);
  EXPECT_LT(y, 0.0);
  EXPECT_NEAR(-200.0 * (length - 1.0) * y / length, g, 1e-9);
}

TEST(Equilibrium, SaysWhatFails) {
  System falling;
  falling.add(Gravity{{0.0, -g}});
  falling.add(Particle{.mass = 1.0}, "stone");
  EXPECT_SAYS(failure_of(falling), "'stone' can move without being held back, out of balance by 9.81 N");

  System pulled;
  pulled.add(HalfPlane{.normal = {0.0, 1.0}}, Surface{.friction = 0.3, .normal_restitution = 0.0});
  const BodyId mass = pulled.add(Particle{.mass = 1.0}, "mass");
  pulled.add(SpringDamper{.from = {ground, {0.0, 2.0}}, .to = mass, .stiffness = 10.0, .free_length = 1.0});
  EXPECT_SAYS(failure_of(pulled), "would have to pull with 10");

  System turned;
  turned.add(Gravity{{0.0, -g}});
  const BodyId arm = turned.add(RigidBody{.mass = rod(1.0, 2.0), .position = {1.0, 0.1}}, "arm");
  turned.add(Revolute{.from = {ground, {0.0, 0.1}}, .to = {arm, {-1.0, 0.0}}});
  turned.add(AppliedTorque{.on = arm, .torque = [](double) { return 1.1 * g; }});
  EXPECT_SAYS(failure_of(turned), "'arm' can move without being held back, out of balance by");

  System sinking;
  sinking.add(Gravity{{0.0, -g}});
  sinking.add(HalfPlane{.point = {0.0, -1.2}, .normal = {0.0, 1.0}},
              Surface{.friction = 0.0, .normal_restitution = 0.0}, "floor");
  const BodyId weight = sinking.add(Particle{.mass = 1.0, .position = {0.0, -1.0}});
  sinking.add(SpringDamper{.from = ground, .to = weight, .stiffness = 10.0, .free_length = 1.0});
  EXPECT_SAYS(failure_of(sinking), "is entered by 0.78");

  System creeping;
  const BodyId creeper = creeping.add(Particle{.mass = 1.0, .position = {0.0, -1.0}});
  creeping.add(MaxwellElement{.from = ground, .to = creeper, .stiffness = 10.0, .damping = 1.0}, "link");
  EXPECT_MODEL_ERROR(find_equilibrium(creeping), "'link' has internal variables");

  EquilibriumOptions options;
  options.tolerance = 0.0;
  EXPECT_MODEL_ERROR(find_equilibrium(sinking, options), "tolerance is 0");
}

}  // namespace
