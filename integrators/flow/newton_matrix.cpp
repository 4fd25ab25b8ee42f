#include <carom/integrators/flow/newton_matrix.h>

#include <carom/core/errors.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace carom {

bool NewtonMatrix::take() {
  const bool known = std::equal(entries_.begin(), entries_.end(), pattern_.begin(), pattern_.end(),
                                [](const RateDerivative& entry, const std::pair<Index, Index>& place) {
                                  return entry.row == place.first && entry.column == place.second;
                                });
  if (!known) analyse();
  for (Sum& sum : sums_) sum.of_rate = sum.of_state = sum.of_integral = 0.0;
  bool finite = true;
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    const RateDerivative& entry = entries_[i];
    finite = finite && std::isfinite(entry.of_rate) && std::isfinite(entry.of_state) &&
             std::isfinite(entry.of_integral);
    if (place_[i] == none) continue;
    Sum& sum = sums_[place_[i]];
    sum.of_rate += entry.of_rate;
    sum.of_state += entry.of_state;
    sum.of_integral += entry.of_integral;
  }
  return finite;
}

void NewtonMatrix::analyse() {
  const auto refuse = [](const char* what, Index number, const char* allowed) {
    throw ModelError("derivative of the rates: " + std::string(what) + " " + std::to_string(number) +
                     "; allowed: " + allowed);
  };
  auto last = static_cast<Index>(size_);
  pattern_.clear();
  for (const RateDerivative& entry : entries_) {
    if (entry.row < integrals_) refuse("row", entry.row, "none of an integral");
    if (entry.column < integrals_) refuse("column", entry.column, "none of an integral");
    if (entry.of_integral != 0.0 && entry.column >= 2 * integrals_) {
      refuse("an integral of unknown", entry.column, "of those that have one");
    }
    pattern_.emplace_back(entry.row, entry.column);
    last = std::max({last, entry.row + 1, entry.column + 1});
  }
  number_.assign(last, none);
  for (const RateDerivative& entry : entries_) number_[entry.row] = 0;
  unknowns_.clear();
  std::vector<char> late;
  for (Index i = 0; i < last; ++i) {
    if (number_[i] == none) {
      if (i >= size_) refuse("no row of multiplier", i, "as many rows as multipliers");
      continue;
    }
    number_[i] = static_cast<Index>(unknowns_.size());
    unknowns_.push_back(i);
    late.push_back(i >= size_ ? 1 : 0);
  }
  std::vector<std::pair<Index, Index>> inside;
  inside.reserve(entries_.size());
  for (const RateDerivative& entry : entries_) {
    if (number_[entry.column] != none) inside.emplace_back(number_[entry.row], number_[entry.column]);
  }
  const std::vector<Index> places = factors_.analyse(inside, late);
  place_.clear();
  sums_.assign(factors_.values().size(), {});
  auto next = places.begin();
  for (const RateDerivative& entry : entries_) {
    place_.push_back(number_[entry.column] == none ? none : *next++);
    if (place_.back() != none)
      sums_[place_.back()] = {number_[entry.row], number_[entry.column], 0.0, 0.0, 0.0};
  }
  constants_ = std::find(place_.begin(), place_.end(), none) != place_.end();
  right_.assign(unknowns_.size(), 0.0);
}

bool NewtonMatrix::factor(double gamma) {
  gamma_ = gamma;
  std::vector<double>& values = factors_.values();
  for (std::size_t i = 0; i < sums_.size(); ++i) {
    const Sum& sum = sums_[i];
    // Multipliers are counted times gamma.
    values[i] = unknowns_[sum.column] >= size_
                    ? -sum.of_state
                    : sum.of_rate - gamma * (sum.of_state + gamma * sum.of_integral);
  }
  return factors_.factor();
}

void NewtonMatrix::solve(const double* b, double* x) {
  std::fill(right_.begin(), right_.end(), 0.0);
  for (const Sum& sum : sums_) {
    const Index column = unknowns_[sum.column];
    if (column >= size_) continue;
    double& right = right_[sum.row];
    right += sum.of_rate * b[column];
    if (column < 2 * integrals_) right += gamma_ * sum.of_integral * b[column - integrals_];
  }
  for (std::size_t i = 0; constants_ && i < entries_.size(); ++i) {
    const RateDerivative& entry = entries_[i];
    if (place_[i] != none) continue;
    double change = entry.of_state * b[entry.column];
    if (entry.column < 2 * integrals_) {
      change += entry.of_integral * (b[entry.column - integrals_] + gamma_ * b[entry.column]);
    }
    right_[number_[entry.row]] += gamma_ * change;
  }
  factors_.solve(right_.data());
  std::copy(b, b + size_, x);
  for (std::size_t i = 0; i < unknowns_.size() && unknowns_[i] < size_; ++i) x[unknowns_[i]] = right_[i];
  for (std::size_t i = 0; i < integrals_; ++i) x[i] += gamma_ * x[integrals_ + i];
}

}  // namespace carom
