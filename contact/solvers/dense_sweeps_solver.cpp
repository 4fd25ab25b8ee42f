// Problem: contacts in space, whose friction lies in a disc, which no pivoting method takes; and many
// contacts, which cost pivoting a pivot each.

#include <carom/contact/solvers/dense_sweeps_solver.h>
#include <carom/contact/solvers/warm_start.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace carom {

namespace {

// The residual at which the iteration is done where there are discs; equal to the accepted residual of the
// solver chain.
constexpr double target = 1e-12;

// Sweeps between two attempts to finish by Newton's method grow by this factor, from this many on.
constexpr int first_attempt = 10;
constexpr int attempt_growth = 3;
constexpr int newton_steps = 15;

// Local rounds between a normal row and its friction sets when they have no joint closed form.
constexpr int local_rounds = 5;

constexpr int secular_steps = 50;

// Minimises P^T W P / 2 + b^T P over |P| <= radius (2 x 2, W >= 0): Coulomb friction in the plane of contact
// for a known normal impulse. (W + lambda I) P = -b with |P| = radius is solved for lambda by Newton's method
// on 1 / |P|, which is nearly linear in lambda and converges from lambda = 0 without safeguards.
void solve_disc(double w11, double w12, double w22, double b1, double b2, double radius, double& p1,
                double& p2) {
  if (!(radius > 0.0)) {
    p1 = p2 = 0.0;
    return;
  }
  double lambda = 0.0;
  const double smallest = 1e-14 * (w11 + w22);
  for (int k = 0; k < secular_steps; ++k) {
    const double a = w11 + lambda, d = w22 + lambda;
    const double determinant = a * d - w12 * w12;
    if (!(determinant > smallest * (w11 + w22))) {
      // Singular block: start inside the interval where lambda must be.
      lambda = std::max(2.0 * lambda, smallest + std::hypot(b1, b2) / radius * 1e-8);
      continue;
    }
    p1 = (w12 * b2 - d * b1) / determinant;
    p2 = (w12 * b1 - a * b2) / determinant;
    const double length = std::hypot(p1, p2);
    if (length <= radius && lambda == 0.0) return;
    // d|P|/dlambda = -P^T (W + lambda I)^-1 P / |P|
    const double slope = (d * p1 * p1 - 2.0 * w12 * p1 * p2 + a * p2 * p2) / (determinant * length);
    const double change = (length / radius - 1.0) * length / slope;
    lambda = std::max(lambda + change, 0.0);
    if (std::abs(length - radius) <= 4.0 * std::numeric_limits<double>::epsilon() * radius) break;
  }
  const double length = std::hypot(p1, p2);
  if (length > 0.0) {
    p1 *= radius / length;
    p2 *= radius / length;
  }
}

double clamp_step(double impulse, double w, double xi, double lower, double upper) {
  if (w > 0.0) return std::clamp(impulse - xi / w, lower, upper);
  const double bound = xi > 0.0 ? lower : (xi < 0.0 ? upper : impulse);
  return std::isfinite(bound) ? bound : impulse;
}

}  // namespace

double DenseSweepsSolver::velocity(const ContactProblem& problem, std::size_t row) const {
  const std::size_t n = impulse_.size();
  const double* const w = problem.matrix().data() + row * n;
  std::array<double, 4> sums{problem.vector()[row], 0.0, 0.0, 0.0};  // which the processor makes side by side
  std::size_t j = 0;
  for (; j + sums.size() <= n; j += sums.size()) {
    for (std::size_t k = 0; k < sums.size(); ++k) sums[k] += w[j + k] * impulse_[j + k];
  }
  for (; j < n; ++j) sums[0] += w[j] * impulse_[j];
  return (sums[0] + sums[1]) + (sums[2] + sums[3]);
}

// The first row of a group, and with it those that are proportional to it: one unknown.
void DenseSweepsSolver::visit_leading(const ContactProblem& problem, const RowGroup& group) {
  const auto first = static_cast<std::size_t>(group.first);
  const std::size_t last = first + static_cast<std::size_t>(group.size);
  const auto sets = problem.sets();
  const bool half_line = sets[first].kind == SetKind::half_line;
  const double lower = half_line ? 0.0 : sets[first].lower;
  const double upper = half_line ? std::numeric_limits<double>::infinity() : sets[first].upper;
  const double own = problem.w(group.first, group.first);
  double w = own;
  for (std::size_t i = first + 1; i < last; ++i) {
    if (sets[i].kind != SetKind::proportional) continue;
    w += sets[i].coefficient * problem.w(group.first, static_cast<int>(i));
  }
  const double xi = velocity(problem, first);
  if (w > 0.0 || !(own > 0.0)) {
    impulse_[first] = clamp_step(impulse_[first], w, xi, lower, upper);
  } else if (xi + w * (lower - impulse_[first]) >= 0.0) {
    // More impulse closes it more: open if it can be, else the impulse that another row has to change.
    impulse_[first] = lower;
  }
  for (std::size_t i = first + 1; i < last; ++i) {
    if (sets[i].kind == SetKind::proportional) impulse_[i] = sets[i].coefficient * impulse_[first];
  }
}

void DenseSweepsSolver::visit(const ContactProblem& problem, const RowGroup& group) {
  const auto first = static_cast<std::size_t>(group.first);
  const std::size_t last = first + static_cast<std::size_t>(group.size);
  const auto rows = problem.sets().subspan(first, last - first);
  const bool is_done_at_once = std::none_of(rows.begin(), rows.end(), [](const RowSet& set) {
    return set.kind == SetKind::bounded_disc || set.kind == SetKind::bounded_interval;
  });
  // In the plane the next sweep is as good.
  const int rounds = is_done_at_once || rows.size() == 2 ? 1 : local_rounds;
  for (int round = 0; round < rounds; ++round) {
    visit_leading(problem, group);
    for (std::size_t i = first + 1; i < last; ++i) {
      const RowSet& set = problem.sets()[i];
      const int r = static_cast<int>(i);
      if (set.kind != SetKind::proportional) {
        const double xi = velocity(problem, i);
        const double limit = set.coefficient * std::max(impulse_[static_cast<std::size_t>(set.bound)], 0.0);
        if (set.kind == SetKind::bounded_interval) {
          impulse_[i] = clamp_step(impulse_[i], problem.w(r, r), xi, -limit, limit);
          continue;
        }
        const double w11 = problem.w(r, r), w12 = problem.w(r, r + 1), w22 = problem.w(r + 1, r + 1);
        const double b1 = xi - w11 * impulse_[i] - w12 * impulse_[i + 1];
        const double b2 = velocity(problem, i + 1) - w12 * impulse_[i] - w22 * impulse_[i + 1];
        solve_disc(w11, w12, w22, b1, b2, limit, impulse_[i], impulse_[i + 1]);
        ++i;
      }
    }
  }
}

SolverAnswer DenseSweepsSolver::solve(const ContactProblem& problem, std::span<double> impulse) {
  const bool discs = has_discs(problem);
  if (!discs && (problem.rows() < swept_rows || problem.groups().size() < 2))
    return {Outcome::not_solved, false, 0, "not applicable"};
  const int most = discs ? most_dense_sweeps : most_planar_sweeps;
  const auto n = static_cast<std::size_t>(problem.rows());
  impulse_.assign(n, 0.0);
  trial_.resize(n);
  for (std::size_t i = 0; i < n; ++i) {
    const RowSet& set = problem.sets()[i];
    if (set.kind == SetKind::interval) impulse_[i] = std::clamp(0.0, set.lower, set.upper);
    if (set.kind == SetKind::proportional) {
      impulse_[i] = set.coefficient * impulse_[static_cast<std::size_t>(set.bound)];
    }
  }
  std::copy(impulse_.begin(), impulse_.end(), impulse.begin());

  double best = std::numeric_limits<double>::infinity();
  int attempt = first_attempt;
  for (int sweep = 1; sweep <= most; ++sweep) {
    for (const RowGroup& group : problem.groups()) visit(problem, group);
    if (watch_) watch_(sweep, impulse_);
    if (sweep != attempt && sweep != most) continue;
    attempt *= attempt_growth;
    trial_ = impulse_;
    const Residual reached = polish_.improve(problem, trial_, newton_steps);
    if (reached.value < best) {
      best = reached.value;
      std::copy(trial_.begin(), trial_.end(), impulse.begin());
    }
    if (best <= (discs ? target : certified_start)) return {Outcome::solved, false, sweep, {}};
  }
  return {Outcome::not_solved, false, most, "sweep bound"};
}

}  // namespace carom
