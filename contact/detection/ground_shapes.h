#pragma once

/// \file
/// Shapes on ground of a model: where they are at a time, and how far from them points of bodies are.

#include <carom/contact/detection/gap_point_half_space.h>
#include <carom/contact/detection/ground_jump.h>
#include <carom/core/constraint.h>
#include <carom/core/discontinuity.h>
#include <carom/core/export.h>
#include <carom/core/ground_shape_kind.h>

#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace carom {

class System;

/// Where the moving shapes on ground are at one time. A workspace that GroundShapes::place() fills.
class GroundPlaces {
public:
  /// The time; NaN before it was ever filled [s].
  [[nodiscard]] double time() const { return time_; }

private:
  friend class GroundShapes;
  double time_ = std::numeric_limits<double>::quiet_NaN();
  std::vector<GroundMotion> motions_;  // of the shapes that move, in their order
};

/// A shape on ground at the end of a time step.
struct GroundAtEnd {
  const GroundMotion* motion = nullptr;  ///< null: the shape is at rest, or no time passes
  double step = 0.0;                     ///< length of the step [s]
};

/// Shapes on ground, by number in the order in which they were added. Motions that it is asked with are null
/// for shapes at rest.
class CAROM_API GroundShapes {
public:
  /// \param system outlives it
  explicit GroundShapes(const System& system);

  /// Number of shapes.
  [[nodiscard]] Index size() const { return static_cast<Index>(shapes_.size()); }
  /// True if there is none.
  [[nodiscard]] bool empty() const { return shapes_.empty(); }
  /// Number of a shape by its serial number; `none` if it is not there.
  [[nodiscard]] Index find(Index serial) const;
  /// Identity of a shape.
  [[nodiscard]] ObstacleId id(Index shape) const;
  /// Groups that a shape may touch.
  [[nodiscard]] ContactFilter filter(Index shape) const {
    return shapes_[shape].kind->filter(shapes_[shape].slot);
  }
  /// A shape as feature of a contact.
  [[nodiscard]] FeatureKey key(Index shape) const {
    return {FeatureKey::Owner::obstacle, shapes_[shape].serial, 0};
  }
  /// True if outlines of bodies touch a shape (GroundShapeKind::pieces).
  [[nodiscard]] bool has_pieces(Index shape) const { return shapes_[shape].has_pieces; }
  /// True if the boundary of a shape without pieces is flat.
  [[nodiscard]] bool is_flat(Index shape) const { return shapes_[shape].is_flat; }
  /// Velocity of a conveyor's surface along itself [m/s].
  [[nodiscard]] double surface_speed(Index shape) const { return shapes_[shape].surface_speed; }
  /// True if a shape moves.
  [[nodiscard]] bool moves(Index shape) const { return shapes_[shape].moving != none; }
  /// True if any does.
  [[nodiscard]] bool any_moves() const { return moving_ > 0; }

  /// Says where the moving shapes are at a time; does nothing if `places` already says so for these shapes.
  /// Throws SolverError, naming the shape, where a prescribed motion is not finite.
  void place(double time, GroundPlaces& places) const;
  /// Motion of a shape that moves, at a time [s]. Throws SolverError, naming the shape, where the prescribed
  /// motion is not finite.
  [[nodiscard]] GroundMotion motion(Index shape, double time) const;
  /// Motion of any shape, as place() found it.
  [[nodiscard]] const GroundMotion* motion(Index shape, const GroundPlaces& places) const {
    const Index moving = shapes_[shape].moving;
    return moving == none ? nullptr : &places.motions_[moving];
  }
  /// Demands that no shape jumps between two times. Throws SolverError naming the shape, the time, and by how
  /// much it jumps (core/law_jump.h).
  void demand_continuous(const GroundPlaces& before, const GroundPlaces& after) const;
  /// Lists the jumps of velocities behind one time and up to another, ascending [s]. Throws as motion().
  void list_jumps(double from, double to, std::vector<GroundJump>& out) const;
  /// Times at which motions are not smooth, in the order of shapes. Made at each call.
  [[nodiscard]] std::vector<Discontinuity> discontinuities() const;

  /// Distance of a point from a shape.
  [[nodiscard]] Gap gap(Index shape, const GroundMotion* motion, const double* point) const {
    const Shape& at = shapes_[shape];
    return motion == nullptr ? at.kind->gap(at.slot, point) : at.kind->moved_gap(at.slot, *motion, point);
  }
  /// Demands a distance that is a number, and a normal of length 1: shapes of users may tell anything. Throws
  /// SolverError naming the shape. \param point finite, where it was asked for \param time [s]
  void demand_numbers(Index shape, const Gap& gap, const double* point, double time) const {
    constexpr double exact = 1e-6;  // of the square of the length
    const double square =
        gap.normal[0] * gap.normal[0] + gap.normal[1] * gap.normal[1] + gap.normal[2] * gap.normal[2];
    const bool is_number = gap.distance >= std::numeric_limits<double>::lowest();
    if (!is_number || !(std::abs(square - 1.0) <= exact)) refuse(shape, gap, point, time);
  }
  /// Which of up to 64 points are at a distance <= `margin` [m] from a shape: bit i of the point number i.
  [[nodiscard]] std::uint64_t points_within(Index shape, const GroundMotion* motion, const PointRow& row,
                                            double margin) const {
    const Shape& at = shapes_[shape];
    if (motion == nullptr) return at.kind->points_within(at.slot, row, margin);
    return at.kind->points_within_moved(at.slot, *motion, row, margin);
  }

private:
  [[noreturn]] void refuse(Index shape, const Gap& gap, const double* point, double time) const;

  struct Shape {
    const GroundShapeKind* kind;
    Index slot;
    Index serial;
    Index moving;  // its number among those that move; `none`: at rest
    double surface_speed;
    bool has_pieces;
    bool is_flat;
  };

  const System* system_;
  std::vector<Shape> shapes_;
  Index moving_ = 0;                              // shapes that move
  std::vector<std::pair<double, Index>> breaks_;  // times at which motions are not smooth, of which shape
};

}  // namespace carom
