// Contacts as constraints of smooth motion: forces against closed forms, also where they are not unique;
// margins are the largest there are; corrections bring gaps and velocities back by the smallest change.

#include "tests/random.h"
#include "tests/shares.h"

#include <carom/carom.h>
#include <carom/contact/active_set.h>
#include <carom/contact/detection/detector.h>
#include <carom/core/assembly.h>
#include <carom/core/constraint_set.h>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

namespace {

using namespace carom;
using namespace carom::planar;
using carom_test::Random;

constexpr double g = 9.81;

/// A model at its start, with all contacts nearer than 1 cm closed.
struct Closed {
  explicit Closed(const System& system, ContactMode mode = ContactMode::stick)
      : assembly(system),
        detector(assembly),
        state(assembly.initial_state()),
        evaluation(make_evaluation(assembly)) {
    detector.place(state.time, places);
    for (const ContactPair& pair : detector.pairs(0)) {
      evaluate_positions(assembly, 0, state.view(), evaluation);
      SingleConstraint at;
      detector.contact(pair, state.view(), evaluation, places, at);
      if (at.gap > 1e-2) continue;
      ActiveContact& closed = contacts.list().emplace_back();
      closed.pair = pair;
      closed.mode = mode;
    }
    update();
  }
  void update() {
    evaluate_positions(assembly, 0, state.view(), evaluation);
    contacts.update(detector, state.view(), evaluation, places);
  }
  /// Accelerations with the reactions to given ones without.
  std::vector<double> react(std::vector<double> free) {
    solved = contacts.add_reactions(assembly, free.data());
    return free;
  }
  double margin() {
    std::vector<ForceMargin> margins;
    contacts.margins(margins);
    EXPECT_EQ(margins.size(), 1u);
    return margins.front().margin;
  }
  const ActiveContact& operator[](std::size_t i) const { return contacts.list()[i]; }

  Assembly assembly;
  Detector detector;
  State state;
  Evaluation evaluation;
  GroundPlaces places;
  ActiveSetMemory memory;
  ActiveSet contacts{memory};
  bool solved = false;
};

constexpr double mass = 2.0, half_width = 0.5, half_height = 0.2;

/// A brick on a slope.
System brick(double friction, double slope = 0.0, const Vec<2>& velocity = {0.0, 0.0}) {
  System system;
  const Vec<2> normal = incline(slope);
  system.add(HalfPlane{.normal = normal}, Surface{.friction = friction, .normal_restitution = 0.0});
  const BodyId id = system.add(RigidBody{.mass = box(mass, 2.0 * half_width, 2.0 * half_height),
                                         .position = half_height * normal,
                                         .angle = slope,
                                         .velocity = velocity});
  system.add(Polygon{.body = id,
                     .vertices = {{-half_width, -half_height},
                                  {half_width, -half_height},
                                  {half_width, half_height},
                                  {-half_width, half_height}}});
  return system;
}

TEST(ActiveSet, ABrickThatSticksAtTwoCorners) {
  const double friction = 0.4;
  for (const double pull : {0.0, 0.1, 0.3, 0.39, 0.6}) {  // of its weight, at its centre
    Closed closed(brick(friction));
    ASSERT_EQ(closed.contacts.list().size(), 2u);
    const std::vector<double> a = closed.react({pull * g, -g, 0.0});
    EXPECT_TRUE(closed.solved);
    for (const double number : a) EXPECT_NEAR(number, 0.0, 1e-13);
    const double margin = closed.margin();
    const ActiveContact &left = closed[0], &right = closed[1];
    const double weight = mass * g, force = pull * weight;
    // Moments about the centre.
    const double shift = force * half_height / (2.0 * half_width);
    EXPECT_NEAR(left.normal, 0.5 * weight - shift, 1e-12);
    EXPECT_NEAR(right.normal, 0.5 * weight + shift, 1e-12);
    EXPECT_NEAR(left.tangential[0] + right.tangential[0], -force, 1e-12);
    // The largest of min(mu N_1 - |T_1|, mu N_2 - |F - T_1|): two tents.
    const double best = std::min(
        {left.normal, friction * left.normal, friction * right.normal, 0.5 * (friction * weight - force)});
    EXPECT_NEAR(margin, best, 1e-12) << pull;
    EXPECT_NEAR(std::min(friction * left.normal - std::abs(left.tangential[0]),
                         friction * right.normal - std::abs(right.tangential[0])),
                best, 1e-12);
  }
}

TEST(ActiveSet, ABrickThatSlips) {
  const double friction = 0.4, slope = 0.2;
  for (const double side : {1.0, -1.0}) {
    const Vec<2> along(std::cos(slope), std::sin(slope));
    Closed closed(brick(friction, slope, side * along),
                  side > 0.0 ? ContactMode::slip_positive : ContactMode::slip_negative);
    const std::vector<double> a = closed.react({0.0, -g, 0.0});
    const double expected = -g * std::sin(slope) - side * friction * g * std::cos(slope);
    EXPECT_NEAR(a[0], expected * along[0], 1e-13);
    EXPECT_NEAR(a[1], expected * along[1], 1e-13);
    EXPECT_NEAR(a[2], 0.0, 1e-12);
    const double weight = mass * g * std::cos(slope);
    const double shift = side * friction * weight * half_height / (2.0 * half_width);
    EXPECT_NEAR(closed[0].normal, 0.5 * weight - shift, 1e-12);
    EXPECT_NEAR(closed[1].normal, 0.5 * weight + shift, 1e-12);
    EXPECT_NEAR(closed[0].tangential[0], -side * friction * closed[0].normal, 1e-13);
    EXPECT_NEAR(closed.margin(), std::min(closed[0].normal, closed[1].normal), 1e-12);
  }
}

TEST(ActiveSet, ABrickThatSticksOnASlope) {
  const double friction = 0.8, slope = 0.5;
  Closed closed(brick(friction, slope));
  const std::vector<double> a = closed.react({0.0, -g, 0.0});
  for (const double number : a) EXPECT_NEAR(number, 0.0, 1e-13);
  closed.margin();
  EXPECT_NEAR(closed[0].normal + closed[1].normal, mass * g * std::cos(slope), 1e-12);
  EXPECT_NEAR(closed[0].tangential[0] + closed[1].tangential[0], mass * g * std::sin(slope), 1e-12);
}

TEST(ActiveSet, ASlipperyBrickOnASlope) {
  Closed closed(brick(0.0, 0.5), ContactMode::slip_positive);
  for (ActiveContact& contact : closed.contacts.list()) contact.frictionless = true;
  closed.update();
  const std::vector<double> a = closed.react({0.0, -g, 0.0});
  EXPECT_NEAR(a[0], -g * std::sin(0.5) * std::cos(0.5), 1e-13);
  EXPECT_EQ(closed[0].tangential[0], 0.0);
}

TEST(ActiveSet, ADiscThatRolls) {
  // Down a slope: 2/3 of the acceleration of sliding without friction.
  System system;
  const double slope = 0.3, radius = 0.5;
  const Vec<2> normal = incline(slope);
  system.add(HalfPlane{.normal = normal}, Surface{.friction = 0.5, .normal_restitution = 0.0});
  const BodyId id = system.add(RigidBody{.mass = disc(mass, radius), .position = radius * normal});
  system.add(Disc{.body = id, .radius = radius});
  Closed closed(system);
  const std::vector<double> a = closed.react({0.0, -g, 0.0});
  const double expected = 2.0 / 3.0 * g * std::sin(slope);
  EXPECT_NEAR(a[0], -expected * std::cos(slope), 1e-13);
  EXPECT_NEAR(a[2], expected / radius, 1e-12);
  EXPECT_NEAR(closed[0].tangential[0], mass * g * std::sin(slope) / 3.0, 1e-12);
  EXPECT_NEAR(closed.margin(), 0.5 * mass * g * std::cos(slope) - mass * g * std::sin(slope) / 3.0, 1e-12);
}

/// The largest margin by all vertices of the piecewise linear function over the null space of the balance.
double largest_margin(const Closed& closed) {
  const auto& list = closed.contacts.list();
  const auto n = static_cast<Eigen::Index>(list.size());
  Eigen::MatrixXd balance(list[0].at.columns(), 2 * n);
  Eigen::VectorXd force(2 * n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const ActiveContact& contact = list[static_cast<std::size_t>(i)];
    for (Eigen::Index c = 0; c < balance.rows(); ++c) {
      balance(c, 2 * i) = contact.at.row(0)[c];
      balance(c, 2 * i + 1) = contact.at.row(1)[c];
    }
    force[2 * i] = contact.normal;
    force[2 * i + 1] = contact.tangential[0];
  }
  Eigen::FullPivLU<Eigen::MatrixXd> lu(balance);
  lu.setThreshold(1e-10);
  const Eigen::MatrixXd kernel = lu.kernel();
  const Eigen::Index k = kernel.cols();
  Eigen::MatrixXd slope(3 * n, k);
  Eigen::VectorXd at(3 * n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const double mu = list[static_cast<std::size_t>(i)].friction;
    slope.row(3 * i) = kernel.row(2 * i);
    at[3 * i] = force[2 * i];
    for (const double side : {-1.0, 1.0}) {
      const Eigen::Index row = 3 * i + (side < 0.0 ? 1 : 2);
      slope.row(row) = mu * kernel.row(2 * i) + side * kernel.row(2 * i + 1);
      at[row] = mu * force[2 * i] + side * force[2 * i + 1];
    }
  }
  double best = (at).minCoeff();
  std::vector<Eigen::Index> chosen(static_cast<std::size_t>(k) + 1);
  const auto choose = [&](auto&& self, std::size_t place, Eigen::Index from) -> void {
    if (place == chosen.size()) {
      Eigen::MatrixXd m(k + 1, k + 1);
      Eigen::VectorXd b(k + 1);
      for (Eigen::Index r = 0; r <= k; ++r) {
        m.row(r).head(k) = slope.row(chosen[static_cast<std::size_t>(r)]);
        m(r, k) = -1.0;
        b[r] = -at[chosen[static_cast<std::size_t>(r)]];
      }
      const Eigen::FullPivLU<Eigen::MatrixXd> solver(m);
      if (!solver.isInvertible()) return;
      const Eigen::VectorXd x = solver.solve(b);
      best = std::max(best, (at + slope * x.head(k)).minCoeff());
      return;
    }
    for (Eigen::Index i = from; i < 3 * n; ++i) {
      chosen[place] = i;
      self(self, place + 1, i + 1);
    }
  };
  choose(choose, 0, 0);
  return best;
}

TEST(ActiveSet, MarginsAreTheLargestOfABallInAV) {
  Random random(1);
  for (int i = 0; i < 300; ++i) {
    System system;
    for (const double side : {-1.0, 1.0}) {
      // So slippery that the walls cannot press against each other.
      system.add(HalfPlane{.normal = {side * random.uniform(0.3, 1.0), 1.0}},
                 Surface{.friction = random.uniform(0.05, 0.25), .normal_restitution = 0.0});
    }
    if (i % 2 == 0) {
      system.add(Particle{.mass = mass});
      Closed closed(system);
      closed.react({random.uniform(-2.0, 2.0), -g});
      const double best = largest_margin(closed);
      EXPECT_NEAR(closed.margin(), best, 1e-10) << i;
    }
  }
}

void find_margins_in_a_corner(std::uint64_t seed, int count) {
  Random random(seed);
  for (int i = 0; i < count; ++i) {
    System system = brick(random.uniform(0.05, 0.9));
    system.add(HalfPlane{.point = {half_width, 0.0}, .normal = {-1.0, 0.0}},
               Surface{.friction = random.uniform(0.05, 0.9), .normal_restitution = 0.0});
    Closed closed(system);
    ASSERT_EQ(closed.contacts.list().size(), 4u);
    const std::vector<double> a = closed.react({random.uniform(-5.0, 15.0), -g, random.uniform(-20.0, 20.0)});
    for (const double number : a) EXPECT_NEAR(number, 0.0, 1e-12);
    const double best = largest_margin(closed);
    EXPECT_NEAR(closed.margin(), best, 1e-10) << i;
    // The distributed forces still do the same.
    double up = 0.0, along = 0.0;
    for (const ActiveContact& contact : closed.contacts.list()) {
      along += contact.normal * contact.at.row(0)[0] + contact.tangential[0] * contact.at.row(1)[0];
      up += contact.normal * contact.at.row(0)[1] + contact.tangential[0] * contact.at.row(1)[1];
    }
    EXPECT_NEAR(up, mass * g, 1e-11);
    EXPECT_TRUE(std::isfinite(along));
  }
}

TEST(ActiveSet, MarginsAreTheLargestOfABoxInACorner) {
  find_margins_in_a_corner(2, carom_test::count_of_samples(100));
}
TEST(ClosedContactsLong, MarginsAreTheLargestOfABoxInACorner) { find_margins_in_a_corner(3, 500); }

TEST(ActiveSet, WedgedContactsKeepFiniteForces) {
  // Two walls with much friction may press a particle as hard as they like.
  System system;
  for (const double side : {-1.0, 1.0}) {
    system.add(HalfPlane{.normal = {side, 0.1}}, Surface{.friction = 1.0, .normal_restitution = 0.0});
  }
  system.add(Particle{.mass = mass});
  Closed closed(system);
  closed.react({0.0, -g});
  EXPECT_GT(closed.margin(), 0.0);
  for (const ActiveContact& contact : closed.contacts.list()) {
    EXPECT_LT(contact.normal, 1e4 * mass * g);
    EXPECT_LE(std::abs(contact.tangential[0]), contact.normal);
  }
}

TEST(ActiveSet, CorrectionsRestoreGapsAndVelocities) {
  Random random(3);
  for (int i = 0; i < 100; ++i) {
    Closed closed(brick(0.4, random.uniform(-0.5, 0.5)),
                  i % 2 == 0 ? ContactMode::stick : ContactMode::slip_positive);
    for (std::size_t c = 0; c < 3; ++c) {
      closed.state.q[c] += random.uniform(-1e-6, 1e-6);
      closed.state.v[c] += random.uniform(-1.0, 1.0);
    }
    closed.update();
    std::vector<double> of_position(3, 0.0), of_velocity(3, 0.0);
    EXPECT_TRUE(closed.contacts.corrections(closed.assembly, closed.state.v.data(), of_position.data(),
                                            of_velocity.data()));
    for (std::size_t c = 0; c < 3; ++c) {
      closed.state.q[c] += of_position[c];
      closed.state.v[c] += of_velocity[c];
    }
    closed.update();
    for (const ActiveContact& contact : closed.contacts.list()) {
      EXPECT_NEAR(contact.at.gap, 0.0, 1e-11);  // (1e-6)^2 times lengths
      // Rows have moved with the positions.
      EXPECT_NEAR(contact.at.velocity(0, closed.state.v.data()), 0.0, 1e-5);
      if (contact.sticks()) {
        EXPECT_NEAR(contact.at.velocity(1, closed.state.v.data()), 0.0, 1e-5);
      }
    }
  }
}

TEST(ActiveSet, CorrectionsAreTheSmallestInTheSenseOfTheMasses) {
  // One corner of a leaning box: dq = -M^-1 n gap/(n M^-1 n).
  System system = brick(0.4);
  Closed closed(system, ContactMode::slip_positive);
  closed.state.angle(system.bodies().front()) = 0.3;
  closed.state.q[1] = half_width * std::sin(0.3) + half_height * std::cos(0.3) + 1e-3;
  closed.state.v = {0.3, -0.2, 0.7};
  closed.contacts.list().pop_back();
  closed.update();
  const SingleConstraint at = closed[0].at;
  ASSERT_NEAR(at.gap, 1e-3, 1e-15);
  std::vector<double> of_position(3, 0.0), of_velocity(3, 0.0);
  ASSERT_TRUE(closed.contacts.corrections(closed.assembly, closed.state.v.data(), of_position.data(),
                                          of_velocity.data()));
  const MassProperties<2> properties = box(mass, 2.0 * half_width, 2.0 * half_height);
  const double inverse[3] = {1.0 / mass, 1.0 / mass, 1.0 / properties.inertia};
  double w = 0.0, speed = 0.0;
  for (int c = 0; c < 3; ++c) {
    w += at.row(0)[c] * inverse[c] * at.row(0)[c];
    speed += at.row(0)[c] * closed.state.v[static_cast<std::size_t>(c)];
  }
  for (int c = 0; c < 3; ++c) {
    const auto place = static_cast<std::size_t>(c);
    EXPECT_NEAR(of_position[place], -inverse[c] * at.row(0)[c] * at.gap / w, 1e-16);
    EXPECT_NEAR(of_velocity[place], -inverse[c] * at.row(0)[c] * speed / w, 1e-14);
  }
}

TEST(ActiveSet, NothingToCorrect) {
  Closed closed(brick(0.4));
  for (ActiveContact& contact : closed.contacts.list()) contact.at.gap = 0.0;
  std::vector<double> of_position(3, 0.0), of_velocity(3, 0.0);
  EXPECT_FALSE(closed.contacts.corrections(closed.assembly, closed.state.v.data(), of_position.data(),
                                           of_velocity.data()));
  EXPECT_EQ(of_position, std::vector<double>(3, 0.0));
}

}  // namespace
