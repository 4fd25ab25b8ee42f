#pragma once

/// \file
/// Impulses along rows of joints at one configuration that correct velocities at another one: with the rows
/// G1 of the conditions, Gm of the reactions and the masses M,
///     G1 M^-1 Gm^T L = -r.
/// Near a singular position G1 and Gm may point so differently that the factors of G1 M^-1 G1^T do not lead
/// there.

#include <carom/core/dynamics/joint_constraints.h>
#include <carom/core/export.h>

#include <memory>

namespace carom {

/// Factors of G1 M^-1 Gm^T of one component.
class CAROM_API MixedConstraints {
public:
  MixedConstraints();
  ~MixedConstraints();
  MixedConstraints(MixedConstraints&&) noexcept;
  MixedConstraints& operator=(MixedConstraints&&) noexcept;
  MixedConstraints(const MixedConstraints&) = delete;
  MixedConstraints& operator=(const MixedConstraints&) = delete;

  /// Factors the matrix of rows that have been placed; false if it is singular, for reasons other than rows
  /// that follow from others at both places.
  [[nodiscard]] bool factor(const JointConstraints& conditions, const JointConstraints& reactions);
  /// r becomes L.
  void solve(double* r) const;

private:
  struct Factors;
  std::unique_ptr<Factors> factors_;
};

}  // namespace carom
