// Problem: solve small, possibly singular systems to the last digits, without allocating each time.

#include <carom/core/numerics/rank_revealing_qr.h>

#include <carom/core/numerics/accurate_dot.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace carom {

namespace {

// Refinement gains about -log10(eps cond) digits a round; more rounds than this gain nothing.
constexpr int most_refinements = 4;

double norm(std::span<const double> v) {
  double largest = 0.0;
  for (const double value : v) largest = std::max(largest, std::abs(value));
  return largest;
}

}  // namespace

void RankRevealingQr::factor(std::span<const double> a, std::size_t rows, std::size_t columns,
                             double tolerance) {
  rows_ = rows;
  columns_ = columns;
  a_.assign(a.begin(), a.end());
  r_.resize(rows * columns);
  work_.resize(rows);
  correction_.resize(columns);
  column_.assign(columns, {});
  for (std::size_t j = 0; j < columns; ++j) column_[j].place = j;

  // r_ is column-major: every step below runs down columns.
  for (std::size_t j = 0; j < columns; ++j) {
    double largest = 0.0;
    for (std::size_t i = 0; i < rows; ++i) largest = std::max(largest, std::abs(a[i * columns + j]));
    // Powers of two: scaling rounds nothing.
    if (largest > 0.0 && std::isfinite(largest)) column_[j].scale = std::exp2(-std::ilogb(largest));
    for (std::size_t i = 0; i < rows; ++i) r_[j * rows + i] = a[i * columns + j] * column_[j].scale;
  }

  rank_ = 0;
  double first_pivot = 0.0;
  for (std::size_t k = 0; k < std::min(rows, columns); ++k) {
    const auto [best, best_norm] = longest_column(k);
    const double length = std::sqrt(std::max(best_norm, 0.0));
    if (k == 0) first_pivot = length;
    if (!(length > tolerance * first_pivot)) break;
    if (best != k) {
      std::swap_ranges(r_.begin() + static_cast<std::ptrdiff_t>(k * rows),
                       r_.begin() + static_cast<std::ptrdiff_t>((k + 1) * rows),
                       r_.begin() + static_cast<std::ptrdiff_t>(best * rows));
      std::swap(column_[k].place, column_[best].place);
    }
    reflect(k, length);
    ++rank_;
  }
}

std::pair<std::size_t, double> RankRevealingQr::longest_column(std::size_t k) const {
  // Remaining column norms are recomputed, not updated: the systems are small, the rank matters.
  std::size_t best = k;
  double best_norm = -1.0;
  for (std::size_t j = k; j < columns_; ++j) {
    double sum = 0.0;
    for (std::size_t i = k; i < rows_; ++i) sum += r_[j * rows_ + i] * r_[j * rows_ + i];
    if (sum > best_norm) {
      best_norm = sum;
      best = j;
    }
  }
  return {best, best_norm};
}

void RankRevealingQr::reflect(std::size_t k, double length) {
  double* pivot = r_.data() + k * rows_;
  const double alpha = pivot[k] > 0.0 ? -length : length;
  const double head = pivot[k] - alpha;
  column_[k].tau = -head / alpha;
  for (std::size_t i = k + 1; i < rows_; ++i) pivot[i] /= head;
  pivot[k] = alpha;
  for (std::size_t j = k + 1; j < columns_; ++j) {
    double* other = r_.data() + j * rows_;
    double dot = other[k];
    for (std::size_t i = k + 1; i < rows_; ++i) dot += pivot[i] * other[i];
    dot *= column_[k].tau;
    other[k] -= dot;
    for (std::size_t i = k + 1; i < rows_; ++i) other[i] -= dot * pivot[i];
  }
}

double RankRevealingQr::reciprocal_condition() const {
  if (rank_ == 0) return 0.0;
  return std::abs(r_[(rank_ - 1) * rows_ + rank_ - 1] / r_[0]);
}

void RankRevealingQr::back_substitute(std::span<double> x) {
  for (std::size_t k = rank_; k-- > 0;) {
    double sum = work_[k];
    for (std::size_t j = k + 1; j < rank_; ++j) sum -= r_[j * rows_ + k] * x[column_[j].place];
    x[column_[k].place] = sum / r_[k * rows_ + k];
  }
  // Unknowns are scaled back in place; nobody reads them unscaled any more.
  for (std::size_t j = 0; j < columns_; ++j) x[j] *= column_[j].scale;
}

// Right-hand side in work_.
void RankRevealingQr::solve_once(std::span<double> x) {
  for (std::size_t k = 0; k < rank_; ++k) {
    const double* v = r_.data() + k * rows_;
    double dot = work_[k];
    for (std::size_t i = k + 1; i < rows_; ++i) dot += v[i] * work_[i];
    dot *= column_[k].tau;
    work_[k] -= dot;
    for (std::size_t i = k + 1; i < rows_; ++i) work_[i] -= dot * v[i];
  }
  std::fill(x.begin(), x.end(), 0.0);
  back_substitute(x);
}

void RankRevealingQr::solve(std::span<const double> b, std::span<double> x) {
  std::copy(b.begin(), b.end(), work_.begin());
  solve_once(x);
  double last = std::numeric_limits<double>::infinity();
  for (int round = 0; round < most_refinements; ++round) {
    for (std::size_t i = 0; i < rows_; ++i) {
      work_[i] = -accurate_dot(std::span(a_).subspan(i * columns_, columns_), x, -b[i]);
    }
    solve_once(correction_);
    const double change = norm(correction_);
    // A correction that does not shrink is noise: of a least-squares remainder, or of a hopeless condition.
    if (!(change < 0.5 * last)) break;
    for (std::size_t j = 0; j < columns_; ++j) x[j] += correction_[j];
    if (change <= std::numeric_limits<double>::epsilon() * norm(x)) break;
    last = change;
  }
}

void RankRevealingQr::null_vector(std::size_t index, std::span<double> x) {
  // R1 y = -R2 e_index in pivoted order; free unknown number `index` is one.
  const std::size_t free = rank_ + index;
  for (std::size_t k = 0; k < rank_; ++k) work_[k] = -r_[free * rows_ + k];
  std::fill(x.begin(), x.end(), 0.0);
  x[column_[free].place] = 1.0;
  back_substitute(x);
}

}  // namespace carom
