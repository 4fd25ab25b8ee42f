#include <carom/core/numerics/weak_rows.h>

#include <algorithm>
#include <numeric>
#include <utility>

namespace carom {

void WeakRows::assign(std::span<const double> pivots, double weak) {
  rows_.clear();
  for (std::size_t row = 0; row < pivots.size(); ++row) {
    if (!(pivots[row] > weak)) rows_.push_back(row);
  }
  if (rows_.size() > most) return;
  size_ = pivots.size();
  combination_.resize(rows_.size() * size_);
  schur_.resize(rows_.size() * rows_.size());
  order_.resize(rows_.size());
  for (std::vector<double>* const numbers : {&whole_, &relative_pivot_, &share_}) {
    numbers->resize(rows_.size());
  }
}

void WeakRows::factor(double dependent) {
  const std::size_t n = rows_.size();
  std::iota(order_.begin(), order_.end(), std::size_t{0});
  const auto part = [&](std::size_t row) { return whole_[row] > 0.0 ? at(row, row) / whole_[row] : 0.0; };
  for (rank_ = 0; rank_ < n; ++rank_) {
    const auto first = order_.begin() + static_cast<std::ptrdiff_t>(rank_);
    const auto best = std::max_element(first, order_.end(),
                                       [&](std::size_t a, std::size_t b) { return part(a) < part(b); });
    if (!(part(*best) > dependent)) break;
    std::swap(*first, *best);
    const std::size_t pivot = *first;
    relative_pivot_[pivot] = part(pivot);
    for (std::size_t k = rank_ + 1; k < n; ++k) {
      const std::size_t row = order_[k];
      const double factor = at(row, pivot) / at(pivot, pivot);
      for (std::size_t m = rank_ + 1; m < n; ++m) at(row, order_[m]) -= factor * at(pivot, order_[m]);
      at(row, pivot) = factor;
    }
  }
  for (std::size_t k = rank_; k < n; ++k) relative_pivot_[order_[k]] = part(order_[k]);
}

void WeakRows::take(const double* right) {
  for (std::size_t row = 0; row < rows_.size(); ++row) {
    share_[row] = std::inner_product(right, right + size_, combination(row), 0.0);
  }
  for (std::size_t i = 0; i < rank_; ++i) {
    for (std::size_t k = i + 1; k < rank_; ++k)
      share_[order_[k]] -= at(order_[k], order_[i]) * share_[order_[i]];
  }
  for (std::size_t i = rank_; i-- > 0;) {
    double& share = share_[order_[i]];
    share /= at(order_[i], order_[i]);
    for (std::size_t k = i + 1; k < rank_; ++k) share -= at(order_[k], order_[i]) * share_[order_[k]];
  }
}

void WeakRows::add_to(double* x) const {
  for (std::size_t i = 0; i < rank_; ++i) {
    const double* const of_row = combination(order_[i]);
    for (std::size_t k = 0; k < size_; ++k) x[k] += share_[order_[i]] * of_row[k];
  }
}

}  // namespace carom
