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
  find_squared_lengths(pattern, jacobian, inverse_mass, v);
  double least = std::numeric_limits<double>::infinity(), most = 0.0;
  for (std::size_t i = 0; i < alike_.size(); ++i) {
    if (!(inverse_mass[i] > 0.0)) {  // keeps its place
      alike_[i] = 0.0;
      continue;
    }
    const double felt = inverse_mass[i] * alike_[i];
    least = std::min(least, felt);
    most = std::max(most, felt);
    if (alike_[i] != 1.0) alike_[i] = 1.0 / alike_[i];
  }
  return most > 0.0 ? most / least : 1.0;
}

/// Square of the length of each velocity, into alike_: 1 of a place; of an angle the longest lever at which
/// joints hold the body, or its radius of gyration where that is longer, between bounds by the longest lever
/// of all: levers along the forces are not seen, and a radius of gyration may be anything.
void JointFactors::find_squared_lengths(const JointPattern& pattern, const double* jacobian,
                                        std::span<const double> inverse_mass, Index v) {
  constexpr double shortest = 0.03 * 0.03;  // of the longest lever
  constexpr double unseen = 1e-9 * 1e-9;    // lever against radius of gyration that is rounding
  const Index places = pattern.dimension();
  alike_.assign(inverse_mass.size(), 1.0);
  pattern.for_angles([&](Index angle, Index) { alike_[angle - v] = 0.0; });
  double longest = 0.0;
  pattern.for_blocks(jacobian,
                     [&](Index, auto rows, auto columns, Index first, const double* number, auto stride) {
                       for (Index i = 0; i < rows; ++i, number += stride) {
                         if (std::all_of(number, number + places, [](double at) { return at == 0.0; }))
                           continue;
                         for (Index c = places; c < columns; ++c) {
                           const Index angle = first - v + c;
                           const double lever = number[c] * number[c];
                           if (lever * inverse_mass[angle] <= unseen * inverse_mass[first - v]) continue;
                           alike_[angle] = std::max(alike_[angle], lever);
                           longest = std::max(longest, lever);
                         }
                       }
                     });
  pattern.for_angles([&](Index angle, Index place) {
    const double turning = inverse_mass[angle - v];
    const double own = turning > 0.0 ? inverse_mass[place - v] / turning : 0.0;
    double& length = alike_[angle - v];
    length = std::max(length, longest > 0.0 ? std::clamp(own, shortest * longest, longest) : own);
    if (!(length > 0.0)) length = 1.0;
  });
}

}  // namespace carom
