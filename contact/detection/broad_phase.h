#pragma once

/// \file
/// Broad phase: which boxes overlap, of many.
///
/// N boxes have N^2/2 pairs, of which a few N overlap. They are found over a grid (box_grid.h) in O(N). From
/// one call to the next most boxes hardly move: each is kept inside a larger one, and pairs of the larger
/// boxes are kept until some box leaves its own. Until then a call tests those pairs and looks up nothing.
/// The answer is taken from the boxes given alone, so it does not depend on what was kept.

#include <carom/contact/detection/box.h>
#include <carom/contact/detection/box_grid.h>
#include <carom/contact/detection/box_pairs.h>
#include <carom/core/export.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace carom {

/// Finds overlapping boxes. A workspace: what it keeps changes the cost of an answer, not the answer.
template <int D>
class CAROM_API BroadPhase {
public:
  /// Coordinates allowed: no farther from 0 than this [m].
  static constexpr double farthest = 1e150;

  /// Other boxes from now on. \param owners one number per box; boxes of the same owner never pair, except
  /// that `none` owns nothing
  void reset(std::span<const Index> owners);
  /// Other boxes from now on, all of which may pair.
  void reset(Index boxes);

  /// Number of boxes.
  [[nodiscard]] Index size() const { return static_cast<Index>(wide_.size()); }

  /// All pairs of boxes that no axis parts by more than a margin (are_within()) and that have different
  /// owners, sorted by (first, second). Valid until the next call of update() or reset().
  /// Throws ModelError, which names the box, where one is not finite, too far away or has min > max; and
  /// where the number of boxes or the margin is wrong. The next call is not affected. \param boxes as many as
  /// size() \param margin >= 0 [m]
  std::span<const BoxPair> update(std::span<const Box<D>> boxes, double margin = 0.0);

  /// Writes the boxes that no axis parts from a given one by more than a margin, ascending.
  /// \param boxes those of the last update(), which must have succeeded \param box finite
  /// \param margin not above that of the last update() [m]
  void query(std::span<const Box<D>> boxes, const Box<D>& box, double margin, std::vector<Index>& out) const;

private:
  void check(std::span<const Box<D>> boxes, double margin) const;
  [[nodiscard]] bool are_many(std::size_t left) const;
  // Lists the boxes that are outside of theirs, until they are many.
  void find_left(std::span<const Box<D>> boxes, double half);
  void widen(Index i, const Box<D>& box, double half);
  void rebuild(std::span<const Box<D>> boxes, double half);
  // Looks up the boxes that left theirs; the candidates of the others stay.
  void replace_left(std::span<const Box<D>> boxes, double half);
  std::span<const BoxPair> select(std::span<const Box<D>> boxes, double margin);
  // Where the larger box of a box is found: in the grid; it left since and is in the late one; it leaves.
  enum class Place : std::uint8_t { grid, late, left };

  std::vector<OwnedBox<D>> wide_;     // the larger boxes, in the order of boxes
  std::vector<std::uint64_t> since_;  // the call that made each
  std::uint64_t call_ = 0;
  std::vector<Place> state_;
  std::vector<Index> left_;        // boxes outside of theirs in this call
  BoxGrid<D> grid_;                // of the larger boxes when all were looked up
  std::vector<OwnedBox<D>> late_;  // larger boxes made since
  BoxGrid<D> late_grid_;
  BoxPairs candidates_;  // pairs of larger boxes
  BoxPairs found_;       // those of boxes that left
  std::vector<BoxPair> pairs_;
};

extern template class BroadPhase<2>;
extern template class BroadPhase<3>;

}  // namespace carom
