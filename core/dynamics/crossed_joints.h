#pragma once

/// \file
/// Impulses along rows of joints at one configuration that correct velocities at another one: with the rows
/// G1 of the conditions, Gm of the reactions and the masses M,
///     G1 M^-1 Gm^T L = -r.
/// Near a singular position G1 and Gm may point so differently that the factors of G1 M^-1 G1^T do not lead
/// there.

#include <carom/core/dynamics/island_joints.h>
#include <carom/core/export.h>

#include <memory>

namespace carom {

/// Factors of G1 M^-1 Gm^T of one island.
class CAROM_API CrossedJoints {
public:
  CrossedJoints();
  ~CrossedJoints();
  CrossedJoints(CrossedJoints&&) noexcept;
  CrossedJoints& operator=(CrossedJoints&&) noexcept;
  CrossedJoints(const CrossedJoints&) = delete;
  CrossedJoints& operator=(const CrossedJoints&) = delete;

  /// Factors the matrix of rows that have been placed; false if it is singular, for reasons other than rows
  /// that follow from others at both places.
  [[nodiscard]] bool factor(const IslandJoints& conditions, const IslandJoints& reactions);
  /// r becomes L.
  void solve(double* r) const;

private:
  struct Factors;
  std::unique_ptr<Factors> factors_;
};

}  // namespace carom
