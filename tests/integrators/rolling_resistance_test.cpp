// Rolling resistance |M| <= rho P_n in time stepping: closed forms of a disc on ground and of two discs that
// meet, its line of the ledger, one contact against the enumeration of its modes.

#include "tests/contact/random_problems.h"
#include "tests/integrators/event_driven/body_scenes.h"

#include <carom/carom.h>

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <vector>

namespace {

using namespace body_scenes;
using contact_test::Random;

constexpr double radius = 0.2, mass = 1.5;

/// A disc on a plane that falls with +x, turned by the slope; it stands on it.
struct DiscOnGround {
  System system;
  BodyId disc;

  DiscOnGround(double slope, double rho, double speed) {
    const Vec<2> normal(std::sin(slope), std::cos(slope)), along(std::cos(slope), -std::sin(slope));
    system.add(Gravity{{0.0, -g}});
    system.add(HalfPlane{.normal = normal},
               Surface{.friction = 2.0, .normal_restitution = 0.0, .rolling_resistance = rho});
    disc = add_disc(system, mass, radius, radius * normal, speed * along, -speed / radius);
  }
};

TEST(RollingResistance, DiscRollsToRestWithConstantDeceleration) {
  constexpr double rho = 0.01, speed = 1.0;
  // (m r + I/r) dv/dt = -rho m g.
  constexpr double deceleration = rho * g / (1.5 * radius);
  constexpr double end = speed / deceleration;
  const DiscOnGround scene(0.0, rho, speed);
  Simulation simulation(scene.system, TimeStepping{.step = 1e-3});
  for (const double part : {0.25, 0.5, 0.9}) {
    simulation.run_until(part * end);
    const double t = simulation.state().time;
    // Exact in every step; rounding of 3,000 of them.
    EXPECT_NEAR(simulation.state().velocity(scene.disc)[0], speed - deceleration * t, 1e-12);
    EXPECT_NEAR(simulation.state().spin(scene.disc), -(speed - deceleration * t) / radius, 1e-11);
    EXPECT_NEAR(simulation.state().position(scene.disc)[0], speed * t - 0.5 * deceleration * t * t, 1e-11);
  }
  simulation.run_until(1.1 * end);
  EXPECT_NEAR(simulation.state().velocity(scene.disc)[0], 0.0, 1e-14);
  EXPECT_NEAR(simulation.state().spin(scene.disc), 0.0, 1e-13);
  // The last step may stop it up to a step early or late.
  EXPECT_NEAR(simulation.state().position(scene.disc)[0], 0.5 * speed * end, deceleration * 1e-6);
  const double kinetic = 0.75 * mass * speed * speed;
  EXPECT_NEAR(simulation.energy().flow(EnergyFlow::rolling), kinetic, 1e-5 * kinetic);
  EXPECT_NEAR(simulation.energy().flow(EnergyFlow::sliding), 0.0, 1e-5 * kinetic);
  EXPECT_LE(std::abs(simulation.energy().residual()), 1e-13);
  ASSERT_EQ(simulation.report().contacts.size(), 1U);
}

TEST(RollingResistance, DiscOnAnInclineStaysBelowTheAngleOfRolling) {
  constexpr double rho = 0.02;
  const double limit = std::atan(rho / radius);
  for (const double share : {0.5, 0.99, 1.01, 2.0}) {
    const double slope = share * limit;
    const DiscOnGround scene(slope, rho, 0.0);
    Simulation simulation(scene.system, TimeStepping{.step = 1e-3});
    simulation.run_until(0.5);
    const double acceleration =
        share < 1.0 ? 0.0 : g * (std::sin(slope) - rho / radius * std::cos(slope)) / 1.5;
    EXPECT_NEAR(simulation.state().velocity(scene.disc).norm(), acceleration * 0.5, 1e-13) << share;
    EXPECT_NEAR(simulation.state().spin(scene.disc), -acceleration * 0.5 / radius, 1e-12) << share;
    const double work = simulation.energy().flow(EnergyFlow::rolling);
    const double angle = 0.5 * acceleration * 0.25 / radius;
    EXPECT_NEAR(work, rho * mass * g * std::cos(slope) * angle, 1e-12) << share;
    const ContactRecord& contact = simulation.report().contacts.at(0);
    const double force = std::min(radius * std::sin(slope), rho * std::cos(slope));
    EXPECT_NEAR(contact.rolling_moment, force * mass * g * 1e-3, 1e-13) << share;
    EXPECT_LE(std::abs(simulation.energy().residual()), 1e-13) << share;
  }
}

TEST(RollingResistance, DiscsThatMeetExchangeSpin) {
  // Central and without friction: P_n = m (1 + e) v/2; the moment stops the relative spin, -e_r of it is
  // left, if I (1 + e_r) w/2 <= rho P_n. Steps begin where gaps are closed already.
  Random random(3);
  int stops = 0;
  for (int i = 0; i < 50; ++i) {
    const double rho = random.uniform(0.0, 0.05), e = random.uniform(0.0, 1.0);
    const double e_r = random.uniform(0.0, 1.0);
    const double speed = random.uniform(0.5, 2.0), spin = random.uniform(-3.0, 3.0);
    System system;
    system.set_default_law(
        {.friction = 0.0, .normal_restitution = e, .rolling_resistance = rho, .rolling_restitution = e_r});
    const BodyId a = add_disc(system, mass, radius, {-radius, 0.0}, {speed, 0.0}, spin);
    const BodyId b = add_disc(system, mass, radius, {radius - 1e-9, 0.0});
    Simulation simulation(system, TimeStepping{.step = 1e-4});
    simulation.step();
    const double inertia = 0.5 * mass * radius * radius;
    const double limit = rho * 0.5 * mass * (1.0 + e) * speed;
    const double moment = std::clamp(-0.5 * inertia * (1.0 + e_r) * spin, -limit, limit);
    stops += std::abs(moment) < limit ? 1 : 0;
    EXPECT_NEAR(simulation.state().spin(a), spin + moment / inertia, 1e-12) << i;
    EXPECT_NEAR(simulation.state().spin(b), -moment / inertia, 1e-12) << i;
    const double kinetic =
        0.5 * inertia * (spin * spin - std::pow(spin + moment / inertia, 2) - std::pow(moment / inertia, 2));
    EXPECT_NEAR(simulation.energy().flow(EnergyFlow::rolling), kinetic, 1e-13) << i;
    EXPECT_LE(std::abs(simulation.energy().residual()), 1e-13) << i;
  }
  EXPECT_GT(stops, 5);
  EXPECT_LT(stops, 45);
}

/// Impulses of one contact with rolling resistance: an equation for each row, by mode. Nothing if a condition
/// of the mode is violated.
bool in_mode(const ContactProblem& problem, const std::array<int, 3>& mode, Eigen::Vector3d& impulse) {
  Eigen::Matrix3d matrix;
  Eigen::Vector3d b;
  for (int i = 0; i < 3; ++i) {
    b[i] = problem.vector()[static_cast<std::size_t>(i)];
    for (int j = 0; j < 3; ++j) matrix(i, j) = problem.w(i, j);
  }
  Eigen::Matrix3d equations = matrix;
  Eigen::Vector3d right = -b;
  for (int i = 1; i < 3; ++i) {
    if (mode[static_cast<std::size_t>(i)] == 0) continue;
    const double slope =
        -mode[static_cast<std::size_t>(i)] * problem.sets()[static_cast<std::size_t>(i)].coefficient;
    equations.row(i) = Eigen::RowVector3d::Unit(i);
    equations(i, 0) = -slope;
    right[i] = 0.0;
  }
  impulse = equations.fullPivLu().solve(right);
  const Eigen::Vector3d xi = matrix * impulse + b;
  if (impulse[0] < 0.0) return false;
  for (int i = 1; i < 3; ++i) {
    const int of_row = mode[static_cast<std::size_t>(i)];
    const double limit = problem.sets()[static_cast<std::size_t>(i)].coefficient * impulse[0];
    if (of_row == 0 ? std::abs(impulse[i]) > limit : of_row * xi[i] < 0.0) return false;
  }
  return true;
}

/// One contact with a row of rolling resistance; its velocities and coefficients are left zero.
ContactProblem rolling_contact(double inverse_inertia, double r_x, double r_y) {
  const std::array<Eigen::Vector3d, 3> rows{Eigen::Vector3d(1.0, 0.0, r_x), Eigen::Vector3d(0.0, 1.0, -r_y),
                                            Eigen::Vector3d(0.0, 0.0, 1.0)};
  // Of two bodies, so that W has full rank: a little mass of the rows' own.
  const Eigen::Vector3d masses(1.0, 1.0, inverse_inertia);
  ContactProblem problem;
  problem.reset(3);
  for (std::size_t k = 0; k < 3; ++k) {
    for (std::size_t l = 0; l < 3; ++l)
      problem.w(static_cast<int>(k), static_cast<int>(l)) = rows[k].dot(masses.cwiseProduct(rows[l]));
  }
  problem.sets()[0].kind = SetKind::half_line;
  for (const std::size_t row : {std::size_t{1}, std::size_t{2}}) {
    problem.sets()[row].kind = SetKind::bounded_interval;
    problem.sets()[row].bound = 0;
  }
  problem.group();
  return problem;
}

TEST(RollingResistance, OneContactIsOneOfItsModes) {
  Random random(11);
  int several = 0;
  for (int i = 0; i < 2000; ++i) {
    const double inverse_inertia = random.log_uniform(0.1, 10.0);
    const double r_x = random.uniform(-1.0, 1.0), r_y = random.uniform(-1.0, 1.0);
    ContactProblem problem = rolling_contact(inverse_inertia, r_x, r_y);
    for (std::size_t k = 0; k < 3; ++k) {
      const double b = random.uniform(-2.0, 2.0);
      problem.vector()[k] = k == 0 ? -std::abs(b) : b;
    }
    problem.sets()[1].coefficient = random.uniform(0.0, 1.0);
    problem.sets()[2].coefficient = random.uniform(0.0, 0.3);
    SolverChain chain;
    std::vector<double> impulse(3);
    const ContactReport report = chain.solve(problem, impulse);
    ASSERT_TRUE(report.usable()) << i << " " << report.reason;
    double nearest = std::numeric_limits<double>::infinity();
    int solutions = 0;
    for (int slip = -1; slip <= 1; ++slip) {
      for (int turn = -1; turn <= 1; ++turn) {
        Eigen::Vector3d found;
        if (!in_mode(problem, {0, slip, turn}, found)) continue;
        ++solutions;
        const Eigen::Vector3d answer(impulse[0], impulse[1], impulse[2]);
        nearest = std::min(nearest, (found - answer).norm() / found.norm());
      }
    }
    EXPECT_LE(nearest, 1e-10) << i;
    // The list of all solutions has these.
    SolutionList list;
    const Outcome outcome = list.enumerate(problem);
    EXPECT_EQ(list.size(), static_cast<std::size_t>(solutions)) << i;
    EXPECT_EQ(outcome == Outcome::several_solutions, solutions > 1) << i;
    several += solutions > 1 ? 1 : 0;
  }
  EXPECT_LT(several, 1000);
}

TEST(RollingResistance, WhatPartsTakesNoImpulse) {
  // Strong friction with a long lever has another solution, in which the ground catches what leaves it.
  Random random(12);
  int others = 0;
  for (int i = 0; i < 8000; ++i) {
    const double inverse_inertia = random.log_uniform(1.0, 100.0);
    const double r_x = random.uniform(-1.0, 1.0), r_y = random.uniform(-1.0, 1.0);
    ContactProblem problem = rolling_contact(inverse_inertia, r_x, r_y);
    for (std::size_t k = 0; k < 3; ++k)
      problem.vector()[k] = k == 0 ? random.uniform(0.0, 0.3) : random.uniform(-3.0, 3.0);
    problem.sets()[1].coefficient = random.uniform(0.0, 2.0);
    problem.sets()[2].coefficient = random.uniform(0.0, 0.3);
    for (int way = -1; way <= 1; ++way) {
      Eigen::Vector3d found;
      others += in_mode(problem, {0, way, 0}, found) && found[0] > 1e-3 ? 1 : 0;
    }
    SolverChain chain;
    std::vector<double> impulse(3, 1.0);
    ASSERT_TRUE(chain.solve(problem, impulse).usable()) << i;
    EXPECT_EQ(impulse, std::vector<double>(3, 0.0)) << i;
  }
  EXPECT_GT(others, 50);
}

TEST(RollingResistance, ImpactLawsTakeItToo) {
  // A disc that falls with spin on ground without friction: M = -rho P_n until the spin is gone.
  for (const ImpactLaw law : {ImpactLaw::newton, ImpactLaw::poisson, ImpactLaw::energetic}) {
    System system;
    system.add(
        HalfPlane{.normal = {0.0, 1.0}},
        Surface{.friction = 0.0, .normal_restitution = 0.5, .impact_law = law, .rolling_resistance = 0.01});
    const BodyId disc = add_disc(system, mass, radius, {0.0, radius}, {0.0, -1.0}, 30.0);
    Simulation simulation(system, TimeStepping{.step = 1e-3});
    simulation.step();
    const double inertia = 0.5 * mass * radius * radius;
    EXPECT_NEAR(simulation.state().velocity(disc)[1], 0.5, 1e-13) << to_string(law);
    EXPECT_NEAR(simulation.state().spin(disc), 30.0 - 0.01 * 1.5 * mass / inertia, 1e-12) << to_string(law);
    EXPECT_LE(std::abs(simulation.energy().residual()), 1e-13) << to_string(law);
  }
}

TEST(RollingResistance, GroundThatTurnsTakesADiscAlong) {
  // A disc falls without spin on ground that turns about where it is hit, without friction: M = rho P_n.
  constexpr double rho = 0.01, turn = 30.0, e = 0.5, speed = 1.0;
  for (const bool pieces : {false, true}) {
    System system;
    const PrescribedMotion motion{.angle = [](double t) { return turn * t; },
                                  .spin = [](double) { return turn; },
                                  .angular_acceleration = [](double) { return 0.0; }};
    const Surface law{.friction = 0.0, .normal_restitution = e, .rolling_resistance = rho};
    if (pieces) {
      system.add(planar::Block{.vertices = {{-1, -1}, {1, -1}, {1, 0}, {-1, 0}}, .motion = motion}, law);
    } else {
      system.add(HalfPlane{.normal = {0.0, 1.0}, .motion = motion}, law);
    }
    const BodyId disc = add_disc(system, mass, radius, {0.0, radius - 1e-9}, {0.0, -speed});
    Simulation simulation(system, TimeStepping{.step = 1e-7});
    simulation.step();
    const double inertia = 0.5 * mass * radius * radius, spin = rho * (1.0 + e) * speed * mass / inertia;
    // The normal turns by 3e-6 in the step, and the ground under the disc comes up at turn^2 h r = 9e-6 m/s.
    EXPECT_NEAR(simulation.state().spin(disc), spin, 1e-4 * spin) << pieces;
    EXPECT_LE(std::abs(simulation.energy().residual()), 1e-13) << pieces;
    // The relative spin goes from -30/s to -30/s + spin, and the ground does the rest.
    const double moment = inertia * spin;
    EXPECT_NEAR(simulation.energy().flow(EnergyFlow::rolling), moment * (turn - 0.5 * spin),
                1e-3 * moment * turn)
        << pieces;
  }
}

TEST(RollingResistance, ADiscRollsWhereItIsInADrumThatTurns) {
  // The moment of its weight about where it touches is rho P_n: it stays at the angle atan(rho/r).
  constexpr double rho = 0.02, spin = 2.0, drum_radius = 1.0, time = 2.0;
  const double angle = std::atan(rho / radius);
  System system;
  system.add(Gravity{{0.0, -g}});
  system.add(drum({0.0, 0.0}, drum_radius, spin),
             Surface{.friction = 0.8, .normal_restitution = 0.0, .rolling_resistance = rho});
  const double rolls = spin * drum_radius / radius;
  const Vec<2> place = (drum_radius - radius) * Vec<2>(std::sin(angle), -std::cos(angle));
  const BodyId disc = add_disc(system, mass, radius, place, {0.0, 0.0}, rolls);
  Simulation simulation(system, TimeStepping{.step = 1e-4});
  simulation.run_until(time);
  // Rows at the start of a step: of first order, g h t.
  EXPECT_LT((simulation.state().position(disc) - place).norm(), 2e-3);
  EXPECT_NEAR(simulation.state().spin(disc), rolls, 2e-2);
  EXPECT_LE(std::abs(simulation.energy().residual()), 1e-11);
  const double moment = rho * mass * g * std::cos(angle);
  EXPECT_NEAR(simulation.energy().flow(EnergyFlow::rolling), moment * (rolls - spin) * time, 1e-2);
  EXPECT_NEAR(simulation.energy().flow(EnergyFlow::external), moment * (rolls - spin) * time, 1e-2);
}

}  // namespace
