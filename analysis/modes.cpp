// Problem: small motions about a state of rest.

#include <carom/analysis/modes.h>
#include <carom/analysis/resting_model.h>
#include <carom/core/assembly.h>
#include <carom/core/errors.h>
#include <carom/core/numerics/sparse_factors.h>
#include <carom/core/part_check.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

namespace carom {

namespace {

using Eigen::MatrixXd;
using Eigen::VectorXcd;
using Eigen::VectorXd;

// Unsymmetric parts of the stiffness this small, and squared frequencies this small against the largest one,
// are rounding and errors of differences.
constexpr double symmetric = 1e-8;
constexpr double nothing = 1e-12;

double largest_entry(const MatrixXd& numbers) {
  return numbers.size() > 0 ? numbers.cwiseAbs().maxCoeff() : 0.0;
}

void check(const ModesOptions& options) {
  const auto refuse = [](const char* option, double value, const char* allowed) {
    throw ModelError(std::string("modes: ") + option + " is " + to_text(value) + "; allowed: " + allowed);
  };
  if (!(std::isfinite(options.contact_tolerance) && options.contact_tolerance >= 0.0)) {
    refuse("contact_tolerance", options.contact_tolerance, "finite and >= 0 m");
  }
  if (!(std::isfinite(options.tolerance) && options.tolerance > 0.0)) {
    refuse("tolerance", options.tolerance, "finite and > 0");
  }
}

/// Demands closed joints and balance.
void check_rest(const RestingModel& model, double scale, double tolerance) {
  const VectorXd left = model.left();
  Eigen::Index worst = 0;
  if (left.size() > 0 && left.cwiseAbs().maxCoeff(&worst) > tolerance * scale) {
    throw ModelError("modes: " + model.body_name(worst) + " is out of balance by " +
                     to_text(std::abs(left[worst])) + " N; allowed: a state of equilibrium");
  }
  for (Eigen::Index row = 0; row < model.constraints().gaps().size(); ++row) {
    if (std::abs(model.gap(row)) <= tolerance * model.size()) continue;
    throw ModelError("modes: " + model.constraints().row_name(row) + " is off by " + to_text(model.gap(row)) +
                     "; allowed: a state that obeys joints and contacts");
  }
}

/// Gives a shape unit mass (its coordinates y have unit length) and turns its largest number to the real
/// side.
VectorXcd finished(const MatrixXd& directions, const VectorXcd& y) {
  VectorXcd shape = directions * (y / y.norm());
  Eigen::Index most = 0;
  const double size = shape.cwiseAbs().maxCoeff(&most);
  shape *= std::conj(shape[most]) / size;
  return shape;
}

void add_conservative(const Linearisation& of, std::vector<VibrationMode>& modes) {
  const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(0.5 * (of.stiffness + of.stiffness.transpose()));
  if (solver.info() != Eigen::Success) throw SolverError("modes: eigenvalues were not found", {});
  const double most = solver.eigenvalues().cwiseAbs().maxCoeff();
  for (Eigen::Index i = 0; i < solver.eigenvalues().size(); ++i) {
    const double squared = solver.eigenvalues()[i];
    VibrationMode mode;
    if (std::abs(squared) > nothing * most) {
      mode.eigenvalue = squared > 0.0 ? std::complex<double>(0.0, std::sqrt(squared))
                                      : std::complex<double>(std::sqrt(-squared), 0.0);
    }
    mode.shape = finished(of.directions, solver.eigenvectors().col(i).cast<std::complex<double>>());
    modes.push_back(std::move(mode));
  }
}

void add_general(const Linearisation& of, std::vector<VibrationMode>& modes) {
  const Eigen::Index size = of.stiffness.rows();
  MatrixXd companion = MatrixXd::Zero(2 * size, 2 * size);
  companion.topRightCorner(size, size).setIdentity();
  companion.bottomLeftCorner(size, size) = -of.stiffness;
  companion.bottomRightCorner(size, size) = -of.damping;
  const Eigen::EigenSolver<MatrixXd> solver(companion);
  if (solver.info() != Eigen::Success) throw SolverError("modes: eigenvalues were not found", {});
  for (Eigen::Index i = 0; i < 2 * size; ++i) {
    const std::complex<double> eigenvalue = solver.eigenvalues()[i];
    if (eigenvalue.imag() < 0.0) continue;
    const VectorXcd vector = solver.eigenvectors().col(i);
    // Velocities are eigenvalue times displacements: of motions that fade at once these are the larger ones.
    const VectorXcd y =
        std::abs(eigenvalue) > 1.0 ? VectorXcd(vector.tail(size)) : VectorXcd(vector.head(size));
    modes.push_back({eigenvalue, finished(of.directions, y)});
  }
}

}  // namespace

Linearisation linearise(const Assembly& assembly, const State& state, const ModesOptions& options) {
  check(options);
  for (std::size_t i = 0; i < state.v.size(); ++i) {
    if (state.v[i] == 0.0) continue;
    RestingModel model(assembly, state, options.contact_tolerance, "modes");  // refuses what is no state
    throw ModelError("modes: " + model.body_name(static_cast<Eigen::Index>(i)) + " moves with " +
                     to_text(state.v[i]) + " m/s or rad/s; allowed: a state of rest");
  }
  RestingModel model(assembly, state, options.contact_tolerance, "modes");
  model.balance();
  MatrixXd by_position, by_velocity;
  model.differentiate(by_position, by_velocity);
  const double force = std::max(largest_entry(model.loads()),
                                largest_entry(model.constraints().rows().transpose() * model.multipliers()));
  check_rest(model, std::max(force, largest_entry(by_position) * model.size()), options.tolerance);
  model.check_supports(options.tolerance * force);

  // x = L^-T z with M = L L^T: directions that the rows leave, orthonormal in z.
  const Eigen::LLT<MatrixXd> mass(model.mass());
  const Eigen::Index size = model.lengths().size();
  MatrixXd free = MatrixXd::Identity(size, size);
  if (model.constraints().rows().rows() > 0) {
    Eigen::ColPivHouseholderQR<MatrixXd> qr;
    MatrixXd columns = mass.matrixL().solve(MatrixXd(model.constraints().rows().transpose()));
    for (Eigen::Index i = 0; i < columns.cols(); ++i) {
      if (columns.col(i).norm() > 0.0) columns.col(i).normalize();
    }
    qr.setThreshold(std::sqrt(dependent_pivot));
    qr.compute(columns);
    const MatrixXd all = qr.householderQ() * free;
    free = all.rightCols(size - qr.rank());
  }
  const MatrixXd directions = mass.matrixU().solve(free);
  Linearisation result;
  result.directions = model.lengths().cwiseInverse().asDiagonal() * directions;
  result.stiffness = -directions.transpose() * by_position * directions;
  result.damping = -directions.transpose() * by_velocity * directions;
  const MatrixXd skew = result.stiffness - result.stiffness.transpose();
  result.conservative = !(largest_entry(result.damping) > 0.0) &&
                        largest_entry(skew) <= symmetric * largest_entry(result.stiffness);
  return result;
}

std::vector<VibrationMode> find_modes(const Linearisation& linearisation) {
  std::vector<VibrationMode> modes;
  if (linearisation.stiffness.size() == 0) return modes;
  if (linearisation.conservative) {
    add_conservative(linearisation, modes);
  } else {
    add_general(linearisation, modes);
  }
  std::stable_sort(modes.begin(), modes.end(), [](const VibrationMode& a, const VibrationMode& b) {
    return std::abs(a.eigenvalue) < std::abs(b.eigenvalue);
  });
  return modes;
}

std::vector<VibrationMode> find_modes(const Assembly& assembly, const State& state,
                                      const ModesOptions& options) {
  return find_modes(linearise(assembly, state, options));
}

}  // namespace carom
