#pragma once

/// \file
/// The linear equations of an implicit step, (I - gamma df/dy) x = b, with df/dy given by equations that the
/// rates obey (RateDerivative). They are solved for unknowns and multipliers together,
///
///     (E - gamma A - gamma^2 K) x = E b + gamma K b',
///
/// E, A, K the numbers `of_rate`, `of_state`, `of_integral`, b' those of b that belong to integrals, whose
/// own rows are put into the others. So a net of springs, or a chain of bodies with joints, stays as sparse
/// as it is.

#include <carom/core/export.h>
#include <carom/core/ids.h>
#include <carom/core/numerics/sparse_lu.h>
#include <carom/integrators/flow/flow.h>

#include <cstddef>
#include <utility>
#include <vector>

namespace carom {

/// The matrix and its factors. Takes memory only where the pattern is not that of the time before.
class CAROM_API NewtonMatrix {
public:
  /// \param size,integrals FlowProblem's
  NewtonMatrix(std::size_t size, std::size_t integrals) : size_(size), integrals_(integrals) {}

  /// The derivatives, to be written anew; then call take().
  [[nodiscard]] std::vector<RateDerivative>& entries() { return entries_; }
  /// Brings the pattern to the entries. False if one of them is not finite. ModelError: an entry that cannot
  /// be.
  [[nodiscard]] bool take();
  /// Factorises the matrix. False if it is singular. \param gamma [s]
  [[nodiscard]] bool factor(double gamma);
  /// Solves. \param b,x size() numbers; may be the same
  void solve(const double* b, double* x);

  /// Unknowns and multipliers that are solved for.
  [[nodiscard]] std::size_t rows() const { return unknowns_.size(); }
  /// Numbers in the factors.
  [[nodiscard]] std::size_t fill() const { return factors_.fill(); }

private:
  // Sums of the entries of one place, factors' numbers and these in the same order.
  struct Sum {
    Index row, column;  // among unknowns_
    double of_rate, of_state, of_integral;
  };
  void analyse();

  std::size_t size_, integrals_;
  double gamma_ = 0.0;
  std::vector<RateDerivative> entries_;
  std::vector<std::pair<Index, Index>> pattern_;  // rows and columns of the entries when it was analysed
  std::vector<Index> unknowns_;                   // those with rows
  std::vector<Index> number_;                     // of an unknown among those, or none
  std::vector<Index> place_;                      // of an entry among the sums, or none
  std::vector<Sum> sums_;
  bool constants_ = false;  // there are columns without rows
  SparseLu factors_;
  std::vector<double> right_;
};

}  // namespace carom
