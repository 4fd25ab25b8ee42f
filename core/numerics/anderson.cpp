// Problem: find a fixed point in fewer evaluations than by plain iteration.

#include <carom/core/numerics/anderson.h>

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include <algorithm>

namespace carom {

void AndersonAcceleration::start(std::size_t size) {
  size_ = size;
  known_ = 0;
  f_.resize(size);
  g_.resize(size);
  f_steps_.resize(depth * size);
  g_steps_.resize(depth * size);
}

void AndersonAcceleration::next(std::span<double> x, std::span<const double> g,
                                std::span<const double> weights) {
  using Small = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, depth, depth>;
  using SmallVector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, depth, 1>;
  // Differences that depend on each other up to this part of their size add nothing but rounding.
  constexpr double independent = 1e-14;

  const bool first = known_ == 0;
  const std::size_t slot = first ? 0 : (known_ - 1) % depth;
  double* const f_step = f_steps_.data() + slot * size_;
  double* const g_step = g_steps_.data() + slot * size_;
  for (std::size_t i = 0; i < size_; ++i) {
    const double f = weights[i] * (g[i] - x[i]);
    if (!first) {
      f_step[i] = f - f_[i];
      g_step[i] = g[i] - g_[i];
    }
    f_[i] = f;
    g_[i] = g[i];
  }
  const auto count = static_cast<Eigen::Index>(std::min(known_, depth));
  ++known_;
  std::copy(g.begin(), g.end(), x.begin());
  if (count == 0) return;

  const auto vector = [this](const std::vector<double>& ring, Eigen::Index j) {
    return Eigen::Map<const Eigen::VectorXd>(ring.data() + static_cast<std::size_t>(j) * size_,
                                             static_cast<Eigen::Index>(size_));
  };
  const Eigen::Map<const Eigen::VectorXd> f(f_.data(), static_cast<Eigen::Index>(size_));
  Small gram(count, count);
  SmallVector right(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    for (Eigen::Index j = 0; j <= i; ++j) {
      gram(i, j) = gram(j, i) = vector(f_steps_, i).dot(vector(f_steps_, j));
    }
    right[i] = vector(f_steps_, i).dot(f);
  }
  // Scaled to a unit diagonal; a vanishing difference drops out.
  SmallVector scale(count);
  for (Eigen::Index i = 0; i < count; ++i) scale[i] = gram(i, i) > 0.0 ? 1.0 / std::sqrt(gram(i, i)) : 0.0;
  Small scaled = scale.asDiagonal() * gram * scale.asDiagonal();
  scaled.diagonal().array() += independent;
  for (Eigen::Index i = 0; i < count; ++i) {
    if (scale[i] == 0.0) scaled(i, i) = 1.0;
  }
  const Eigen::LLT<Small> factor(scaled);
  if (factor.info() != Eigen::Success) return;
  const SmallVector weighted = scale.cwiseProduct(right);
  const SmallVector coefficients = scale.cwiseProduct(factor.solve(weighted));
  if (!coefficients.allFinite()) return;
  Eigen::Map<Eigen::VectorXd> result(x.data(), static_cast<Eigen::Index>(size_));
  for (Eigen::Index j = 0; j < count; ++j) result -= coefficients[j] * vector(g_steps_, j);
}

}  // namespace carom
