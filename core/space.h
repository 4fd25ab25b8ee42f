#pragma once

/// \file
/// Differences between the plane and space: rotation, spin, lever, tangents. Everything else in the library
/// is written once.
///
/// Coordinates of a body begin with the position of its centre of mass (D numbers), its velocities with the
/// velocity of the centre of mass; a body with an orientation appends orientation and spin.

#include <carom/core/export.h>

#include <Eigen/Core>

#include <array>
#include <cmath>

namespace carom {

/// Small vector without alignment demands, so that it may cross the library's boundary.
template <int D>
using Vec = Eigen::Matrix<double, D, 1, Eigen::DontAlign>;

/// Small matrix without alignment demands.
template <int Rows, int Columns = Rows>
using Mat = Eigen::Matrix<double, Rows, Columns, Eigen::DontAlign>;

/// A vector of equal numbers, as a default of members. Eigen's own, Vec<D>::Constant(), is an expression that
/// every program would compile anew.
template <int D>
[[nodiscard]] Vec<D> filled(double value) {
  Vec<D> vector;
  for (int i = 0; i < D; ++i) vector.data()[i] = value;
  return vector;
}
/// A square matrix of equal numbers, as a default of members.
template <int D>
[[nodiscard]] Mat<D> filled_matrix(double value) {
  Mat<D> matrix;
  for (int i = 0; i < D * D; ++i) matrix.data()[i] = value;
  return matrix;
}

template <int D>
struct Space;

/// The plane. Angles in radians, counter-clockwise positive.
template <>
struct Space<2> {
  static constexpr int dimension = 2;
  static constexpr bool has_orientation = true;  ///< bodies may have an orientation
  static constexpr int spin_size = 1;            ///< the angular velocity
  static constexpr int rotation_size = 2;        ///< cosine and sine of the angle
  static constexpr int tangents = 1;

  /// Writes cosine and sine of the angle.
  static void rotation(const double* orientation, double* out) {
    out[0] = std::cos(orientation[0]);
    out[1] = std::sin(orientation[0]);
  }
  /// Vector fixed to the body, seen from the fixed frame.
  static Vec<2> rotate(const double* rotation, const Vec<2>& local) {
    return {rotation[0] * local[0] - rotation[1] * local[1], rotation[1] * local[0] + rotation[0] * local[1]};
  }
  /// Velocity omega x r of the end of the lever r.
  static Vec<2> lever_velocity(const double* spin, const Vec<2>& r) {
    return {-spin[0] * r[1], spin[0] * r[0]};
  }
  /// Acceleration omega x (omega x r) of the end of the lever r.
  static Vec<2> centripetal(const double* spin, const Vec<2>& r) {
    return {-spin[0] * spin[0] * r[0], -spin[0] * spin[0] * r[1]};
  }
  /// Adds the torque r x f.
  static void add_torque(const Vec<2>& r, const Vec<2>& f, double* torque) {
    torque[0] += r[0] * f[1] - r[1] * f[0];
  }
  /// Orientation after the rotation vector `delta` (spin times time).
  static void advance_orientation(const double* from, const double* delta, double* to) {
    to[0] = from[0] + delta[0];
  }
  /// Angle of the turn under which levers move by delta x (mean lever).
  static double rational_turn(double delta) { return 2.0 * std::atan(0.5 * delta); }
  /// Tangent of a contact: the normal turned clockwise by 90 degrees (Johansson 1999, figure 1).
  static std::array<Vec<2>, 1> tangent_frame(const Vec<2>& n) { return {Vec<2>(n[1], -n[0])}; }
  /// Writes the row of a contact velocity a.(v + omega x r) with respect to the spin.
  static void spin_row(const Vec<2>& a, const Vec<2>& r, double* row) { row[0] = r[0] * a[1] - r[1] * a[0]; }
};

/// Space, as far as particles need it.
template <>
struct Space<3> {
  static constexpr int dimension = 3;
  static constexpr bool has_orientation = false;  ///< rigid bodies in space are not there yet
  static constexpr int tangents = 2;

  /// Two tangents of a contact that form a right-handed frame (t1, t2, n); the first lies along the axis
  /// least aligned with the normal.
  CAROM_API static std::array<Vec<3>, 2> tangent_frame(const Vec<3>& n);
};

}  // namespace carom
