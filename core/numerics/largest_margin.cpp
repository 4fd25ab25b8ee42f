// Problem: few numbers are free, many margins depend on them; make the least of these largest.

#include <carom/core/numerics/largest_margin.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace carom {

namespace {

constexpr std::size_t no_line = std::numeric_limits<std::size_t>::max();

// Lines below the margin by less than this part of the largest number are at it.
constexpr double same_margin = 1e-13;

// Entries of a column below this part of the largest are rounding.
constexpr double no_pivot = 1e-10;

}  // namespace

void LargestMargin::start(std::size_t unknowns) {
  unknowns_ = unknowns;
  at_.clear();
  slopes_.clear();
}

std::span<double> LargestMargin::add(double at) {
  at_.push_back(at);
  slopes_.resize(at_.size() * unknowns_, 0.0);
  return std::span(slopes_).last(unknowns_);
}

/// The basis in which the bound is the margin, and x = 0.
void LargestMargin::begin_at_bound(double bound) {
  const std::size_t size = unknowns_ + 1;
  bound_ = bound;
  rounding_ = std::abs(bound);
  for (const double at : at_) rounding_ = std::max(rounding_, std::abs(at));
  rounding_ *= same_margin;
  basic_.resize(size);
  inverse_.assign(size * size, 0.0);
  for (std::size_t i = 0; i < size; ++i) {
    basic_[i] = i < unknowns_ ? lines() + 1 + i : lines();
    inverse_[i * size + i] = 1.0;
  }
  column_.resize(size);
  change_.resize(size);
  product_.resize(size * size);
  x_.resize(unknowns_);
}

/// Column of a variable in the equations of y.
void LargestMargin::write_column(std::size_t variable, std::span<double> column) const {
  std::fill(column.begin(), column.end(), 0.0);
  if (variable > lines()) {
    column[variable - lines() - 1] = 1.0;
    return;
  }
  column[unknowns_] = 1.0;
  if (variable == lines()) return;
  const double* const slopes = slopes_.data() + variable * unknowns_;
  std::copy(slopes, slopes + unknowns_, column.begin());
}

/// x and the margin, by which all lines of the basis are at the margin.
void LargestMargin::find_point() {
  const std::size_t size = unknowns_ + 1;
  std::fill(x_.begin(), x_.end(), 0.0);
  margin_ = 0.0;
  for (std::size_t i = 0; i < size; ++i) {
    if (basic_[i] > lines()) continue;
    const double value = basic_[i] == lines() ? bound_ : at_[basic_[i]];
    for (std::size_t k = 0; k < unknowns_; ++k) x_[k] -= value * inverse_[i * size + k];
    margin_ += value * inverse_[i * size + unknowns_];
  }
}

/// One step of Newton's method for the inverse B' <- B' (2 - B B'): exchanges leave rounding in it.
void LargestMargin::polish_inverse() {
  const std::size_t size = unknowns_ + 1;
  // product = B' B, whose columns are those of the basis.
  for (std::size_t j = 0; j < size; ++j) {
    write_column(basic_[j], column_);
    for (std::size_t i = 0; i < size; ++i) {
      double sum = 0.0;
      for (std::size_t k = 0; k < size; ++k) sum += inverse_[i * size + k] * column_[k];
      product_[i * size + j] = (i == j ? 2.0 : 0.0) - sum;
    }
  }
  // (2 - B' B) B', column by column.
  for (std::size_t j = 0; j < size; ++j) {
    for (std::size_t k = 0; k < size; ++k) column_[k] = inverse_[k * size + j];
    for (std::size_t i = 0; i < size; ++i) {
      double sum = 0.0;
      for (std::size_t k = 0; k < size; ++k) sum += product_[i * size + k] * column_[k];
      inverse_[i * size + j] = sum;
    }
  }
}

/// The line that is farthest below the margin, or the first one that is. `no_line` if there is none.
std::size_t LargestMargin::lowest(bool first) const {
  std::size_t found = no_line;
  double least = margin_ - rounding_;
  for (std::size_t i = 0; i < lines(); ++i) {
    double value = at_[i];
    for (std::size_t k = 0; k < unknowns_; ++k) value += slopes_[i * unknowns_ + k] * x_[k];
    if (!(value < least)) continue;
    found = i;
    if (first) return found;
    least = value;
  }
  return found;
}

/// Takes a line into the basis. Variables that stay 0 go first. False if nothing can leave.
bool LargestMargin::exchange(std::size_t entering, bool first) {
  const std::size_t size = unknowns_ + 1;
  write_column(entering, column_);
  double largest = 0.0;
  for (std::size_t i = 0; i < size; ++i) {
    change_[i] = 0.0;
    for (std::size_t k = 0; k < size; ++k) change_[i] += inverse_[i * size + k] * column_[k];
    largest = std::max(largest, std::abs(change_[i]));
  }
  std::size_t leaving = no_line;
  bool is_idle = false;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < size; ++i) {
    const bool idle = basic_[i] > lines();
    if (!((idle ? std::abs(change_[i]) : change_[i]) > no_pivot * largest) || (is_idle && !idle)) continue;
    const double ratio = idle ? 0.0 : std::max(inverse_[i * size + unknowns_], 0.0) / change_[i];
    const bool tie = leaving != no_line && ratio == least && is_idle == idle;
    const bool better = tie && first && !idle ? basic_[i] < basic_[leaving]
                                              : tie && std::abs(change_[i]) > std::abs(change_[leaving]);
    if (leaving != no_line && !(idle && !is_idle) && !(ratio < least) && !better) continue;
    leaving = i;
    is_idle = idle;
    least = ratio;
  }
  if (leaving == no_line) return false;
  double* const row = inverse_.data() + leaving * size;
  for (std::size_t k = 0; k < size; ++k) row[k] /= change_[leaving];
  for (std::size_t i = 0; i < size; ++i) {
    if (i == leaving || change_[i] == 0.0) continue;
    for (std::size_t k = 0; k < size; ++k) inverse_[i * size + k] -= change_[i] * row[k];
  }
  basic_[leaving] = entering;
  return true;
}

bool LargestMargin::solve(double bound) {
  constexpr std::size_t polished_every = 16;
  begin_at_bound(bound);
  const std::size_t usual = 2 * (lines() + unknowns_), most = 10 * usual + 10;
  bool polished = true;
  for (std::size_t count = 0; count < most;) {
    find_point();
    const std::size_t entering = lowest(count > usual);
    if (entering == no_line && polished) {
      multipliers_.assign(lines(), 0.0);
      for (std::size_t i = 0; i <= unknowns_; ++i) {
        if (basic_[i] < lines()) multipliers_[basic_[i]] = inverse_[i * (unknowns_ + 1) + unknowns_];
      }
      return true;
    }
    polished = entering == no_line || count % polished_every == polished_every - 1;
    if (entering != no_line) {
      if (!exchange(entering, count > usual)) return false;
      ++count;
    }
    if (polished) polish_inverse();
  }
  return false;
}

}  // namespace carom
