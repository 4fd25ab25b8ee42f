#pragma once

/// \file
/// A contact: which features meet, how deep, and the map from body velocities to contact velocities.

#include <carom/core/export.h>
#include <carom/core/ids.h>
#include <carom/core/surface.h>

#include <array>
#include <cmath>
#include <compare>
#include <cstdint>
#include <string_view>

namespace carom {

/// One feature of something that can touch.
struct FeatureKey {
  /// What the feature belongs to.
  enum class Owner : std::uint8_t { body, shape, obstacle, joint };

  Owner owner = Owner::body;  ///< what it belongs to
  Index serial = none;        ///< serial number of the owner
  Index feature = 0;          ///< number of the feature within its owner
  friend auto operator<=>(const FeatureKey&, const FeatureKey&) = default;
};

/// Identity of a contact, of a stop of a joint or of friction in one (then both features are that's): it keys
/// reports, modes and warm starts and survives edits and checkpoints.
struct ContactKey {
  FeatureKey of;       ///< feature of the body or shape
  FeatureKey against;  ///< feature of the obstacle
  friend auto operator<=>(const ContactKey&, const ContactKey&) = default;
};

/// State of one planar contact after its problem is solved.
enum class ContactMode : std::uint8_t {
  open,           ///< no impulse
  stick,          ///< mean tangential velocity zero
  slip_positive,  ///< mean tangential velocity > 0, friction -mu P_n
  slip_negative,  ///< mean tangential velocity < 0, friction +mu P_n
  slip            ///< slipping in the plane of a spatial contact
};

/// Name of a mode: "open", "stick", "slip+", "slip-", "slip".
[[nodiscard]] CAROM_API std::string_view to_string(ContactMode mode);

/// A contact of a body with an obstacle, or a stop of a joint between two bodies, at one configuration. Row 0
/// is the normal direction (from the obstacle into free space), the others are tangential (in the plane: the
/// normal turned clockwise).
///
/// Dry friction in a joint is a contact that never opens: row 1 is the rate of the joint's coordinate, row 0
/// is empty and stands for a force that is known.
struct Contact {
  static constexpr int max_rows = 3;
  static constexpr int max_columns = 6;

  ContactKey key;               ///< identity
  Index body = none;            ///< in the order of assembly
  Index v = 0;                  ///< first velocity of the body
  int columns = 0;              ///< velocities of the body
  Index other_v = 0;            ///< of a stop: first velocity of the second body
  int other_columns = 0;        ///< its velocities; 0 where there is no second body
  int rows = 0;                 ///< 2 in the plane and of friction in a joint, 3 in space, 1 of a stop
  Index dry_friction = none;    ///< of friction in a joint: its number in the detector
  double friction_bound = 0.0;  ///< then: `friction` times this is the largest force [N, N m] or impulse
  double gap = 0.0;             ///< negative where violated [m]
  /// Of a lasting contact that turning has opened: the normal velocity that would close it within the step,
  /// with which it may still approach at its end [m/s]. Else 0.
  double allowed_approach = 0.0;
  Surface law;  ///< coefficients
  /// The coefficient of friction that acts: law.friction_at() the sliding speed found, in time stepping
  /// law.sticking_friction() where it stuck in the step before.
  double friction = 0.0;
  std::array<double, static_cast<std::size_t>(max_rows* max_columns)>
      jacobian{};  ///< row-major, stride max_columns, the second body's columns behind those of the first
  std::array<double, static_cast<std::size_t>(max_rows)>
      obstacle_velocity{};  ///< of the obstacle where it is touched, along the rows [m/s]
  std::array<double, static_cast<std::size_t>(max_rows)>
      drift{};  ///< rate of the contact velocity at constant velocities of the body [m/s^2]
  std::array<double, static_cast<std::size_t>(max_rows)>
      obstacle_velocity_after{};  ///< of the same place of the obstacle at the end of a time step; else the
                                  ///< same as obstacle_velocity [m/s]

  /// True of friction in a joint.
  [[nodiscard]] bool has_dry_friction() const { return dry_friction != none; }
  /// First row that is one.
  [[nodiscard]] int begin_row() const { return has_dry_friction() ? 1 : 0; }
  /// Row of the map from the body's velocities to the contact velocity.
  [[nodiscard]] const double* row(int i) const { return jacobian.data() + max_columns * i; }
  [[nodiscard]] double* row(int i) { return jacobian.data() + max_columns * i; }
  /// Row i times numbers of the body. \param numbers an array over all velocities
  [[nodiscard]] double times(int i, const double* numbers) const {
    double sum = 0.0;
    for (int c = 0; c < columns; ++c) sum += row(i)[c] * numbers[v + static_cast<Index>(c)];
    for (int c = 0; c < other_columns; ++c) {
      sum += row(i)[columns + c] * numbers[other_v + static_cast<Index>(c)];
    }
    return sum;
  }
  /// Adds row i, transposed, times a number. \param out an array over all velocities
  void add_transposed(int i, double factor, double* out) const {
    for (int c = 0; c < columns; ++c) out[v + static_cast<Index>(c)] += factor * row(i)[c];
    for (int c = 0; c < other_columns; ++c) {
      out[other_v + static_cast<Index>(c)] += factor * row(i)[columns + c];
    }
  }
  /// Contact velocity along row i: of the body against the obstacle. \param velocities of all bodies
  [[nodiscard]] double velocity(int i, const double* velocities) const {
    return times(i, velocities) - obstacle_velocity[static_cast<std::size_t>(i)];
  }
  /// Sum of the magnitudes that the contact velocity along row i is the sum of [m/s]: what its rounding is
  /// to be measured with. \param velocities of all bodies
  [[nodiscard]] double speed(int i, const double* velocities) const {
    double sum = std::abs(obstacle_velocity[static_cast<std::size_t>(i)]);
    for (int c = 0; c < columns; ++c) sum += std::abs(row(i)[c] * velocities[v + static_cast<Index>(c)]);
    for (int c = 0; c < other_columns; ++c) {
      sum += std::abs(row(i)[columns + c] * velocities[other_v + static_cast<Index>(c)]);
    }
    return sum;
  }
  /// Speed of sliding [m/s]. \param velocities of all bodies
  [[nodiscard]] double sliding_speed(const double* velocities) const {
    const double along = velocity(1, velocities);
    return rows == 2 ? std::abs(along) : std::hypot(along, velocity(2, velocities));
  }
  /// Contact velocity along row i after the time step or impact. \param velocities of all bodies, then
  [[nodiscard]] double velocity_after(int i, const double* velocities) const {
    return times(i, velocities) - obstacle_velocity_after[static_cast<std::size_t>(i)];
  }
  /// Rate of the contact velocity along row i. \param accelerations of all bodies
  [[nodiscard]] double acceleration(int i, const double* accelerations) const {
    return times(i, accelerations) + drift[static_cast<std::size_t>(i)];
  }
};

}  // namespace carom
