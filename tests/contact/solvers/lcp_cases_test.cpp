// Lemke's method and principal pivoting on 57 problems with known solutions (reference/lcp_cases.json).

#include <carom/core/numerics/lcp.h>
#include <carom/core/numerics/lemke.h>
#include <carom/core/numerics/principal_pivoting.h>

#include "tests/reference/reference_data.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <string>
#include <vector>

namespace carom {
namespace {

// The bound on pivots for which the behaviour in the file was recorded.
constexpr int recorded_bound = 5000;

Lcp read(const nlohmann::json& c) {
  Lcp lcp;
  lcp.reset(c.at("n").get<int>());
  for (int i = 0; i < lcp.size; ++i) {
    const auto k = static_cast<std::size_t>(i);
    lcp.q[k] = c.at("q")[k].get<double>();
    for (int j = 0; j < lcp.size; ++j) lcp.at(i, j) = c.at("M")[k][static_cast<std::size_t>(j)].get<double>();
  }
  return lcp;
}

// Distance to the nearest listed solution, relative to that solution's size.
double distance_to_known(const nlohmann::json& c, const std::vector<double>& z) {
  double least = std::numeric_limits<double>::infinity();
  for (const auto& known : c.at("solutions_z")) {
    double size = 1.0, worst = 0.0;
    for (std::size_t i = 0; i < z.size(); ++i) {
      const double value = known[i].get<double>();
      size = std::max(size, std::abs(value));
      worst = std::max(worst, std::abs(z[i] - value));
    }
    least = std::min(least, worst / size);
  }
  return least;
}

bool has_continuum(const nlohmann::json& c) { return c.contains("continua") && !c.at("continua").empty(); }

// A solved problem is solved right: to a few roundings of the refined basis, cond(M) up to 1e3 here.
void expect_correct(const nlohmann::json& c, const Lcp& lcp, const std::vector<double>& z) {
  EXPECT_LE(lcp_residual(lcp, z), 1e-14);
  if (!has_continuum(c) && c.contains("solutions_z")) {
    EXPECT_LE(distance_to_known(c, z), 1e-13);
  }
}

LcpStatus recorded(const std::string& name) {
  if (name == "solved" || name == "trivial") return LcpStatus::solved;
  if (name == "ray") return LcpStatus::secondary_ray;
  if (name == "cycles" || name == "limit") return LcpStatus::pivot_bound;
  if (name == "singular") return LcpStatus::vanishing_pivot;
  ADD_FAILURE() << "unknown status " << name;
  return LcpStatus::inaccurate;
}

TEST(LcpCases, LemkeEndsAsRecorded) {
  int solved = 0, rays = 0, bounds = 0, recorded_ones = 0;
  const auto data = carom_test::reference_data("lcp_cases.json");
  ASSERT_EQ(data.at("cases").size(), 57u);
  for (const auto& c : data.at("cases")) {
    SCOPED_TRACE(c.at("name").get<std::string>());
    const Lcp lcp = read(c);
    std::vector<double> z(static_cast<std::size_t>(lcp.size));
    Lemke lemke;
    const LcpAnswer answer = lemke.solve(lcp, z, recorded_bound);
    EXPECT_NE(answer.status, LcpStatus::inaccurate);
    EXPECT_NE(answer.status, LcpStatus::vanishing_pivot);
    if (answer.status == LcpStatus::solved) expect_correct(c, lcp, z);
    solved += answer.status == LcpStatus::solved ? 1 : 0;
    rays += answer.status == LcpStatus::secondary_ray ? 1 : 0;
    bounds += answer.status == LcpStatus::pivot_bound ? 1 : 0;
    if (!c.contains("lemke_ones_status_pivots_by_tie_rule")) continue;
    const auto& lex = c.at("lemke_ones_status_pivots_by_tie_rule").at("lex");
    EXPECT_EQ(to_string(answer.status), to_string(recorded(lex[0].get<std::string>())));
    // The same path, pivot by pivot. Only Fathi's matrix for n = 12 takes thousands of pivots through ties,
    // on an ill-conditioned tableau: there rounding breaks some of them, and the path gets shorter.
    if (answer.status == LcpStatus::solved && c.at("name") != "fathi_qneg_ones_12") {
      EXPECT_EQ(answer.pivots, lex[1].get<int>());
    }
    ++recorded_ones;
  }
  std::printf("[   data   ] solved %d, rays %d, pivot bound %d; compared with the record: %d\n", solved, rays,
              bounds, recorded_ones);
  EXPECT_EQ(solved + rays + bounds, 57);
}

// w = -1 - z has no solution: the path ends after one pivot, at a ray that is one.
TEST(LcpCases, LemkeConfirmsARay) {
  Lcp lcp;
  lcp.reset(1);
  lcp.at(0, 0) = lcp.q[0] = -1.0;
  std::vector<double> z(1);
  Lemke lemke;
  const LcpAnswer answer = lemke.solve(lcp, z);
  EXPECT_EQ(answer.status, LcpStatus::secondary_ray);
  EXPECT_EQ(answer.pivots, 1);
}

TEST(LcpCases, PrincipalPivotingEndsAsRecorded) {
  int solved = 0, vanishing = 0, bounds = 0, recorded_ones = 0;
  const auto data = carom_test::reference_data("lcp_cases.json");
  for (const auto& c : data.at("cases")) {
    SCOPED_TRACE(c.at("name").get<std::string>());
    const Lcp lcp = read(c);
    std::vector<double> z(static_cast<std::size_t>(lcp.size));
    PrincipalPivoting pivoting;
    const LcpAnswer answer = pivoting.solve(lcp, z, recorded_bound);
    EXPECT_NE(answer.status, LcpStatus::inaccurate);
    if (answer.status == LcpStatus::solved) {
      expect_correct(c, lcp, z);
    } else {
      EXPECT_EQ(z, std::vector<double>(z.size(), 0.0));
    }
    solved += answer.status == LcpStatus::solved ? 1 : 0;
    vanishing += answer.status == LcpStatus::vanishing_pivot ? 1 : 0;
    bounds += answer.status == LcpStatus::pivot_bound ? 1 : 0;
    if (!c.contains("principal_pivoting_status_flips")) continue;
    const auto& least = c.at("principal_pivoting_status_flips").at("least");
    EXPECT_EQ(to_string(answer.status), to_string(recorded(least[0].get<std::string>())));
    if (answer.status == LcpStatus::solved) {
      EXPECT_EQ(answer.pivots, least[1].get<int>());
    }
    ++recorded_ones;
  }
  std::printf("[   data   ] solved %d, vanishing pivot %d, pivot bound %d; compared with the record: %d\n",
              solved, vanishing, bounds, recorded_ones);
  EXPECT_EQ(solved + vanishing + bounds, 57);
}

TEST(LcpCases, DefaultBoundsEndEverything) {
  const auto data = carom_test::reference_data("lcp_cases.json");
  for (const auto& c : data.at("cases")) {
    SCOPED_TRACE(c.at("name").get<std::string>());
    const Lcp lcp = read(c);
    std::vector<double> z(static_cast<std::size_t>(lcp.size));
    Lemke lemke;
    const LcpAnswer by_lemke = lemke.solve(lcp, z);
    EXPECT_LE(by_lemke.pivots, 100 + 30 * lcp.size);
    if (by_lemke.status == LcpStatus::solved) expect_correct(c, lcp, z);
    PrincipalPivoting pivoting;
    const LcpAnswer by_pivoting = pivoting.solve(lcp, z);
    EXPECT_LE(by_pivoting.pivots, 20 + 10 * lcp.size);
    if (by_pivoting.status == LcpStatus::solved) expect_correct(c, lcp, z);
  }
}

TEST(Lcp, ResidualSeesEveryViolation) {
  Lcp lcp;
  lcp.reset(2);
  lcp.at(0, 0) = 2.0;
  lcp.at(1, 1) = 1.0;
  lcp.q = {-4.0, 1.0};
  EXPECT_EQ(lcp_residual(lcp, std::vector{2.0, 0.0}), 0.0);
  EXPECT_EQ(lcp_residual(lcp, std::vector{1.0, 0.0}), 0.5);    // w = -2 of 4
  EXPECT_EQ(lcp_residual(lcp, std::vector{2.0, 2.0}), 1.0);    // w and z both positive
  EXPECT_EQ(lcp_residual(lcp, std::vector{2.0, -0.5}), 0.25);  // z negative
  EXPECT_EQ(lcp_residual(lcp, std::vector{2.0, std::numeric_limits<double>::quiet_NaN()}),
            std::numeric_limits<double>::infinity());
}

TEST(Lcp, NamesOfStatuses) {
  EXPECT_EQ(to_string(LcpStatus::solved), "solved");
  EXPECT_EQ(to_string(LcpStatus::secondary_ray), "secondary ray");
  EXPECT_EQ(to_string(LcpStatus::pivot_bound), "pivot bound");
  EXPECT_EQ(to_string(LcpStatus::vanishing_pivot), "vanishing pivot");
  EXPECT_EQ(to_string(LcpStatus::inaccurate), "inaccurate");
}

}  // namespace
}  // namespace carom
