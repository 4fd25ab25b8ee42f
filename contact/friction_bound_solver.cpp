#include <carom/contact/friction_bound_solver.h>
#include <carom/core/numerics/bound_iteration.h>
#include <carom/core/numerics/least_distance.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>

namespace carom {

namespace {

// Repetitions after which forces of least norm are taken; most models settle within ten.
constexpr int patience = 60;

/// Takes from `from` its parts along orthonormal vectors, one behind the other in `null`.
void remove_parts(const std::vector<double>& null, std::vector<double>& from) {
  const std::size_t n = from.size();
  for (const double* along = null.data(); along < null.data() + null.size(); along += n) {
    const double part = std::inner_product(from.begin(), from.end(), along, 0.0);
    for (std::size_t i = 0; i < n; ++i) from[i] -= part * along[i];
  }
}

/// Directions in which the law leaves impulses free at velocities xi, one behind the other: normal impulses
/// where nothing parts, with the friction of slip; friction that sticks, in joints too.
std::vector<double> free_directions(const ContactProblem& problem, std::span<const double> xi) {
  constexpr double same = 1e-10;  // against the largest velocity: no velocity
  const std::size_t n = xi.size();
  double size = 0.0;
  for (const double b : problem.vector()) size = std::max(size, std::abs(b));
  std::vector<double> free;
  const auto add = [&](std::size_t row) {
    free.resize(free.size() + n, 0.0);
    double* const direction = free.data() + free.size() - n;
    direction[row] = 1.0;
    return direction;
  };
  for (const RowGroup& group : problem.groups()) {
    const auto first = static_cast<std::size_t>(group.first);
    if (std::abs(xi[first]) > same * size) continue;
    double* direction = add(first);
    std::vector<std::size_t> sticking;
    for (std::size_t row = first + 1; row < first + static_cast<std::size_t>(group.size); ++row) {
      const RowSet& set = problem.sets()[row];
      if (set.kind == SetKind::proportional) {
        direction[row] = set.coefficient;
      } else if (std::abs(xi[row]) <= same * size) {
        if (set.coefficient > 0.0) sticking.push_back(row);
      } else if (set.kind == SetKind::bounded_interval) {
        direction[row] = xi[row] > 0.0 ? -set.coefficient : set.coefficient;
      }
    }
    for (const std::size_t row : sticking) add(row);
  }
  return free;
}

/// Moves impulses along null vectors by the least that brings them into their sets.
void allow(const ContactProblem& problem, const std::vector<double>& null, std::vector<double>& impulses) {
  constexpr double rounding = 1e-13;  // of impulses, against the largest
  const std::size_t n = impulses.size(), count = null.size() / n;
  double size = 0.0;
  for (const double impulse : impulses) size = std::max(size, std::abs(impulse));
  std::vector<double> at, slopes;
  const auto line = [&](double offset, std::size_t row, double factor, std::size_t other,
                        double other_factor) {
    at.push_back(offset + factor * impulses[row] + other_factor * impulses[other]);
    for (std::size_t k = 0; k < count; ++k) {
      slopes.push_back(factor * null[k * n + row] + other_factor * null[k * n + other]);
    }
  };
  for (std::size_t row = 0; row < n; ++row) {
    const RowSet& set = problem.sets()[row];
    if (set.kind == SetKind::half_line) line(0.0, row, 1.0, row, 0.0);
    for (const double side : {-1.0, 1.0}) {
      if (set.kind == SetKind::bounded_interval) {
        line(0.0, row, side, static_cast<std::size_t>(set.bound), set.coefficient);
      } else if (set.kind == SetKind::interval) {
        line(side > 0.0 ? -set.lower : set.upper, row, side, row, 0.0);
      }
    }
  }
  if (std::all_of(at.begin(), at.end(), [&](double value) { return value >= -rounding * size; })) return;
  std::vector<double> x(count, 0.0);
  LeastDistance nearest;
  // Where rounding leaves no point, the one that satisfies most is as good.
  static_cast<void>(nearest.solve(at, slopes, rounding * size, x));
  for (std::size_t k = 0; k < count; ++k) {
    for (std::size_t i = 0; i < n; ++i) impulses[i] += x[k] * null[k * n + i];
  }
}

}  // namespace

FrictionBounds* FrictionBoundProblem::bounds_of(const Constraint& contact) const {
  for (FrictionBounds* const some : bounds) {
    if (some->depends_on_joint_force(contact)) return some;
  }
  return nullptr;
}

/// Changes of the answer `found_` that the law leaves free and that move nothing, orthonormal.
void FrictionBoundSolver::find_null_space(const ContactProblem& problem) {
  if (problem.is_factored()) return find_null_space(problem.dense());
  constexpr double dependent = 1e-11;  // pivots below this part of the largest are rounding
  const auto n = static_cast<std::size_t>(problem.rows());
  null_.clear();
  std::vector<double> xi(n);
  problem.velocities(found_, xi);
  const std::vector<double> free = free_directions(problem, xi);
  const std::size_t count = free.size() / n;
  if (count == 0) return;
  std::vector<double> moved(n * count, 0.0);  // W times the directions
  for (std::size_t row = 0; row < n; ++row) {
    for (std::size_t k = 0; k < count; ++k) {
      moved[row * count + k] =
          std::inner_product(free.begin() + static_cast<std::ptrdiff_t>(k * n),
                             free.begin() + static_cast<std::ptrdiff_t>((k + 1) * n),
                             problem.matrix().begin() + static_cast<std::ptrdiff_t>(row * n), 0.0);
    }
  }
  factors_.factor(moved, n, count, dependent);
  std::vector<double> parts(count);
  for (std::size_t index = 0; index + factors_.rank() < count; ++index) {
    factors_.null_vector(index, parts);
    vector_.assign(n, 0.0);
    for (std::size_t k = 0; k < count; ++k) {
      for (std::size_t i = 0; i < n; ++i) vector_[i] += parts[k] * free[k * n + i];
    }
    for (int pass = 0; pass < 2; ++pass) remove_parts(null_, vector_);  // the second for what rounding left
    const double length = std::sqrt(std::inner_product(vector_.begin(), vector_.end(), vector_.begin(), 0.0));
    for (double& number : vector_) number /= length;
    null_.insert(null_.end(), vector_.begin(), vector_.end());
  }
}

void FrictionBoundSolver::take_multipliers(const FrictionBoundProblem& problem) {
  for (std::size_t i = 0; i < problem.bounds.size(); ++i)
    problem.bounds[i]->take(problem.multipliers(i), problem.duration, problem.size);
}

void FrictionBoundSolver::take_forces(const FrictionBoundProblem& problem, bool least) {
  IslandProblem& island = problem.problem;
  null_.clear();
  if (least) {
    found_.assign(island.impulses().begin(), island.impulses().end());
    find_null_space(island.problem());
  }
  if (null_.empty()) return take_multipliers(problem);
  least_ = found_;
  remove_parts(null_, least_);
  allow(island.problem(), null_, least_);
  island.set_impulses(least_);
  take_multipliers(problem);
  island.set_impulses(found_);
}

bool FrictionBoundSolver::solve(const FrictionBoundProblem& problem, SolverChain& chain) {
  if (std::all_of(problem.bounds.begin(), problem.bounds.end(),
                  [](const FrictionBounds* some) { return some->empty(); }))
    return problem.problem.solve(chain).usable();
  // Of answers that are not unique one may follow another for ever.
  return converge(problem, chain, patience, false) ||
         (problem.problem.report().usable() &&
          converge(problem, chain, BoundIteration::most_repetitions, true));
}

bool FrictionBoundSolver::converge(const FrictionBoundProblem& problem, SolverChain& chain, int repetitions,
                                   bool least) {
  BoundIteration iteration;
  for (int i = 0; i < repetitions; ++i) {
    if (!problem.problem.solve(chain).usable()) return false;
    take_forces(problem, least);
    double change = 0.0;
    iteration.begin();
    for (std::size_t c = 0; c < problem.contacts.size(); ++c) {
      Constraint& contact = problem.contacts[c];
      FrictionBounds* const bounds = problem.bounds_of(contact);
      if (bounds == nullptr) continue;
      const double before = contact.of_joint.friction_bound;
      change = std::max(change, bounds->update(contact, problem.at));
      iteration.add(before, contact.of_joint.friction_bound);
      problem.problem.update_bound(c);
    }
    if (iteration.converged(change)) return true;
    if (!iteration.accelerates()) continue;
    std::size_t bound = 0;
    for (std::size_t c = 0; c < problem.contacts.size(); ++c) {
      if (problem.bounds_of(problem.contacts[c]) == nullptr) continue;
      problem.contacts[c].of_joint.friction_bound = iteration.guess(bound++);
      problem.problem.update_bound(c);
    }
  }
  return false;
}

}  // namespace carom
