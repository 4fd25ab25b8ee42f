// Problem: the paper's LCP, by the paper's rule, with the two traps it does not mention fenced off.

#include <carom/core/numerics/principal_pivoting.h>

#include <algorithm>
#include <cmath>

namespace carom {

namespace {

// q_i counts as negative below minus this part of the largest term that has gone into it: what is above is
// the rounding of a zero, and pivoting on it would never end.
constexpr double negative_threshold = 1e-13;

constexpr double rank_tolerance = 1e-14;

}  // namespace

bool PrincipalPivoting::vanishes(std::size_t index) const {
  double largest = 0.0;
  for (std::size_t j = 0; j < n_; ++j) {
    largest = std::max({largest, std::abs(a_[index * n_ + j]), std::abs(a_[j * n_ + index])});
  }
  return !(std::abs(a_[index * n_ + index]) > vanishing_pivot_threshold * largest);
}

// Solves row `index` for its z and puts it into the others: w_i and z_i change places.
void PrincipalPivoting::exchange(std::size_t index) {
  double* row = a_.data() + index * n_;
  const double p = row[index];
  for (std::size_t j = 0; j < n_; ++j) row[j] = j == index ? 1.0 / p : -row[j] / p;
  q_[index] = -q_[index] / p;
  size_[index] = std::abs(q_[index]);
  for (std::size_t i = 0; i < n_; ++i) {
    if (i == index) continue;
    double* other = a_.data() + i * n_;
    const double factor = other[index];
    if (factor == 0.0) continue;
    other[index] = 0.0;
    for (std::size_t j = 0; j < n_; ++j) other[j] += factor * row[j];
    q_[i] += factor * q_[index];
    size_[i] = std::max(size_[i], std::abs(factor * q_[index]));
  }
  exchanged_[index] = exchanged_[index] == 0 ? 1 : 0;
}

void PrincipalPivoting::read_solution(const Lcp& problem, std::span<double> z) {
  support_.clear();
  for (std::size_t i = 0; i < n_; ++i) {
    if (exchanged_[i] != 0) support_.push_back(i);
  }
  const std::size_t k = support_.size();
  if (k == 0) return;
  system_.resize(k * k);
  rhs_.resize(k);
  unknown_.resize(k);
  for (std::size_t i = 0; i < k; ++i) {
    for (std::size_t j = 0; j < k; ++j) system_[i * k + j] = problem.m[support_[i] * n_ + support_[j]];
    rhs_[i] = -problem.q[support_[i]];
  }
  qr_.factor(system_, k, k, rank_tolerance);
  qr_.solve(rhs_, unknown_);
  for (std::size_t i = 0; i < k; ++i) z[support_[i]] = std::max(unknown_[i], 0.0);
}

LcpAnswer PrincipalPivoting::solve(const Lcp& problem, std::span<double> z, int most_pivots) {
  n_ = static_cast<std::size_t>(problem.size);
  a_ = problem.m;
  q_ = problem.q;
  size_.resize(n_);
  for (std::size_t i = 0; i < n_; ++i) size_[i] = std::abs(q_[i]);
  exchanged_.assign(n_, 0);
  std::fill(z.begin(), z.end(), 0.0);

  LcpAnswer answer;
  if (most_pivots == 0) most_pivots = 20 + 10 * problem.size;
  for (std::size_t i = 0; i < n_;) {
    if (!(q_[i] < -negative_threshold * size_[i])) {
      ++i;
      continue;
    }
    if (vanishes(i)) return {LcpStatus::vanishing_pivot, answer.pivots};
    if (answer.pivots == most_pivots) return {LcpStatus::pivot_bound, answer.pivots};
    exchange(i);
    ++answer.pivots;
    i = 0;
  }
  read_solution(problem, z);
  answer.status = lcp_residual(problem, z) <= lcp_accuracy ? LcpStatus::solved : LcpStatus::inaccurate;
  if (answer.status != LcpStatus::solved) std::fill(z.begin(), z.end(), 0.0);
  return answer;
}

}  // namespace carom
