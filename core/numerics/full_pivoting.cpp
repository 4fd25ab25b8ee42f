#include <carom/core/numerics/full_pivoting.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace carom {

void FullPivoting::reset(std::size_t n) {
  rank_ = n;
  if (n == 1 && size() == 1) return;  // one equation stays in its order
  matrix_.resize(n * n);
  row_order_.resize(n);
  column_order_.resize(n);
  std::iota(row_order_.begin(), row_order_.end(), std::size_t{0});
  std::iota(column_order_.begin(), column_order_.end(), std::size_t{0});
}

/// The largest number that is left.
FullPivoting::Pivot FullPivoting::choose_pivot(std::size_t step) const {
  Pivot best{step, step, -1.0};
  for (std::size_t i = step; i < size(); ++i) {
    for (std::size_t j = step; j < size(); ++j) {
      const double number = std::abs(entry(i, j));
      if (number > best.size) best = {i, j, number};
    }
  }
  return best;
}

/// One equation, without the search.
bool FullPivoting::solve_one(double& right) {
  rank_ = std::abs(matrix_[0]) > 0.0 ? 1 : 0;
  right = rank_ == 1 ? right / matrix_[0] : 0.0;
  return std::isfinite(right);
}

bool FullPivoting::solve(double dependent, std::vector<double>& right) {
  const std::size_t n = size();
  if (n == 1) return solve_one(right[0]);
  double largest = 0.0;
  for (std::size_t step = 0; step < n; ++step) {
    const Pivot pivot = choose_pivot(step);
    if (step == 0) largest = pivot.size;
    if (!(pivot.size > dependent * largest)) {
      rank_ = step;
      break;
    }
    std::swap(row_order_[step], row_order_[pivot.row]);
    std::swap(column_order_[step], column_order_[pivot.column]);
    for (std::size_t i = step + 1; i < n; ++i) {
      const double factor = entry(i, step) / entry(step, step);
      if (factor == 0.0) continue;
      double* const row = matrix_.data() + row_order_[i] * n;
      for (std::size_t j = step + 1; j < n; ++j) row[column_order_[j]] -= factor * entry(step, j);
      right[row_order_[i]] -= factor * right[row_order_[step]];
    }
  }
  work_.assign(n, 0.0);
  for (std::size_t i = rank_; i-- > 0;) {
    double sum = right[row_order_[i]];
    for (std::size_t j = i + 1; j < rank_; ++j) sum -= entry(i, j) * work_[column_order_[j]];
    work_[column_order_[i]] = sum / entry(i, i);
  }
  right.swap(work_);
  return std::all_of(right.begin(), right.end(), [](double number) { return std::isfinite(number); });
}

void FullPivoting::null_vector(std::size_t free, std::vector<double>& out) const {
  out.assign(size(), 0.0);
  out[column_order_[free]] = 1.0;
  for (std::size_t i = rank_; i-- > 0;) {
    double sum = -entry(i, free);
    for (std::size_t j = i + 1; j < rank_; ++j) sum -= entry(i, j) * out[column_order_[j]];
    out[column_order_[i]] = sum / entry(i, i);
  }
}

}  // namespace carom
