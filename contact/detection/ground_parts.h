#pragma once

/// \file
/// Shapes on ground in the plane beside the half-plane, at rest or moved as prescribed: terrain, the inside
/// of a box and of a circle, which are solid on one side; a wall, a block, a peg, which are solids.
///
/// Points, discs, segments and convex polygons of bodies touch them, in both modes. All have in common:
/// `surface_speed` is the velocity of the surface along itself, of a conveyor, which moves what rubs on it
/// but not the shape; `motion` moves `pivot` and turns the shape about it.

#include <carom/contact/detection/prescribed_motion.h>
#include <carom/core/contact_filter.h>
#include <carom/core/export.h>
#include <carom/core/ground_shape_kind.h>
#include <carom/core/part.h>
#include <carom/core/space.h>

#include <limits>
#include <string_view>
#include <vector>

namespace carom::planar {

/// Straight faces one after the other, solid on one side. Bodies slide across the corners where faces join
/// without a snag. If it is open, the solid has
/// a side at each end, at a right angle and `depth` high; below that it has no surface.
struct CAROM_API Terrain {
  static constexpr Role role = Role::obstacle;
  static constexpr std::string_view label = "terrain";
  /// Its type, for System::add().
  [[nodiscard]] static PartType<GroundShapeKind> part_type();

  std::vector<Vec<2>>
      vertices{};  ///< the solid is on the right of who walks along them: below, from left to right [m]
  /// > 0: how far below its faces the ground is solid; less than it is thick anywhere, since what is deeper
  /// than this behind a face does not touch it [m].
  double depth = std::numeric_limits<double>::quiet_NaN();
  bool is_closed = false;         ///< the last vertex is joined to the first
  MaterialId material{};          ///< for laws between materials
  double surface_speed = 0.0;     ///< of a conveyor; positive to the right of who stands on it [m/s]
  Vec<2> pivot = filled<2>(0.0);  ///< point about which it turns [m]
  PrescribedMotion motion{};      ///< of `pivot`, and about it; empty: at rest
  ContactFilter filter{};         ///< what it may touch

  /// Its boundary. Throws ModelError for invalid values.
  [[nodiscard]] std::vector<GroundPiece> pieces(const PartCheck& check) const;
};

/// Everything outside a rectangle is solid.
struct CAROM_API BoxInside {
  static constexpr Role role = Role::obstacle;
  static constexpr std::string_view label = "inside of a box";
  /// Its type, for System::add().
  [[nodiscard]] static PartType<GroundShapeKind> part_type();

  Vec<2> lower =
      filled<2>(std::numeric_limits<double>::quiet_NaN());  ///< corner with the least coordinates [m]
  Vec<2> upper = filled<2>(std::numeric_limits<double>::quiet_NaN());  ///< corner with the largest [m]
  MaterialId material{};                                               ///< for laws between materials
  double surface_speed = 0.0;     ///< of a conveyor; positive to the right of who stands on it [m/s]
  Vec<2> pivot = filled<2>(0.0);  ///< point about which it turns [m]
  PrescribedMotion motion{};      ///< of `pivot`, and about it; empty: at rest
  ContactFilter filter{};         ///< what it may touch

  /// Its boundary. Throws ModelError for invalid values.
  [[nodiscard]] std::vector<GroundPiece> pieces(const PartCheck& check) const;
};

/// Everything outside a circle is solid: a drum.
struct CAROM_API CircleInside {
  static constexpr Role role = Role::obstacle;
  static constexpr std::string_view label = "inside of a circle";
  /// Its type, for System::add().
  [[nodiscard]] static PartType<GroundShapeKind> part_type();

  Vec<2> centre = filled<2>(0.0);                            ///< [m]
  double radius = std::numeric_limits<double>::quiet_NaN();  ///< > 0 [m]
  MaterialId material{};                                     ///< for laws between materials
  double surface_speed = 0.0;     ///< of a conveyor; positive to the right of who stands on it [m/s]
  Vec<2> pivot = filled<2>(0.0);  ///< point about which it turns [m]
  PrescribedMotion motion{};      ///< of `pivot`, and about it; empty: at rest
  ContactFilter filter{};         ///< what it may touch

  /// Its boundary. Throws ModelError for invalid values.
  [[nodiscard]] std::vector<GroundPiece> pieces(const PartCheck& check) const;
};

/// A straight wall with round ends, touched from all sides.
struct CAROM_API Wall {
  static constexpr Role role = Role::obstacle;
  static constexpr std::string_view label = "wall";
  /// Its type, for System::add().
  [[nodiscard]] static PartType<GroundShapeKind> part_type();

  Vec<2> from = filled<2>(std::numeric_limits<double>::quiet_NaN());  ///< one end [m]
  Vec<2> to = filled<2>(std::numeric_limits<double>::quiet_NaN());    ///< the other end [m]
  double radius =
      std::numeric_limits<double>::quiet_NaN();  ///< > 0: half its thickness, without which points pass [m]
  MaterialId material{};                         ///< for laws between materials
  double surface_speed = 0.0;     ///< of a conveyor; positive to the right of who stands on it [m/s]
  Vec<2> pivot = filled<2>(0.0);  ///< point about which it turns [m]
  PrescribedMotion motion{};      ///< of `pivot`, and about it; empty: at rest
  ContactFilter filter{};         ///< what it may touch

  /// Its boundary. Throws ModelError for invalid values.
  [[nodiscard]] std::vector<GroundPiece> pieces(const PartCheck& check) const;
};

/// A convex polygon on ground, sharp or rounded.
struct CAROM_API Block {
  static constexpr Role role = Role::obstacle;
  static constexpr std::string_view label = "block";
  /// Its type, for System::add().
  [[nodiscard]] static PartType<GroundShapeKind> part_type();

  std::vector<Vec<2>> vertices{};  ///< at least three, convex, in either orientation [m]
  double radius = 0.0;             ///< >= 0: widens it all around, with rounded corners [m]
  MaterialId material{};           ///< for laws between materials
  double surface_speed = 0.0;      ///< of a conveyor; positive to the right of who stands on it [m/s]
  Vec<2> pivot = filled<2>(0.0);   ///< point about which it turns [m]
  PrescribedMotion motion{};       ///< of `pivot`, and about it; empty: at rest
  ContactFilter filter{};          ///< what it may touch

  /// Its boundary. Throws ModelError for invalid values.
  [[nodiscard]] std::vector<GroundPiece> pieces(const PartCheck& check) const;
};

/// A disc on ground.
struct CAROM_API Peg {
  static constexpr Role role = Role::obstacle;
  static constexpr std::string_view label = "peg";
  /// Its type, for System::add().
  [[nodiscard]] static PartType<GroundShapeKind> part_type();

  Vec<2> centre = filled<2>(0.0);                            ///< [m]
  double radius = std::numeric_limits<double>::quiet_NaN();  ///< > 0 [m]
  MaterialId material{};                                     ///< for laws between materials
  double surface_speed = 0.0;     ///< of a conveyor; positive to the right of who stands on it [m/s]
  Vec<2> pivot = filled<2>(0.0);  ///< point about which it turns [m]
  PrescribedMotion motion{};      ///< of `pivot`, and about it; empty: at rest
  ContactFilter filter{};         ///< what it may touch

  /// Its boundary. Throws ModelError for invalid values.
  [[nodiscard]] std::vector<GroundPiece> pieces(const PartCheck& check) const;
};

}  // namespace carom::planar
