#pragma once

/// \file
/// Contact problems of bodies and contacts, from the rows of contact velocities.

#include <carom/contact/solvers/contact_problem.h>

#include <cstddef>
#include <vector>

namespace validation {

/// Rows of contact velocities over the velocities of bodies, with the inverse masses of these.
struct Rows {
  std::vector<std::vector<double>> h;
  std::vector<double> inverse_mass;
};

/// W = H M^-1 H^T and b; every row an impulse >= 0 unless its set is changed.
inline carom::ContactProblem problem_of(const Rows& rows, const std::vector<double>& b) {
  carom::ContactProblem problem;
  const int n = static_cast<int>(rows.h.size());
  problem.reset(n);
  for (int i = 0; i < n; ++i) {
    const auto& left = rows.h[static_cast<std::size_t>(i)];
    problem.vector()[static_cast<std::size_t>(i)] = b[static_cast<std::size_t>(i)];
    for (int j = 0; j < n; ++j) {
      const auto& right = rows.h[static_cast<std::size_t>(j)];
      for (std::size_t k = 0; k < left.size(); ++k)
        problem.w(i, j) += left[k] * rows.inverse_mass[k] * right[k];
    }
  }
  problem.group();
  return problem;
}

}  // namespace validation
