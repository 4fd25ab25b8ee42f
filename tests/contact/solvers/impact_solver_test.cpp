// Laws of impact other than Newton's: the path of one contact against closed forms and against an integration
// of the impulse equations; two phases against what they ask for; where the three laws agree, and where not.

#include "tests/contact/solvers/random_impact_paths.h"

#include <carom/contact/solvers/impact_solver.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace carom {
namespace {

using contact_test::Random;
using contact_test::random_impact_path;

double energy_gained(const ImpactPathInput& in, const ImpactPathEnd& end) {
  return 0.5 * end.normal_impulse * (in.normal + end.normal) +
         0.5 * end.tangential_impulse * (in.tangential + end.tangential);
}

/// Many small steps of the impulse with the friction of the present slip; where slip would change its sign
/// within a step, the friction that stops it, if there is enough. Of first order in the step.
struct SmallSteps {
  double normal = 0.0, tangential = 0.0, compression = 0.0, expansion = 0.0;
};
SmallSteps integrate(const ImpactPathInput& in, double step) {
  SmallSteps at;
  double n = in.normal, t = in.tangential;
  for (;;) {
    // Implicit in friction: the root of t + (wnt + wtt k) step = 0 where it lies in the cone.
    const double stop = (-t / step - in.wnt) / in.wtt;
    const double k = std::clamp(stop, -in.friction, in.friction);
    const double next = n + (in.wnn + in.wnt * k) * step;
    const double work = 0.5 * (n + next) * step;
    (next < 0.0 && at.expansion == 0.0 ? at.compression : at.expansion) += work;
    at.normal += step;
    at.tangential += k * step;
    n = next;
    t += (in.wnt + in.wtt * k) * step;
    if (at.expansion >= -in.restitution * in.restitution * at.compression && n > 0.0) return at;
  }
}

TEST(ImpactPath, AgreesWithSmallStepsOfTheImpulse) {
  Random random(3);
  int reversals = 0, sticks = 0;
  for (int i = 0; i < 300; ++i) {
    const ImpactPathInput in = random_impact_path(random, random.uniform(0.1, 1.0));
    const auto end = follow_impact(in);
    ASSERT_TRUE(end) << i;
    const double step = 1e-4 * end->normal_impulse;
    const SmallSteps steps = integrate(in, step);
    // Two steps, one at the end of either phase; their work is lost or gained.
    const double tolerance = 10.0 * step * (1.0 + in.friction);
    EXPECT_NEAR(end->normal_impulse, steps.normal, tolerance) << i;
    EXPECT_NEAR(end->tangential_impulse, steps.tangential, tolerance) << i;
    reversals += end->tangential * in.tangential < 0.0 ? 1 : 0;
    sticks += end->sticks ? 1 : 0;
  }
  EXPECT_GT(reversals, 10);
  EXPECT_GT(sticks, 20);
}

TEST(ImpactPath, ClosedFormsOfCentralImpact) {
  // W_nt = 0: P_n = (1 + e) |gamma_n|/W_nn; slip or stop of the tangential motion alone.
  Random random(4);
  for (int i = 0; i < 1000; ++i) {
    ImpactPathInput in = random_impact_path(random, random.uniform(0.0, 1.0));
    in.wnt = 0.0;
    const auto end = follow_impact(in);
    ASSERT_TRUE(end) << i;
    const double normal = (1.0 + in.restitution) * -in.normal / in.wnn;
    const double limit = in.friction * normal;
    const double tangential = std::clamp(-in.tangential / in.wtt, -limit, limit);
    EXPECT_NEAR(end->normal_impulse, normal, 1e-14 * normal) << i;
    EXPECT_NEAR(end->tangential_impulse, tangential, 1e-14 * (normal + std::abs(tangential))) << i;
    EXPECT_NEAR(end->normal, -in.restitution * in.normal, 1e-14 * -in.normal) << i;
  }
}

TEST(ImpactPath, SlipThatGoesOnThroughoutHasNewtonsImpulse) {
  // Constant ratio k: the energetic, Poisson's and Newton's law are one; P_n = -(1 + e) gamma_n/(W_nn + k
  // W_nt).
  Random random(5);
  int found = 0;
  for (int i = 0; i < 1000; ++i) {
    const ImpactPathInput in = random_impact_path(random, random.uniform(0.0, 1.0));
    const double k = -std::copysign(in.friction, in.tangential);
    const double rate = in.wnn + k * in.wnt;
    const double impulse = -(1.0 + in.restitution) * in.normal / rate;
    if (!(rate > 0.0) || (in.tangential + (in.wnt + k * in.wtt) * impulse) * in.tangential <= 0.0) continue;
    ++found;
    const auto end = follow_impact(in);
    ASSERT_TRUE(end) << i;
    EXPECT_NEAR(end->normal_impulse, impulse, 1e-13 * impulse) << i;
    EXPECT_FALSE(end->sticks) << i;
  }
  EXPECT_GT(found, 100);
}

TEST(ImpactPath, NeverGainsAndGivesBackWhatTheLawSays) {
  Random random(6);
  for (int i = 0; i < 20000; ++i) {
    const ImpactPathInput in = random_impact_path(random, random.uniform(0.0, 1.0));
    const auto end = follow_impact(in);
    ASSERT_TRUE(end) << i;
    const double scale =
        end->normal_impulse * (std::abs(in.normal) + std::abs(end->normal)) +
        std::abs(end->tangential_impulse) * (std::abs(in.tangential) + std::abs(end->tangential));
    EXPECT_LE(energy_gained(in, *end), 1e-14 * scale) << i;
    EXPECT_GE(end->normal, 0.0) << i;
    EXPECT_LE(std::abs(end->tangential_impulse), in.friction * end->normal_impulse * (1.0 + 1e-14)) << i;
    const double normal =
        in.normal + in.wnn * end->normal_impulse + in.wnt * end->tangential_impulse - end->normal;
    EXPECT_NEAR(normal, 0.0, 1e-13 * (std::abs(in.normal) + in.wnn * end->normal_impulse)) << i;
  }
}

TEST(ImpactPath, DoesNotGainWhereNewtonDoes) {
  // Johansson 1999, end of section 5: r1 = r, r2 = -r, I = m r^2, mu = 1, velocities (v, -2 v). Newton's law
  // with (e_n, e_t) = (1, 0) adds 2/15 of the kinetic energy m (v^2 + 4 v^2)/2.
  constexpr double friction = 1.0;
  ContactProblem problem;
  // Rates with r_y = -r, r_x = -r in theory.md's frame: W_nt = -r_x r_y/I = -1.
  contact_test::make_problem(2.0, -1.0, 2.0, 2.0 * -2.0, 1.0 * 1.0, friction, problem);
  SolverChain chain;
  std::array<double, 2> impulse{};
  ASSERT_TRUE(chain.solve(problem, impulse).usable());
  const double n = -2.0 + 2.0 * impulse[0] - impulse[1], t = 1.0 - impulse[0] + 2.0 * impulse[1];
  const double gain = 0.5 * impulse[0] * (-2.0 + n) + 0.5 * impulse[1] * (1.0 + t);
  EXPECT_NEAR(gain / 2.5, 2.0 / 15.0, 1e-14);
  const ImpactPathInput in{2.0, -1.0, 2.0, friction, 1.0, -2.0, 1.0};
  const auto end = follow_impact(in);
  ASSERT_TRUE(end);
  // Slip stops at p = 1/3, where gamma_n = -1 and W_nn + k W_nt = 3 so far; then stick with k = 1/2 and the
  // rate 3/2: gamma_n = 0 at p = 1. Works -1/2 and -1/3; expansion to (3/4) x^2 = 5/6.
  EXPECT_NEAR(end->normal_impulse, 1.0 + std::sqrt(10.0 / 9.0), 1e-14);
  EXPECT_LT(energy_gained(in, *end), 0.0);
}

/// Problem of several contacts on bodies that share them: W = H H^T of random H, b = (1 + e) gamma^-.
struct SeveralContacts {
  ContactProblem problem;
  std::vector<double> restitution, before;
};
/// \param fastest of contacts that part before the impact, with e the same for all where there are none
SeveralContacts several(Random& random, int contacts, double fastest) {
  SeveralContacts out;
  const int rows = 2 * contacts, freedoms = rows + 1;
  std::vector<double> h(static_cast<std::size_t>(rows * freedoms));
  for (double& number : h) number = random.uniform(-1.0, 1.0);
  out.problem.reset(rows);
  for (int i = 0; i < rows; ++i) {
    for (int j = 0; j < rows; ++j) {
      double sum = 0.0;
      for (int k = 0; k < freedoms; ++k) {
        sum += h[static_cast<std::size_t>(i * freedoms + k)] * h[static_cast<std::size_t>(j * freedoms + k)];
      }
      out.problem.w(i, j) = sum;
    }
  }
  const double common = random.uniform(0.0, 1.0);
  for (int c = 0; c < contacts; ++c) {
    const double own = random.uniform(0.0, 1.0);
    const double e = fastest > 0.0 ? own : common;
    const double normal = random.uniform(-2.0, fastest);
    const double tangential = random.uniform(-2.0, 2.0);
    out.problem.sets()[static_cast<std::size_t>(2 * c)].kind = SetKind::half_line;
    RowSet& set = out.problem.sets()[static_cast<std::size_t>(2 * c + 1)];
    set.kind = SetKind::bounded_interval;
    set.bound = 2 * c;
    set.coefficient = 0.0;
    out.restitution.insert(out.restitution.end(), {e, 0.0});
    out.before.insert(out.before.end(), {normal, tangential});
  }
  for (std::size_t i = 0; i < out.before.size(); ++i) {
    out.problem.vector()[i] = (1.0 + out.restitution[i]) * out.before[i];
  }
  out.problem.group();
  return out;
}

// Contacts that part before the impact would have P_n > 0 by Newton's law to part by e less: there the laws
// differ.
TEST(ImpactSolver, LawsAgreeWithoutFriction) {
  Random random(7);
  for (int i = 0; i < 300; ++i) {
    const SeveralContacts at = several(random, random.integer(1, 4), 0.0);
    SolverChain chain;
    std::vector<double> newton(at.before.size());
    ASSERT_TRUE(chain.solve(at.problem, newton).usable()) << i;
    const double size = 1.0 + *std::max_element(newton.begin(), newton.end());
    for (const ImpactLaw law : {ImpactLaw::poisson, ImpactLaw::energetic}) {
      ImpactSolver solver;
      ContactSolution answer;
      solver.solve(law, at.problem, at.restitution, chain, answer);
      ASSERT_TRUE(answer.report.usable()) << i << to_string(law);
      for (std::size_t row = 0; row < newton.size(); ++row) {
        EXPECT_NEAR(answer.impulse[row], newton[row], 1e-13 * size) << i << to_string(law) << row;
      }
    }
  }
}

TEST(ImpactSolver, EnergeticLawOfSeveralContactsDoesNotGain) {
  Random random(8);
  int newton_gains = 0;
  for (int i = 0; i < 500; ++i) {
    const SeveralContacts at = several(random, random.integer(2, 4), 1.0);
    SolverChain chain;
    const auto gain = [&](const std::vector<double>& impulse) {
      double sum = 0.0;
      for (std::size_t row = 0; row < impulse.size(); ++row) {
        double after = at.before[row];
        for (std::size_t k = 0; k < impulse.size(); ++k) {
          after += at.problem.w(static_cast<int>(row), static_cast<int>(k)) * impulse[k];
        }
        sum += 0.5 * impulse[row] * (at.before[row] + after);
      }
      return sum;
    };
    std::vector<double> newton(at.before.size());
    if (chain.solve(at.problem, newton).usable()) newton_gains += gain(newton) > 1e-9 ? 1 : 0;
    ImpactSolver solver;
    ContactSolution answer;
    solver.solve(ImpactLaw::energetic, at.problem, at.restitution, chain, answer);
    ASSERT_TRUE(answer.report.usable()) << i;
    EXPECT_LE(gain(answer.impulse), 1e-12) << i;
  }
  EXPECT_GT(newton_gains, 0);
}

// Two contacts jam a body (its 4 rows have 3 freedoms), without restitution: the compression leaves 1e-16
// m/s, which impulses of the expansion would have to answer to in vain.
TEST(ImpactSolver, WhatTheCompressionStopsOfAJamStaysAtRest) {
  const std::vector<double> w{
      0.7038588744317656,     0.2303319596321336,    -0.7239595051074278, -0.0038841687784730294,
      0.2303319596321336,     1.159095821415955,     -0.156683200978916,  0.0009387133746429077,
      -0.7239595051074278,    -0.156683200978916,    0.8899031830351116,  -0.4007209154003587,
      -0.0038841687784730294, 0.0009387133746429077, -0.4007209154003587, 1.1765675518944736};
  ContactProblem problem;
  problem.reset(4);
  std::copy(w.begin(), w.end(), problem.matrix().begin());
  const std::vector<double> before{1.1136924715771102e-14, -1.1445708772357956, -0.35441387793107215,
                                   0.7813386170920429};
  std::copy(before.begin(), before.end(), problem.vector().begin());
  problem.sets()[0].kind = problem.sets()[2].kind = SetKind::half_line;
  problem.sets()[1] = {.kind = SetKind::bounded_interval, .bound = 0, .coefficient = 0.307024354228201};
  problem.sets()[3] = {.kind = SetKind::bounded_interval, .bound = 2, .coefficient = 0.5690573897211474};
  problem.group();
  for (const ImpactLaw law : {ImpactLaw::poisson, ImpactLaw::energetic}) {
    SolverChain chain;
    ImpactSolver solver;
    ContactSolution answer;
    solver.solve(law, problem, std::vector<double>(4, 0.0), chain, answer);
    ASSERT_TRUE(answer.report.usable()) << to_string(law) << answer.report.reason;
    std::vector<double> after(4);
    problem.velocities(answer.impulse, after);
    for (const double velocity : after) EXPECT_NEAR(velocity, 0.0, 1e-14);  // rounding of impulses of 3 N s
  }
}

/// Checks of the two phases of one contact, for which phases are enumerated by hand.
TEST(ImpactSolver, PoissonOfOneContactIsOneOfItsModes) {
  Random random(9);
  int reversible = 0;
  for (int i = 0; i < 2000; ++i) {
    const ImpactPathInput in = random_impact_path(random, random.uniform(0.0, 1.0));
    const double e_t = random.chance(0.5) ? random.uniform(0.1, 1.0) : 0.0;
    ContactProblem problem;
    contact_test::make_problem(in.wnn, in.wnt, in.wtt, (1.0 + in.restitution) * in.normal,
                               (1.0 + e_t) * in.tangential, in.friction, problem);
    SolverChain chain;
    ImpactSolver solver;
    ContactSolution answer;
    const std::array<double, 2> restitution{in.restitution, e_t};
    solver.solve(ImpactLaw::poisson, problem, restitution, chain, answer);
    ASSERT_TRUE(answer.report.usable()) << i;
    // The compression has gamma_n = 0, and is the problem with e = 0.
    ContactProblem plastic;
    contact_test::make_problem(in.wnn, in.wnt, in.wtt, in.normal, in.tangential, in.friction, plastic);
    std::array<double, 2> c{};
    ASSERT_TRUE(chain.solve(plastic, c).usable());
    const double t_c = in.tangential + in.wnt * c[0] + in.wtt * c[1];
    const double p_n = answer.impulse[0] - c[0], p_t = answer.impulse[1] - c[1];
    const double n_e = in.wnn * p_n + in.wnt * p_t, t_e = t_c + in.wnt * p_n + in.wtt * p_t;
    const double size = answer.impulse[0], speed = std::abs(in.normal) + std::abs(in.tangential);
    const double tiny = 1e-10;
    EXPECT_GE(p_n, in.restitution * c[0] - tiny * size) << i;
    EXPECT_GE(n_e, -tiny * speed) << i;
    EXPECT_LE(std::min(p_n - in.restitution * c[0], n_e), tiny * (size + speed)) << i;
    const double limit = in.friction * p_n, stored = in.restitution * e_t * c[1];
    EXPECT_LE(std::abs(p_t), limit + tiny * size) << i;
    const bool at_stored = std::abs(p_t - stored) <= tiny * size && t_e * c[1] >= -tiny && e_t > 0.0;
    const bool sticks = std::abs(t_e) <= tiny * speed;
    const bool slips = std::abs(std::abs(p_t) - limit) <= tiny * size && p_t * t_e <= tiny;
    EXPECT_TRUE(at_stored || sticks || slips) << i << " " << p_t << " " << stored << " " << t_e;
    reversible += at_stored && !sticks ? 1 : 0;
  }
  EXPECT_GT(reversible, 100);
}

TEST(ImpactSolver, ReversibleTangentialImpulseTurnsASuperballRound) {
  // W_nt = 0, enough friction: gamma_t^+ = -e_n e_t gamma_t^-.
  for (const double e_t : {0.25, 1.0}) {
    ContactProblem problem;
    contact_test::make_problem(1.0, 0.0, 3.5, 2.0 * -1.0, (1.0 + e_t) * 0.5, 1.0, problem);
    SolverChain chain;
    ImpactSolver solver;
    ContactSolution answer;
    const std::array<double, 2> restitution{1.0, e_t};
    solver.solve(ImpactLaw::poisson, problem, restitution, chain, answer);
    EXPECT_NEAR(answer.impulse[0], 2.0, 1e-14);
    EXPECT_NEAR(0.5 + 3.5 * answer.impulse[1], -e_t * 0.5, 1e-14);
  }
}

}  // namespace
}  // namespace carom
