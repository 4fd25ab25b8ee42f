#include <carom/core/numerics/full_pivoting.h>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#if defined(__x86_64__) && defined(__GNUC__)
#include <immintrin.h>
#endif

namespace carom {

namespace {

/// Numbers of a row that an elimination changes: row -= factor times that of the pivot.
struct RowChange {
  double* row;
  const double* of_pivot;
  double factor;
  std::size_t count;
};

/// Changes a row, and returns the size of its largest number then; -1 of none.
double change_from(std::size_t begin, const RowChange& of, double largest) {
  for (std::size_t j = begin; j < of.count; ++j) {
    of.row[j] -= of.factor * of.of_pivot[j];
    largest = std::max(largest, std::abs(of.row[j]));
  }
  return largest;
}

#if defined(__x86_64__) && defined(__GNUC__)
// Four numbers at a time, in one pass. No fused multiply-add: the same bits.
[[gnu::target("avx2")]] double change_by_fours(const RowChange& of) {
  const __m256d factor = _mm256_set1_pd(of.factor), sign = _mm256_set1_pd(-0.0);
  __m256d sizes = _mm256_set1_pd(-1.0);
  std::size_t j = 0;
  for (; j + 4 <= of.count; j += 4) {
    const __m256d product = _mm256_mul_pd(factor, _mm256_loadu_pd(of.of_pivot + j));
    const __m256d left = _mm256_sub_pd(_mm256_loadu_pd(of.row + j), product);
    _mm256_storeu_pd(of.row + j, left);
    sizes = _mm256_max_pd(_mm256_andnot_pd(sign, left), sizes);
  }
  const __m128d halves = _mm_max_pd(_mm256_castpd256_pd128(sizes), _mm256_extractf128_pd(sizes, 1));
  const double largest = std::max(_mm_cvtsd_f64(halves), _mm_cvtsd_f64(_mm_unpackhi_pd(halves, halves)));
  return change_from(j, of, largest);
}
const bool by_fours = __builtin_cpu_supports("avx2") != 0;
#else
constexpr bool by_fours = false;
double change_by_fours(const RowChange& of) { return change_from(0, of, -1.0); }
#endif

double change(const RowChange& of) { return by_fours ? change_by_fours(of) : change_from(0, of, -1.0); }

}  // namespace

void FullPivoting::reset(std::size_t n) {
  rank_ = n;
  if (n == 1 && size() == 1) return;  // one equation stays in its order
  matrix_.resize(n * n);
  row_order_.resize(n);
  column_order_.resize(n);
  std::iota(row_order_.begin(), row_order_.end(), std::size_t{0});
  std::iota(column_order_.begin(), column_order_.end(), std::size_t{0});
}

/// The size of the largest number of a row from a column on.
double FullPivoting::largest_from(const double* row, std::size_t column) const {
  constexpr std::size_t few = 8;  // for which the call of a wide search takes longer
  const std::size_t count = size() - column;
  if (count > few)
    return Eigen::Map<const Eigen::ArrayXd>(row + column, static_cast<Eigen::Index>(count)).abs().maxCoeff();
  double largest = -1.0;
  for (std::size_t j = column; j < size(); ++j) largest = std::max(largest, std::abs(row[j]));
  return largest;
}

/// The largest number that is left, of several alike the first.
FullPivoting::Pivot FullPivoting::choose_pivot(std::size_t step) const {
  Pivot best{step, step, -1.0};
  for (std::size_t i = step; i < size(); ++i) {
    const double number = row_sizes_[row_order_[i]];
    if (number > best.size) best = {i, step, number};
  }
  const double* const row = row_at(best.row);
  while (best.column + 1 < size() && std::abs(row[best.column]) != best.size) ++best.column;
  return best;
}

/// Brings a column to a place, and that which is there to its own.
void FullPivoting::swap_columns(std::size_t a, std::size_t b) {
  if (a == b) return;
  std::swap(column_order_[a], column_order_[b]);
  const std::size_t n = size();
  for (double *row = matrix_.data(), *const end = row + n * n; row != end; row += n)
    std::swap(row[a], row[b]);
}

/// One equation, without the search.
bool FullPivoting::solve_one(double& right) {
  rank_ = std::abs(matrix_[0]) > 0.0 ? 1 : 0;
  right = rank_ == 1 ? right / matrix_[0] : 0.0;
  return std::isfinite(right);
}

/// There is no solution in numbers.
bool FullPivoting::fail(std::vector<double>& right) {
  std::fill(right.begin(), right.end(), std::numeric_limits<double>::quiet_NaN());
  return false;
}

bool FullPivoting::solve(double dependent, std::vector<double>& right) {
  const std::size_t n = size();
  if (n == 1) return solve_one(right[0]);
  // A number that is NaN has no size: its row would be taken for one without a pivot.
  if (!std::all_of(matrix_.begin(), matrix_.end(), [](double number) { return std::isfinite(number); }))
    return fail(right);
  row_sizes_.resize(n);
  for (std::size_t i = 0; i < n; ++i) row_sizes_[i] = largest_from(matrix_.data() + i * n, 0);
  double largest = 0.0;
  for (std::size_t step = 0; step < n; ++step) {
    const Pivot pivot = choose_pivot(step);
    if (step == 0) largest = pivot.size;
    if (pivot.size < 0.0) return fail(right);  // numbers have grown beyond all bounds
    if (!(pivot.size > dependent * largest)) {
      rank_ = step;
      break;
    }
    std::swap(row_order_[step], row_order_[pivot.row]);
    swap_columns(step, pivot.column);
    const double* const of_pivot = row_at(step);
    for (std::size_t i = step + 1; i < n; ++i) {
      double* const row = matrix_.data() + row_order_[i] * n;
      if (row[step] == 0.0) continue;  // its largest number is elsewhere
      const double factor = row[step] / of_pivot[step];
      right[row_order_[i]] -= factor * right[row_order_[step]];
      row_sizes_[row_order_[i]] = change({row + step + 1, of_pivot + step + 1, factor, n - step - 1});
    }
  }
  return substitute(right);
}

/// Eliminates a right side as it would have been with the matrix: each row keeps, left of its pivot, what it
/// had there when that was eliminated.
bool FullPivoting::solve_again(std::vector<double>& right) {
  const std::size_t n = size();
  if (n == 1) return solve_one(right[0]);
  for (std::size_t step = 0; step < rank_; ++step) {
    const double pivot = entry(step, step), of_pivot = right[row_order_[step]];
    for (std::size_t i = step + 1; i < n; ++i) {
      const double number = entry(i, step);
      if (number == 0.0) continue;
      right[row_order_[i]] -= number / pivot * of_pivot;
    }
  }
  return substitute(right);
}

/// The unknowns from the triangle.
bool FullPivoting::substitute(std::vector<double>& right) {
  work_.assign(size(), 0.0);
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
