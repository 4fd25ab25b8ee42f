// Many random problems with several contacts: is every one solved, and right?

#include <carom/contact/solvers/residual.h>
#include <carom/contact/solvers/solution_list.h>
#include <carom/contact/solvers/solver_chain.h>

#include "tests/contact/random_problems.h"
#include "tests/shares.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <string>
#include <vector>

namespace carom {
namespace {

struct Counts {
  std::int64_t failures = 0;
  double worst_gain = 0.0;  // of kinetic energy, where one e forbids it
};

// 2 to 12 contacts on one or more rigid bodies; a solution exists for each (random_problems.h).
void solve_many(const carom_test::SeedRange& seeds, double decades) {
  SolverChain chain;
  Counts counts;
  std::vector<double> impulse, xi;
  for (std::uint64_t seed = seeds.first; seed < seeds.last; ++seed) {
    const auto random = contact_test::random_problem(seed, 12, decades);
    ASSERT_TRUE(random.existence_guaranteed);
    impulse.assign(static_cast<std::size_t>(random.problem.rows()), 0.0);
    xi.resize(impulse.size());
    const ContactReport report = chain.solve(random.problem, impulse);
    random.problem.velocities(impulse, xi);
    const double error = residual(random.problem, impulse, xi).value;
    if (!report.usable() || !(error <= tolerated_residual)) {
      if (++counts.failures <= 20) {
        ADD_FAILURE() << "seed " << seed << ": " << to_string(report.outcome) << ", " << report.reason
                      << ", residual " << error << ", bodies " << random.bodies << ", contacts "
                      << random.contacts;
      }
      continue;
    }
    EXPECT_EQ(report.residual, error) << "seed " << seed;
    if (!random.common_restitution) continue;
    // One e <= 1 and obstacles at rest: dT = P^T (gamma^- + gamma^+) / 2 <= 0 (docs/method.md section 5),
    // with gamma^- = b / (1 + e) and gamma^+ = xi - e gamma^-. Exactly so; xi carries the residual of the
    // answer.
    double change = 0.0, terms = 0.0;
    for (std::size_t i = 0; i < impulse.size(); ++i) {
      const double before = random.problem.vector()[i] / (1.0 + random.restitution);
      change += 0.5 * impulse[i] * (xi[i] + (1.0 - random.restitution) * before);
      terms += std::abs(impulse[i] * random.problem.vector()[i]);
      for (std::size_t j = 0; j < impulse.size(); ++j) {
        terms +=
            std::abs(impulse[i] * random.problem.w(static_cast<int>(i), static_cast<int>(j)) * impulse[j]);
      }
    }
    if (!(terms > 0.0)) continue;
    counts.worst_gain = std::max(counts.worst_gain, change / terms);
    EXPECT_LE(change, 1e-14 * terms) << "seed " << seed << " gains energy";
  }
  const ChainStatistics& s = chain.statistics();
  std::printf(
      "[   data   ] %d problems over %.0f decades of mass: principal pivoting %lld of %lld tried, Lemke %lld "
      "of %lld, enumeration %lld; above 1e-12: %lld; worst residual %.1e; failures "
      "%lld; "
      "energy gain at most %.1e of its terms\n",
      seeds.count(), decades, static_cast<long long>(s.accepted[1]), static_cast<long long>(s.tried[1]),
      static_cast<long long>(s.accepted[2]), static_cast<long long>(s.tried[2]),
      static_cast<long long>(s.accepted[4]), static_cast<long long>(s.tolerated), s.worst_residual,
      static_cast<long long>(counts.failures), counts.worst_gain);
  EXPECT_EQ(counts.failures, 0);
}

// Any directions, each contact with its own e: contacts can jam, and then there need not be a solution. Every
// problem ends with an answer that is right, a proof that there is none, or a plain not_solved.
void solve_jams(const carom_test::SeedRange& seeds) {
  SolverChain chain;
  std::vector<double> impulse, xi;
  int small = 0, small_open = 0;
  for (std::uint64_t seed = seeds.first; seed < seeds.last; ++seed) {
    const auto random = contact_test::random_problem(seed, 12, 3.0, true);
    impulse.assign(static_cast<std::size_t>(random.problem.rows()), 0.0);
    xi.resize(impulse.size());
    const ContactReport report = chain.solve(random.problem, impulse);
    random.problem.velocities(impulse, xi);
    if (report.usable()) {
      EXPECT_LE(residual(random.problem, impulse, xi).value, tolerated_residual) << "seed " << seed;
    } else {
      EXPECT_FALSE(report.reason.empty());
    }
    if (random.contacts > enumeration_groups) continue;
    ++small;
    if (report.outcome != Outcome::not_solved) continue;
    ++small_open;
    std::printf("[   data   ] seed %llu: %d contacts, neither solved nor refuted, residual %.1e\n",
                static_cast<unsigned long long>(seed), random.contacts, report.residual);
  }
  const ChainStatistics& s = chain.statistics();
  std::printf(
      "[   data   ] %d problems that may jam: no solution proved %lld, not solved %lld; up to three "
      "contacts: %d, "
      "of which solved by enumeration %lld, open %d; worst residual %.1e\n",
      seeds.count(), static_cast<long long>(s.no_solution), static_cast<long long>(s.not_solved), small,
      static_cast<long long>(s.accepted[static_cast<std::size_t>(SolverId::enumeration)]), small_open,
      s.worst_residual);
  EXPECT_EQ(small_open, 0) << "up to three contacts the enumeration decides";
}

TEST(RandomContacts, JamsAreSolvedOrNamed) { solve_jams({1, 1 + carom_test::count_of_samples(500U)}); }

TEST(RandomContactsLong, JamsAreSolvedOrNamed) { solve_jams(carom_test::seeds_from(1'000'000, 10'000)); }

TEST(RandomContacts, TenThousandProblems) { solve_many({1, 1 + carom_test::count_of_samples(10'000U)}, 3.0); }

TEST(RandomContactsLong, HundredThousandProblems) {
  solve_many(carom_test::seeds_from(1'000'000, 100'000), 3.0);
}

TEST(RandomContactsLong, MassesOverSixDecades) { solve_many(carom_test::seeds_from(3'000'000, 50'000), 6.0); }

}  // namespace
}  // namespace carom
