#pragma once

/// \file
/// A contact that stays closed for a while: its mode, its forces, and the equation that a force is found by.

#include <carom/contact/detection/detector.h>
#include <carom/contact/solvers/contact_mode.h>
#include <carom/contact/tangent_direction.h>
#include <carom/core/constraint.h>
#include <carom/core/export.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace carom {

/// A contact in a smooth phase; or friction in a joint; or the rolling resistance of the contact before it in
/// a list, which sticks where the relative spin is held and slips where it rolls.
struct ActiveContact {
  ContactPair pair;                       ///< what touches
  Index place = none;                     ///< of the pair in a list of all, where there is one
  ContactMode mode = ContactMode::stick;  ///< stick, slip+ or slip-; slip of a contact in space
  /// Direction of slip of a contact in space whose mode is `slip`. In the plane the mode says it.
  TangentDirection direction_in_space;
  /// Of two bodies: the feature of the outline that the vertex is nearest to in this phase; `none` if there
  /// is but one.
  Index feature = none;
  bool frictionless = false;  ///< without friction: neither sticks nor cares which way it slips
  SingleConstraint at;        ///< at the present configuration
  double friction = 0.0;      ///< coefficient: sliding where it slips, static where it sticks
  /// Force; of friction in a joint OfJoint::friction_bound; of rolling resistance that of its contact [N].
  double normal = 0.0;
  /// Force by tangential row; of friction in a joint along its coordinate; of rolling resistance the moment
  /// over its arm (Constraint::OfJoint::length) [N].
  TangentDirection::Numbers tangential{};
  /// False where forces were shared out and it is at its end by chance: others set the margin.
  bool sets_margin = true;

  /// True if the tangent is a constraint.
  [[nodiscard]] bool sticks() const { return mode == ContactMode::stick; }
  /// Factor that makes a normal force of distances from the edge of friction, for moments against rolling
  /// too.
  [[nodiscard]] double margin_scale() const { return at.attached ? 1.0 / friction : 1.0; }
  /// The least of its normal force and, where it sticks, its distance from the edge of friction [N].
  [[nodiscard]] double margin() const {
    const double edge = sticks() ? margin_scale() * (friction * normal - tangential_force()) : normal;
    return at.normals == 0 ? edge : std::min(normal, edge);
  }
  /// Direction of the sliding velocity; zero if it sticks.
  [[nodiscard]] TangentDirection slip_direction() const {
    return mode == ContactMode::slip ? direction_in_space : TangentDirection::of_mode(mode);
  }
  /// Force of sliding friction along a tangential row by normal force: -mu times the direction of slip; zero
  /// if it sticks. \param k number among the tangential rows
  [[nodiscard]] double friction_ratio(std::size_t k) const { return -slip_direction()[k] * friction; }
  /// Sets the tangential force to sliding friction, which opposes slip with the size mu N.
  void set_sliding_friction() {
    for_tangents(at, [this](std::size_t k, int) { tangential[k] = friction_ratio(k) * normal; });
  }
  /// Size of the tangential force [N].
  [[nodiscard]] double tangential_force() const {
    return tangential[1] == 0.0 ? std::abs(tangential[0]) : std::hypot(tangential[0], tangential[1]);
  }
  /// Adds its force to loads. \param loads of all velocities
  void add_force(double* loads) const {
    if (at.normals > 0) at.add_transposed(0, normal, loads);
    for_tangents(at, [&](std::size_t k, int row) { at.add_transposed(row, tangential[k], loads); });
  }
  /// The coefficient of friction at a configuration and velocities of all bodies. A step may look beyond the
  /// end of sliding: the curve goes on smoothly there.
  [[nodiscard]] double friction_at(const Constraint& where, const double* velocities) const;
};

/// Numbers of the force of a contact in a list: the normal one, then one for each tangential row.
inline constexpr std::size_t numbers_of_force = 1 + TangentDirection::most_rows;

/// One of the equations that forces of closed contacts were found by, and the force that it was solved for.
struct ContactPivot {
  /// A direction of a contact.
  struct Row {
    std::size_t contact = 0;  ///< its place in the list
    bool tangent = false;     ///< the tangent if it sticks; else the normal
  };
  Row equation;  ///< whose acceleration vanishes
  Row force;     ///< that of a normal pushes in the direction of the cone of friction where the contact slips
};

}  // namespace carom
