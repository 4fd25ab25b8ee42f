#pragma once

/// \file
/// How deep two outlines come into each other on a path.
///
/// The gap of two convex sets is the distance between them, or minus the least way that separates them. Apart
/// by g along a normal n they stay apart for at least g/c, c the largest rate at which they come nearer along
/// n: that of their translation, and for each turning one the size of its spin times the reach of its
/// vertices. So looks from one such time to the next miss nothing (conservative advancement: B. Mirtich,
/// Impulse-based Dynamic Simulation of Rigid Body Systems, Berkeley 1996, chapter 2). Inside a circle, which
/// is not convex from within, c is the whole rate of the translation. The gap of a vertex and an outline
/// (first_closing.h) does not tell depths: a vertex that has come through the middle is nearer to the far
/// side.

#include <carom/contact/detection/detector.h>
#include <carom/contact/detection/first_closing.h>
#include <carom/contact/detection/gap_point.h>
#include <carom/contact/detection/state_path.h>
#include <carom/contact/detection/swept_pairs.h>
#include <carom/core/export.h>

#include <array>
#include <optional>
#include <vector>

namespace carom {

/// Searches paths for depths. Keeps memory.
class CAROM_API OutlineDepth {
public:
  /// \param detector must outlive it
  explicit OutlineDepth(const Detector& detector) : detector_(&detector) {}

  /// The gap of two outlines where a path begins [m]; infinite where they do not face each other.
  [[nodiscard]] double gap_at_begin(const StatePath& path, const NearOutlines& of);
  /// The gap of two outlines where a path ends [m]; infinite where they do not face each other.
  [[nodiscard]] double gap_at_end(const StatePath& path, const NearOutlines& of);
  /// The first time at which two outlines have a gap down to a level, found at a gap down to `fine` below
  /// that; infinity: never. \param level < 0 [m] \param fine > 0 [m] \param until later times are of no
  /// interest [s]
  [[nodiscard]] double first(StatePath& path, const NearOutlines& of, double level, double fine,
                             double until);
  /// Name of the contact of two outlines where the path begins; they must face each other there.
  [[nodiscard]] ConstraintKey key_at_begin(const StatePath& path, const NearOutlines& of);

private:
  [[nodiscard]] std::optional<GapPoint> look(const NearOutlines& of, const PathSample& at);
  [[nodiscard]] double approach(const StatePath& path, const NearOutlines& of, const Vec<2>& normal) const;

  const Detector* detector_;
  std::array<std::vector<Vec<2>>, 2> placed_;  // vertices of both
};

}  // namespace carom
