// The energetic law of a contact with rolling resistance: its path against an integration of the impulse
// equations, and what it gains.

#include "tests/contact/solvers/random_impact_paths.h"

#include <carom/contact/solvers/impact_solver.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace carom {
namespace {

using contact_test::PathRows;
using contact_test::Random;
using contact_test::random_impact_path;

/// Impulses by many small steps of the normal impulse: friction and moment of a step in turns, each that
/// which stops its row, if there is enough. Of first order in the step.
std::array<double, 3> integrate_rolling(const ImpactPathInput& in, double step) {
  std::array<double, 3> impulse{};
  double n = in.normal, t = in.tangential, w = in.spin, compression = 0.0, expansion = 0.0;
  for (;;) {
    double k = 0.0, m = 0.0;
    for (int turn = 0; turn < 200; ++turn) {
      const double before = k + m;
      k = std::clamp((-t / step - in.wnt - in.wtr * m) / in.wtt, -in.friction, in.friction);
      m = std::clamp((-w / step - in.wnr - in.wtr * k) / in.wrr, -in.rolling_resistance,
                     in.rolling_resistance);
      if (k + m == before) break;
    }
    const double next = n + (in.wnn + in.wnt * k + in.wnr * m) * step;
    (next < 0.0 && expansion == 0.0 ? compression : expansion) += 0.5 * (n + next) * step;
    impulse[0] += step;
    impulse[1] += k * step;
    impulse[2] += m * step;
    n = next;
    t += (in.wnt + in.wtt * k + in.wtr * m) * step;
    w += (in.wnr + in.wtr * k + in.wrr * m) * step;
    if (expansion >= -in.restitution * in.restitution * compression && n > 0.0) return impulse;
  }
}

TEST(RollingImpactPath, AgreesWithSmallStepsOfTheImpulse) {
  Random random(13);
  int held = 0, turned = 0, sticks = 0;
  for (int i = 0; i < 300; ++i) {
    const ImpactPathInput in = random_impact_path(random, random.uniform(0.1, 1.0), PathRows::with_rolling);
    const auto end = follow_impact(in);
    ASSERT_TRUE(end) << i;
    const double step = 1e-4 * end->normal_impulse;
    const std::array<double, 3> steps = integrate_rolling(in, step);
    // Two steps, one at the end of either phase; where normal velocity hardly grows an error of the work is a
    // larger one of the impulse.
    const double tolerance = 20.0 * step * (1.0 + in.friction + in.rolling_resistance);
    EXPECT_NEAR(end->normal_impulse, steps[0], tolerance) << i;
    EXPECT_NEAR(end->tangential_impulse, steps[1], tolerance) << i;
    EXPECT_NEAR(end->rolling_moment, steps[2], tolerance) << i;
    held += end->spin == 0.0 ? 1 : 0;
    turned += end->spin * in.spin < 0.0 ? 1 : 0;
    sticks += end->sticks ? 1 : 0;
  }
  EXPECT_GT(held, 10);
  EXPECT_GT(turned, 10);
  EXPECT_GT(sticks, 20);
}

TEST(RollingImpactPath, NeverGains) {
  Random random(14);
  for (int i = 0; i < 20000; ++i) {
    const ImpactPathInput in =
        random_impact_path(random, i % 3 == 0 ? 1.0 : random.uniform(0.0, 1.0), PathRows::with_rolling);
    const auto end = follow_impact(in);
    ASSERT_TRUE(end) << i;
    const double gain = 0.5 * end->normal_impulse * (in.normal + end->normal) +
                        0.5 * end->tangential_impulse * (in.tangential + end->tangential) +
                        0.5 * end->rolling_moment * (in.spin + end->spin);
    const double scale =
        end->normal_impulse * (std::abs(in.normal) + std::abs(end->normal)) +
        std::abs(end->tangential_impulse) * (std::abs(in.tangential) + std::abs(end->tangential)) +
        std::abs(end->rolling_moment) * (std::abs(in.spin) + std::abs(end->spin));
    EXPECT_LE(gain, 1e-14 * scale) << i;
    EXPECT_GE(end->normal, 0.0) << i;
    EXPECT_LE(std::abs(end->rolling_moment), in.rolling_resistance * end->normal_impulse * (1.0 + 1e-14))
        << i;
  }
}

TEST(RollingImpactPath, IsFollowedByTheSolver) {
  // A corner below and beside the centre hits the ground: by two phases of impulses it gained 87 %.
  constexpr double mass = 2.16597, inertia = 0.0309042, r_x = 0.318814, r_y = 0.0920867, mu = 0.636794,
                   rho = 0.393291;
  const std::array<std::array<double, 3>, 3> rows{{{0.0, 1.0, r_x}, {1.0, 0.0, r_y}, {0.0, 0.0, 1.0}}};
  const std::array<double, 3> inverse{1.0 / mass, 1.0 / mass, 1.0 / inertia},
      velocity{0.127385, -0.634724, -3.88977}, restitution{1.0, 0.0, 0.0};
  ContactProblem problem;
  problem.reset(3);
  std::array<double, 3> before{};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t k = 0; k < 3; ++k) before[i] += rows[i][k] * velocity[k];
    for (std::size_t j = 0; j < 3; ++j) {
      for (std::size_t k = 0; k < 3; ++k)
        problem.w(static_cast<int>(i), static_cast<int>(j)) += rows[i][k] * inverse[k] * rows[j][k];
    }
    problem.vector()[i] = (1.0 + restitution[i]) * before[i];
  }
  problem.sets()[0].kind = SetKind::half_line;
  for (const std::size_t row : {1U, 2U}) {
    problem.sets()[row] = {.kind = SetKind::bounded_interval, .bound = 0, .coefficient = row == 1 ? mu : rho};
  }
  problem.group();
  SolverChain chain;
  ImpactSolver solver;
  ContactSolution answer;
  solver.solve(ImpactLaw::energetic, problem, restitution, chain, answer);
  ASSERT_TRUE(answer.report.usable());
  double gain = 0.0, energy = 0.0;
  for (std::size_t i = 0; i < 3; ++i) {
    double after = before[i];
    for (std::size_t j = 0; j < 3; ++j)
      after += problem.w(static_cast<int>(i), static_cast<int>(j)) * answer.impulse[j];
    gain += 0.5 * answer.impulse[i] * (before[i] + after);
    energy += 0.5 * velocity[i] * velocity[i] / inverse[i];
  }
  EXPECT_LT(gain, 0.0);
  EXPECT_GT(gain, -energy);
}

}  // namespace
}  // namespace carom
