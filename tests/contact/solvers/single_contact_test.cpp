#include <carom/contact/solvers/single_contact.h>

#include <carom/contact/solvers/residual.h>
#include <carom/contact/solvers/solver_chain.h>

#include "tests/contact/random_problems.h"
#include "tests/reference/reference_data.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

namespace carom {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

SolverAnswer solve_row(RowSet set, double w, double b, double& impulse) {
  ContactProblem problem;
  problem.reset(1);
  problem.w(0, 0) = w;
  problem.vector()[0] = b;
  problem.sets()[0] = set;
  problem.group();
  SingleContactSolver solver;
  return solver.solve(problem, std::span(&impulse, 1));
}

TEST(SingleContact, LoneRows) {
  double p = 0.0;
  EXPECT_EQ(solve_row({}, 2.0, -3.0, p).outcome, Outcome::solved);
  EXPECT_EQ(p, 1.5);
  EXPECT_EQ(solve_row({}, 2.0, 3.0, p).outcome, Outcome::solved);
  EXPECT_EQ(p, 0.0);
  const RowSet limited{.kind = SetKind::interval, .lower = -1.0, .upper = 2.0};
  EXPECT_EQ(solve_row(limited, 1.0, -5.0, p).outcome, Outcome::solved);
  EXPECT_EQ(p, 2.0);
  EXPECT_EQ(solve_row(limited, 0.0, 1.0, p).outcome, Outcome::solved);
  EXPECT_EQ(p, -1.0);
  EXPECT_EQ(solve_row({}, 0.0, -1.0, p).outcome, Outcome::no_solution);
  EXPECT_EQ(solve_row({}, 0.0, 1.0, p).outcome, Outcome::solved);
  const RowSet free{.kind = SetKind::interval, .lower = -infinity, .upper = infinity};
  EXPECT_EQ(solve_row(free, 0.0, 1.0, p).outcome, Outcome::no_solution);
}

// The short door gives what the long ways give, regular or not, and its certificate is the one residual.
TEST(SingleContact, CertifiedFromItsNumbers) {
  contact_test::Random random(5);
  ContactProblem problem;
  int unusable = 0;
  for (int i = 0; i < 20000; ++i) {
    // W = A A^T of rank one or two, from well to badly conditioned; some without friction, some without b_n.
    const double a = random.uniform(-2.0, 2.0), b = random.uniform(-2.0, 2.0);
    const double second = random.chance(0.25) ? 0.0 : random.log_uniform(1e-3, 3.0);
    PlanarContact c{.w_nn = a * a + second,
                    .w_nt = a * b,
                    .w_tt = b * b + second,
                    .b_n = random.chance(0.1) ? 0.0 : random.uniform(-2.0, 0.5),
                    .b_t = random.uniform(-2.0, 2.0),
                    .friction = random.chance(0.125) ? 0.0 : random.uniform(0.0, 3.0)};
    const CertifiedImpulse answer = solve_certified_contact(c);
    const PlanarSolutions listed = solve_planar_contact(c);
    EXPECT_EQ(answer.usable, listed.count > 0);
    if (!answer.usable) {
      ++unusable;
      continue;
    }
    EXPECT_EQ(answer.outcome, listed.outcome);
    EXPECT_EQ(answer.impulse.normal, listed.list[0].normal);
    EXPECT_EQ(answer.impulse.tangential, listed.list[0].tangential);
    contact_test::make_problem(c.w_nn, c.w_nt, c.w_tt, c.b_n, c.b_t, c.friction, problem);
    const double impulse[2] = {answer.impulse.normal, answer.impulse.tangential};
    const double xi[2] = {answer.xi_n, answer.xi_t};
    EXPECT_DOUBLE_EQ(answer.residual, residual(problem, impulse, xi).value);
  }
  EXPECT_GT(unusable, 0);  // jammed ones were among them
}

// docs/method.md section 4: where the directions do not couple.
TEST(SingleContact, SphereInThePlane) {
  const double m = 2.0, r = 0.1, inertia = 0.4 * m * r * r, m1 = 1.0 / (1.0 / m + r * r / inertia);
  for (const double e_n : {0.0, 0.5, 1.0}) {
    for (const double e_t : {0.0, 0.3, 1.0}) {
      for (const double x : {-3.0, -0.2, 0.1, 4.0}) {
        const double y = -1.5, mu = 0.2;
        const double p_n = -m * (1.0 + e_n) * y;
        const double stick = -m1 * (1.0 + e_t) * x;
        const double p_t = std::abs(stick) <= mu * p_n ? stick : -mu * p_n * std::copysign(1.0, x);
        const PlanarSolutions found =
            solve_planar_contact({1.0 / m, 0.0, 1.0 / m1, (1.0 + e_n) * y, (1.0 + e_t) * x, mu});
        ASSERT_EQ(found.count, 1);
        EXPECT_NEAR(found.list[0].normal, p_n, 1e-15 * p_n);
        EXPECT_NEAR(found.list[0].tangential, p_t, 1e-15 * p_n);
      }
    }
  }
}

TEST(SingleContact, SphereInSpaceIsTheSphereInThePlaneOfItsMotion) {
  const double m = 2.0, w_tt = 3.5 / m, mu = 0.2;
  for (int k = 0; k < 12; ++k) {
    const double angle = 0.5 * k, speed = 0.3 * k;
    ContactProblem problem;
    problem.reset(3);
    problem.w(0, 0) = 1.0 / m;
    problem.w(1, 1) = problem.w(2, 2) = w_tt;
    problem.sets()[1] = problem.sets()[2] = {.kind = SetKind::bounded_disc, .bound = 0, .coefficient = mu};
    problem.vector()[0] = -1.5;
    problem.vector()[1] = speed * std::cos(angle);
    problem.vector()[2] = speed * std::sin(angle);
    problem.group();
    std::vector<double> p(3), xi(3);
    SingleContactSolver solver;
    ASSERT_EQ(solver.solve(problem, p).outcome, Outcome::solved);
    problem.velocities(p, xi);
    EXPECT_LE(residual(problem, p, xi).value, 1e-15);
    const PlanarSolutions planar = solve_planar_contact({1.0 / m, 0.0, w_tt, -1.5, speed, mu});
    EXPECT_EQ(p[0], planar.list[0].normal);
    EXPECT_NEAR(p[1], planar.list[0].tangential * std::cos(angle), 1e-15);
    EXPECT_NEAR(p[2], planar.list[0].tangential * std::sin(angle), 1e-15);
    // A coupled contact in space is left to the others.
    problem.w(0, 1) = problem.w(1, 0) = 0.1;
    EXPECT_EQ(solver.solve(problem, p).reason, "not applicable");
  }
}

// The Painleve rod of tests/reference/contacts_planar.json: rod tip at mu = 2, tan theta = 2. Impact without
// collision: stick with P = (0.3, 0.4).
TEST(SingleContact, PainleveRod) {
  const auto data = carom_test::reference_data("contacts_planar.json");
  int compared = 0;
  for (const auto& state : data.at("painleve_rod").at("states")) {
    SCOPED_TRACE(state.at("name").get<std::string>());
    const auto& w = state.at("W");  // in the order (t, n)
    const double sign = state.at("tip_velocity_sign").get<double>();
    for (const bool approaching : {false, true}) {
      const auto& known = state.at(approaching ? "impact_law_solutions_normal_minus_1e_6"
                                               : "impact_law_solutions_tip_speed_1_normal_0");
      const PlanarSolutions found =
          solve_planar_contact({w[1][1].get<double>(), w[0][1].get<double>(), w[0][0].get<double>(),
                                approaching ? -1e-6 : 0.0, sign, state.at("mu").get<double>()});
      ASSERT_EQ(static_cast<std::size_t>(found.count), known.size());
      EXPECT_EQ(found.outcome == Outcome::several_solutions, known.size() > 1);
      for (std::size_t k = 0; k < known.size(); ++k) {
        EXPECT_NEAR(found.list[k].tangential, known[k][1].get<double>(), 1e-15);
        EXPECT_NEAR(found.list[k].normal, known[k][2].get<double>(), 1e-15);
        ++compared;
      }
      if (found.count > 1) {
        EXPECT_EQ(found.list[0].mode, ContactMode::open);  // no impulse where none is needed
      }
    }
  }
  EXPECT_EQ(compared, 18);
}

// p+ < 0 and b_n > 0: open, stick and slip are all possible (docs/method.md section 3, "otherwise there can
// be three").
TEST(SingleContact, ThreeSolutionsAreFound) {
  const PlanarContact contact{1.6, 1.2, 3.4, 0.1, 1.0, 2.0};
  const PlanarSolutions found = solve_planar_contact(contact);
  ASSERT_EQ(found.count, 3);
  EXPECT_EQ(found.outcome, Outcome::several_solutions);
  EXPECT_FALSE(found.degenerate);
  EXPECT_EQ(found.list[0].mode, ContactMode::open);
  EXPECT_EQ(found.list[1].mode, ContactMode::slip_positive);
  EXPECT_EQ(found.list[2].mode, ContactMode::stick);
  EXPECT_NEAR(found.list[1].normal, 0.1 / 0.8, 1e-15);  // -b_n / (W_nn - mu W_nt)
  EXPECT_NEAR(found.list[2].normal, (1.2 * 1.0 - 3.4 * 0.1) / (1.6 * 3.4 - 1.44), 1e-15);
  ContactProblem problem;
  contact_test::make_problem(1.6, 1.2, 3.4, 0.1, 1.0, 2.0, problem);
  for (std::size_t k = 0; k < 3; ++k) {
    const std::vector<double> p{found.list[k].normal, found.list[k].tangential};
    std::vector<double> xi(2);
    problem.velocities(p, xi);
    EXPECT_LE(residual(problem, p, xi).value, 1e-15);
  }
}

// A rod on a pin whose tip strikes: one degree of freedom, W of rank one.
TEST(SingleContact, SingularWithConsistentRestitutionHasForcesThatAreNotUnique) {
  const PlanarSolutions found = solve_planar_contact({1.0, 0.5, 0.25, -2.0, -1.0, 0.8});
  EXPECT_EQ(found.outcome, Outcome::forces_not_unique);
  EXPECT_TRUE(found.degenerate);
  ASSERT_EQ(found.count, 1);
  // Nearest to the origin: along (1, 0.5), with P_n + 0.5 P_t = 2.
  EXPECT_DOUBLE_EQ(found.list[0].normal, 1.6);
  EXPECT_DOUBLE_EQ(found.list[0].tangential, 0.8);
  // The cone is too narrow for that: its edge.
  const PlanarSolutions narrow = solve_planar_contact({1.0, 0.5, 0.25, -2.0, -1.0, 0.1});
  EXPECT_DOUBLE_EQ(narrow.list[0].tangential, 0.1 * narrow.list[0].normal);
  EXPECT_DOUBLE_EQ(narrow.list[0].normal, 2.0 / 1.05);
}

TEST(SingleContact, SingularWithUnequalRestitutionSlipsOrJams) {
  // Not in the range of W, cone clear of the null space: slips in the direction that W cannot stop.
  const PlanarSolutions slips = solve_planar_contact({1.0, 0.5, 0.25, -2.0, -0.5, 0.8});
  EXPECT_EQ(slips.outcome, Outcome::solved);
  EXPECT_EQ(slips.list[0].mode, ContactMode::slip_positive);
  // mu W_nt > W_nn, and the slip that would be needed makes friction pull the contact in: jammed.
  const PlanarSolutions jammed = solve_planar_contact({1.0, 2.0, 4.0, -2.0, -3.0, 0.8});
  EXPECT_EQ(jammed.outcome, Outcome::no_solution);
  EXPECT_EQ(jammed.count, 0);
  // Equal restitution saves it.
  EXPECT_EQ(solve_planar_contact({1.0, 2.0, 4.0, -2.0, -4.0, 0.8}).outcome, Outcome::forces_not_unique);
}

TEST(SingleContact, ImmovableDirections) {
  // Normal direction held by joints.
  EXPECT_EQ(solve_planar_contact({0.0, 0.0, 1.0, -1.0, 1.0, 0.5}).outcome, Outcome::no_solution);
  EXPECT_EQ(solve_planar_contact({0.0, 0.0, 1.0, 1.0, 1.0, 0.5}).outcome, Outcome::solved);
  EXPECT_EQ(solve_planar_contact({0.0, 0.0, 1.0, 0.0, 1.0, 0.5}).outcome, Outcome::several_solutions);
  EXPECT_EQ(solve_planar_contact({0.0, 0.0, 1.0, 0.0, 0.0, 0.5}).outcome, Outcome::forces_not_unique);
  // Tangential direction held by joints: friction is arbitrary at rest, at its limit else.
  const PlanarSolutions rest = solve_planar_contact({1.0, 0.0, 0.0, -1.0, 0.0, 0.5});
  EXPECT_EQ(rest.outcome, Outcome::forces_not_unique);
  EXPECT_EQ(rest.list[0].normal, 1.0);
  EXPECT_EQ(rest.list[0].tangential, 0.0);
  const PlanarSolutions dragged = solve_planar_contact({1.0, 0.0, 0.0, -1.0, 3.0, 0.5});
  EXPECT_EQ(dragged.outcome, Outcome::solved);
  EXPECT_EQ(dragged.list[0].tangential, -0.5);
}

TEST(SingleContact, BoundariesAreDegenerateAndCountOnce) {
  // Stick and slip meet.
  const PlanarSolutions edge = solve_planar_contact({1.0, 0.0, 1.0, -1.0, 0.5, 0.5});
  EXPECT_EQ(edge.count, 1);
  EXPECT_TRUE(edge.degenerate);
  // Touching without approaching.
  const PlanarSolutions touch = solve_planar_contact({1.0, 0.0, 1.0, 0.0, 0.5, 0.5});
  EXPECT_EQ(touch.count, 1);
  EXPECT_TRUE(touch.degenerate);
  EXPECT_EQ(touch.list[0].normal, 0.0);
  // Slip at P_n = 0 is open.
  EXPECT_FALSE(solve_planar_contact({1.0, 0.0, 1.0, -1.0, 0.4, 0.5}).degenerate);
}

TEST(SingleContact, NotANumberIsNotAnswered) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (int k = 0; k < 5; ++k) {
    double v[5] = {1.0, 0.1, 1.0, -1.0, 0.3};
    v[k] = nan;
    ContactProblem problem;
    contact_test::make_problem(v[0], v[1], v[2], v[3], v[4], 0.5, problem);
    std::vector<double> p(2);
    SolverChain chain;
    EXPECT_FALSE(chain.solve(problem, p).usable()) << k;
  }
}

}  // namespace
}  // namespace carom
