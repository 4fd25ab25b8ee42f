// Problem: find a complementary solution of w = q + M z by following one path that cannot cycle.

#include <carom/core/numerics/lemke.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace carom {

namespace {

constexpr std::size_t no_row = std::numeric_limits<std::size_t>::max();

// Pivots below this part of the largest one make a basis singular when it is solved anew.
constexpr double basis_rank_tolerance = 1e-14;

double power_of_two_near(double value) {
  return value > 0.0 && std::isfinite(value) ? std::exp2(std::ilogb(value)) : 1.0;
}

double largest_magnitude(std::span<const double> v) {
  double largest = 0.0;
  for (const double value : v) largest = std::max(largest, std::abs(value));
  return largest;
}

}  // namespace

void Lemke::scale(const Lcp& problem) {
  n_ = static_cast<std::size_t>(problem.size);
  scaled_.m = problem.m;
  scaled_.q = problem.q;
  scaled_.row_scale.assign(n_, 1.0);
  scaled_.column_scale.assign(n_, 1.0);
  for (std::size_t i = 0; i < n_; ++i) {
    scaled_.row_scale[i] =
        1.0 / power_of_two_near(largest_magnitude(std::span(scaled_.m).subspan(i * n_, n_)));
    for (std::size_t j = 0; j < n_; ++j) scaled_.m[i * n_ + j] *= scaled_.row_scale[i];
    scaled_.q[i] *= scaled_.row_scale[i];
  }
  for (std::size_t j = 0; j < n_; ++j) {
    double largest = 0.0;
    for (std::size_t i = 0; i < n_; ++i) largest = std::max(largest, std::abs(scaled_.m[i * n_ + j]));
    scaled_.column_scale[j] = 1.0 / power_of_two_near(largest);
    for (std::size_t i = 0; i < n_; ++i) scaled_.m[i * n_ + j] *= scaled_.column_scale[j];
  }
  const double q_scale = power_of_two_near(largest_magnitude(scaled_.q));
  for (double& value : scaled_.q) value /= q_scale;
}

void Lemke::start() {
  tableau_.resize(n_ * (n_ + 1));
  for (std::size_t i = 0; i < n_; ++i) {
    for (std::size_t j = 0; j < n_; ++j) entry(i, j) = scaled_.m[i * n_ + j];
    entry(i, n_) = scaled_.row_scale[i];
  }
  value_ = scaled_.q;
  basic_.resize(n_);
  nonbasic_.resize(n_ + 1);
  place_.resize(2 * n_ + 1);
  for (std::size_t i = 0; i < n_; ++i) {
    basic_[i] = i;
    nonbasic_[i] = n_ + i;
    place_[i] = i;
    place_[n_ + i] = n_ + i;
  }
  nonbasic_[n_] = 2 * n_;
  place_[2 * n_] = 2 * n_;
}

// Exchanges the basic variable of `row` with the nonbasic one of `column`.
void Lemke::pivot(std::size_t row, std::size_t column) {
  const double p = entry(row, column);
  for (std::size_t j = 0; j <= n_; ++j) entry(row, j) = j == column ? 1.0 / p : -entry(row, j) / p;
  value_[row] = -value_[row] / p;
  for (std::size_t i = 0; i < n_; ++i) {
    if (i == row) continue;
    const double factor = entry(i, column);
    if (factor == 0.0) continue;
    entry(i, column) = 0.0;
    for (std::size_t j = 0; j <= n_; ++j) entry(i, j) += factor * entry(row, j);
    value_[i] += factor * value_[row];
  }
  std::swap(basic_[row], nonbasic_[column]);
  place_[basic_[row]] = row;
  place_[nonbasic_[column]] = n_ + column;
}

// Coefficient of epsilon^(index + 1) in the value of `row` when q_index is perturbed by it.
double Lemke::perturbation(std::size_t row, std::size_t index) const {
  const std::size_t place = place_[index];
  if (place < n_) return place == row ? 1.0 : 0.0;
  return -entry(row, place - n_);
}

bool Lemke::lexicographically_less(std::size_t row, std::size_t other, std::size_t column) const {
  const double p = std::abs(entry(row, column)), p_other = std::abs(entry(other, column));
  for (std::size_t k = 0; k < n_; ++k) {
    const double mine = perturbation(row, k) / p, theirs = perturbation(other, k) / p_other;
    if (std::abs(mine - theirs) > lemke_tie_threshold * std::max({1.0, std::abs(mine), std::abs(theirs)})) {
      return mine < theirs;
    }
  }
  return false;
}

// The row whose variable z0 replaces first: lexicographic minimum of (q_i, e_i) / d_i. Nothing is rounded
// yet, so ties are exact ones, and the last of them has the smaller row of the unit matrix.
std::size_t Lemke::first_row() const {
  std::size_t best = no_row;
  double least = 0.0;
  for (std::size_t i = 0; i < n_; ++i) {
    const double ratio = value_[i] / scaled_.row_scale[i];
    if (ratio < 0.0 && ratio <= least) {
      least = ratio;
      best = i;
    }
  }
  return best;
}

std::size_t Lemke::blocking_row(std::size_t column) const {
  double largest = 0.0;
  for (std::size_t i = 0; i < n_; ++i) largest = std::max(largest, std::abs(entry(i, column)));
  const double threshold = lemke_pivot_threshold * largest;

  double step = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < n_; ++i) {
    if (entry(i, column) < -threshold) step = std::min(step, std::max(value_[i], 0.0) / -entry(i, column));
  }
  if (std::isinf(step)) return no_row;

  const double tie = lemke_tie_threshold * std::max(1.0, largest_magnitude(value_));
  std::size_t best = no_row;
  for (std::size_t i = 0; i < n_; ++i) {
    if (!(entry(i, column) < -threshold) || value_[i] + step * entry(i, column) > tie) continue;
    // z0 at zero ends the path: no need to ask which of the tied rows leaves.
    if (basic_[i] == 2 * n_) return i;
    if (best == no_row || lexicographically_less(i, best, column)) best = i;
  }
  return best;
}

// Coefficients of a variable in the system  I w - M z - d z0 = q. \param stride between those of two rows
void Lemke::write_column(std::size_t variable, std::size_t stride, double* out) const {
  for (std::size_t i = 0; i < n_; ++i) {
    out[i * stride] = variable < n_       ? (variable == i ? 1.0 : 0.0)
                      : variable < 2 * n_ ? -scaled_.m[i * n_ + variable - n_]
                                          : -scaled_.row_scale[i];
  }
}

// Recomputes the values and one column of the tableau of the present basis from the problem's data: solves B
// [value, column] = [q, N] with columns of the system. False, without a change, of a singular basis.
bool Lemke::renew(std::size_t column) {
  system_.resize(n_ * n_);
  rhs_.resize(n_);
  unknown_.resize(n_);
  for (std::size_t j = 0; j < n_; ++j) write_column(basic_[j], n_, system_.data() + j);
  qr_.factor(system_, n_, n_, basis_rank_tolerance);
  if (qr_.rank() < n_) return false;
  qr_.solve(scaled_.q, value_);
  write_column(nonbasic_[column], 1, rhs_.data());
  qr_.solve(rhs_, unknown_);
  for (std::size_t i = 0; i < n_; ++i) entry(i, column) = -unknown_[i];
  return true;
}

// Whether the ray along a column at which the path ended is one of the problem, to the last digits: all basic
// variables are there, and none falls along it.
bool Lemke::confirms_ray(std::size_t column) {
  if (!renew(column) || blocking_row(column) != no_row) return false;
  const double rounding = lemke_pivot_threshold * std::max(1.0, largest_magnitude(value_));
  return std::all_of(value_.begin(), value_.end(), [&](double value) { return value >= -rounding; });
}

LcpStatus Lemke::follow_path(int most_pivots, int& pivots) {
  start();
  std::size_t row = first_row();
  if (row == no_row) return LcpStatus::solved;
  std::size_t column = n_;
  for (;;) {
    const std::size_t leaving = basic_[row];
    pivot(row, column);
    ++pivots;
    if (leaving == 2 * n_) return LcpStatus::solved;
    if (pivots >= most_pivots) return LcpStatus::pivot_bound;
    // The complement of what left enters.
    column = place_[leaving < n_ ? leaving + n_ : leaving - n_] - n_;
    row = blocking_row(column);
    if (row != no_row) continue;
    ray_ = column;
    return LcpStatus::secondary_ray;
  }
}

// z of the present basis: the system of its z rows, solved from the problem's own data.
void Lemke::read_solution(const Lcp& problem, std::span<double> z) {
  support_.clear();
  for (std::size_t i = 0; i < n_; ++i) {
    if (place_[n_ + i] < n_) support_.push_back(i);
    z[i] = 0.0;
  }
  const std::size_t k = support_.size();
  system_.resize(k * k);
  rhs_.resize(k);
  unknown_.resize(k);
  // Rows scaled by powers of two as in the tableau; columns are scaled by the factorisation.
  for (std::size_t i = 0; i < k; ++i) {
    const double factor = scaled_.row_scale[support_[i]];
    for (std::size_t j = 0; j < k; ++j)
      system_[i * k + j] = factor * problem.m[support_[i] * n_ + support_[j]];
    rhs_[i] = -factor * problem.q[support_[i]];
  }
  if (k == 0) return;
  qr_.factor(system_, k, k, basis_rank_tolerance);
  qr_.solve(rhs_, unknown_);
  for (std::size_t i = 0; i < k; ++i) z[support_[i]] = std::max(unknown_[i], 0.0);
}

LcpAnswer Lemke::solve(const Lcp& problem, std::span<double> z, int most_pivots) {
  if (most_pivots == 0) most_pivots = 100 + 30 * problem.size;
  scale(problem);
  LcpAnswer answer;
  answer.status = follow_path(most_pivots, answer.pivots);
  read_solution(problem, z);
  // A path can also end where z0 is zero but for rounding: then it stands at a solution.
  if (lcp_residual(problem, z) <= lcp_accuracy) {
    answer.status = LcpStatus::solved;
  } else if (answer.status == LcpStatus::solved ||
             (answer.status == LcpStatus::secondary_ray && !confirms_ray(ray_))) {
    answer.status = LcpStatus::inaccurate;
  }
  return answer;
}

}  // namespace carom
