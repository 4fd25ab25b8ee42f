// Problem: solve with the rows of joints at two configurations, sparse as their graph.

#include <carom/core/dynamics/mixed_constraints.h>
#include <carom/core/numerics/pivoting_lu.h>

#include <Eigen/SparseCore>

#include <vector>

namespace carom {

namespace {

using Matrix = Eigen::SparseMatrix<double>;

Matrix matrix_of(const JointConstraints& joints) {
  const Range v = joints.velocities();
  std::vector<Eigen::Triplet<double>> numbers;
  for (std::size_t i = 0; i < joints.size(); ++i) {
    const JointRow row = joints.row(i);
    for (int b = 0; b < row.bodies; ++b) {
      const JointRow::Block& block = row.blocks[static_cast<std::size_t>(b)];
      for (int c = 0; c < block.columns; ++c) {
        numbers.emplace_back(static_cast<int>(i), static_cast<int>(block.v - v.begin) + c,
                             block.jacobian[static_cast<std::size_t>(c)]);
      }
    }
  }
  Matrix matrix(static_cast<Eigen::Index>(joints.size()), static_cast<Eigen::Index>(v.size()));
  matrix.setFromTriplets(numbers.begin(), numbers.end());
  return matrix;
}

}  // namespace

struct MixedConstraints::Factors {
  PivotingLu lu;
};

MixedConstraints::MixedConstraints() : factors_(std::make_unique<Factors>()) {}
MixedConstraints::~MixedConstraints() = default;
MixedConstraints::MixedConstraints(MixedConstraints&&) noexcept = default;
MixedConstraints& MixedConstraints::operator=(MixedConstraints&&) noexcept = default;

bool MixedConstraints::factor(const JointConstraints& conditions, const JointConstraints& reactions) {
  // Against the diagonal: what rows that follow from others get as a pivot. A row near a singular position
  // keeps a pivot of the product of two angles from it, which steps leave far larger.
  constexpr double least_pivot = 1e-11;
  const Range v = conditions.velocities();
  std::vector<double> all(v.end, 1.0);
  conditions.apply_inverse_mass(all.data());
  const Eigen::Map<const Eigen::VectorXd> inverse(all.data() + v.begin, static_cast<Eigen::Index>(v.size()));
  const Matrix columns = matrix_of(reactions).transpose();
  Matrix matrix = matrix_of(conditions) * (inverse.asDiagonal() * columns);
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
    double& pivot = matrix.coeffRef(i, i);
    pivot += least_pivot * std::abs(pivot);
  }
  matrix.makeCompressed();
  factors_->lu.analyzePattern(matrix);
  factors_->lu.factorize(matrix);
  return factors_->lu.info() == Eigen::Success;
}

void MixedConstraints::solve(double* r) const {
  Eigen::Map<Eigen::VectorXd> map(r, factors_->lu.rows());
  const Eigen::VectorXd solution = factors_->lu.solve(-map);
  map = solution;
}

}  // namespace carom
