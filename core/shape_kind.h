#pragma once

/// \file
/// Interface of a kind of shapes: fixed to bodies, or to the ground (core/ground_shape_kind.h).

#include <carom/core/contact_filter.h>
#include <carom/core/export.h>
#include <carom/core/fingerprint.h>
#include <carom/core/ids.h>
#include <carom/core/space.h>

#include <array>
#include <memory>
#include <string_view>
#include <vector>

namespace carom {

/// A point fixed to a body with a radius: a place where a convex shape can touch a half-plane on ground.
struct RoundedPoint {
  std::array<double, 3> centre{};  ///< in the body's frame, from the centre of mass [m]
  double radius = 0.0;             ///< [m]
};

/// A convex set in the plane: the hull of its vertices, widened by a radius. One vertex: a point or a disc;
/// two: a segment or a capsule; more: a polygon, its vertices counter-clockwise, each of them a corner.
struct Outline {
  std::vector<Vec<2>> vertices{};  ///< in the body's frame, from the centre of mass [m]
  double radius = 0.0;             ///< >= 0 [m]
};

class PartCheck;

/// All shapes of one kind.
class CAROM_API ShapeKind {
public:
  virtual ~ShapeKind() = default;
  [[nodiscard]] virtual std::unique_ptr<ShapeKind> clone() const = 0;  ///< a copy
  virtual void remove(Index slot) = 0;  ///< removes a shape; later ones move up

  [[nodiscard]] virtual std::string_view label() const = 0;         ///< name used in messages
  [[nodiscard]] virtual int dimension() const = 0;                  ///< 2 or 3
  [[nodiscard]] virtual Index size() const = 0;                     ///< number of shapes
  [[nodiscard]] virtual BodyId body(Index slot) const = 0;          ///< the body it is fixed to, or `ground`
  [[nodiscard]] virtual MaterialId material(Index slot) const = 0;  ///< its material
  /// Groups that it may touch. The fingerprint of a system takes it from here.
  [[nodiscard]] virtual ContactFilter filter(Index /*slot*/) const { return {}; }
  /// Appends the points that may touch a shape on ground, in a fixed order (their places are feature
  /// numbers).
  virtual void rounded_points(Index slot, std::vector<RoundedPoint>& out) const = 0;
  /// Appends the convex sets with which a shape touches other bodies, in a fixed order; none: it touches
  /// none. Vertices are in an order of their own, not in that of rounded_points(). Throws ModelError by
  /// `check` for a shape that is not convex.
  virtual void outlines(Index /*slot*/, const PartCheck& /*check*/, std::vector<Outline>& /*out*/) const {}
  /// Adds all data that distinguish the shapes of this kind (except functions).
  virtual void fingerprint(Fingerprint& print) const = 0;
};

}  // namespace carom
