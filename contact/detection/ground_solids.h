#pragma once

/// \file
/// Convex solids on ground, at rest or moved as prescribed: a wall, a block, a peg.

#include <carom/contact/detection/ground_piece_shapes.h>
#include <carom/contact/detection/prescribed_motion.h>
#include <carom/core/export.h>
#include <carom/core/part.h>
#include <carom/core/space.h>

#include <limits>
#include <string_view>
#include <vector>

namespace carom::planar {

/// A straight wall that is touched from both sides; with a radius it is thick, with round ends.
struct CAROM_API Wall {
  static constexpr Role role = Role::obstacle;
  static constexpr std::string_view label = "wall";
  using Kind = generic::PieceShapeKind<Wall>;

  Vec<2> from = Vec<2>::Constant(std::numeric_limits<double>::quiet_NaN());  ///< one end [m]
  Vec<2> to = Vec<2>::Constant(std::numeric_limits<double>::quiet_NaN());    ///< the other end [m]
  double radius = 0.0;                                                       ///< >= 0 [m]
  MaterialId material{};                                                     ///< for laws between materials
  double surface_speed = 0.0;     ///< of a conveyor; positive to the right of who stands on it [m/s]
  Vec<2> pivot = Vec<2>::Zero();  ///< point about which it turns [m]
  PrescribedMotion motion{};      ///< of `pivot`, and about it; empty: at rest

  /// Its boundary. Throws ModelError for invalid values.
  [[nodiscard]] std::vector<GroundPiece> pieces(const PartCheck& check) const;
};

/// A convex polygon on ground, sharp or rounded.
struct CAROM_API Block {
  static constexpr Role role = Role::obstacle;
  static constexpr std::string_view label = "block";
  using Kind = generic::PieceShapeKind<Block>;

  std::vector<Vec<2>> vertices{};  ///< at least three, convex, in either orientation [m]
  double radius = 0.0;             ///< >= 0: widens it all around, with rounded corners [m]
  MaterialId material{};           ///< for laws between materials
  double surface_speed = 0.0;      ///< of a conveyor; positive to the right of who stands on it [m/s]
  Vec<2> pivot = Vec<2>::Zero();   ///< point about which it turns [m]
  PrescribedMotion motion{};       ///< of `pivot`, and about it; empty: at rest

  /// Its boundary. Throws ModelError for invalid values.
  [[nodiscard]] std::vector<GroundPiece> pieces(const PartCheck& check) const;
};

/// A disc on ground.
struct CAROM_API Peg {
  static constexpr Role role = Role::obstacle;
  static constexpr std::string_view label = "peg";
  using Kind = generic::PieceShapeKind<Peg>;

  Vec<2> centre = Vec<2>::Zero();                            ///< [m]
  double radius = std::numeric_limits<double>::quiet_NaN();  ///< > 0 [m]
  MaterialId material{};                                     ///< for laws between materials
  double surface_speed = 0.0;     ///< of a conveyor; positive to the right of who stands on it [m/s]
  Vec<2> pivot = Vec<2>::Zero();  ///< point about which it turns [m]
  PrescribedMotion motion{};      ///< of `pivot`, and about it; empty: at rest

  /// Its boundary. Throws ModelError for invalid values.
  [[nodiscard]] std::vector<GroundPiece> pieces(const PartCheck& check) const;
};

}  // namespace carom::planar
