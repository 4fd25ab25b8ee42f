#include <carom/core/numerics/elimination.h>
#include <carom/core/numerics/pair_substitution.h>
#include <carom/core/numerics/sparse_factors.h>

#include <algorithm>
#include <array>
#include <limits>
#include <numeric>
#include <type_traits>

namespace carom {

std::vector<double>& SparseFactors::values() {
  if (pattern_ && work_.empty()) {
    values_.assign(pattern_->values_size, 0.0);
    lower_.assign(pattern_->lower_size, 0.0);
    own_.assign(pattern_->own_size, 0.0);
    pivot_.assign(size(), 1.0);
    relative_pivot_.assign(size(), 1.0);
    work_.assign(std::size_t{pattern_->most} * size(), 0.0);
  }
  return values_;
}

/// Calls f with the number of rows of all blocks if that is one of the usual ones, or with 0.
template <class F>
void SparseFactors::with_rows(F&& f) const {
  if (pattern_->uniform && pattern_->most == 1) {
    f(std::integral_constant<Index, 1>());
  } else if (pattern_->uniform && pattern_->most == 2) {
    f(std::integral_constant<Index, 2>());
  } else {
    f(std::integral_constant<Index, 0>());
  }
}

namespace {

/// Factorises a block on the diagonal, from which the blocks before it have been subtracted in `d`. \param
/// own its numbers of L \param relative pivots against `diagonal` \param left_out rows that are; null: none
template <Index Rows>
void factor_diagonal(Index rows, const double* diagonal, double least_pivot, const char* left_out, double* d,
                     double* own, double* pivots, double* relative) {
  const Index n = Rows == 0 ? rows : Rows;
  const double* const first_own = own;
  for (Index r = 0; r < n; ++r) {
    // Of the row: L times D behind the diagonal's block, its own numbers of L there.
    double pivot = d[r * n + r];
    const double* before = first_own;
    for (Index c = 0; c < r; ++c) {
      double product = d[r * n + c];
      for (Index m = 0; m < c; ++m) product -= *before++ * d[r * n + m];
      d[r * n + c] = product;
      own[c] = product / pivots[c];
      pivot -= own[c] * product;
    }
    own += r;
    const double whole = diagonal[r * n + r];
    relative[r] = whole > 0.0 ? pivot / whole : 0.0;
    // With an infinite pivot nothing comes from the row and nothing goes to it.
    const bool kept = pivot > least_pivot * whole && (left_out == nullptr || left_out[r] == 0);
    pivots[r] = kept ? pivot : std::numeric_limits<double>::infinity();
  }
}

}  // namespace

/// Row of blocks by row of blocks. \tparam Rows of all blocks; 0 where they differ \param left_out by row of
/// the matrix, not 0 where it is; null: none
template <Index Rows>
void SparseFactors::factor_blocks(double least_pivot, const char* left_out) {
  const Pattern& at = *pattern_;
  constexpr Index room = Rows == 0 ? most_rows : Rows;
  const Index most = Rows == 0 ? at.most : Rows;
  const auto rows_of = [&](Index block) { return Rows == 0 ? at.rows(block) : Rows; };
  const auto row_of = [&](Index block) { return Rows == 0 ? at.row_begin[block] : Rows * block; };
  const auto number_of = [&](Index k) { return Rows == 0 ? at.below_number[k] : Rows * Rows * k; };
  const double* value = values_.data();
  double* const work = work_.data();
  std::array<double, std::size_t{room} * room> y{}, d{};
  for (Index i = 0; i < at.blocks(); ++i) {
    const Index n = rows_of(i), first = row_of(i), last = at.entry_begin[i + 1] - 1;
    for (Index p = at.entry_begin[i]; p < last; ++p) {
      const Index j = at.entry_column[p], numbers = n * rows_of(j);
      std::copy_n(value, numbers, work + std::size_t{most} * row_of(j));
      value += numbers;
    }
    const double* const diagonal = value;
    std::copy_n(diagonal, n * n, d.begin());
    value += n * n;
    for (Index p = at.left_begin[i]; p < at.left_begin[i + 1]; ++p) {
      const Index j = at.left_column[p], place = at.left_place[p], columns = rows_of(j);
      double* const from = work + std::size_t{most} * row_of(j);
      std::copy_n(from, n * columns, y.begin());
      std::fill_n(from, n * columns, 0.0);
      const double* own = own_.data() + at.own_begin[j];
      for (Index c = 1; c < columns; ++c) {
        for (Index m = 0; m < c; ++m, ++own) {
          for (Index r = 0; r < n; ++r) y[r * columns + c] -= *own * y[r * columns + m];
        }
      }
      for (Index k = at.below_begin[j]; k < place; ++k) {
        const Index others = rows_of(at.below_row[k]);
        const double* const l = lower_.data() + number_of(k);
        double* const to = work + std::size_t{most} * row_of(at.below_row[k]);
        for (Index r = 0; r < n; ++r) {
          for (Index o = 0; o < others; ++o) {
            double sum = 0.0;
            for (Index c = 0; c < columns; ++c) sum += y[r * columns + c] * l[o * columns + c];
            to[r * others + o] -= sum;
          }
        }
      }
      double* const l = lower_.data() + number_of(place);
      const double* const pivots = pivot_.data() + row_of(j);
      for (Index r = 0; r < n; ++r) {
        for (Index c = 0; c < columns; ++c) l[r * columns + c] = y[r * columns + c] / pivots[c];
        for (Index o = 0; o <= r; ++o) {
          for (Index c = 0; c < columns; ++c) d[r * n + o] -= l[r * columns + c] * y[o * columns + c];
        }
      }
    }
    const char* const of_block = left_out == nullptr ? nullptr : left_out + at.given_row[i];
    factor_diagonal<Rows>(n, diagonal, least_pivot, of_block, d.data(), own_.data() + at.own_begin[i],
                          pivot_.data() + first, relative_pivot_.data() + at.given_row[i]);
  }
}

void SparseFactors::factor_down_to(double least_pivot, const char* left_out) {
  with_rows([&](auto rows) { factor_blocks<decltype(rows)::value>(least_pivot, left_out); });
}

void SparseFactors::factor() {
  weak_.clear();
  if (values().empty()) return;
  factor_down_to(dependent_pivot);
  if (reveals_rank_ && is_doubtful()) factor_weak_rows();
}

void SparseFactors::factor_without(std::span<const char> left_out) {
  // Of the diagonal: a pivot below is rounding.
  constexpr double rounding = 1e-15;
  weak_.clear();
  if (values().empty()) return;
  factor_down_to(rounding, left_out.data());
}

/// True if a small pivot may have magnified the rounding of a pivot that decides.
bool SparseFactors::is_doubtful() const {
  // Of rows that clearly follow from others. Rounding divided by it reaches the weakest pivot that decides.
  constexpr double clear = 1e-12, deciding = 1e-6;
  bool any_weak = false, any_deciding = false;
  for (const double pivot : relative_pivot_) {
    any_weak = any_weak || (pivot > clear && pivot < weak_pivot);
    any_deciding = any_deciding || pivot < deciding;
  }
  return any_weak && any_deciding;
}

/// Eliminates strong rows first, then weak ones, the largest pivot first. Too many weak rows are left as they
/// were.
void SparseFactors::factor_weak_rows() {
  factor_down_to(weak_pivot);
  weak_.assign(relative_pivot_, weak_pivot);
  const std::span<const std::size_t> rows = weak_.rows();
  if (rows.size() > WeakRows::most) {
    weak_.clear();
    factor_down_to(dependent_pivot);
    return;
  }
  // The combination of a row that vanishes at strong ones: its numbers there, solved for.
  for (std::size_t k = 0; k < rows.size(); ++k) {
    double* const combination = weak_.combination(k);
    read_row(rows[k], combination);
    weak_.whole(k) = combination[rows[k]];
    solve_strong(combination);
    for (std::size_t i = 0; i < size(); ++i) combination[i] = -combination[i];
    combination[rows[k]] = 1.0;
  }
  row_.resize(size());
  for (std::size_t k = 0; k < rows.size(); ++k) {
    read_row(rows[k], row_.data());
    for (std::size_t m = 0; m <= k; ++m) {
      weak_.at(k, m) = weak_.at(m, k) =
          std::inner_product(row_.begin(), row_.end(), weak_.combination(m), 0.0);
    }
  }
  weak_.factor(dependent_pivot);
  for (std::size_t k = 0; k < rows.size(); ++k) relative_pivot_[rows[k]] = weak_.relative_pivot(k);
}

template <Index Rows>
void SparseFactors::substitute(double* given) {
  const Pattern& at = *pattern_;
  if constexpr (Rows == 2) {
    if (is_chained(at)) {
      return substitute_pairs(
          {at.given_row.data(), at.below_row.data(), at.blocks(), lower_.data(), own_.data(), pivot_.data()},
          work_.data(), given);
    }
  }
  const auto rows_of = [&](Index block) { return Rows == 0 ? at.rows(block) : Rows; };
  const auto row_of = [&](Index block) { return Rows == 0 ? at.row_begin[block] : Rows * block; };
  double* const x = work_.data();
  for (Index j = 0; j < at.blocks(); ++j) {
    for (Index r = 0; r < rows_of(j); ++r) x[row_of(j) + r] = given[at.given_row[j] + r];
  }
  const double* l = lower_.data();
  for (Index j = 0; j < at.blocks(); ++j) {
    const Index n = rows_of(j);
    double* const own_x = x + row_of(j);
    const double* own = own_.data() + at.own_begin[j];
    for (Index r = 1; r < n; ++r) {
      for (Index c = 0; c < r; ++c) own_x[r] -= *own++ * own_x[c];
    }
    for (Index k = at.below_begin[j]; k < at.below_begin[j + 1]; ++k) {
      const Index others = rows_of(at.below_row[k]);
      double* const to = x + row_of(at.below_row[k]);
      for (Index o = 0; o < others; ++o) {
        double sum = 0.0;
        for (Index c = 0; c < n; ++c) sum += *l++ * own_x[c];
        to[o] -= sum;
      }
    }
  }
  for (Index j = at.blocks(); j-- > 0;) {
    const Index n = rows_of(j);
    double* const own_x = x + row_of(j);
    for (Index r = 0; r < n; ++r) own_x[r] /= pivot_[row_of(j) + r];
    for (Index k = at.below_begin[j + 1]; k-- > at.below_begin[j];) {
      const Index others = rows_of(at.below_row[k]);
      const double* const from = x + row_of(at.below_row[k]);
      l -= others * n;
      for (Index o = 0; o < others; ++o) {
        for (Index c = 0; c < n; ++c) own_x[c] -= l[o * n + c] * from[o];
      }
    }
    const double* own = own_.data() + at.own_begin[j + 1];
    for (Index r = n; r-- > 1;) {
      own -= r;
      for (Index c = 0; c < r; ++c) own_x[c] -= own[c] * own_x[r];
    }
  }
  for (Index j = 0; j < at.blocks(); ++j) {
    for (Index r = 0; r < rows_of(j); ++r) {
      given[at.given_row[j] + r] = x[row_of(j) + r];
      x[row_of(j) + r] = 0.0;
    }
  }
}

/// Solves by the rows that are not left out of the sparse factors.
void SparseFactors::solve_strong(double* x) {
  with_rows([&](auto rows) { substitute<decltype(rows)::value>(x); });
}

void SparseFactors::solve(double* x) {
  if (!pattern_) return;
  if (!weak_.empty()) weak_.take(x);
  solve_strong(x);
  if (!weak_.empty()) weak_.add_to(x);
}

/// A x of the matrix as it was given.
void SparseFactors::multiply(const double* x, double* out) const {
  const Pattern& at = *pattern_;
  std::fill_n(out, size(), 0.0);
  const double* value = values_.data();
  for (Index i = 0; i < at.blocks(); ++i) {
    for (Index p = at.entry_begin[i]; p < at.entry_begin[i + 1]; ++p) {
      const Index j = at.entry_column[p], row = at.given_row[i], column = at.given_row[j];
      for (Index r = 0; r < at.rows(i); ++r) {
        for (Index c = 0; c < at.rows(j); ++c, ++value) {
          if (i == j && c > r) continue;
          out[row + r] += *value * x[column + c];
          if (row + r != column + c) out[column + c] += *value * x[row + r];
        }
      }
    }
  }
}

/// A row of the matrix, as it was given.
void SparseFactors::read_row(std::size_t row, double* out) {
  work_[row] = 1.0;
  multiply(work_.data(), out);
  work_[row] = 0.0;
}

void SparseFactors::dependence(std::span<const double> shares, std::vector<double>& out) {
  out.resize(size());
  multiply(shares.data(), out.data());
  solve(out.data());
  for (std::size_t row = 0; row < shares.size(); ++row) out[row] = shares[row] - out[row];
}

}  // namespace carom
