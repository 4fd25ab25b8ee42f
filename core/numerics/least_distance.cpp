#include <carom/core/numerics/least_distance.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace carom {

namespace {

// A slope of which others leave less than this part follows from them.
constexpr double dependent = 1e-9;

double dot(const double* a, const double* b, std::size_t size) {
  return std::inner_product(a, a + size, b, 0.0);
}

}  // namespace

bool LeastDistance::solve(std::span<const double> at, std::span<const double> slopes, double noise,
                          std::span<double> x) {
  const std::size_t most_lines = 10 * (at.size() + 1);  // each is taken up a few times at most
  std::fill(x.begin(), x.end(), 0.0);
  held_.clear();
  multipliers_.clear();
  for (std::size_t count = 0; count < most_lines; ++count) {
    std::size_t worst = at.size();
    double least = -noise;
    for (std::size_t i = 0; i < at.size(); ++i) {
      if (std::find(held_.begin(), held_.end(), i) != held_.end()) continue;
      const double value = at[i] + dot(slopes.data() + i * x.size(), x.data(), x.size());
      if (!(value < least)) continue;
      least = value;
      worst = i;
    }
    if (worst == at.size()) return true;
    if (!satisfy(worst, at, slopes, x)) return false;
  }
  return false;
}

/// A slope as a combination of those held, and what is left of it.
void LeastDistance::split(const double* slope, std::span<const double> slopes, std::size_t size) {
  const std::size_t held = held_.size();
  basis_.assign(held * size, 0.0);
  upper_.assign(held * held, 0.0);
  part_.assign(held, 0.0);
  rest_.assign(size, 0.0);
  const auto reduce = [&](double* vector, std::size_t against, auto&& note) {
    for (int pass = 0; pass < 2; ++pass) {  // the second for what rounding left
      for (std::size_t k = 0; k < against; ++k) {
        const double* const other = basis_.data() + k * size;
        const double along = dot(vector, other, size);
        note(k, along);
        for (std::size_t i = 0; i < size; ++i) vector[i] -= along * other[i];
      }
    }
  };
  for (std::size_t j = 0; j < held; ++j) {
    double* const vector = basis_.data() + j * size;
    std::copy_n(slopes.data() + held_[j] * size, size, vector);
    reduce(vector, j, [&](std::size_t k, double along) { upper_[k * held + j] += along; });
    const double length = std::sqrt(dot(vector, vector, size));
    upper_[j * held + j] = length;
    for (std::size_t i = 0; i < size; ++i) vector[i] /= length;
  }
  std::copy_n(slope, size, rest_.begin());
  reduce(rest_.data(), held, [&](std::size_t k, double along) { part_[k] += along; });
  for (std::size_t j = held; j-- > 0;) {
    for (std::size_t k = j + 1; k < held; ++k) part_[j] -= upper_[j * held + k] * part_[k];
    part_[j] /= upper_[j * held + j];
  }
}

/// Moves x until a line is satisfied; lines that do not hold it any more are let go.
bool LeastDistance::satisfy(std::size_t line, std::span<const double> at, std::span<const double> slopes,
                            std::span<double> x) {
  constexpr double never = std::numeric_limits<double>::infinity();
  const std::size_t size = x.size();
  const double* const slope = slopes.data() + line * size;
  const double length = std::sqrt(dot(slope, slope, size));
  double multiplier = 0.0;
  for (;;) {
    split(slope, slopes, size);
    const double rest = dot(rest_.data(), rest_.data(), size);
    const bool moves = rest > dependent * dependent * length * length;
    const double full = moves ? -(at[line] + dot(slope, x.data(), size)) / rest : never;
    double step = full;
    std::size_t let_go = held_.size();
    for (std::size_t j = 0; j < held_.size(); ++j) {
      if (!(part_[j] > 0.0) || !(multipliers_[j] / part_[j] < step)) continue;
      step = multipliers_[j] / part_[j];
      let_go = j;
    }
    if (step == never) return false;
    if (moves) {
      for (std::size_t i = 0; i < size; ++i) x[i] += step * rest_[i];
    }
    for (std::size_t j = 0; j < held_.size(); ++j) multipliers_[j] -= step * part_[j];
    multiplier += step;
    if (let_go == held_.size()) {
      held_.push_back(line);
      multipliers_.push_back(multiplier);
      return true;
    }
    held_.erase(held_.begin() + static_cast<std::ptrdiff_t>(let_go));
    multipliers_.erase(multipliers_.begin() + static_cast<std::ptrdiff_t>(let_go));
  }
}

}  // namespace carom
