#include <carom/integrators/bound_iteration.h>
#include <carom/integrators/pressed_contacts.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>

namespace carom {

namespace {

/// Takes from `from` its parts along orthonormal vectors, one behind the other in `null`.
void remove_parts(const std::vector<double>& null, std::vector<double>& from) {
  const std::size_t n = from.size();
  for (const double* along = null.data(); along < null.data() + null.size(); along += n) {
    const double part = std::inner_product(from.begin(), from.end(), along, 0.0);
    for (std::size_t i = 0; i < n; ++i) from[i] -= part * along[i];
  }
}

}  // namespace

void PressedSolver::find_null_space(const ContactProblem& problem) {
  constexpr double dependent = 1e-11;  // pivots of W below this part of the largest are rounding
  const auto n = static_cast<std::size_t>(problem.rows());
  factors_.factor(problem.matrix(), n, n, dependent);
  null_.clear();
  vector_.resize(n);
  for (std::size_t index = 0; index + factors_.rank() < n; ++index) {
    factors_.null_vector(index, vector_);
    for (int pass = 0; pass < 2; ++pass) remove_parts(null_, vector_);  // the second for what rounding left
    const double length = std::sqrt(std::inner_product(vector_.begin(), vector_.end(), vector_.begin(), 0.0));
    for (double& number : vector_) number /= length;
    null_.insert(null_.end(), vector_.begin(), vector_.end());
  }
}

void PressedSolver::take_forces(const PressedContacts& problem) {
  ContactCluster& cluster = problem.cluster;
  if (null_.empty()) {
    problem.pressure.take(problem.multipliers(), problem.duration, problem.size);
    return;
  }
  found_.assign(cluster.impulses().begin(), cluster.impulses().end());
  least_ = found_;
  remove_parts(null_, least_);
  cluster.set_impulses(least_);
  problem.pressure.take(problem.multipliers(), problem.duration, problem.size);
  cluster.set_impulses(found_);
}

bool PressedSolver::solve(const PressedContacts& problem, SolverChain& chain) {
  if (problem.pressure.empty()) return problem.cluster.solve(chain).usable();
  find_null_space(problem.cluster.problem());
  BoundIteration iteration;
  for (int i = 0; i < BoundIteration::most_repetitions; ++i) {
    if (!problem.cluster.solve(chain).usable()) return false;
    take_forces(problem);
    double change = 0.0;
    iteration.begin();
    for (std::size_t c = 0; c < problem.contacts.size(); ++c) {
      Contact& contact = problem.contacts[c];
      if (!problem.pressure.bears(contact)) continue;
      const double before = contact.pressed;
      change = std::max(change, problem.pressure.press(contact, problem.at));
      iteration.add(before, contact.pressed);
      problem.cluster.press(c);
    }
    if (iteration.settled(change)) return true;
    if (!iteration.accelerates()) continue;
    std::size_t bound = 0;
    for (std::size_t c = 0; c < problem.contacts.size(); ++c) {
      if (!problem.pressure.bears(problem.contacts[c])) continue;
      problem.contacts[c].pressed = iteration.guess(bound++);
      problem.cluster.press(c);
    }
  }
  return false;
}

}  // namespace carom
