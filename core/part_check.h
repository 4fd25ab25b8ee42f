#pragma once

/// \file
/// Checks of a part as it enters a system. A failed check throws a ModelError that names the part, the
/// quantity, its value and what is allowed.

#include <carom/core/export.h>
#include <carom/core/ids.h>

#include <span>
#include <string>
#include <string_view>
#include <utility>

namespace carom {

class System;
struct ContactFilter;
struct Surface;

/// The shortest text of a number that reads back to the same double.
[[nodiscard]] CAROM_API std::string to_text(double value);

/// Numbers that describe parts, states and options are not larger than this in magnitude: their squares, and
/// products of two of them, stay within the range of double.
inline constexpr double largest_magnitude = 1e150;

/// True for a finite number of a magnitude up to largest_magnitude.
[[nodiscard]] constexpr bool is_admissible(double value) {
  return value >= -largest_magnitude && value <= largest_magnitude;
}

/// Numbers allowed in the place of one that was refused, as a message says it: `allowed`, unless the number
/// is finite and too large.
[[nodiscard]] CAROM_API std::string allowed_instead(double value, std::string_view allowed);

/// Text for a body that is refused: its name, and that it was removed, if it was.
[[nodiscard]] CAROM_API std::string refused_name(const System& system, BodyId id);
/// Text for a force element that is refused: its name, and that it was removed, if it was.
[[nodiscard]] CAROM_API std::string refused_name(const System& system, ElementId id);
/// Text for a joint that is refused: its name, and that it was removed, if it was.
[[nodiscard]] CAROM_API std::string refused_name(const System& system, JointId id);
/// Text for a shape that is refused: its name, and that it was removed, if it was.
[[nodiscard]] CAROM_API std::string refused_name(const System& system, ShapeId id);
/// Text for a shape on ground that is refused: its name, and that it was removed, if it was.
[[nodiscard]] CAROM_API std::string refused_name(const System& system, ObstacleId id);

/// Checks one part. `part` is the text by which messages name it, e.g. "particle 'upper'".
class CAROM_API PartCheck {
public:
  PartCheck(std::string part, const System& system) : part_(std::move(part)), system_(&system) {}

  /// Name of the part in messages.
  [[nodiscard]] const std::string& part() const { return part_; }
  /// The system it enters, without the part.
  [[nodiscard]] const System& system() const { return *system_; }

  /// Throws the ModelError "<part>: <quantity> is <value>; allowed: <allowed>".
  [[noreturn]] void refuse(std::string_view quantity, std::string_view value, std::string_view allowed) const;

  /// Demands a finite number of a magnitude up to largest_magnitude.
  void finite(double value, std::string_view quantity, std::string_view unit) const;
  /// Demands finite numbers of a magnitude up to largest_magnitude.
  void finite(std::span<const double> values, std::string_view quantity, std::string_view unit) const;
  /// Demands a finite number > 0.
  void positive(double value, std::string_view quantity, std::string_view unit) const;
  /// Demands a finite number >= 0.
  void non_negative(double value, std::string_view quantity, std::string_view unit) const;
  /// Demands the numbers of a direction, whose length does not matter: finite, of any magnitude.
  void direction(std::span<const double> values, std::string_view quantity) const;
  /// Demands a number in [lower, upper].
  void between(double value, double lower, double upper, std::string_view quantity) const;
  /// Demands times that are finite and ascending.
  void breaks(std::span<const double> times, std::string_view quantity) const;
  /// Demands valid coefficients of a contact law.
  void surface(const Surface& surface) const;
  /// Demands a body of this system (or `ground` where `may_be_ground`).
  void body(BodyId id, std::string_view quantity, bool may_be_ground) const;
  /// Demands a body of this system that has an orientation.
  void oriented_body(BodyId id, std::string_view quantity) const;
  /// Demands two ends that are not on one body and not both on the ground.
  void different_ends(BodyId from, BodyId to) const;
  /// Demands a material of this system, or none.
  void material(MaterialId id) const;
  /// Demands a filter that leaves something to touch: at least one group in each of its sets.
  void filter(const ContactFilter& filter) const;

private:
  std::string part_;
  const System* system_;
};

}  // namespace carom
