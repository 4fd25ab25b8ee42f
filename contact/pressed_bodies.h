#pragma once

/// \file
/// Causes of a contact problem without an answer, for errors of both modes: obstacles whose motion leaves
/// bodies no room, masses that differ by more than numbers have digits for, friction in joints that grows
/// with the force that it causes.

#include <carom/contact/island_problem.h>
#include <carom/core/export.h>
#include <carom/core/system.h>

#include <algorithm>
#include <limits>
#include <span>
#include <string>

namespace carom {

/// Masses of some bodies, least and largest [kg].
struct MassRange {
  double least = std::numeric_limits<double>::infinity();
  double most = 0.0;

  /// Takes one more.
  void add(double mass) {
    least = std::min(least, mass);
    most = std::max(most, mass);
  }
};

/// Text that an error adds of contacts whose problem has no answer: the obstacles that move along the normal
/// of one of them, by Constraint::surface_velocity_after, and the remedies; empty where none moves so.
[[nodiscard]] CAROM_API std::string pressed_by(const System& system, std::span<const Constraint> contacts);
/// Text that an error adds of contacts whose problem is not solved, or has no answer: the shapes on ground
/// whose surfaces run along bodies, and the remedies, where there are two and more contacts; empty where none
/// runs.
[[nodiscard]] CAROM_API std::string carried_by(const System& system, std::span<const Constraint> contacts);
/// Text that an error adds of a contact problem: by how much the masses of its bodies differ, where that
/// leaves a light body between heavy ones few digits (its acceleration is the difference of forces that are
/// as much larger); else empty.
[[nodiscard]] CAROM_API std::string uneven_masses(const IslandProblem& problem);
/// Text that an error adds where unequal masses may be its cause: by how much the masses of some bodies
/// differ, where that leaves a light body between heavy ones few digits; else empty.
[[nodiscard]] CAROM_API std::string uneven_masses(const MassRange& masses);

/// Says that bounds of friction in joints and the forces that they follow from come to no end, and why.
inline constexpr const char* unsettled_friction =
    "friction in joints and the forces that bound it do not settle (allowed: coefficients, friction times "
    "radius of a pin, below the arms of loads and contacts about it; beyond, friction may grow with the "
    "force "
    "that it causes)";

}  // namespace carom
