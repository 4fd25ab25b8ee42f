// One contact that slips in a known direction.

#include <carom/contact/solvers/single_contact.h>
#include <carom/contact/solvers/sliding_contact.h>

#include <carom/contact/solvers/newton_polish.h>
#include <carom/contact/solvers/residual.h>
#include <carom/contact/solvers/solution_list.h>
#include <carom/contact/solvers/solver_chain.h>

#include "tests/contact/brute_force.h"
#include "tests/contact/random_problems.h"
#include "tests/reference/reference_data.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

namespace carom {
namespace {

using contact_test::Quad;

ContactProblem problem_of(const SlidingContact& c) {
  ContactProblem problem;
  contact_test::make_problem(c.w_nn, c.w_nt, c.w_tt, c.b_n, c.b_t, 0.0, problem);
  problem.sets()[1] = {.kind = SetKind::proportional, .bound = 0, .coefficient = c.coefficient};
  problem.group();
  return problem;
}

double judge(const ContactProblem& problem, const std::vector<double>& impulse) {
  std::vector<double> xi(impulse.size());
  problem.velocities(impulse, xi);
  return residual(problem, impulse, xi).value;
}

// W of a random body and a coefficient of either sign; p = W_nn + c W_nt < 0 is frequent. One in eight has
// round numbers, for which p or b_n can be zero.
SlidingContact random_contact(std::uint64_t seed) {
  contact_test::Random random(seed + 77);
  const auto impact = contact_test::random_impact(seed);
  SlidingContact c{impact.w_nn(), impact.w_nt(), impact.w_tt(), impact.b_n(), impact.b_t(), 0.0};
  if (random.chance(0.4)) c.b_n = -c.b_n;
  c.coefficient = random.chance(0.5) ? impact.friction : -impact.friction;
  if (random.chance(0.3)) c.coefficient = c.w_nt > 0.0 ? -5.0 : 5.0;
  return c;
}

TEST(SlidingContact, AgreesWithTheLawInQuadruplePrecision) {
  int none = 0, two = 0, slides = 0, negative = 0, on_boundary = 0;
  SolverChain chain;
  for (std::uint64_t seed = 0; seed < 20'000; ++seed) {
    SCOPED_TRACE(seed);
    const SlidingContact c = random_contact(seed);
    const PlanarSolutions found = solve_sliding_contact(c);
    const Quad p = Quad(c.w_nn) + Quad(c.coefficient) * Quad(c.w_nt);
    const bool slide = p != 0 && c.b_n != 0.0 && -Quad(c.b_n) / p > 0;
    const int expected = (c.b_n >= 0.0 ? 1 : 0) + (slide ? 1 : 0);
    if (found.degenerate) {
      ++on_boundary;
      continue;
    }
    ASSERT_EQ(found.count, expected);
    EXPECT_EQ(found.outcome, expected == 0   ? Outcome::no_solution
                             : expected == 1 ? Outcome::solved
                                             : Outcome::several_solutions);
    none += expected == 0 ? 1 : 0;
    two += expected == 2 ? 1 : 0;
    slides += slide ? 1 : 0;
    negative += p < 0 ? 1 : 0;
    const ContactProblem problem = problem_of(c);
    const double p_scale = c.w_nn + std::abs(c.coefficient * c.w_nt);
    for (int k = 0; k < found.count; ++k) {
      const PlanarImpulse& impulse = found.list[static_cast<std::size_t>(k)];
      EXPECT_EQ(impulse.mode == ContactMode::open, k == 0 && c.b_n > 0.0);
      EXPECT_EQ(impulse.tangential, c.coefficient * impulse.normal);
      // P and xi carry a few roundings of terms as large as P_t; P* is not smaller.
      EXPECT_LE(judge(problem, {impulse.normal, impulse.tangential}), 1e-15);
      if (impulse.mode == ContactMode::open) continue;
      const Quad exact = -Quad(c.b_n) / p;
      // One rounding of p, whose terms may cancel, and one of the division.
      const double tolerance = 2.3e-16 * (1.0 + p_scale / std::abs(static_cast<double>(p)));
      EXPECT_LE(static_cast<double>(contact_test::magnitude(impulse.normal - exact) / exact), tolerance);
    }
    // The chain takes the first, and reads its mode off.
    std::vector<double> impulse(2);
    const ContactReport report = chain.solve(problem, impulse);
    EXPECT_EQ(report.outcome, found.outcome);
    EXPECT_EQ(report.usable(), found.count > 0);
    EXPECT_EQ(report.solver, "single contact");
    EXPECT_EQ(impulse[0], found.list[0].normal);
    if (found.count > 0) {
      EXPECT_EQ(chain.modes()[0], found.list[0].mode);
    }
  }
  EXPECT_GT(none, 1000);
  EXPECT_GT(two, 1000);
  EXPECT_GT(slides, 4000);
  EXPECT_GT(negative, 2000);
  EXPECT_GT(on_boundary, 10);
  EXPECT_LT(on_boundary, 1000);
}

TEST(SlidingContact, EveryFieldOfTheTable) {
  // W_nn = 1, W_nt = -1/2: p = 1/2, 0, -1/2 for coefficients 1, 2, 3.
  const auto solve = [](double coefficient, double b_n) {
    return solve_sliding_contact({1.0, -0.5, 1.0, b_n, 0.25, coefficient});
  };
  for (const double coefficient : {1.0, 2.0, 3.0}) {
    const PlanarSolutions opens = solve(coefficient, 1.0);
    EXPECT_EQ(opens.list[0].mode, ContactMode::open);
    EXPECT_EQ(opens.list[0].normal, 0.0);
    EXPECT_EQ(opens.count, coefficient == 3.0 ? 2 : 1);
    EXPECT_EQ(opens.degenerate, coefficient == 2.0);
    const PlanarSolutions touches = solve(coefficient, 0.0);
    EXPECT_EQ(touches.count, 1);
    EXPECT_EQ(touches.list[0].normal, 0.0);
    EXPECT_EQ(touches.outcome, coefficient == 2.0 ? Outcome::several_solutions : Outcome::solved);
    EXPECT_TRUE(touches.degenerate);
    const PlanarSolutions closes = solve(coefficient, -1.0);
    EXPECT_EQ(closes.outcome, coefficient == 1.0 ? Outcome::solved : Outcome::no_solution);
    EXPECT_EQ(closes.degenerate, coefficient == 2.0);
  }
  EXPECT_EQ(solve(1.0, -1.0).list[0].normal, 2.0);
  EXPECT_EQ(solve(1.0, -1.0).list[0].tangential, 2.0);
  EXPECT_EQ(solve(3.0, 1.0).list[1].normal, 2.0);
  EXPECT_EQ(solve(3.0, 1.0).list[1].tangential, 6.0);
  EXPECT_EQ(solve(3.0, 1.0).outcome, Outcome::several_solutions);
  // p = 0 and W_nt + c W_tt = 0: impulses that move nothing.
  EXPECT_EQ(solve_sliding_contact({1.0, -0.5, 0.25, 0.0, 0.25, 2.0}).outcome, Outcome::forces_not_unique);
}

TEST(SlidingContact, MarginsAreRelative) {
  for (const double size : {1e-6, 1.0, 1e6}) {
    // p = 1e-9 and 1e-11 of its terms, then b_n as small against b_t.
    const auto near_p = [&](double part) {
      return solve_sliding_contact({size, -0.5 * size, size, -1.0, 0.0, 2.0 - 4.0 * part}).degenerate;
    };
    EXPECT_FALSE(near_p(1e-9));
    EXPECT_TRUE(near_p(1e-11));
    const auto near_b = [&](double part) {
      return solve_sliding_contact({1.0, -0.5, 1.0, -size * part, size, 1.0}).degenerate;
    };
    EXPECT_FALSE(near_b(1e-9));
    EXPECT_TRUE(near_b(1e-11));
  }
  // Nothing has cancelled in the zero of an immovable contact.
  EXPECT_FALSE(solve_sliding_contact({0.0, 0.0, 1.0, 1.0, 0.0, 2.0}).degenerate);
  EXPECT_EQ(solve_sliding_contact({0.0, 0.0, 1.0, -1.0, 0.0, 2.0}).outcome, Outcome::no_solution);
}

TEST(SlidingContact, NumbersThatAreNoneProveNothing) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(solve_sliding_contact({1.0, -0.5, 1.0, nan, 0.0, 1.0}).outcome, Outcome::not_solved);
  EXPECT_EQ(solve_sliding_contact({1.0, nan, 1.0, -1.0, 0.0, 1.0}).outcome, Outcome::not_solved);
  const SlidingContact infinite{1.0, -0.5, 1.0, -std::numeric_limits<double>::infinity(), 0.0, 1.0};
  EXPECT_EQ(solve_sliding_contact(infinite).outcome, Outcome::not_solved);
  std::vector<double> impulse(2);
  SolverChain chain;
  EXPECT_EQ(chain.solve(problem_of(infinite), impulse).outcome, Outcome::not_solved);
}

// Slip in the positive direction has a coefficient -mu; without friction the sign of the zero tells.
TEST(SlidingContact, ModeIsTheDirectionTold) {
  SolverChain chain;
  std::vector<double> impulse(2);
  const auto mode = [&](double coefficient, double b_n) {
    // b_t says the opposite of both directions in turn: it must not matter.
    for (const double b_t : {-3.0, 3.0}) {
      EXPECT_TRUE(chain.solve(problem_of({2.0, 0.5, 1.0, b_n, b_t, coefficient}), impulse).usable());
    }
    return chain.modes()[0];
  };
  EXPECT_EQ(mode(-0.3, -1.0), ContactMode::slip_positive);
  EXPECT_EQ(mode(0.3, -1.0), ContactMode::slip_negative);
  EXPECT_EQ(mode(-0.0, -1.0), ContactMode::slip_positive);
  EXPECT_EQ(mode(0.0, -1.0), ContactMode::slip_negative);
  EXPECT_EQ(mode(0.3, 1.0), ContactMode::open);
  // The same numbers with friction of unknown direction, by the fast path: it sticks.
  ContactProblem sticks;
  contact_test::make_problem(2.0, 0.5, 1.0, -1.0, -0.25, 0.3, sticks);
  ASSERT_TRUE(chain.solve(sticks, impulse).usable());
  EXPECT_EQ(chain.modes()[0], ContactMode::stick);
  ASSERT_TRUE(chain.solve(problem_of({2.0, 0.5, 1.0, -1.0, -0.25, 0.3}), impulse).usable());
  EXPECT_EQ(chain.modes()[0], ContactMode::slip_negative);
  EXPECT_NEAR(impulse[0], 1.0 / 2.15, 1e-16);
}

TEST(SlidingContact, AnswersNearABoundaryAreDegenerate) {
  SolverChain chain;
  std::vector<double> impulse(2);
  EXPECT_TRUE(chain.solve(problem_of({2.0, 0.5, 1.0, 0.0, 1.0, 0.3}), impulse).degenerate);
  EXPECT_FALSE(chain.solve(problem_of({2.0, 0.5, 1.0, -1.0, 1.0, 0.3}), impulse).degenerate);
  // |P_t| = |c| P_n is no boundary here, whatever xi_t.
  const ContactProblem problem = problem_of({2.0, 0.5, 1.0, -1.0, 0.0, 0.3});
  std::vector<double> xi(2);
  impulse = {1.0 / 2.15, 0.3 / 2.15};
  problem.velocities(impulse, xi);
  xi[1] = 0.0;
  EXPECT_FALSE(at_mode_boundary(problem, impulse, xi));
}

TEST(SlidingContact, ResidualSeesWhatIsWrong) {
  const ContactProblem problem = problem_of({1.0, 0.5, 1.0, -3.0, 40.0, 1.0});  // p = 1.5: P = (2, 2)
  // P* = |b_t| / trace = 20, rho = 1/2.
  EXPECT_EQ(judge(problem, {2.0, 2.0}), 0.0);
  EXPECT_EQ(judge(problem, {2.0, 2.5}), 0.5 / 20.0);   // off the proportion; xi_n = 1/4 counts 1/8
  EXPECT_EQ(judge(problem, {3.0, 3.0}), 0.75 / 20.0);  // xi_n = 1.5
  EXPECT_EQ(judge(problem, {0.0, 0.0}), 1.5 / 20.0);   // nothing done
  EXPECT_EQ(judge(problem, {2.0, -2.0}), 4.0 / 20.0);  // the wrong direction
}

TEST(SlidingContact, NewtonPolishReachesRounding) {
  for (std::uint64_t seed = 0; seed < 2000; ++seed) {
    contact_test::Random random(seed);
    const SlidingContact c = random_contact(seed);
    const PlanarSolutions exact = solve_sliding_contact(c);
    if (exact.degenerate || exact.count == 0) continue;
    const PlanarImpulse& last = exact.list[static_cast<std::size_t>(exact.count) - 1];
    std::vector<double> impulse{last.normal * (1.0 + 1e-7 * random.uniform(-1.0, 1.0)),
                                last.tangential * (1.0 + 1e-7 * random.uniform(-1.0, 1.0))};
    NewtonPolish polish;
    EXPECT_LE(polish.improve(problem_of(c), impulse, 4).value, 1e-15) << "seed " << seed;
    EXPECT_EQ(impulse[1], c.coefficient * impulse[0]) << "seed " << seed;
  }
}

// Two ways to the same answer: closed form and enumeration.
TEST(SlidingContact, EnumerationCountsLikeTheClosedForm) {
  for (std::uint64_t seed = 0; seed < 3000; ++seed) {
    SCOPED_TRACE(seed);
    const SlidingContact c = random_contact(seed);
    const PlanarSolutions exact = solve_sliding_contact(c);
    if (exact.degenerate) continue;
    // Solutions are counted to nine digits: b_n has to be seen beside b_t.
    if (std::abs(c.b_n) < 1e-6 * std::abs(c.b_t)) continue;
    SolutionList list;
    EXPECT_EQ(list.enumerate(problem_of(c)), exact.outcome);
    ASSERT_EQ(list.size(), static_cast<std::size_t>(exact.count));
    for (std::size_t k = 0; k < list.size(); ++k) {
      // A few roundings of p = W_nn + c W_nt, whose terms may cancel.
      const double coupling = c.coefficient * c.w_nt;
      const double amplified = (c.w_nn + std::abs(coupling)) / std::abs(c.w_nn + coupling);
      EXPECT_NEAR(list.impulse(k)[0], exact.list[k].normal, 1e-15 * amplified * exact.list[k].normal);
    }
  }
  // p = 0 and b_n = 0: a ray of solutions.
  SolutionList list;
  EXPECT_EQ(list.enumerate(problem_of({1.0, -0.5, 1.0, 0.0, 0.25, 2.0})), Outcome::several_solutions);
  EXPECT_TRUE(list.unbounded());
  EXPECT_EQ(list.enumerate(problem_of({1.0, -0.5, 0.25, 0.0, 0.25, 2.0})), Outcome::forces_not_unique);
}

// Whatever one solver says of one contact alone is right, and none claims a proof that is none.
TEST(SlidingContact, EverySolverIsRightOrSaysThatItIsNot) {
  SolverChain chain;
  int solved[solver_count] = {}, solvable = 0;
  for (std::uint64_t seed = 0; seed < 1000; ++seed) {
    SCOPED_TRACE(seed);
    const SlidingContact c = random_contact(seed);
    const PlanarSolutions exact = solve_sliding_contact(c);
    if (exact.degenerate || std::abs(c.b_n) < 1e-6 * std::abs(c.b_t)) continue;
    solvable += exact.count > 0 ? 1 : 0;
    const ContactProblem problem = problem_of(c);
    for (const SolverId solver : all_solvers) {
      std::vector<double> impulse(2);
      const ContactReport report = chain.solve_with(solver, problem, impulse);
      if (report.outcome == Outcome::no_solution) {
        EXPECT_EQ(exact.count, 0) << to_string(solver);
      }
      if (!report.usable()) continue;
      EXPECT_GT(exact.count, 0) << to_string(solver);
      EXPECT_LE(judge(problem, impulse), 1e-12) << to_string(solver);
      ++solved[static_cast<std::size_t>(solver)];
    }
  }
  // Where p < 0 the open solution is one that all of them start from.
  for (const SolverId solver : all_solvers) {
    // Of problems in factors only, of problems with discs only.
    if (solver == SolverId::nonlinear_cg || solver == SolverId::dense_sweeps) continue;
    EXPECT_EQ(solved[static_cast<std::size_t>(solver)], solvable) << to_string(solver);
  }
}

// The states of the sliding rod in tests/reference/contacts_planar.json, forces in place of impulses.
TEST(SlidingContact, PainleveRod) {
  const auto data = carom_test::reference_data("contacts_planar.json");
  int none = 0, two = 0, slides = 0, detaches = 0;
  SolverChain chain;
  for (const auto& state : data.at("painleve_rod").at("states")) {
    SCOPED_TRACE(state.at("name").get<std::string>());
    const auto& w = state.at("W");  // in the order (t, n)
    const double p = state.at("p").get<double>(), b = state.at("b").get<double>();
    SlidingContact c{w[1][1].get<double>(),
                     w[0][1].get<double>(),
                     w[0][0].get<double>(),
                     b,
                     0.0,
                     -state.at("tip_velocity_sign").get<double>() * state.at("mu").get<double>()};
    // Terms up to 3.4 leave p no smaller than 0.08: 2 roundings of them, and the file's, are 2e-15.
    EXPECT_NEAR(c.w_nn + c.coefficient * c.w_nt, p, 2e-15);
    const auto& known = state.at("force_level_solutions");
    none += known.empty() ? 1 : 0;
    two += known.size() == 2 ? 1 : 0;
    for (const double b_t : {0.0, 7.0, -100.0}) {  // xi_t may be anything
      c.b_t = b_t;
      const ContactProblem problem = problem_of(c);
      const PlanarSolutions found = solve_sliding_contact(c);
      SolutionList list;
      EXPECT_EQ(list.enumerate(problem), found.outcome);
      ASSERT_EQ(list.size(), known.size());
      ASSERT_EQ(static_cast<std::size_t>(found.count), known.size());
      for (std::size_t k = 0; k < known.size(); ++k) {
        const double lambda = known[k].at("lambda_n").get<double>();
        const bool slide = known[k].at("kind").get<std::string>() == "slide";
        slides += slide ? 1 : 0;
        detaches += slide ? 0 : 1;
        EXPECT_EQ(found.list[k].mode != ContactMode::open, slide);
        EXPECT_NEAR(found.list[k].normal, lambda, 2e-15 / std::abs(p) * lambda);
        EXPECT_NEAR(list.impulse(k)[0], lambda, 2e-15 / std::abs(p) * lambda);
        const double a_n = list.velocity(k)[0];
        // W P + b of terms as large as W_nn lambda.
        EXPECT_NEAR(a_n, known[k].at("a_n").get<double>(), 1e-15 * (std::abs(b) + 2.0 * c.w_nn * lambda));
      }
      std::vector<double> impulse(2);
      const ContactReport report = chain.solve(problem, impulse);
      EXPECT_EQ(report.outcome, known.empty()        ? Outcome::no_solution
                                : known.size() == 1u ? Outcome::solved
                                                     : Outcome::several_solutions);
      EXPECT_EQ(impulse[0], found.list[0].normal);  // of two the one without force
    }
  }
  EXPECT_EQ(none, 2);
  EXPECT_EQ(two, 2);
  EXPECT_EQ(slides, 3 * 4);
  EXPECT_EQ(detaches, 3 * 3);
}

}  // namespace
}  // namespace carom
