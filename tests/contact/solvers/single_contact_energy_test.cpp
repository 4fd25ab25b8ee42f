// Energy at a single impact (docs/method.md section 5; Johansson 1999, equation 23).

#include <carom/contact/solvers/solver_chain.h>

#include "tests/contact/random_problems.h"
#include "tests/reference/reference_data.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <vector>

namespace carom {
namespace {

using contact_test::Impact;

struct Change {
  double energy = 0.0;  // P_n (y- + y+) / 2 + P_t (x- + x+) / 2
  double terms = 0.0;   // sum of the magnitudes that went into it
  double p_n = 0.0, p_t = 0.0;
};

Change solve(const Impact& impact, SolverChain& chain) {
  ContactProblem problem;
  contact_test::make_problem(impact, problem);
  std::array<double, 2> p{};
  const ContactReport report = chain.solve(problem, p);
  EXPECT_TRUE(report.usable());
  const double y_plus = chain.velocities()[0] - impact.e_n * impact.y_minus;
  const double x_plus = chain.velocities()[1] - impact.e_t * impact.x_minus;
  // The velocities behind carry the rounding of their own terms, W P among them.
  const double y_terms =
      std::abs(problem.vector()[0]) + problem.w(0, 0) * p[0] + std::abs(problem.w(0, 1) * p[1]);
  const double x_terms =
      std::abs(problem.vector()[1]) + problem.w(1, 1) * std::abs(p[1]) + std::abs(problem.w(0, 1) * p[0]);
  return {0.5 * (p[0] * (impact.y_minus + y_plus) + p[1] * (impact.x_minus + x_plus)),
          p[0] * y_terms + std::abs(p[1]) * x_terms, p[0], p[1]};
}

// One common e <= 1 cannot gain energy, whatever the offset, friction and masses.
void never_gains(std::uint64_t first, int count) {
  SolverChain chain;
  double worst = 0.0;
  for (int k = 0; k < count; ++k) {
    const std::uint64_t seed = first + static_cast<std::uint64_t>(k);
    Impact impact = contact_test::random_impact(seed);
    impact.load_x = impact.load_y = impact.load_m = 0.0;
    impact.e_t = impact.e_n;
    const Change change = solve(impact, chain);
    if (!(change.terms > 0.0)) continue;
    worst = std::max(worst, change.energy / change.terms);
    // Exactly <= 0; what is above is half a rounding of the largest term.
    ASSERT_LE(change.energy, 1.1e-16 * change.terms) << "seed " << seed;
  }
  std::printf("[   data   ] %d impacts, largest gain %.1e of its terms\n", count, worst);
}

TEST(SingleContactEnergy, EqualRestitutionNeverGains) { never_gains(1, 20'000); }

TEST(SingleContactEnergyLong, EqualRestitutionNeverGains) { never_gains(1'000'000, 500'000); }

Impact papers_counterexample(double e_n, double e_t) {
  Impact impact;
  impact.mass = impact.inertia = 1.0;
  impact.r_y = -1.0;  // r1 = r
  impact.r_x = -1.0;  // r2 = -r
  impact.x_minus = 1.0;
  impact.y_minus = -2.0;
  impact.friction = 1.0;
  impact.e_n = e_n;
  impact.e_t = e_t;
  return impact;
}

TEST(SingleContactEnergy, ThePapersGains) {
  SolverChain chain;
  const double kinetic = 2.5;
  // +2/15, +1/30 and 0 of T; sums of a few numbers of order one.
  EXPECT_NEAR(solve(papers_counterexample(1.0, 0.0), chain).energy / kinetic, 2.0 / 15.0, 4e-16);
  EXPECT_NEAR(solve(papers_counterexample(1.0, 0.5), chain).energy / kinetic, 1.0 / 30.0, 4e-16);
  EXPECT_NEAR(solve(papers_counterexample(1.0, 1.0), chain).energy / kinetic, 0.0, 4e-16);
}

TEST(SingleContactEnergy, GainsWhereTheFormulaSaysSo) {
  SolverChain chain;
  for (int i = 0; i <= 40; ++i) {
    for (int j = 0; j <= 40; ++j) {
      const double e_n = i / 40.0, e_t = j / 40.0;
      const double exact = (4.0 * e_n * e_n - 2.0 * e_n * e_t + e_t * e_t - 3.0) / 3.0;
      const double change = solve(papers_counterexample(e_n, e_t), chain).energy;
      EXPECT_NEAR(change, exact, 2e-15);
      const double border = (e_t + std::sqrt(12.0 - 3.0 * e_t * e_t)) / 4.0;
      if (std::abs(e_n - border) > 1e-12) {
        EXPECT_EQ(change > 0.0, e_n > border);
      }
    }
  }
}

TEST(SingleContactEnergy, EnergyInconsistencyOfTheReference) {
  SolverChain chain;
  const auto data = carom_test::reference_data("impacts_planar.json");
  const auto& values = data.at("energy_inconsistency").at("values");
  ASSERT_EQ(values.size(), 36u);
  for (const auto& row : values) {
    const Change change =
        solve(papers_counterexample(row.at("e_n").get<double>(), row.at("e_t").get<double>()), chain);
    EXPECT_NEAR(change.p_t, row.at("Pt").get<double>(), 1e-15);
    EXPECT_NEAR(change.p_n, row.at("Pn").get<double>(), 1e-15);
    EXPECT_NEAR(change.energy, row.at("energy_change").get<double>(), 2e-15);
  }
}

}  // namespace
}  // namespace carom
