// Problem: take an answer of sweeps for what it is worth, and say how much that is.

#include <carom/contact/solvers/large_problem_solver.h>

#include <carom/contact/solvers/contact_mode.h>
#include <carom/contact/solvers/residual.h>

#include <stdexcept>

namespace carom {

void LargeProblemSolver::set_budget(const SweepBudget& budget) {
  if (budget.sweeps < 0 || !(budget.residual > 0.0) || !(budget.accepted >= 0.0)) {
    throw std::invalid_argument("contact solver: a budget has sweeps >= 0, residual > 0 and accepted >= 0");
  }
  sweeps_.set_budget(budget);
}

void LargeProblemSolver::solve(const ContactProblem& problem, std::span<double> impulse, std::span<double> xi,
                               std::span<ContactMode> modes, ContactReport& report) {
  constexpr auto id = static_cast<std::size_t>(SolverId::nonlinear_cg);
  const SweepBudget& budget = sweeps_.budget();
  report.solver = solver_names[id];
  report.tried = 1u << id;
  problem.velocities(impulse, xi, slot_velocity_);
  Residual found = residual(problem, impulse, xi);
  if (!(found.value <= budget.residual)) {
    const SolverAnswer answer = sweeps_.improve(problem, impulse);
    report.iterations = answer.iterations;
    report.reason = answer.reason;
    problem.velocities(impulse, xi, slot_velocity_);
    found = residual(problem, impulse, xi);
  }
  report.residual = found.value;
  report.worst_group = found.group;
  if (found.value <= budget.residual) {
    report.outcome = Outcome::solved;
  } else {
    report.outcome = found.value <= budget.accepted ? Outcome::accepted_at_cap : Outcome::not_solved;
  }
  for (std::size_t g = 0; g < modes.size(); ++g) {
    modes[g] = contact_mode(problem, problem.groups()[g], impulse, xi);
  }
}

}  // namespace carom
