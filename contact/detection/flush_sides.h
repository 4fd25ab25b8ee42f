#pragma once

/// \file
/// Sides of pieces on ground, and what other pieces cover of them (flush_faces.h).

#include <carom/contact/detection/box.h>
#include <carom/contact/detection/flush_faces.h>
#include <carom/core/ids.h>
#include <carom/core/space.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

namespace carom {

/// A length or an angle without bound.
inline constexpr double without_bound = std::numeric_limits<double>::infinity();

/// The third component of a x b.
[[nodiscard]] inline double cross_of_sides(const Vec<2>& a, const Vec<2>& b) {
  return a[0] * b[1] - a[1] * b[0];
}

/// A side of a piece, from `ends[0]` to `ends[1]`, free space on its right.
struct PieceSide {
  Index shape = none;            ///< of the piece
  Index piece = none;            ///< all faces of one shape are one
  std::array<Vec<2>, 2> ends;    ///< as far as no other piece covers it [m]
  std::array<Vec<2>, 2> beyond;  ///< ends of its neighbours, as described; its own where there are none [m]
  Vec<2> along;                  ///< unit vector
  double depth = without_bound;  ///< what is deeper does not touch it [m]
  std::array<Index, 2> next{none,
                            none};  ///< sides of the same piece at its tail and head; `none`: it ends there
  std::array<bool, 2> is_cut{};     ///< other pieces cover the side there
  bool is_hidden = false;           ///< other pieces cover all of it

  /// Length of what is not covered [m].
  [[nodiscard]] double length() const { return along.dot(ends[1] - ends[0]); }
  /// Distance of a point from the line of the side, positive in front of it [m].
  [[nodiscard]] double height(const Vec<2>& point) const {
    return -cross_of_sides(along, Vec<2>(point - ends[0]));
  }
  /// Unit normal, outwards.
  [[nodiscard]] Vec<2> normal() const { return {along[1], -along[0]}; }
};

/// The neighbour that follows at an end of a side.
struct SideFollower {
  Index side = none;              ///< `none`: a line, or nothing
  bool is_foreign = false;        ///< it is of another piece
  bool ends_here = false;         ///< with one of its ends; else it goes through
  double turn = 0.0;              ///< angle of the free space between the two [rad]
  Vec<2> along = Vec<2>::Zero();  ///< unit vector
};

/// The neighbours that follow at the tail and at the head of a side.
using SideFollowers = std::array<SideFollower, 2>;

/// True where a face of another piece follows in one line, or turning to the free side.
[[nodiscard]] inline bool goes_on(const SideFollower& at) {
  constexpr double flat = 1e-9;  // as of a polyline [rad]
  return at.is_foreign && at.turn >= std::numbers::pi - flat;
}

/// A convex set: what is behind all of some lines.
struct SolidPiece {
  Index shape = none, piece = none;  ///< as of PieceSide
  std::vector<GroundLine> lines;     ///< around the set
  Box<2> box;                        ///< infinite of a set without bound [m]
  Index first_side = none;           ///< of a solid, whose sides follow one another; else `none`

  /// True if its box is finite.
  [[nodiscard]] bool is_bounded() const { return std::isfinite((box.max - box.min).sum()); }
  /// Largest height of a point over its lines: negative inside [m].
  [[nodiscard]] double height(const Vec<2>& point) const {
    double most = -without_bound;
    for (const GroundLine& line : lines)
      most = std::max(most, -cross_of_sides(line.along, Vec<2>(point - line.origin)));
    return most;
  }
};

/// How far from each other places are one, on a side of some length [m].
[[nodiscard]] inline double near_places(double length, const Vec<2>& place) {
  constexpr double roundings = 64.0 * std::numeric_limits<double>::epsilon();
  return std::max(flush_part * length, roundings * place.cwiseAbs().maxCoeff());
}

/// The part of a side, from and to a length along it, that is in a solid, or on its boundary back to back;
/// empty where there is none. \param near distance that is none [m]
[[nodiscard]] inline std::pair<double, double> covered_part(const PieceSide& side, const SolidPiece& solid,
                                                            double near) {
  std::pair<double, double> part{0.0, side.length()};
  for (const GroundLine& line : solid.lines) {
    const Vec<2> normal(line.along[1], -line.along[0]);
    const double tail = normal.dot(side.ends[0] - line.origin), head = normal.dot(side.ends[1] - line.origin);
    if (std::abs(tail) <= near && std::abs(head) <= near) {
      if (normal.dot(side.normal()) > 0.0) return {0.0, 0.0};  // both are seen
      continue;
    }
    if (std::min(tail, head) > near) return {0.0, 0.0};
    if (std::max(tail, head) <= near) continue;
    // Where it crosses the line itself: there what follows on the line begins.
    const double at = std::clamp(side.length() * tail / (tail - head), 0.0, side.length());
    (tail > near ? part.first : part.second) =
        tail > near ? std::max(part.first, at) : std::min(part.second, at);
  }
  return part;
}

}  // namespace carom
