// Problem: tell rows of joints that follow from others from those that bind light bodies to heavy ones.

#include <carom/core/dynamics/joint_factors.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace carom {

namespace {

// Pivots that nobody takes for those of independent rows far from a singular position.
constexpr double small_pivot = 1e-2;
// Ratio of masses from which on they may make a pivot so small.
constexpr double uneven = 30.0;
// Ratio beyond which rounding, as much larger, is more than positions have.
constexpr double very_uneven = 1e4;

}  // namespace

void JointFactors::factor(const JointPattern& pattern, const double* jacobian,
                          std::span<const double> inverse_mass, Index v) {
  uneven_ = inexact_ = false;
  pattern.multiply(jacobian, inverse_mass.data(), v, by_masses_.values());
  by_masses_.factor();
  if (!has_small_pivot()) return;
  const double ratio = weigh_alike(pattern, jacobian, inverse_mass, v);
  if (!(ratio > uneven)) return;
  uneven_ = true;
  inexact_ = ratio > very_uneven;
  if (by_geometry_.empty()) by_geometry_.push_back(by_masses_);
  SparseFactors& geometry = by_geometry_.front();
  pattern.multiply(jacobian, alike_.data(), v, geometry.values());
  geometry.factor();
  left_out_.resize(pattern.rows());
  for (std::size_t row = 0; row < left_out_.size(); ++row) {
    left_out_[row] = geometry.pivot(row) > dependent_pivot ? 0 : 1;
  }
  by_masses_.factor_without(left_out_);
}

bool JointFactors::has_small_pivot() const {
  for (std::size_t row = 0; row < by_masses_.size(); ++row) {
    if (by_masses_.pivot(row) < small_pivot) return true;
  }
  return false;
}

/// Finds D. Returns the ratio of the masses that joints feel, those of angles over the squares of lengths.
double JointFactors::weigh_alike(const JointPattern& pattern, const double* jacobian,
                                 std::span<const double> inverse_mass, Index v) {
  find_lengths(pattern, jacobian, inverse_mass, v);
  double least = std::numeric_limits<double>::infinity(), most = 0.0;
  for (std::size_t i = 0; i < alike_.size(); ++i) {
    if (!(inverse_mass[i] > 0.0)) {  // keeps its place
      alike_[i] = 0.0;
      continue;
    }
    const double length = alike_[i], felt = inverse_mass[i] * length * length;
    least = std::min(least, felt);
    most = std::max(most, felt);
    alike_[i] = 1.0 / (length * length);
  }
  return most > 0.0 ? most / least : 1.0;
}

/// Length of each velocity, into alike_: 1 of a place; of an angle the longest lever at which joints hold the
/// body, or its radius of gyration where that is longer, between bounds by the longest lever of all: levers
/// along the forces are not seen, and a radius of gyration may be anything.
void JointFactors::find_lengths(const JointPattern& pattern, const double* jacobian,
                                std::span<const double> inverse_mass, Index v) {
  constexpr double shortest = 0.03;  // of the longest lever
  constexpr double unseen = 1e-9;    // lever against radius of gyration that is rounding
  const Index places = pattern.dimension();
  alike_.assign(inverse_mass.size(), 0.0);
  const auto gyration = [&](Index angle, Index place) {
    return inverse_mass[angle] > 0.0 ? std::sqrt(inverse_mass[place] / inverse_mass[angle]) : 0.0;
  };
  double longest = 0.0;
  const auto for_angles = [&](auto&& f) {
    pattern.for_blocks(jacobian,
                       [&](Index, auto rows, auto columns, Index first, const double* number, auto stride) {
                         for (Index c = places; c < columns; ++c) f(rows, first - v, c, number, stride);
                       });
  };
  for_angles([&](Index rows, Index first, Index c, const double* number, Index stride) {
    for (Index i = 0; i < rows; ++i) {
      const double* const row = number + i * stride;
      if (std::all_of(row, row + places, [](double at) { return at == 0.0; })) continue;
      const double lever = std::abs(row[c]);
      if (lever > unseen * gyration(first + c, first)) alike_[first + c] = std::max(alike_[first + c], lever);
      longest = std::max(longest, alike_[first + c]);
    }
  });
  for_angles([&](Index, Index first, Index c, const double*, Index) {
    const double own = gyration(first + c, first);
    const double bounded = longest > 0.0 ? std::clamp(own, shortest * longest, longest) : own;
    alike_[first + c] = std::max(alike_[first + c], bounded);
  });
  for (double& length : alike_) {
    if (!(length > 0.0)) length = 1.0;
  }
}

}  // namespace carom
