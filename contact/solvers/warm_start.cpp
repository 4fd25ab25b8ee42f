// Problem: the answer in the modes of the answer before.

#include <carom/contact/solvers/solver_chain.h>
#include <carom/contact/solvers/warm_start.h>

namespace carom {

bool WarmStart::keep_modes(const ContactProblem& problem, std::span<const ContactMode> modes,
                           std::vector<double>& impulse, Residual& found) {
  // The modes are known and, if they are right, linear: one step solves them, another takes the rounding.
  constexpr int newton_steps = 2;
  trial_.assign(impulse.begin(), impulse.end());
  found = polish_.improve(problem, trial_, newton_steps);
  if (!(found.value <= accepted_residual)) return false;
  xi_.resize(trial_.size());
  problem.velocities(trial_, xi_);
  for (std::size_t group = 0; group < modes.size(); ++group) {
    if (contact_mode(problem, problem.groups()[group], trial_, xi_) != modes[group]) return false;
  }
  impulse.swap(trial_);
  return true;
}

}  // namespace carom
