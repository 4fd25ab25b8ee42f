// Problem: recognise a problem with one contact and hand it to its closed form.

#include <carom/contact/solvers/single_contact.h>
#include <carom/contact/solvers/sliding_contact.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace carom {

namespace {

// Coupling and anisotropy below this part of W count as rounding in the closed form of a sphere.
constexpr double decoupled_threshold = 8.0 * std::numeric_limits<double>::epsilon();

constexpr SolverAnswer does_not_apply{Outcome::not_solved, false, 0, "not applicable"};

SolverAnswer solve_planar(const ContactProblem& problem, std::span<double> impulse) {
  const auto b = problem.vector();
  const double w_nn = problem.w(0, 0), w_nt = problem.w(0, 1), w_tt = problem.w(1, 1);
  const RowSet& friction = problem.sets()[1];
  const PlanarSolutions found =
      friction.kind == SetKind::proportional
          ? solve_sliding_contact({w_nn, w_nt, w_tt, b[0], b[1], friction.coefficient})
          : solve_planar_contact({w_nn, w_nt, w_tt, b[0], b[1], friction.coefficient});
  impulse[0] = found.list[0].normal;
  impulse[1] = found.list[0].tangential;
  return {found.outcome, found.degenerate, 1, found.count == 0 ? "no mode is possible" : std::string_view{}};
}

SolverAnswer solve_lone_row(const ContactProblem& problem, std::span<double> impulse) {
  const RowSet& set = problem.sets()[0];
  const double w = problem.w(0, 0), b = problem.vector()[0];
  const double lower = set.kind == SetKind::half_line ? 0.0 : set.lower;
  const double upper = set.kind == SetKind::half_line ? std::numeric_limits<double>::infinity() : set.upper;
  const double wanted = w > 0.0 ? -b / w : (b > 0.0 ? lower : (b < 0.0 ? upper : 0.0));
  impulse[0] = std::clamp(wanted, lower, upper);
  if (std::isfinite(impulse[0])) return {Outcome::solved, b == 0.0, 1, {}};
  if (std::isnan(b) || std::isnan(w)) return {Outcome::not_solved, false, 1, "not a number"};
  impulse[0] = 0.0;
  return {Outcome::no_solution, false, 1, "an immovable row is driven against its bound"};
}

// A sphere or a particle in space (docs/method.md section 4, with the tangent a plane).
SolverAnswer solve_decoupled_disc(const ContactProblem& problem, std::span<double> impulse) {
  const auto b = problem.vector();
  const double w_nn = problem.w(0, 0), w_tt = 0.5 * (problem.w(1, 1) + problem.w(2, 2));
  const double coupling = std::max(std::abs(problem.w(0, 1)), std::abs(problem.w(0, 2)));
  const double anisotropy = std::max(std::abs(problem.w(1, 2)), std::abs(problem.w(1, 1) - problem.w(2, 2)));
  if (!(w_nn > 0.0 && w_tt > 0.0) || coupling > decoupled_threshold * std::min(w_nn, w_tt) ||
      anisotropy > decoupled_threshold * w_tt) {
    return does_not_apply;
  }
  const double normal = std::max(-b[0] / w_nn, 0.0);
  const double wanted = std::hypot(b[1], b[2]) / w_tt;
  const double limit = problem.sets()[1].coefficient * normal;
  const double shrink = wanted > limit ? limit / wanted : 1.0;
  impulse[0] = normal;
  impulse[1] = -shrink * b[1] / w_tt;
  impulse[2] = -shrink * b[2] / w_tt;
  const double scale = std::max({std::abs(b[0]), std::abs(b[1]), std::abs(b[2])});
  const bool between =
      normal > 0.0 && limit > 0.0 && std::abs(wanted - limit) < degenerate_margin * (wanted + limit);
  return {Outcome::solved, between || !(std::abs(b[0]) > degenerate_margin * scale), 1, {}};
}

}  // namespace

SolverAnswer SingleContactSolver::solve(const ContactProblem& problem, std::span<double> impulse) {
  if (problem.groups().size() != 1) return does_not_apply;
  switch (problem.rows()) {
    case 1:
      return solve_lone_row(problem, impulse);
    case 2:
      return problem.sets()[0].kind == SetKind::half_line ? solve_planar(problem, impulse) : does_not_apply;
    case 3:
      return problem.sets()[0].kind == SetKind::half_line && problem.sets()[1].kind == SetKind::bounded_disc
                 ? solve_decoupled_disc(problem, impulse)
                 : does_not_apply;
    default:
      return does_not_apply;
  }
}

}  // namespace carom
