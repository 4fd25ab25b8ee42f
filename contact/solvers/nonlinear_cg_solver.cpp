// Problem: thousands of contacts within a given time, as exactly as that allows.

#include <carom/contact/solvers/nonlinear_cg_solver.h>

#include <algorithm>
#include <limits>

namespace carom {

namespace {

// Sweeps between two looks at the residual, at most.
constexpr int look_every = 8;

// Where the residual grows between two looks the sweeps go on without a direction for as many looks: of a
// body with hundreds of contacts beta stays below one although the steps along d lead away.
constexpr int plain_looks = 8;

// An answer that could not be accepted gets up to this many times the sweeps of the budget.
constexpr int most_times = 10;

// Aim of the sweeps: a little less than what is asked for: whoever judges adds in another order.
constexpr double aim = 0.9;

}  // namespace

SolverAnswer NonlinearCgSolver::solve(const ContactProblem& problem, std::span<double> impulse) {
  std::fill(impulse.begin(), impulse.end(), 0.0);
  return improve(problem, impulse);
}

SolverAnswer NonlinearCgSolver::improve(const ContactProblem& problem, std::span<double> impulse) {
  if (!problem.is_factored()) return {Outcome::not_solved, false, 0, "not applicable"};
  const double target = aim * budget_.residual;
  sweeps_.begin(problem, impulse);
  double best = sweeps_.judge(), last = best;
  if (best <= target) return {Outcome::solved, false, 0, {}};
  double before = 0.0;  // |g|^2 of the sweep before
  int sweep = 0, plain = 0;
  // An answer that must not be used is worth more sweeps than one that is not exact.
  const auto goes_on = [&] {
    const bool refused = budget_.accepted > 0.0 && best > budget_.accepted;
    return sweep < budget_.sweeps || (refused && sweep < most_times * budget_.sweeps);
  };
  while (goes_on() && best <= std::numeric_limits<double>::max()) {
    const ImpulseChange change = sweeps_.sweep();
    ++sweep;
    if (watch_) {
      watched_.resize(impulse.size());
      sweeps_.write(problem, watched_);
      watch_(sweep, watched_);
    }
    const bool regular_look = sweep % look_every == 0;
    if (change.largest <= target * sweeps_.scale() || regular_look || sweep % budget_.sweeps == 0) {
      const double found = sweeps_.judge();
      if (found <= best) {
        best = found;
        sweeps_.write(problem, impulse);
      }
      if (best <= target) return {Outcome::solved, false, sweep, {}};
      if (regular_look) {
        plain = found > last ? plain_looks : std::max(plain - 1, 0);
        last = found;
      }
    }
    if (plain == 0 && before > 0.0 && change.square <= before) {
      sweeps_.step(change.square / before);
    } else {
      sweeps_.restart();
    }
    before = change.square;
  }
  return {best <= budget_.accepted ? Outcome::accepted_at_cap : Outcome::not_solved, false, sweep,
          "budget of sweeps"};
}

}  // namespace carom
