// An island made by hand: two rigid bodies in space, six columns each, and a contact of three rows, whose
// friction lies in a disc. Impacts and separation know nothing of where its rows come from.

#include "tests/random.h"

#include <carom/contact/gap_source.h>
#include <carom/contact/separation.h>
#include <carom/contact/strike.h>
#include <carom/core/constraint_set.h>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <span>
#include <vector>

namespace {

using namespace carom;
using Vector = Eigen::Vector3d;

constexpr int of_body = 6;
constexpr Index count = 2;

/// A rigid body with equal moments of inertia, and a ball on an arm from its centre of mass, by which it
/// touches.
struct Ball {
  double mass = 1.0, inertia = 0.4, radius = 1.0;
  Vector place = Vector::Zero(), arm = Vector::Zero();
  [[nodiscard]] Vector centre() const { return place + arm; }
};

/// Two of them, which answer by their masses.
class TwoBalls final : public GapSource, public BodyResponse {
public:
  explicit TwoBalls(const std::array<Ball, 2>& balls) : balls_(balls), from_(balls), lengths_(12, 1.0) {}

  /// Their contact: normal from the second towards the first, two tangents.
  void write(Constraint& out) const {
    const Vector apart = balls_[0].centre() - balls_[1].centre();
    out.gap = apart.norm() - balls_[0].radius - balls_[1].radius;
    const Vector n = apart.normalized();
    const Vector t1 = n.unitOrthogonal(), t2 = n.cross(t1);
    const Vector point = balls_[1].centre() + (balls_[1].radius + 0.5 * out.gap) * n;
    for (Index b = 0; b < count; ++b) out.add_body(b, of_body * b, of_body);
    out.start_rows(3);
    int row = 0;
    for (const Vector& direction : {n, t1, t2}) {
      double* number = out.row(row++);
      double sign = 1.0;
      for (const Ball& ball : balls_) {
        const Vector turn = (point - ball.place).cross(direction);
        for (int k = 0; k < 3; ++k) *number++ = sign * direction[k];
        for (int k = 0; k < 3; ++k) *number++ = sign * turn[k];
        sign = -1.0;
      }
    }
    out.key.b.serial = 1;
  }
  [[nodiscard]] const Ball& ball(Index b) const { return balls_[b]; }
  /// M^-1 times row i of their contact.
  [[nodiscard]] Eigen::VectorXd answer_to_row(const Constraint& at, int i) const {
    Eigen::VectorXd x = Eigen::Map<const Eigen::VectorXd>(at.row(i), 12);
    for (Index v = 0; v < 12; ++v) x[v] /= mass_of(v);
    return x;
  }

  Range reach(Index body) const override { return {of_body * body, of_body * body + of_body}; }
  void answer(Index body, double* x, std::size_t columns, char* held) override {
    for (std::size_t c = 0; c < columns; ++c, x += of_body) {
      held[c] = 0;
      for (Index v = 0; v < of_body; ++v) x[v] /= mass_of(of_body * body + v);
    }
  }

  std::span<Constraint> find(double) override {
    found_.clear();
    write(found_.add());
    return found_;
  }
  Index bodies() const override { return count; }
  Index first_together(Index body) const override { return body; }
  Range velocities() const override { return {0, 12}; }
  const std::vector<double>& lengths() const override { return lengths_; }
  double rounding() const override { return 1e-15; }
  void begin() override {
    from_ = balls_;
    ++begins;
  }
  std::span<const Range> select(std::span<const Constraint>) override { return both_; }
  BodyResponse& response() override { return *this; }
  void move(const double* displacement) override {
    displacement_ = Eigen::Map<const Eigen::VectorXd>(displacement, 12);
    for (Index b = 0; b < count; ++b, displacement += of_body) {
      const Vector way(displacement), turn(displacement + 3);
      balls_[b].place = from_[b].place + way;
      const double angle = turn.norm();
      balls_[b].arm =
          angle == 0.0 ? from_[b].arm : Vector(Eigen::AngleAxisd(angle, turn / angle) * from_[b].arm);
    }
  }
  void update() override {}
  /// By which they have been moved since begin() was called, so often.
  [[nodiscard]] const Eigen::VectorXd& displacement() const { return displacement_; }
  int begins = 0;
  bool is_off(double) override { return false; }
  void close_joints(const double*, double*) override {}

private:
  [[nodiscard]] double mass_of(Index v) const {
    const Ball& ball = balls_[v / of_body];
    return v % of_body < 3 ? ball.mass : ball.inertia;
  }

  std::array<Ball, 2> balls_, from_;
  Eigen::VectorXd displacement_ = Eigen::VectorXd::Zero(12);
  std::vector<double> lengths_;
  std::array<Range, 2> both_{Range{0, 6}, Range{6, 12}};
  ConstraintSet found_;
};

const std::array<Ball, 2> two_that_touch{
    {{.mass = 2.0, .inertia = 0.8, .radius = 1.0, .place = {0.6, 0.0, 0.8}},
     {.mass = 3.0, .inertia = 0.3, .radius = 0.5, .place = {-0.3, 0.0, -0.4}}}};

/// Velocities after an impact of two balls, and its impulses along the rows.
struct Impact {
  Eigen::VectorXd after;
  Vector impulse;
};

Impact strike_balls(const TwoBalls& balls, const Eigen::VectorXd& before, const Surface& law) {
  TwoBalls response = balls;
  ConstraintSet touching;
  balls.write(touching.add());
  touching[0].law = law;
  ImpactProblems problems{IslandOptions{}};
  SolverChain chain;
  const auto by = [&](ImpactLaw impact_law) {
    IslandProblem& problem = problems.by(impact_law);
    problem.build(touching, before.data());
    problem.respond(response);
    problem.set_free_velocity(before.data());
    return StrikeAnswer{problem, problem.solve(chain).usable()};
  };
  const ImpactRules rules;
  const Struck struck =
      strike(touching, {.rules = rules, .velocity = before.data(), .speed_noise = 1e-12}, by);
  Impact out{before, Vector::Constant(std::nan(""))};
  EXPECT_EQ(struck.outcome, Struck::Outcome::solved);
  if (struck.outcome != Struck::Outcome::solved) return out;
  struck.problem->map().add_velocities(out.after.data());
  for (int i = 0; i < 3; ++i) out.impulse[i] = struck.problem->map().impulse(0, i);
  return out;
}

/// Velocities along the rows of their contact.
Vector along_rows(const TwoBalls& balls, const Eigen::VectorXd& v) {
  SingleConstraint contact;
  balls.write(contact);
  return {contact.velocity(0, v.data()), contact.velocity(1, v.data()), contact.velocity(2, v.data())};
}

/// 1/W along the normal, and along any tangent, of balls without arms.
double mass_along_normal(const TwoBalls& balls) {
  return 1.0 / (1.0 / balls.ball(0).mass + 1.0 / balls.ball(1).mass);
}
double mass_along_tangent(const TwoBalls& balls) {
  double sum = 1.0 / mass_along_normal(balls);
  for (Index b = 0; b < count; ++b)
    sum += balls.ball(b).radius * balls.ball(b).radius / balls.ball(b).inertia;
  return 1.0 / sum;
}

Eigen::VectorXd random_velocity(int seed, const TwoBalls& balls) {
  carom_test::Random random(static_cast<std::uint64_t>(seed));
  Eigen::VectorXd v(12);
  for (double& number : v) number = random.uniform(-1.0, 1.0);
  // Towards each other.
  const Vector n = (balls.ball(0).centre() - balls.ball(1).centre()).normalized();
  v.head<3>() -= 3.0 * n;
  v.segment<3>(6) += 3.0 * n;
  return v;
}

// A few roundings of impulses of about 10 N s.
constexpr double solved = 1e-13;

TEST(SpatialIsland, BallsThatSlideAreRubbedAgainstTheirSliding) {
  const TwoBalls balls(two_that_touch);
  constexpr double e = 0.6, friction = 0.01;
  for (int seed = 1; seed <= 20; ++seed) {
    const Eigen::VectorXd before = random_velocity(seed, balls);
    const Vector gamma = along_rows(balls, before);
    const Impact impact = strike_balls(balls, before, {.friction = friction, .normal_restitution = e});
    const double normal = -(1.0 + e) * mass_along_normal(balls) * gamma[0];
    const Eigen::Vector2d slip = gamma.tail<2>();
    ASSERT_GT(slip.norm(), friction * normal / mass_along_tangent(balls)) << "it would stick";
    EXPECT_NEAR(impact.impulse[0], normal, solved);
    EXPECT_LE((impact.impulse.tail<2>() + friction * normal * slip.normalized()).norm(), solved) << seed;
    EXPECT_NEAR(along_rows(balls, impact.after)[0], -e * gamma[0], solved);
  }
}

TEST(SpatialIsland, BallsThatStickRebound) {
  const TwoBalls balls(two_that_touch);
  constexpr double e_n = 0.3, e_t = 0.5;
  for (int seed = 1; seed <= 20; ++seed) {
    const Eigen::VectorXd before = random_velocity(seed, balls);
    const Vector gamma = along_rows(balls, before);
    const Impact impact = strike_balls(
        balls, before, {.friction = 10.0, .normal_restitution = e_n, .tangential_restitution = e_t});
    const Vector after = along_rows(balls, impact.after);
    EXPECT_NEAR(after[0], -e_n * gamma[0], solved);
    EXPECT_LE((after.tail<2>() + e_t * gamma.tail<2>()).norm(), solved) << seed;
  }
}

// Whatever the arms: momenta and their moments are as before, and energy is not gained.
TEST(SpatialIsland, MomentaStayAndEnergyIsLost) {
  std::array<Ball, 2> arms = two_that_touch;
  arms[0].arm = {0.2, -0.5, 0.1};
  arms[0].place -= arms[0].arm;
  arms[1].arm = {0.3, 0.3, -0.2};
  arms[1].place -= arms[1].arm;
  const TwoBalls balls(arms);
  const auto momenta = [&](const Eigen::VectorXd& v) {
    Eigen::VectorXd sum = Eigen::VectorXd::Zero(6);
    for (Index b = 0; b < count; ++b) {
      const Ball& ball = balls.ball(b);
      const Vector linear = ball.mass * v.segment<3>(6 * b);
      sum.head<3>() += linear;
      sum.tail<3>() += ball.place.cross(linear) + ball.inertia * v.segment<3>(6 * b + 3);
    }
    return sum;
  };
  const auto energy = [&](const Eigen::VectorXd& v) {
    double sum = 0.0;
    for (Index b = 0; b < count; ++b) {
      sum += 0.5 * balls.ball(b).mass * v.segment<3>(6 * b).squaredNorm() +
             0.5 * balls.ball(b).inertia * v.segment<3>(6 * b + 3).squaredNorm();
    }
    return sum;
  };
  for (int seed = 1; seed <= 40; ++seed) {
    const Eigen::VectorXd before = random_velocity(seed, balls);
    const Impact impact = strike_balls(balls, before, {.friction = 0.4, .normal_restitution = 0.5});
    EXPECT_LE((momenta(impact.after) - momenta(before)).norm(), 2e-15 * momenta(before).norm()) << seed;
    EXPECT_LT(energy(impact.after), energy(before)) << seed;
    EXPECT_LE(impact.impulse.tail<2>().norm(), 0.4 * impact.impulse[0] + solved) << "in the disc of friction";
  }
}

TEST(SpatialIsland, WhatPartsIsLeftAlone) {
  const TwoBalls balls(two_that_touch);
  const Eigen::VectorXd before = -random_velocity(3, balls);
  const Impact impact = strike_balls(balls, before, {.friction = 0.4, .normal_restitution = 0.5});
  EXPECT_EQ(impact.impulse, Vector::Zero());
  EXPECT_EQ(impact.after, before);
}

TEST(SpatialIsland, BallsThatOverlapGoApartAgainstTheirMasses) {
  std::array<Ball, 2> deep = two_that_touch;
  deep[0].place = {0.36, 0.0, 0.48};  // by 0.4 m nearer
  TwoBalls balls(deep);
  SolverChain chain;
  const Separation out = Separator().separate(balls, chain);
  EXPECT_TRUE(out.moved);
  EXPECT_EQ(out.left, nullptr);
  const Vector n(0.6, 0.0, 0.8);
  EXPECT_LE((balls.ball(0).place - (deep[0].place + 0.4 * 3.0 / 5.0 * n)).norm(), 1e-14);
  EXPECT_LE((balls.ball(1).place - (deep[1].place - 0.4 * 2.0 / 5.0 * n)).norm(), 1e-14);
}

// With arms bodies turn too: at the end the displacement is M^-1 G^T y, the condition of a least one.
TEST(SpatialIsland, BallsOnArmsTurnByTheLeastDisplacement) {
  std::array<Ball, 2> deep = two_that_touch;
  deep[0].arm = {0.3, 0.7, -0.2};
  deep[0].place -= deep[0].arm;
  deep[1].arm = {0.0, -0.4, 0.3};
  deep[1].place -= deep[1].arm;
  deep[0].place -= Vector(0.12, 0.0, 0.16);
  TwoBalls balls(deep);
  SolverChain chain;
  const Separation out = Separator().separate(balls, chain);
  ASSERT_EQ(out.left, nullptr);
  SingleConstraint contact;
  balls.write(contact);
  EXPECT_NEAR(contact.gap, 0.0, 1e-14);
  ASSERT_EQ(balls.begins, 1) << "displacements are from where they stood";
  const Eigen::VectorXd& moved = balls.displacement();
  const Eigen::VectorXd expected = balls.answer_to_row(contact, 0);
  const double y = moved.head<3>().norm() / expected.head<3>().norm();
  EXPECT_GT(moved.segment<3>(3).norm(), 0.01) << "it turns";
  // What the displacement is made of lags a pass behind the place, and gaps end at rounding.
  EXPECT_LE((moved - y * expected).norm(), 3e-8 * moved.norm());
}

}  // namespace
