#pragma once

/// \file
/// The outline of a convex piece that goes on in its neighbours, and stays convex.
///
/// The problem: where the tops of two pieces lie in one plane, what slides from one to the other is not to
/// meet the side of the other one. On ground at rest the tops become faces of one polyline (flush_faces.h). A
/// piece that is to touch others which are polylines themselves has to stay a convex outline. So where a
/// neighbour covers all of its side, its top goes on under that of the neighbour, a corner within the
/// neighbour lower by a slope that nothing feels; and where the neighbour covers a part of the side,
/// beginning at the corner, the corner is cut off, so that the side begins below the top, and the neighbour's
/// top goes on to there.

#include <carom/contact/detection/flush_sides.h>
#include <carom/core/ids.h>
#include <carom/core/space.h>

#include <array>
#include <optional>
#include <span>
#include <vector>

namespace carom {

/// The outline of one piece, as all pieces together leave it.
class DrawnOutline {
public:
  /// \param sides of all pieces, and `followers` of each \param solids all pieces \param of the piece at hand
  DrawnOutline(std::span<const PieceSide> sides, std::span<const SideFollowers> followers,
               std::span<const SolidPiece> solids, const SolidPiece& of)
      : sides_(sides), followers_(followers), solids_(solids), of_(&of) {}

  /// Its vertices, counter-clockwise [m]. \param described those that it has without neighbours
  [[nodiscard]] std::vector<Vec<2>> points(std::span<const Vec<2>> described) const;

private:
  [[nodiscard]] bool goes_on_at(Index side, std::size_t end) const;
  void add_corner(Index side, const Vec<2>& described, std::vector<Vec<2>>& out) const;
  void add_end(Index top, std::size_t end, Index side, std::vector<Vec<2>>& out) const;
  void cut_corner(Index top, std::size_t end, Index side, const Vec<2>& corner,
                  std::vector<Vec<2>>& out) const;
  struct Drawn {
    Vec<2> near, far;  // where the face begins to sink, and where it ends
  };
  [[nodiscard]] std::optional<Drawn> drawn(Index top, std::size_t end, const PieceSide& hidden) const;

  std::span<const PieceSide> sides_;
  std::span<const SideFollowers> followers_;
  std::span<const SolidPiece> solids_;
  const SolidPiece* of_;
};

}  // namespace carom
