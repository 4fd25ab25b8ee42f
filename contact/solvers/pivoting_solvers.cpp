// Problem: pivoting methods speak of w, q and z; the library of impulses and outcomes.

#include <carom/contact/solvers/pivoting_solvers.h>

#include <algorithm>

namespace carom {

namespace {

bool without_friction(const ContactProblem& problem) {
  return std::all_of(problem.sets().begin(), problem.sets().end(), [](const RowSet& set) {
    return set.kind == SetKind::half_line || set.kind == SetKind::interval || set.coefficient == 0.0;
  });
}

}  // namespace

SolverAnswer PrincipalPivotingSolver::solve(const ContactProblem& problem, std::span<double> impulse) {
  if (!form_.build(problem, lcp_)) return {Outcome::not_solved, false, 0, "not applicable"};
  z_.resize(lcp_.q.size());
  const LcpAnswer answer = method_.solve(lcp_, z_);
  form_.impulses(problem, z_, impulse);
  if (answer.status == LcpStatus::solved) return {Outcome::solved, false, answer.pivots, {}};
  return {Outcome::not_solved, false, answer.pivots, to_string(answer.status)};
}

SolverAnswer LemkeSolver::solve(const ContactProblem& problem, std::span<double> impulse) {
  if (!form_.build(problem, lcp_)) return {Outcome::not_solved, false, 0, "not applicable"};
  z_.resize(lcp_.q.size());
  const LcpAnswer answer = method_.solve(lcp_, z_);
  form_.impulses(problem, z_, impulse);
  if (answer.status == LcpStatus::solved) return {Outcome::solved, false, answer.pivots, {}};
  const bool proved = answer.status == LcpStatus::secondary_ray && without_friction(problem);
  return {proved ? Outcome::no_solution : Outcome::not_solved, false, answer.pivots,
          to_string(answer.status)};
}

}  // namespace carom
