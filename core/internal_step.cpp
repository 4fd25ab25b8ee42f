#include <carom/core/internal_step.h>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <utility>

namespace carom {

namespace {

using DenseVector = Eigen::Map<Eigen::VectorXd>;
using DenseMatrix = Eigen::Map<Eigen::MatrixXd>;

/// Gauss's elimination with partial pivoting in the memory of the matrix: the right side becomes the
/// solution, not finite where the matrix is singular.
void solve_in_place(DenseMatrix& matrix, DenseVector& right) {
  const Eigen::Index count = right.size();
  for (Eigen::Index k = 0; k < count; ++k) {
    Eigen::Index pivot = 0;
    matrix.col(k).tail(count - k).cwiseAbs().maxCoeff(&pivot);
    matrix.row(k).swap(matrix.row(k + pivot));
    std::swap(right[k], right[k + pivot]);
    for (Eigen::Index i = k + 1; i < count; ++i) {
      const double factor = matrix(i, k) / matrix(k, k);
      matrix.row(i).tail(count - k - 1) -= factor * matrix.row(k).tail(count - k - 1);
      right[i] -= factor * right[k];
    }
  }
  for (Eigen::Index k = count; k-- > 0;) {
    for (Eigen::Index j = k + 1; j < count; ++j) right[k] -= matrix(k, j) * right[j];
    right[k] /= matrix(k, k);
  }
}

}  // namespace

bool advance_trapezoidal(double step, const double* z0, const double* rates0, InternalRates rates_at_end,
                         double* z, std::size_t number, double* memory) {
  constexpr int most_steps = 50;
  // Changes of this part of the variables are their rounding.
  constexpr double negligible = 1e-15;
  constexpr double difference = 1e-7;  // relative, for one-sided differences

  const auto count = static_cast<Eigen::Index>(number);
  const double half = 0.5 * step;
  const Eigen::Map<const Eigen::VectorXd> start(z0, count), start_rates(rates0, count);
  DenseVector now(z, count);
  DenseVector rates(memory, count), moved(rates.data() + count, count), gap(moved.data() + count, count);
  DenseMatrix slope(gap.data() + count, count, count);
  double last = 0.0;
  for (int i = 0; i < most_steps; ++i) {
    rates_at_end(z, rates.data());
    gap = now - start - half * (start_rates + rates);
    if (!gap.allFinite()) return false;
    slope.setIdentity();
    for (Eigen::Index column = 0; column < count; ++column) {
      const double kept = now[column];
      const double size = std::max({std::abs(kept), std::abs(z0[column]), half * std::abs(rates[column])});
      const double move = size > 0.0 ? difference * size : difference;
      now[column] = kept + move;
      rates_at_end(z, moved.data());
      now[column] = kept;
      slope.col(column) -= half / move * (moved - rates);
    }
    solve_in_place(slope, gap);
    const auto& change = gap;
    if (!change.allFinite()) return false;
    now -= change;
    const double size = now.lpNorm<Eigen::Infinity>() + start.lpNorm<Eigen::Infinity>();
    const double changed = change.lpNorm<Eigen::Infinity>();
    // Rounding of the rates may keep the change above that of the variables: then it stops shrinking.
    constexpr double nearly = 1e-9;
    if (changed <= negligible * size || (i > 1 && changed >= last && changed <= nearly * size)) return true;
    last = changed;
  }
  return false;
}

}  // namespace carom
