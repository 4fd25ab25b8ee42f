#pragma once

/// \file
/// Small vibrations about a state of rest: linearisation, eigenfrequencies, mode shapes. With displacements
/// V y that satisfy joints and closed contacts, V^T M V = 1,
///
///     y'' + D y' + K y = 0,   D = -V^T df/dv V,   K = -V^T d(f + G^T l)/dq V,
///
/// where the rows G and their forces l are those of equilibrium.h. Closed contacts are constraints: normals,
/// and the tangents of those with friction, which stick while motions are small.

#include <carom/core/export.h>
#include <carom/core/state.h>

#include <Eigen/Core>

#include <complex>
#include <vector>

namespace carom {

class Assembly;

/// Options of the linearisation about a state.
struct ModesOptions {
  double contact_tolerance = 1e-6;  ///< contacts with gaps up to this are closed, >= 0 [m]
  /// Forces that may be out of balance against those that act, and gaps of joints against coordinates (at
  /// least 1 m); motions are right to about this. > 0
  double tolerance = 1e-6;
};

/// A model linearised about a state of rest. n velocities, m degrees of freedom.
struct Linearisation {
  Eigen::MatrixXd directions;  ///< V, n x m [by sqrt(kg)]: displacements of all bodies
  Eigen::MatrixXd damping;     ///< D, m x m [1/s]
  Eigen::MatrixXd stiffness;   ///< K, m x m [1/s^2]
  /// True if there is neither damping nor an unsymmetric part of the stiffness (follower loads).
  bool conservative = true;
};

/// A mode: displacements shape * exp(eigenvalue * t). Of a conjugate pair the one that turns forward.
struct VibrationMode {
  std::complex<double> eigenvalue;  ///< [1/s], imaginary part >= 0
  Eigen::VectorXcd shape;           ///< n numbers, shape^H M shape = 1, the largest one real and > 0

  /// Angular frequency [rad/s]; 0 of a motion that creeps, grows or runs free.
  [[nodiscard]] double frequency() const { return eigenvalue.imag(); }
  /// Part of critical damping, 1 and more for motions that creep, negative for those that grow; 0 of free
  /// ones.
  [[nodiscard]] double damping_ratio() const {
    const double size = std::abs(eigenvalue);
    return size > 0.0 ? -eigenvalue.real() / size : 0.0;
  }
};

/// Linearises about a state of rest. Throws ModelError for options, elements (with internal variables) or a
/// state that is not allowed: one in motion, or not in equilibrium; SolverError for a contact that would pull
/// or slip.
[[nodiscard]] CAROM_API Linearisation linearise(const Assembly& assembly, const State& state,
                                                const ModesOptions& options = {});

/// Modes, by the size of their eigenvalues. Conservative: one for every degree of freedom, those that grow
/// (unstable equilibrium) with their real eigenvalue > 0; what is below rounding of the largest is 0, a free
/// motion. Else: one for every conjugate pair and every real eigenvalue. Throws SolverError where eigenvalues
/// are not found.
[[nodiscard]] CAROM_API std::vector<VibrationMode> find_modes(const Linearisation& linearisation);
/// Modes of linearise(assembly, state, options), by the size of their eigenvalues; throws the errors of that
/// and of the function for a linearisation.
[[nodiscard]] CAROM_API std::vector<VibrationMode> find_modes(const Assembly& assembly, const State& state,
                                                              const ModesOptions& options = {});

}  // namespace carom
