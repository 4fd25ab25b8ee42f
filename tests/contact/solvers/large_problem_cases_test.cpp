// Cases that sweeps must survive: forces that are not unique, contacts that cannot move, masses of any ratio,
// strong friction with several local solutions or none.

#include <carom/contact/solvers/nonlinear_cg_solver.h>

#include <carom/contact/solvers/residual.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <span>
#include <vector>

namespace carom {
namespace {

constexpr double fall = 9.81e-3;  // velocity that a step of 1 ms gives [m/s]

/// Writes a contact with normal (0, 1) and tangent (1, 0) of slot `above` over slot `below` (-1: ground), at
/// a point with levers (x, y) from the body above and (x, other_y) from the one below.
struct Floor {
  ContactProblem& problem;
  int contact = 0;

  void add(int above, int below, double x, double y, double other_y, double friction) {
    const auto first = static_cast<std::size_t>(2 * contact++);
    ResponseFactors::Row &n = problem.factors().rows[first], &t = problem.factors().rows[first + 1];
    n.slot = t.slot = {above, below, -1};
    n.h = {0.0, 1.0, x, 0.0, -1.0, -x, 0.0, 0.0, 0.0};
    t.h = {1.0, 0.0, -y, -1.0, 0.0, other_y, 0.0, 0.0, 0.0};
    if (below < 0) std::fill(n.h.begin() + 3, n.h.end(), 0.0), std::fill(t.h.begin() + 3, t.h.end(), 0.0);
    problem.sets()[first + 1] = {
        .kind = SetKind::bounded_interval, .bound = static_cast<int>(first), .coefficient = friction};
  }
};

/// Blocks of height 1 and width 2 on one another, each on `points` points, falling for one step.
ContactProblem stack(std::span<const double> masses, int points, double friction) {
  ContactProblem problem;
  const int levels = static_cast<int>(masses.size());
  problem.reset_factors(2 * levels * points, levels);
  Floor floor{problem};
  for (int level = 0; level < levels; ++level) {
    const double mass = masses[static_cast<std::size_t>(level)];
    double* const inverse = problem.factors().inverse_mass.data() + 3 * level;
    inverse[0] = inverse[1] = 1.0 / mass;
    inverse[2] = 12.0 / (5.0 * mass);
    for (int i = 0; i < points; ++i) {
      const double x = points == 1 ? 0.0 : -1.0 + 2.0 * i / (points - 1.0);
      floor.add(level, level - 1, x, -0.5, 0.5, friction);
    }
  }
  for (int i = 0; i < points; ++i) problem.vector()[static_cast<std::size_t>(2 * i)] = -fall;
  problem.group();
  return problem;
}

struct Answer {
  SolverAnswer answer;
  std::vector<double> impulse, xi;
  double residual = 0.0;
};

Answer solve(const ContactProblem& problem, const SweepBudget& budget, std::vector<double> start = {}) {
  NonlinearCgSolver solver;
  solver.set_budget(budget);
  Answer result;
  result.impulse = std::move(start);
  result.impulse.resize(static_cast<std::size_t>(problem.rows()));
  result.answer = solver.improve(problem, result.impulse);
  result.xi.resize(result.impulse.size());
  problem.velocities(result.impulse, result.xi);
  result.residual = residual(problem, result.impulse, result.xi).value;
  return result;
}

/// Sum of normal impulses of one interface of a stack.
double carried(const Answer& answer, int level, int points) {
  double sum = 0.0;
  for (int i = 0; i < points; ++i) sum += answer.impulse[static_cast<std::size_t>(2 * (level * points + i))];
  return sum;
}

TEST(LargeProblemCases, RedundantStacksCarryTheirWeight) {
  const std::vector<double> masses(10, 2.0);
  for (const int points : {2, 3, 4, 7}) {
    const Answer answer = solve(stack(masses, points, 0.0), {.residual = 1e-13, .sweeps = 2000});
    EXPECT_EQ(answer.answer.outcome, Outcome::solved) << points;
    EXPECT_LE(answer.residual, 1e-13);
    for (int level = 0; level < 10; ++level) {
      // The residual times the condition of the stack.
      EXPECT_NEAR(carried(answer, level, points), 2.0 * fall * (10 - level), 1e-10) << points;
    }
    for (const double xi : answer.xi) EXPECT_NEAR(xi, 0.0, 1e-12);
  }
}

// With friction the feet of a block can press against each other sideways, and sweeps creep along such
// states.
TEST(LargeProblemCases, WithFrictionStacksCreepTowardsTheirWeight) {
  const std::vector<double> masses(10, 2.0);
  for (const int points : {2, 3, 4, 7}) {
    for (const double friction : {0.5, 50.0}) {
      const Answer early = solve(stack(masses, points, friction), {.residual = 1e-12, .sweeps = 80});
      EXPECT_EQ(early.answer.outcome, Outcome::accepted_at_cap) << points << " " << friction;
      const Answer late = solve(stack(masses, points, friction), {.residual = 1e-12, .sweeps = 5000});
      EXPECT_LE(late.residual, 0.1 * early.residual) << points << " " << friction;
      for (int level = 0; level < 10; ++level) {
        const double weight = 2.0 * fall * (10 - level);
        EXPECT_NEAR(carried(early, level, points), weight, 3e-2 * 20.0 * fall) << points << " " << friction;
        EXPECT_NEAR(carried(late, level, points), weight, 1e-4 * 20.0 * fall) << points << " " << friction;
      }
    }
  }
}

TEST(LargeProblemCases, MassRatios) {
  // Light on heavy is easy at any ratio. Heavy on light is not: W is of condition `ratio`.
  for (const double ratio : {1e3, 1e6}) {
    const std::vector<double> light_above{ratio, 1.0};
    const Answer easy = solve(stack(light_above, 2, 0.3), {.residual = 1e-13, .sweeps = 200});
    EXPECT_EQ(easy.answer.outcome, Outcome::solved) << ratio;
    EXPECT_NEAR(carried(easy, 0, 2), (ratio + 1.0) * fall, 1e-11 * ratio);
  }
  const std::vector<double> heavy_above{1.0, 1e3};
  const Answer hard = solve(stack(heavy_above, 2, 0.3), {.residual = 1e-10, .sweeps = 4000});
  EXPECT_EQ(hard.answer.outcome, Outcome::solved);
  EXPECT_NEAR(carried(hard, 0, 2), 1001.0 * fall, 1e-10 * 1e3 * 1001.0 * fall);
  const std::vector<double> heavier_above{1.0, 1e6};
  const Answer hardest = solve(stack(heavier_above, 2, 0.3), {.residual = 1e-10, .sweeps = 4000});
  EXPECT_EQ(hardest.answer.outcome, Outcome::accepted_at_cap);
}

TEST(LargeProblemCases, ImmovableBodiesAndContacts) {
  // A body of infinite mass below a movable one, which bounces off it; and beside it a contact between two
  // bodies of infinite mass: at rest, parting, and closing, which nothing can help.
  for (const double closing : {0.0, 0.5, -0.5}) {
    ContactProblem problem;
    problem.reset_factors(4, 3);
    problem.factors().inverse_mass = {0.5, 0.5, 0.7, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0};
    Floor floor{problem};
    floor.add(0, 1, 0.0, -0.5, 0.5, 0.3);
    floor.add(1, 2, 0.2, -0.5, 0.5, 0.3);
    problem.vector()[0] = -2.0;
    problem.vector()[2] = closing;
    problem.group();
    const Answer answer = solve(problem, {.residual = 1e-14});
    EXPECT_NEAR(answer.impulse[0], 4.0, 1e-14);
    EXPECT_EQ(answer.impulse[2], 0.0);
    EXPECT_EQ(answer.answer.outcome, closing < 0.0 ? Outcome::not_solved : Outcome::solved);
  }
}

/// One contact with the given block of W, as a body with the Cholesky factor of the block for its rows.
ContactProblem one_contact(double w_nn, double w_nt, double w_tt, double b_n, double b_t, double friction) {
  ContactProblem problem;
  problem.reset_factors(2, 1);
  problem.factors().inverse_mass = {1.0, 1.0, 0.0};
  Floor floor{problem};
  floor.add(0, -1, 0.0, 0.0, 0.0, friction);
  const double l11 = std::sqrt(w_nn), l21 = w_nt / l11, rest = w_tt - l21 * l21;
  problem.factors().rows[0].h = {l11, 0.0, 0.0};
  problem.factors().rows[1].h = {l21, rest > 0.0 ? std::sqrt(rest) : 0.0, 0.0};
  problem.vector()[0] = b_n;
  problem.vector()[1] = b_t;
  problem.group();
  return problem;
}

TEST(LargeProblemCases, OfSeveralLocalSolutionsTheNearest) {
  // mu W_nt > W_nn: open, slip and stick are possible. From nothing the open one, as of
  // solve_planar_contact(); from an impulse near the sticking one that.
  const ContactProblem problem = one_contact(1.6, 1.2, 3.4, 0.1, 1.0, 2.0);
  const Answer open = solve(problem, {.residual = 1e-14});
  EXPECT_EQ(open.answer.outcome, Outcome::solved);
  EXPECT_EQ(open.impulse, (std::vector{0.0, 0.0}));
  const double determinant = 1.6 * 3.4 - 1.2 * 1.2;
  const double n = (1.2 * 1.0 - 3.4 * 0.1) / determinant, t = (1.2 * 0.1 - 1.6 * 1.0) / determinant;
  const Answer stuck = solve(problem, {.residual = 1e-14}, {1.01 * n, 1.01 * t});
  EXPECT_EQ(stuck.answer.outcome, Outcome::solved);
  EXPECT_NEAR(stuck.impulse[0], n, 1e-14);
  EXPECT_NEAR(stuck.impulse[1], t, 1e-14);
}

// Impulses grow without end, and the residual with their inverse: sweeps cannot prove that there is no
// solution, and never call it solved.
TEST(LargeProblemCases, JammedContactIsNotSolved) {
  for (const int sweeps : {10, 80, 1000}) {
    const Answer answer = solve(one_contact(1.0, 2.0, 4.0, -2.0, -3.0, 0.8), {.sweeps = sweeps});
    EXPECT_NE(answer.answer.outcome, Outcome::solved);
    EXPECT_GT(answer.residual, 1e-7);
  }
}

TEST(LargeProblemCases, EverySetOfAPlanarRow) {
  // Intervals, half-lines, a proportional row and three bodies in one row, against the conditions themselves.
  ContactProblem problem;
  problem.reset_factors(5, 3);
  problem.factors().inverse_mass = {1.0, 1.0, 2.0, 0.5, 0.5, 1.0, 0.25, 0.25, 0.0};
  auto& rows = problem.factors().rows;
  rows[0] = {.slot = {{0, 1, 2}}, .h = {{1.0, 0.5, 0.2, -1.0, 0.3, 0.4, 0.2, 0.1, 0.0}}};
  rows[1] = {.slot = {{1, -1, -1}}, .h = {{0.0, 1.0, 0.3}}};
  rows[2] = {.slot = {{0, 2, -1}}, .h = {{0.3, 1.0, 0.0, 0.1, -1.0, 0.0}}};
  rows[3] = {.slot = {{0, 1, -1}}, .h = {{0.0, 1.0, 0.1, 0.0, -1.0, 0.2}}};
  rows[4] = {.slot = {{0, 1, -1}}, .h = {{1.0, 0.0, 0.3, -1.0, 0.0, 0.4}}};
  problem.sets()[0] = {.kind = SetKind::interval, .lower = -0.2, .upper = 0.1};
  problem.sets()[1] = {.kind = SetKind::half_line};
  problem.sets()[2] = {.kind = SetKind::interval, .lower = -5.0, .upper = 5.0};
  problem.sets()[3] = {.kind = SetKind::half_line};
  problem.sets()[4] = {.kind = SetKind::proportional, .bound = 3, .coefficient = -0.2};
  const std::array<double, 5> b{1.0, -1.0, 0.4, -0.6, 0.3};
  std::copy(b.begin(), b.end(), problem.vector().begin());
  problem.group();
  const Answer answer = solve(problem, {.residual = 1e-14, .sweeps = 1000});
  EXPECT_EQ(answer.answer.outcome, Outcome::solved);
  EXPECT_LE(answer.residual, 1e-14);
  EXPECT_EQ(answer.impulse[0], -0.2);
  EXPECT_GT(answer.impulse[1], 0.0);
  EXPECT_NEAR(answer.xi[1], 0.0, 1e-13);
  EXPECT_NEAR(answer.xi[2], 0.0, 1e-13);
  EXPECT_NEAR(answer.xi[3], 0.0, 1e-13);
  EXPECT_GT(answer.impulse[3], 0.0);
  EXPECT_EQ(answer.impulse[4], -0.2 * answer.impulse[3]);
}

TEST(LargeProblemCases, NumbersThatAreNoneAreNoAnswer) {
  ContactProblem problem = stack(std::vector<double>(3, 1.0), 2, 0.3);
  problem.vector()[3] = std::numeric_limits<double>::quiet_NaN();
  const Answer answer = solve(problem, {});
  EXPECT_EQ(answer.answer.outcome, Outcome::not_solved);
  EXPECT_EQ(answer.answer.iterations, 0);
}

TEST(LargeProblemCases, AHubOfManyContacts) {
  // One body that touches 200 others, more than there are colours: all of them press it from all sides.
  constexpr int spokes = 200;
  ContactProblem problem;
  problem.reset_factors(2 * spokes, spokes + 1);
  for (std::size_t k = 0; k < 3 * (spokes + 1); ++k) problem.factors().inverse_mass[k] = k < 3 ? 0.1 : 1.0;
  for (int c = 0; c < spokes; ++c) {
    const double angle = 2.0 * 3.14159265358979 * c / spokes, x = std::cos(angle), y = std::sin(angle);
    const auto first = static_cast<std::size_t>(2 * c);
    problem.factors().rows[first] = {.slot = {{c + 1, 0, -1}}, .h = {{x, y, 0.0, -x, -y, 0.0}}};
    problem.factors().rows[first + 1] = {.slot = {{c + 1, 0, -1}}, .h = {{y, -x, 1.0, -y, x, 1.0}}};
    problem.vector()[first] = -1.0 - 0.5 * x;
    problem.vector()[first + 1] = 0.1;
    problem.sets()[first + 1] = {.kind = SetKind::bounded_interval, .bound = 2 * c, .coefficient = 0.2};
  }
  problem.group();
  const Answer answer = solve(problem, {.residual = 1e-12, .sweeps = 1000});
  EXPECT_EQ(answer.answer.outcome, Outcome::solved);
  EXPECT_LE(answer.residual, 1e-12);
}

}  // namespace
}  // namespace carom
