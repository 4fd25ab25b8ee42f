#include <carom/contact/solvers/solver_chain.h>

#include "tests/allocation_counter.h"
#include "tests/contact/random_problems.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <limits>
#include <sstream>
#include <stdexcept>
#include <vector>

namespace carom {
namespace {

TEST(SolverChain, OneContactIsSolvedExactly) {
  ContactProblem problem;
  contact_test::make_problem(1.0, 0.0, 3.5, -2.0, 0.5, 0.2, problem);
  SolverChain chain;
  std::vector<double> p(2);
  const ContactReport report = chain.solve(problem, p);
  EXPECT_EQ(report.outcome, Outcome::solved);
  EXPECT_EQ(report.solver, "single contact");
  EXPECT_TRUE(report.was_tried(SolverId::single_contact));
  EXPECT_FALSE(report.was_tried(SolverId::lemke));
  EXPECT_FALSE(report.degenerate);
  EXPECT_LE(report.residual, 1e-16);
  EXPECT_EQ(p[0], 2.0);
  EXPECT_DOUBLE_EQ(p[1], -1.0 / 7.0);
  ASSERT_EQ(chain.modes().size(), 1u);
  EXPECT_EQ(chain.modes()[0], ContactMode::stick);
  ASSERT_EQ(chain.velocities().size(), 2u);
  EXPECT_EQ(chain.velocities()[0], 0.0);
}

TEST(SolverChain, SeveralSolutionsAreNamed) {
  ContactProblem problem;
  contact_test::make_problem(1.6, 1.2, 3.4, 0.1, 1.0, 2.0, problem);
  SolverChain chain;
  std::vector<double> p(2);
  const ContactReport report = chain.solve(problem, p);
  EXPECT_EQ(report.outcome, Outcome::several_solutions);
  EXPECT_EQ(p[0], 0.0);
  EXPECT_EQ(chain.statistics().several_solutions, 1);
}

TEST(SolverChain, ProvedImpossibleIsNamedAndNothingActs) {
  ContactProblem problem;  // jammed with unequal restitution: W of rank one
  contact_test::make_problem(1.0, 2.0, 4.0, -2.0, -3.0, 0.8, problem);
  SolverChain chain;
  std::vector<double> p{7.0, 7.0};
  const ContactReport report = chain.solve(problem, p);
  EXPECT_EQ(report.outcome, Outcome::no_solution);
  EXPECT_FALSE(report.usable());
  EXPECT_FALSE(report.reason.empty());
  EXPECT_EQ(p, (std::vector{0.0, 0.0}));
  EXPECT_EQ(chain.velocities()[0], -2.0);
  EXPECT_EQ(chain.statistics().no_solution, 1);
  // Two closing walls, by the ray of Lemke's method.
  problem.reset(2);
  problem.w(0, 0) = problem.w(1, 1) = 1.0;
  problem.w(0, 1) = problem.w(1, 0) = -1.0;
  problem.vector()[0] = problem.vector()[1] = -1.0;
  problem.group();
  EXPECT_EQ(chain.solve(problem, p).outcome, Outcome::no_solution);
}

TEST(SolverChain, FallsBackInSpace) {
  ContactProblem problem;  // a coupled contact in space: neither closed form nor LCP
  problem.reset(3);
  problem.w(0, 0) = 1.0;
  problem.w(1, 1) = 2.0;
  problem.w(2, 2) = 3.0;
  problem.w(0, 1) = problem.w(1, 0) = 0.5;
  problem.sets()[1] = problem.sets()[2] = {.kind = SetKind::bounded_disc, .bound = 0, .coefficient = 0.3};
  problem.vector()[0] = -1.0;
  problem.vector()[1] = 2.0;
  problem.vector()[2] = -1.0;
  problem.group();
  SolverChain chain;
  std::vector<double> p(3);
  const ContactReport report = chain.solve(problem, p);
  EXPECT_EQ(report.outcome, Outcome::solved);
  EXPECT_EQ(report.solver, "dense sweeps");
  EXPECT_LE(report.residual, 1e-15);
  EXPECT_EQ(chain.modes()[0], ContactMode::slip);
}

TEST(SolverChain, RefusesWrongArguments) {
  ContactProblem problem;
  problem.reset(1);
  problem.w(0, 0) = 1.0;
  SolverChain chain;
  std::vector<double> p(1), wrong(2);
  EXPECT_THROW(static_cast<void>(chain.solve(problem, p)), std::invalid_argument);  // not grouped
  problem.group();
  EXPECT_THROW(static_cast<void>(chain.solve(problem, wrong)), std::invalid_argument);
  EXPECT_TRUE(chain.solve(problem, p).usable());
}

TEST(SolverChain, NothingToSolveIsSolved) {
  ContactProblem problem;
  problem.reset(0);
  problem.group();
  SolverChain chain;
  const ContactReport report = chain.solve(problem, {});
  EXPECT_EQ(report.outcome, Outcome::solved);
  EXPECT_EQ(report.residual, 0.0);
  EXPECT_TRUE(chain.modes().empty());
}

TEST(SolverChain, NumbersThatAreNoneAreNotAnswered) {
  for (const int contacts : {2, 5}) {
    auto random = contact_test::random_problem(3, contacts);
    random.problem.vector()[1] = std::numeric_limits<double>::quiet_NaN();
    SolverChain chain;
    std::vector<double> p(static_cast<std::size_t>(random.problem.rows()));
    const ContactReport report = chain.solve(random.problem, p);
    EXPECT_EQ(report.outcome, Outcome::not_solved);
    EXPECT_FALSE(report.usable());
    EXPECT_EQ(chain.statistics().not_solved, 1);
  }
}

TEST(SolverChain, StatisticsAddUp) {
  SolverChain chain;
  constexpr int problems = 300;
  for (std::uint64_t seed = 0; seed < problems; ++seed) {
    const auto random = contact_test::random_problem(seed, 6);
    std::vector<double> p(static_cast<std::size_t>(random.problem.rows()));
    static_cast<void>(chain.solve(random.problem, p));
  }
  const ChainStatistics& s = chain.statistics();
  EXPECT_EQ(s.problems, problems);
  std::int64_t accepted = 0;
  for (std::size_t i = 0; i < solver_count; ++i) {
    accepted += s.accepted[i];
    EXPECT_LE(s.accepted[i], s.tried[i]);
  }
  EXPECT_EQ(accepted + s.no_solution + s.not_solved, problems);
  EXPECT_GT(s.accepted[static_cast<std::size_t>(SolverId::principal_pivoting)], 0);
  EXPECT_GT(s.accepted[static_cast<std::size_t>(SolverId::lemke)], 0);
  ChainStatistics twice = s;
  twice += s;
  EXPECT_EQ(twice.problems, 2 * problems);
  EXPECT_EQ(twice.tried[2], 2 * s.tried[2]);
  EXPECT_EQ(twice.accepted[1], 2 * s.accepted[1]);
  EXPECT_EQ(twice.fall_backs, 2 * s.fall_backs);
  EXPECT_EQ(twice.worst_residual, s.worst_residual);
  chain.reset_statistics();
  EXPECT_EQ(chain.statistics().problems, 0);
}

// Single contacts are counted apart, and together with the others wherever anybody asks.
TEST(SolverChain, StatisticsThatAreTakenAddUpToTheSame) {
  SolverChain taken, kept;
  ChainStatistics sum;
  constexpr int problems = 300;
  for (std::uint64_t seed = 0; seed < problems; ++seed) {
    ContactProblem problem = contact_test::random_problem(seed, 4).problem;
    if (seed % 3 != 0) {  // its first contact alone
      const double w[] = {problem.w(0, 0), problem.w(0, 1), problem.w(1, 1)},
                   b[] = {problem.vector()[0], problem.vector()[1]};
      const RowSet friction = problem.sets()[1];
      problem.reset(2);
      problem.w(0, 0) = w[0];
      problem.w(0, 1) = problem.w(1, 0) = w[1];
      problem.w(1, 1) = w[2];
      problem.vector()[0] = b[0];
      problem.vector()[1] = b[1];
      problem.sets()[1] = friction;
      problem.group();
    }
    std::vector<double> p(static_cast<std::size_t>(problem.rows()));
    static_cast<void>(kept.solve(problem, p));
    static_cast<void>(taken.solve(problem, p));
    if (seed % 7 == 0) {
      EXPECT_EQ(kept.statistics().problems, static_cast<std::int64_t>(seed) + 1);
    }
    if (seed % 2 == 0) taken.take_statistics(sum);
  }
  taken.take_statistics(sum);
  EXPECT_EQ(sum, kept.statistics());
  EXPECT_EQ(sum.problems, problems);
  EXPECT_EQ(taken.statistics(), ChainStatistics{});
  taken.take_statistics(sum);
  EXPECT_EQ(sum, kept.statistics());
  EXPECT_GT(sum.accepted[static_cast<std::size_t>(SolverId::single_contact)], problems / 5);
  EXPECT_GT(sum.accepted[static_cast<std::size_t>(SolverId::principal_pivoting)], 0);
}

TEST(SolverChain, StatisticsAreATable) {
  ChainStatistics statistics;
  statistics.problems = 12;
  statistics.tried = {10, 2, 1, 0, 0};
  statistics.accepted = {10, 1, 1, 0, 0};
  statistics.fall_backs = 1;
  statistics.worst_residual = 2.5e-16;
  std::ostringstream out;
  out << 0.125 << "\n" << statistics << 0.125;
  EXPECT_EQ(out.str(),
            "0.125\n"
            "  contact problems                      12\n"
            "  solver                             tried      accepted\n"
            "  single contact                        10            10\n"
            "  principal pivoting                     2             1\n"
            "  Lemke                                  1             1\n"
            "  first solver not accepted              1\n"
            "  worst residual                 2.500e-16\n"
            "0.125");
}

// Same problem, same bits, whatever was solved before.
TEST(SolverChain, KeepsNothingThatChangesAnAnswer) {
  SolverChain used;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    const auto random = contact_test::random_problem(seed, 8);
    std::vector<double> first(static_cast<std::size_t>(random.problem.rows())), second(first);
    SolverChain fresh;
    const ContactReport a = used.solve(random.problem, first), b = fresh.solve(random.problem, second);
    EXPECT_EQ(first, second);
    EXPECT_EQ(a.residual, b.residual);
    EXPECT_EQ(a.outcome, b.outcome);
  }
}

TEST(SolverChain, AllocatesNothingInTheSteadyState) {
  SolverChain chain;
  std::vector<contact_test::RandomProblem> problems;
  std::vector<std::vector<double>> impulses;
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    problems.push_back(contact_test::random_problem(seed, 8));
    impulses.emplace_back(static_cast<std::size_t>(problems.back().problem.rows()));
  }
  ContactProblem single;
  contact_test::make_problem(1.0, 0.1, 3.5, -2.0, 0.5, 0.2, single);
  ContactProblem threefold;
  contact_test::make_problem(1.6, 1.2, 3.4, 0.1, 1.0, 2.0, threefold);
  std::vector<double> p(2);
  std::int64_t counted = 0;
  for (int round = 0; round < 2; ++round) {
    const std::int64_t before = carom_test::allocations();
    for (std::size_t k = 0; k < problems.size(); ++k) {
      static_cast<void>(chain.solve(problems[k].problem, impulses[k]));
      static_cast<void>(chain.solve(single, p));
      static_cast<void>(chain.solve(threefold, p));
    }
    counted = carom_test::allocations() - before;
  }
  EXPECT_EQ(counted, 0);
}

// An answer of every sort: its residual is that of the impulses written, and somebody stands by it.
TEST(SolverChain, EveryAnswerCarriesItsResidualAndASolver) {
  std::vector<ContactProblem> problems(5);
  contact_test::make_problem(1.0, 0.1, 3.5, -2.0, 0.5, 0.2, problems[0]);   // regular
  contact_test::make_problem(1.6, 1.2, 3.4, 0.1, 1.0, 2.0, problems[1]);    // several solutions
  contact_test::make_problem(1.0, 2.0, 4.0, -2.0, -3.0, 0.8, problems[2]);  // jammed, by its modes
  problems[3].reset(2);                                                     // two closing walls, by a ray
  problems[3].w(0, 0) = problems[3].w(1, 1) = 1.0;
  problems[3].w(0, 1) = problems[3].w(1, 0) = -1.0;
  problems[3].vector()[0] = problems[3].vector()[1] = -1.0;
  problems[3].group();
  problems[4].reset(1);  // immovable, no number
  problems[4].vector()[0] = std::numeric_limits<double>::quiet_NaN();
  problems[4].group();
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    problems.push_back(contact_test::random_problem(seed, 6, 3.0, seed % 3 == 0).problem);
  }
  SolverChain chain;
  int unsolved = 0;
  for (const ContactProblem& problem : problems) {
    std::vector<double> p(static_cast<std::size_t>(problem.rows()));
    const ContactReport report = chain.solve(problem, p);
    EXPECT_FALSE(report.solver.empty());
    EXPECT_EQ(report.usable(), report.residual <= tolerated_residual);
    EXPECT_EQ(report.usable(), report.reason.empty());
    EXPECT_GE(report.iterations, 0);
    // Not from the chain's velocities: those are what the residual was taken with.
    std::vector<double> xi(p.size());
    problem.velocities(p, xi);
    const Residual found = residual(problem, p, xi);
    if (report.usable()) {
      EXPECT_NEAR(report.residual, found.value, 1e-15);  // the hot path rounds xi by itself
    } else {
      EXPECT_EQ(report.residual, found.value);
    }
    unsolved += !report.usable();
  }
  EXPECT_GE(unsolved, 3);
  EXPECT_EQ(chain.statistics().no_solution + chain.statistics().not_solved, unsolved);
}

TEST(SolverChain, EverySolverAloneIsJudgedAsInTheChain) {
  SolverChain chain;
  std::vector<int> certified(solver_count, 0);
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    const auto random = contact_test::random_problem(seed, 3);
    for (const SolverId id : all_solvers) {
      std::vector<double> p(static_cast<std::size_t>(random.problem.rows()), 7.0);
      const ContactReport report = chain.solve_with(id, random.problem, p);
      EXPECT_EQ(report.solver, to_string(id));
      // Who has nothing to say writes zeros, which may be right by chance.
      const bool silent = p == std::vector<double>(p.size(), 0.0) && !report.reason.empty();
      EXPECT_EQ(report.usable(), report.residual <= tolerated_residual && !silent);
      EXPECT_EQ(chain.modes().size(), random.problem.groups().size());
      std::vector<double> xi(p.size());
      random.problem.velocities(p, xi);
      EXPECT_EQ(residual(random.problem, p, xi).value, report.residual);
      certified[static_cast<std::size_t>(id)] += report.usable();
      if (id == SolverId::single_contact || id == SolverId::dense_sweeps) {
        EXPECT_EQ(report.outcome, Outcome::not_solved);
        EXPECT_EQ(report.reason, "not applicable");
        EXPECT_FALSE(report.was_tried(id));
        EXPECT_EQ(p, std::vector<double>(p.size(), 0.0));
      }
    }
  }
  EXPECT_EQ(certified[static_cast<std::size_t>(SolverId::single_contact)], 0);
  EXPECT_EQ(certified[static_cast<std::size_t>(SolverId::dense_sweeps)], 0);
  // Existence is guaranteed for these; Lemke and enumeration are complete there.
  EXPECT_EQ(certified[static_cast<std::size_t>(SolverId::lemke)], 200);
  EXPECT_EQ(certified[static_cast<std::size_t>(SolverId::enumeration)], 200);
  EXPECT_GT(certified[static_cast<std::size_t>(SolverId::principal_pivoting)], 100);
  EXPECT_EQ(chain.statistics().problems, 0);
}

TEST(SolverChain, EnumerationAloneNamesWhatItCannotDo) {
  SolverChain chain;
  const auto random = contact_test::random_problem(4, 8);
  ASSERT_GT(random.problem.groups().size(), 3u);
  std::vector<double> p(static_cast<std::size_t>(random.problem.rows()));
  EXPECT_EQ(chain.solve_with(SolverId::enumeration, random.problem, p).reason, "not applicable");
  std::vector<double> wrong(1);
  EXPECT_THROW(static_cast<void>(chain.solve_with(SolverId::lemke, random.problem, wrong)),
               std::invalid_argument);
}

TEST(SolverChain, NamesOfSolvers) {
  EXPECT_EQ(to_string(SolverId::single_contact), "single contact");
  EXPECT_EQ(to_string(SolverId::principal_pivoting), "principal pivoting");
  EXPECT_EQ(to_string(SolverId::lemke), "Lemke");
  EXPECT_EQ(to_string(SolverId::dense_sweeps), "dense sweeps");
  EXPECT_EQ(to_string(SolverId::enumeration), "enumeration");
}

}  // namespace
}  // namespace carom
