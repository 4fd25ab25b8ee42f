// Problem: take an answer of sweeps for what it is worth, and say how much that is.

#include <carom/contact/solvers/large_problem_solver.h>

#include <carom/contact/solvers/contact_mode.h>
#include <carom/contact/solvers/planar_certificate.h>
#include <carom/contact/solvers/warm_start.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace carom {

namespace {

/// True of a single body, and of bodies that answer together.
bool demands_exact(const ContactProblem& problem) {
  return problem.factors().any_bound() || problem.factors().slots() == 1;
}

}  // namespace

double LargeProblemSolver::mass_ratio(const ContactProblem& problem) {
  const ResponseFactors& factors = problem.factors();
  double least = std::numeric_limits<double>::infinity(), most = 0.0;
  for (std::size_t slot = 0; slot < factors.slots(); ++slot) {
    const double inverse = factors.inverse_mass[ResponseFactors::columns * slot];
    if (inverse == 0.0) continue;  // immovable
    least = std::min(least, inverse);
    most = std::max(most, inverse);
  }
  return most > 0.0 ? most / least : 1.0;
}

/// Sweeps of a problem: conjugate gradients need as many as the square root of its condition, which grows
/// with the ratio of masses that lie on each other.
int LargeProblemSolver::sweeps_of(const ContactProblem& problem) const {
  constexpr double most_times = 64.0;
  constexpr int most_sweeps = std::numeric_limits<int>::max() / 16;
  const double times = std::clamp(std::sqrt(mass_ratio(problem) / uneven_masses), 1.0, most_times);
  return static_cast<int>(std::min(times * budget_.sweeps, double{most_sweeps}));
}

void LargeProblemSolver::set_budget(const SweepBudget& budget) {
  if (budget.sweeps < 0 || !(budget.residual > 0.0) || !(budget.accepted >= 0.0)) {
    throw std::invalid_argument("contact solver: a budget has sweeps >= 0, residual > 0 and accepted >= 0");
  }
  budget_ = budget;
}

Residual LargeProblemSolver::judge(const ContactProblem& problem, std::span<const double> impulse,
                                   std::span<double> xi) {
  problem.velocities(impulse, xi, slot_velocity_);
  return residual(problem, impulse, xi);
}

Outcome LargeProblemSolver::judged(double residual) const {
  if (residual <= budget_.residual) return Outcome::solved;
  return residual <= budget_.accepted ? Outcome::accepted_at_cap : Outcome::not_solved;
}

bool LargeProblemSolver::has_dense(const ContactProblem& problem, const ContactReport& report) const {
  const std::size_t contacts = problem.groups().size();
  if (contacts <= most_exact) return true;
  if (!demands_exact(problem) || problem.rows() > most_dense_rows) return false;
  return !report.usable() || (contacts <= most_polished && report.outcome != Outcome::solved);
}

/// Modes that sweeps found are right, or nearly: Newton steps solve them, on W in full.
void LargeProblemSolver::polish(const ContactProblem& problem, std::span<double> impulse) {
  constexpr int steps = 4;
  dense_.reset(problem.rows());
  for (int row = 0; row < problem.rows(); ++row) {
    for (int column = 0; column <= row; ++column) {
      const double entry =
          problem.factors().entry(static_cast<std::size_t>(row), static_cast<std::size_t>(column));
      dense_.w(row, column) = dense_.w(column, row) = entry;
    }
  }
  std::copy(problem.vector().begin(), problem.vector().end(), dense_.vector().begin());
  std::copy(problem.sets().begin(), problem.sets().end(), dense_.sets().begin());
  dense_.group();
  double before = std::numeric_limits<double>::infinity();
  for (int step = 0; step < steps; ++step) {
    const double found = polish_.improve(dense_, impulse, 1).value;
    if (found <= NewtonPolish::round_off || !(found <= 0.5 * before)) return;  // more steps only move noise
    before = found;
  }
}

void LargeProblemSolver::solve(const ContactProblem& problem, std::span<double> impulse, std::span<double> xi,
                               std::span<ContactMode> modes, ContactReport& report,
                               ModeEquations* equations) {
  constexpr auto id = static_cast<std::size_t>(SolverId::nonlinear_cg);
  const std::size_t contacts = problem.groups().size();
  report.solver = solver_names[id];
  report.tried = 1u << id;
  const bool is_small = contacts <= most_exact, is_exacting = demands_exact(problem);
  if (equations != nullptr && equations->are_of(problem)) {
    Residual refined;
    static_cast<void>(polish_.refine(problem, *equations, impulse, refined));
  }
  Residual found = judge(problem, impulse, xi);
  const bool is_certified = found.value <= certified_start;
  SweepBudget budget = budget_;
  // Exact solvers would have been the choice, were there fewer contacts.
  if (is_exacting) budget.residual = std::min(budget.residual, certified_start);
  if (!(found.value <= budget.residual)) {
    budget.sweeps = sweeps_of(problem);
    // Sweeps over few contacts cost less than anything else: all that there are.
    if (is_small) budget.accepted = std::min(budget.accepted, budget.residual);
    sweeps_.set_budget(budget);
    const SolverAnswer answer = sweeps_.improve(problem, impulse);
    report.iterations = answer.iterations;
    report.reason = answer.reason;
    found = judge(problem, impulse, xi);
  }
  const Outcome swept = judged(found.value);
  const bool is_left = swept == Outcome::not_solved || (is_exacting && swept != Outcome::solved);
  const bool is_polished =
      is_left && (contacts <= most_polished ||
                  (is_exacting && swept == Outcome::not_solved && problem.rows() <= most_dense_rows));
  if (is_small ? !is_certified && !(found.value <= NewtonPolish::round_off) : is_polished) {
    polish(problem, impulse);
    if (equations != nullptr) polish_.swap_equations(*equations);
    found = judge(problem, impulse, xi);
  }
  report.residual = found.value;
  report.worst_group = found.group;
  report.outcome = judged(found.value);
  if (report.outcome == Outcome::solved) report.reason = {};
  contact_modes(problem, impulse, xi, modes);
}

}  // namespace carom
