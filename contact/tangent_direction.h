#pragma once

/// \file
/// Direction of slip of a contact: a unit vector in its tangent plane, by tangential row.

#include <carom/core/constraint.h>

#include <array>
#include <cmath>
#include <cstddef>

namespace carom {

/// Calls f(k, row) for each tangential row of a constraint: its number among the tangential rows, and among
/// all rows.
template <class F>
void for_tangents(const ConstraintHead& at, F&& f) {
  for (int k = 0; k < at.tangents(); ++k) f(static_cast<std::size_t>(k), at.tangent_row() + k);
}

/// A direction in the tangent plane of a contact, one number for each tangential row: a unit vector, which is
/// +1 or -1 in the plane; zero where there is no direction, as of a contact that sticks. Friction in a joint
/// and rolling resistance have one tangential row, as a contact in the plane.
struct TangentDirection {
  static constexpr std::size_t most_rows = std::size_t{Constraint::max_rows} - 1;

  /// One number for each tangential row.
  using Numbers = std::array<double, most_rows>;

  Numbers along{};  ///< components of the unit vector; 0 behind the last tangential row

  /// Direction of a vector in the tangent plane; zero if the vector is.
  [[nodiscard]] static TangentDirection of(const Numbers& vector) {
    if (vector[1] == 0.0) return of_sign(vector[0]);
    const double length = std::hypot(vector[0], vector[1]);
    return {{vector[0] / length, vector[1] / length}};
  }
  /// Direction along a single tangential row, by the sign of a number; zero if the number is.
  [[nodiscard]] static TangentDirection of_sign(double number) {
    return {{number > 0.0 ? 1.0 : number < 0.0 ? -1.0 : 0.0, 0.0}};
  }
  /// Direction of slip that a mode of the plane says; zero of any other mode.
  [[nodiscard]] static TangentDirection of_mode(ContactMode mode) {
    return {{mode == ContactMode::slip_positive   ? 1.0
             : mode == ContactMode::slip_negative ? -1.0
                                                  : 0.0,
             0.0}};
  }

  /// True if there is no direction.
  [[nodiscard]] bool is_zero() const { return along[0] == 0.0 && along[1] == 0.0; }
  /// Component along a tangential row. \param k number among the tangential rows
  [[nodiscard]] double operator[](std::size_t k) const { return along[k]; }
  /// Mode of a contact that slips in this direction; sticking where there is no direction.
  /// \param tangents number of tangential rows of the contact
  [[nodiscard]] ContactMode mode(int tangents) const {
    if (is_zero()) return ContactMode::stick;
    if (tangents > 1) return ContactMode::slip;
    return along[0] > 0.0 ? ContactMode::slip_positive : ContactMode::slip_negative;
  }
};

/// Component of the tangential velocity along a direction: the sliding speed where that is the direction of
/// slip [m/s]. \param velocities of all bodies
[[nodiscard]] inline double velocity_along(const Constraint& at, const TangentDirection& direction,
                                           const double* velocities) {
  double sum = 0.0;
  for_tangents(at, [&](std::size_t k, int row) { sum += direction[k] * at.velocity(row, velocities); });
  return sum;
}

/// Tangential acceleration, by tangential row [m/s^2]. \param accelerations of all bodies
[[nodiscard]] inline TangentDirection::Numbers tangential_accelerations(const Constraint& at,
                                                                        const double* accelerations) {
  TangentDirection::Numbers numbers{};
  for_tangents(at, [&](std::size_t k, int row) { numbers[k] = at.acceleration(row, accelerations); });
  return numbers;
}

/// Component of the tangential acceleration along a direction [m/s^2]. \param accelerations of all bodies
[[nodiscard]] inline double acceleration_along(const Constraint& at, const TangentDirection& direction,
                                               const double* accelerations) {
  const TangentDirection::Numbers numbers = tangential_accelerations(at, accelerations);
  double sum = 0.0;
  for_tangents(at, [&](std::size_t k, int) { sum += direction[k] * numbers[k]; });
  return sum;
}

}  // namespace carom
