// The closed form of one contact against brute force in quadruple precision.

#include <carom/contact/solvers/contact_problem.h>
#include <carom/contact/solvers/single_contact.h>
#include <carom/contact/solvers/solver_chain.h>

#include "tests/contact/brute_force.h"
#include "tests/contact/random_problems.h"
#include "tests/shares.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <string>

namespace carom {
namespace {

using contact_test::Impact;
using contact_test::magnitude;
using contact_test::Quad;
using contact_test::QuadMode;

constexpr double epsilon = std::numeric_limits<double>::epsilon();

struct Counts {
  std::int64_t impacts = 0, none = 0, several = 0, three = 0, degenerate = 0, wrong = 0;
  std::array<std::int64_t, 4> modes{};
  double worst_error = 0.0;  // of impulses, in units of the tolerance
};

ContactMode mode_of(int kind) {
  constexpr std::array modes{ContactMode::open, ContactMode::stick, ContactMode::slip_positive,
                             ContactMode::slip_negative};
  return modes[static_cast<std::size_t>(kind)];
}

// Tolerance of an impulse of this mode. Stick: two differences of products within 2.5 eps and one division,
// so 6 eps of the component itself, whatever the condition of W. Slip: -b_n / p, where p has one rounding of
// mu W_nt and one of the sum: eps times the cancellation in p, and two more roundings.
Quad tolerance(const QuadMode& mode, Quad value) {
  return magnitude(value) * epsilon * (mode.kind == 1 ? Quad(6) : 2 + mode.condition);
}

// Faults of the library's answer to this impact; empty if there is none.
std::string compare(std::uint64_t seed, SolverChain& chain, Counts& counts) {
  const Impact impact = contact_test::random_impact(seed);
  ContactProblem problem;
  contact_test::make_problem(impact, problem);
  const double mu = impact.friction;
  const auto modes = contact_test::quad_modes(problem.w(0, 0), problem.w(0, 1), problem.w(1, 1),
                                              problem.vector()[0], problem.vector()[1], mu);
  ++counts.impacts;
  std::array<double, 2> p{};
  const ContactReport report = chain.solve(problem, p);
  if (!report.usable()) {
    ++counts.none;
    return "no answer: " + std::string(report.reason);
  }
  if (report.was_tried(SolverId::lemke)) return "fell back on Lemke";

  // Modes that hold, and whether the picture is clear: a mode near its boundary counts for both sides.
  bool clear = true, regular = true;
  int solutions = 0;
  const QuadMode* wanted = nullptr;
  for (const QuadMode& mode : modes) {
    // Without friction only the sign of b_n decides: stick and slip differ in name.
    if (magnitude(mode.margin) < degenerate_margin && (mu > 0.0 || mode.kind == 0)) clear = false;
    if (mode.kind > 1 && (!mode.exists || impact.w_nn() <= mu * magnitude(impact.w_nt()))) regular = false;
    if (mode.exists && mode.margin >= 0) {
      ++solutions;
      if (wanted == nullptr || mode.normal < wanted->normal) wanted = &mode;
    }
  }
  // Without friction stick and both slips are one.
  if (mu == 0.0 && solutions > 1) solutions = 1;
  if (solutions > 1) ++counts.several;
  if (solutions > 2) ++counts.three;
  if (report.degenerate) ++counts.degenerate;

  const auto near = [&](const QuadMode& mode, Quad slack) {
    for (std::size_t i = 0; i < 2; ++i) {
      const Quad reference = i == 0 ? mode.normal : mode.tangential;
      const Quad error = magnitude(Quad(p[i]) - reference);
      const Quad allowed = tolerance(mode, reference) + slack;
      if (error > allowed) return false;
      if (allowed > 0 && slack == 0) {
        counts.worst_error = std::max(counts.worst_error, static_cast<double>(error / allowed));
      }
      // gamma^+ = xi - E gamma^-: the library's xi = W p + b has three roundings of its terms, and the error
      // of p.
      Quad exact = problem.vector()[i], terms = magnitude(exact), passed_on = 0;
      for (std::size_t j = 0; j < 2; ++j) {
        const Quad w = problem.w(static_cast<int>(i), static_cast<int>(j));
        const Quad pj = j == 0 ? mode.normal : mode.tangential;
        exact += w * pj;
        terms += magnitude(w * pj);
        passed_on += magnitude(w) * (tolerance(mode, pj) + slack);
      }
      if (magnitude(Quad(chain.velocities()[i]) - exact) > 3 * epsilon * terms + passed_on) return false;
    }
    return true;
  };

  if (clear || (regular && wanted != nullptr && wanted->margin >= degenerate_margin)) {
    if (solutions == 0) return "brute force finds none";
    ++counts.modes[static_cast<std::size_t>(wanted->kind)];
    if (!near(*wanted, 0)) return "other impulses than brute force";
    if (mu > 0.0 && chain.modes()[0] != mode_of(wanted->kind) && wanted->margin > 1e-9) return "other mode";
    if ((solutions > 1) != (report.outcome == Outcome::several_solutions)) return "other outcome";
    const PlanarSolutions list = solve_planar_contact(
        {problem.w(0, 0), problem.w(0, 1), problem.w(1, 1), problem.vector()[0], problem.vector()[1], mu});
    if (list.count != solutions) return "other number of solutions";
    for (std::size_t k = 0; k < static_cast<std::size_t>(list.count) && mu > 0.0; ++k) {
      const PlanarImpulse& listed = list.list[k];
      const bool known = std::any_of(modes.begin(), modes.end(), [&](const QuadMode& mode) {
        return mode.exists && mode.margin >= 0 && mode_of(mode.kind) == listed.mode &&
               magnitude(listed.normal - mode.normal) <= tolerance(mode, mode.normal) &&
               magnitude(listed.tangential - mode.tangential) <= tolerance(mode, mode.tangential);
      });
      if (!known && clear) return "a listed solution is none of brute force";
    }
    return report.degenerate && clear ? "clear case reported as degenerate" : "";
  }
  // Near a boundary either neighbour counts, to the accuracy that the margin leaves.
  if (!report.degenerate) return "not reported as degenerate";
  for (const QuadMode& mode : modes) {
    if (!mode.exists || mode.margin < -degenerate_margin) continue;
    const Quad size = std::max(magnitude(mode.normal), magnitude(mode.tangential));
    if (near(mode, 4 * degenerate_margin * mode.condition * size)) return "";
  }
  return "near no mode of brute force";
}

void compare_many(const carom_test::SeedRange& seeds) {
  SolverChain chain;
  Counts counts;
  for (std::uint64_t seed = seeds.first; seed < seeds.last; ++seed) {
    const std::string wrong = compare(seed, chain, counts);
    if (wrong.empty()) continue;
    if (++counts.wrong <= 10) ADD_FAILURE() << "seed " << seed << ": " << wrong;
  }
  EXPECT_EQ(counts.wrong, 0);
  EXPECT_EQ(counts.none, 0) << "W is positive definite: a solution always exists";
  // The sample is worth something only if it holds every kind.
  for (const std::int64_t n : counts.modes) EXPECT_GT(n, seeds.count() / 100);
  EXPECT_GT(counts.several, seeds.count() / 1000);
  EXPECT_GT(counts.three, 0);
  EXPECT_LE(chain.statistics().worst_residual, 1e-15) << "closed form: a few roundings of the terms";
  std::printf(
      "[   data   ] %lld impacts: open %lld, stick %lld, slip+ %lld, slip- %lld; several solutions %lld "
      "(three: %lld), degenerate %lld; worst residual %.1e, worst error %.2f of its tolerance\n",
      static_cast<long long>(counts.impacts), static_cast<long long>(counts.modes[0]),
      static_cast<long long>(counts.modes[1]), static_cast<long long>(counts.modes[2]),
      static_cast<long long>(counts.modes[3]), static_cast<long long>(counts.several),
      static_cast<long long>(counts.three), static_cast<long long>(counts.degenerate),
      chain.statistics().worst_residual, counts.worst_error);
}

TEST(SingleContactBruteForce, TwentyThousandImpacts) { compare_many({1, 20'001}); }

TEST(SingleContactBruteForceLong, MillionImpacts) {
  compare_many(carom_test::seeds_from(1'000'000, 1'000'000));
}

}  // namespace
}  // namespace carom
