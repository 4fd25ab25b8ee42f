// The impact law on the published and recomputed cases of tests/reference.

#include <carom/contact/solvers/single_contact.h>
#include <carom/contact/solvers/solution_list.h>
#include <carom/contact/solvers/solver_chain.h>

#include "tests/contact/random_problems.h"
#include "tests/reference/reference_data.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>
#include <vector>

namespace carom {
namespace {

// The files write slip+1 and slip-1.
bool same_mode(const std::string& name, ContactMode mode) {
  const std::string found(to_string(mode));
  return name == found || name == found + "1";
}

TEST(ReferenceImpacts, SingleContacts) {
  const auto data = carom_test::reference_data("open_variants.json");
  ASSERT_EQ(data.at("single_contact").size(), 40u);
  SolverChain chain;
  for (const auto& c : data.at("single_contact")) {
    const auto& r = c.at("contact_from_centre");
    contact_test::Impact impact;
    impact.mass = c.at("m").get<double>();
    impact.inertia = c.at("I").get<double>();
    impact.r_x = r[0].get<double>();
    impact.r_y = r[1].get<double>();
    impact.x_minus = c.at("v_minus")[0].get<double>();
    impact.y_minus = c.at("v_minus")[1].get<double>();
    impact.e_n = c.at("e_n").get<double>();
    impact.e_t = c.at("e_t").get<double>();
    impact.friction = c.at("mu").get<double>();
    EXPECT_NEAR(impact.w_tt(), c.at("W")[0][0].get<double>(), 1e-15 * impact.w_tt());
    EXPECT_NEAR(impact.w_nt(), c.at("W")[0][1].get<double>(), 1e-15 * impact.w_tt());
    EXPECT_NEAR(impact.w_nn(), c.at("W")[1][1].get<double>(), 1e-15 * impact.w_nn());

    ContactProblem problem;
    contact_test::make_problem(impact, problem);
    std::array<double, 2> p{};
    const ContactReport report = chain.solve(problem, p);
    const PlanarSolutions list = solve_planar_contact(
        {impact.w_nn(), impact.w_nt(), impact.w_tt(), impact.b_n(), impact.b_t(), impact.friction});
    const auto& known = c.at("solutions");
    ASSERT_EQ(static_cast<std::size_t>(list.count), known.size());
    EXPECT_EQ(report.outcome == Outcome::several_solutions, known.size() > 1);
    EXPECT_FALSE(report.degenerate);
    // mode, P_t, P_n, x+, y+; inputs of three digits, cond(W) < 100: 15 digits of the file less two.
    const auto& s = known[0];
    EXPECT_TRUE(same_mode(s[0].get<std::string>(), chain.modes()[0]));
    EXPECT_NEAR(p[1], s[1].get<double>(), 1e-13);
    EXPECT_NEAR(p[0], s[2].get<double>(), 1e-13);
    EXPECT_NEAR(chain.velocities()[1] - impact.e_t * impact.x_minus, s[3].get<double>(), 1e-14);
    EXPECT_NEAR(chain.velocities()[0] - impact.e_n * impact.y_minus, s[4].get<double>(), 1e-14);
  }
}

TEST(ReferenceImpacts, TwoContactsOfOneBody) {
  const auto data = carom_test::reference_data("open_variants.json");
  ASSERT_EQ(data.at("two_contacts").size(), 20u);
  SolverChain chain;
  for (const auto& c : data.at("two_contacts")) {
    const double m = c.at("m").get<double>(), inertia = c.at("I").get<double>();
    const std::array<double, 3> inverse{1.0 / m, 1.0 / m, 1.0 / inertia};
    std::array<std::array<double, 3>, 4> h{};  // rows n, t of each contact; n = (0, 1), t = (1, 0)
    for (std::size_t k = 0; k < 2; ++k) {
      const double x = c.at("points")[k][0].get<double>(), y = c.at("points")[k][1].get<double>();
      h[2 * k] = {0.0, 1.0, x};
      h[2 * k + 1] = {1.0, 0.0, -y};
    }
    std::array<double, 4> before{};
    ContactProblem problem;
    problem.reset(4);
    for (std::size_t i = 0; i < 4; ++i) {
      for (std::size_t k = 0; k < 3; ++k) before[i] += h[i][k] * c.at("body_velocity")[k].get<double>();
      const double e = c.at(i % 2 == 0 ? "e_n" : "e_t").get<double>();
      problem.vector()[i] = (1.0 + e) * before[i];
      for (std::size_t j = 0; j < 4; ++j) {
        for (std::size_t k = 0; k < 3; ++k) {
          problem.w(static_cast<int>(i), static_cast<int>(j)) += h[i][k] * inverse[k] * h[j][k];
        }
      }
    }
    const double mu = c.at("mu").get<double>();
    problem.sets()[1] = {.kind = SetKind::bounded_interval, .bound = 0, .coefficient = mu};
    problem.sets()[3] = {.kind = SetKind::bounded_interval, .bound = 2, .coefficient = mu};
    problem.group();

    SolutionList list;
    const Outcome outcome = list.enumerate(problem);
    const auto& known = c.at("solutions");
    ASSERT_EQ(known.size(), 1u);
    EXPECT_EQ(outcome, Outcome::solved);
    ASSERT_EQ(list.size(), 1u);
    std::array<double, 4> p{};
    const ContactReport report = chain.solve(problem, p);
    EXPECT_TRUE(report.usable());
    EXPECT_LE(report.residual, 1e-15);
    for (std::size_t k = 0; k < 2; ++k) {
      EXPECT_TRUE(same_mode(known[0].at("modes")[k].get<std::string>(), chain.modes()[k]));
      for (std::size_t d = 0; d < 2; ++d) {  // the file has t first
        const std::size_t row = 2 * k + (1 - d);
        const double impulse = known[0].at("impulses_t_n")[2 * k + d].get<double>();
        const double velocity = known[0].at("contact_velocity_after")[2 * k + d].get<double>();
        const double e = c.at(d == 1 ? "e_n" : "e_t").get<double>();
        // W has rank 3 of 4: impulses keep two digits less. Velocities carry the last bits of impulses whose
        // contributions cancel, and those of the file's inputs.
        double terms = std::abs(problem.vector()[row]);
        for (std::size_t j = 0; j < 4; ++j) {
          terms += std::abs(problem.w(static_cast<int>(row), static_cast<int>(j)) * p[j]);
        }
        EXPECT_NEAR(p[row], impulse, 2e-13);
        EXPECT_NEAR(list.impulse(0)[row], impulse, 2e-13);
        EXPECT_NEAR(chain.velocities()[row] - e * before[row], velocity, 5e-16 * terms);
      }
    }
  }
}

// Walton's law is this law (docs/method.md section 4): psi2 over psi1, with unit normal speed.
TEST(ReferenceImpacts, WaltonCurves) {
  const auto data = carom_test::reference_data("impacts_planar.json");
  SolverChain chain;
  int points = 0;
  for (const auto& c : data.at("walton_curves").at("cases")) {
    const double inertia = c.at("I_over_m_r2").get<double>();
    const double e_n = c.at("e_n").get<double>(), beta = c.at("beta0").get<double>();
    for (const auto& point : c.at("curve_psi1_psi2_mode")) {
      const double psi1 = point[0].get<double>();
      ContactProblem problem;
      contact_test::make_problem(1.0, 0.0, 1.0 + 1.0 / inertia, -(1.0 + e_n), (1.0 + beta) * psi1,
                                 c.at("mu").get<double>(), problem);
      std::array<double, 2> p{};
      const ContactReport report = chain.solve(problem, p);
      EXPECT_TRUE(report.usable());
      EXPECT_NEAR(chain.velocities()[1] - beta * psi1, point[1].get<double>(), 2e-15);
      EXPECT_NEAR(chain.velocities()[0] - e_n * -1.0, e_n, 1e-15);
      // At psi* itself stick and slip meet.
      if (std::abs(psi1 - c.at("psi_star").get<double>()) > 1e-9) {
        EXPECT_TRUE(same_mode(point[2].get<std::string>(), chain.modes()[0]));
      } else {
        EXPECT_TRUE(report.degenerate);
      }
      ++points;
    }
  }
  EXPECT_EQ(points, 33);
}

// Johansson 1999 section 5: thin shell, contact speed v_x + r spin.
TEST(ReferenceImpacts, HoraksBall) {
  const auto data = carom_test::reference_data("impacts_planar.json");
  const double m = 0.1134, r = 0.0359, inertia = 2.0 / 3.0 * m * r * r;
  const double v_n = data.at("horak").at("impact_speed").get<double>();
  SolverChain chain;
  int rows = 0;
  for (const auto& [name, result] : data.at("horak").at("results").items()) {
    SCOPED_TRACE(name);
    const double e_n = name == "fit_mu0.08_en0.92_et0.92" ? 0.92 : 0.82, e_t = result.at("e_t").get<double>();
    for (const auto& row : result.at("rows")) {
      const double spin = row.at("spin_before").get<double>();
      ContactProblem problem;
      contact_test::make_problem(1.0 / m, 0.0, 1.0 / m + r * r / inertia, -(1.0 + e_n) * v_n,
                                 (1.0 + e_t) * r * spin, result.at("mu").get<double>(), problem);
      std::array<double, 2> p{};
      EXPECT_TRUE(chain.solve(problem, p).usable());
      // 15 digits of spins up to 200 rad/s; P_t r / I magnifies by 1 / (m r) = 245.
      EXPECT_NEAR(spin + r * p[1] / inertia, row.at("spin_after").get<double>(), 2e-13);
      EXPECT_NEAR(p[1] / m, row.at("vx_after").get<double>(), 2e-15);
      EXPECT_NEAR(-v_n + p[0] / m, row.at("vy_after").get<double>(), 2e-15);
      if (spin > 0.0) {
        EXPECT_TRUE(same_mode(row.at("mode").get<std::string>(), chain.modes()[0]));
      }
      ++rows;
    }
  }
  EXPECT_EQ(rows, 54);
}

}  // namespace
}  // namespace carom
