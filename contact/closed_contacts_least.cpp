// Problem: forces that closed contacts leave open, chosen so that they depend continuously on the state.

#include <carom/contact/closed_contacts.h>

#include <cmath>
#include <numeric>

namespace carom {

/// Null vector of the matrix last factorised that belongs to one of its free columns, into work_.
void ClosedContacts::find_null_vector(std::size_t free) {
  const std::size_t n = rows_.size();
  const auto entry = [&](std::size_t i, std::size_t j) {
    return matrix_[row_order_[i] * n + column_order_[j]];
  };
  work_.assign(n, 0.0);
  work_[column_order_[free]] = 1.0;
  for (std::size_t i = rank_; i-- > 0;) {
    double sum = -entry(i, free);
    for (std::size_t j = i + 1; j < rank_; ++j) sum -= entry(i, j) * work_[column_order_[j]];
    work_[column_order_[i]] = sum / entry(i, i);
  }
}

/// Forces of least norm: those of the basic solution without their part along the null vectors. Which rows
/// elimination takes for dependent is a matter of rounding; this solution does not depend on it.
void ClosedContacts::take_least() {
  const std::size_t n = rows_.size();
  orthonormal_.clear();
  const auto dot = [n](const double* a, const double* b) { return std::inner_product(a, a + n, b, 0.0); };
  for (std::size_t free = rank_; free < n; ++free) {
    find_null_vector(free);
    for (int pass = 0; pass < 2; ++pass) {  // the second for what rounding left
      for (std::size_t at = 0; at < orthonormal_.size(); at += n) {
        const double along = dot(work_.data(), orthonormal_.data() + at);
        for (std::size_t i = 0; i < n; ++i) work_[i] -= along * orthonormal_[at + i];
      }
    }
    const double length = std::sqrt(dot(work_.data(), work_.data()));
    for (std::size_t i = 0; i < n; ++i) orthonormal_.push_back(work_[i] / length);
  }
  for (std::size_t at = 0; at < orthonormal_.size(); at += n) {
    const double along = dot(unknown_.data(), orthonormal_.data() + at);
    for (std::size_t i = 0; i < n; ++i) unknown_[i] -= along * orthonormal_[at + i];
  }
}

}  // namespace carom
