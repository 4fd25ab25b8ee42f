// Problem: solve small, possibly singular systems to the last digits, without allocating each time.

#include <carom/core/numerics/rank_revealing_qr.h>

#include <carom/core/numerics/accurate_dot.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace carom {

namespace {

// Refinement gains about -log10(eps cond) digits a round; more rounds than this gain nothing.
constexpr int most_refinements = 4;

/// Sum of products in eight sums side by side, so that no product waits for the one before.
double dot_of_eight(const double* a, const double* b, std::size_t size) {
  constexpr std::size_t width = 8;
  std::array<double, width> sums{};
  std::size_t i = 0;
  for (; i + width <= size; i += width) {
    for (std::size_t k = 0; k < width; ++k) sums[k] += a[i + k] * b[i + k];
  }
  double sum = ((sums[0] + sums[4]) + (sums[1] + sums[5])) + ((sums[2] + sums[6]) + (sums[3] + sums[7]));
  for (; i < size; ++i) sum += a[i] * b[i];
  return sum;
}

/// a -= factor * b.
void subtract(double* a, double factor, const double* b, std::size_t size) {
  for (std::size_t i = 0; i < size; ++i) a[i] -= factor * b[i];
}

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
    column_[j].measure(r_.data() + j * rows, rows);
  }

  rank_ = 0;
  double first_pivot = 0.0;
  for (std::size_t k = 0; k < std::min(rows, columns); ++k) {
    const std::size_t best = longest_column(k);
    const double* const pivot = r_.data() + best * rows;
    const double length = std::sqrt(dot_of_eight(pivot + k, pivot + k, rows - k));
    if (k == 0) first_pivot = length;
    if (!(length > tolerance * first_pivot)) break;
    if (best != k) {
      std::swap_ranges(r_.begin() + static_cast<std::ptrdiff_t>(k * rows),
                       r_.begin() + static_cast<std::ptrdiff_t>((k + 1) * rows),
                       r_.begin() + static_cast<std::ptrdiff_t>(best * rows));
      std::swap(column_[k].place, column_[best].place);
      std::swap(column_[k].square, column_[best].square);
      std::swap(column_[k].measured, column_[best].measured);
    }
    reflect(k, length);
    ++rank_;
  }
}

void RankRevealingQr::Column::measure(const double* column, std::size_t size) {
  square = measured = dot_of_eight(column, column, size);
}

std::size_t RankRevealingQr::longest_column(std::size_t k) const {
  std::size_t best = k;
  for (std::size_t j = k + 1; j < columns_; ++j) {
    if (column_[j].square > column_[best].square) best = j;
  }
  return best;
}

void RankRevealingQr::reflect(std::size_t k, double length) {
  // Squares of lengths are brought down from row to row. Where less than this part of one is left, rounding
  // of what it was counts, and it is measured anew: the rank hangs on it.
  constexpr double least_left = 1e-4;
  double* pivot = r_.data() + k * rows_;
  const double alpha = pivot[k] > 0.0 ? -length : length;
  const double head = pivot[k] - alpha;
  column_[k].tau = -head / alpha;
  for (std::size_t i = k + 1; i < rows_; ++i) pivot[i] /= head;
  pivot[k] = alpha;
  const std::size_t below = rows_ - (k + 1);
  for (std::size_t j = k + 1; j < columns_; ++j) {
    double* other = r_.data() + j * rows_ + k;
    const double part = column_[k].tau * (other[0] + dot_of_eight(pivot + k + 1, other + 1, below));
    other[0] -= part;
    subtract(other + 1, part, pivot + k + 1, below);
    Column& left = column_[j];
    left.square -= other[0] * other[0];
    if (!(left.square > least_left * left.measured)) left.measure(other + 1, below);
  }
}

double RankRevealingQr::reciprocal_condition() const {
  if (rank_ == 0) return 0.0;
  return std::abs(r_[(rank_ - 1) * rows_ + rank_ - 1] / r_[0]);
}

// Right-hand side in work_, which is used up.
void RankRevealingQr::back_substitute(std::span<double> x) {
  for (std::size_t k = rank_; k-- > 0;) {
    const double* const column = r_.data() + k * rows_;
    const double found = work_[k] / column[k];
    x[column_[k].place] = found;
    subtract(work_.data(), found, column, k);
  }
  // Unknowns are scaled back in place; nobody reads them unscaled any more.
  for (std::size_t j = 0; j < columns_; ++j) x[j] *= column_[j].scale;
}

// Right-hand side in work_.
void RankRevealingQr::solve_once(std::span<double> x) {
  for (std::size_t k = 0; k < rank_; ++k) {
    const double* const v = r_.data() + k * rows_ + k + 1;
    const std::size_t below = rows_ - (k + 1);
    const double part = column_[k].tau * (work_[k] + dot_of_eight(v, work_.data() + k + 1, below));
    work_[k] -= part;
    subtract(work_.data() + k + 1, part, v, below);
  }
  std::fill(x.begin(), x.end(), 0.0);
  back_substitute(x);
}

void RankRevealingQr::solve_by_factors(std::span<const double> b, std::span<double> x) {
  std::copy(b.begin(), b.end(), work_.begin());
  solve_once(x);
}

void RankRevealingQr::solve(std::span<const double> b, std::span<double> x) {
  solve_by_factors(b, x);
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
