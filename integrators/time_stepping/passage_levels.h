#pragma once

/// \file
/// How deep a pair may come on the way of a step: less deep than it takes to leave the other thing on its far
/// side (OverlapRules::never_tunnel; TimeStepping::impacts).
///
/// A body that passes through a thing is in it for at least the radii of the largest circles in both. An
/// eighth of these is as deep as it may come. Ground without a far side (the outside of a box or of a circle,
/// terrain of any depth) cannot be left, but a step may end far in it: it counts with none, so that how deep
/// a body may come depends on the body alone.

#include <carom/contact/detection/detector.h>
#include <carom/contact/detection/swept_pairs.h>
#include <carom/core/export.h>

#include <cstdint>
#include <vector>

namespace carom {

/// Which passages are looked for.
enum class Passages : std::uint8_t {
  all,          ///< nothing may be deep in anything
  of_far_sides  ///< ground without a far side is left out
};

/// Depths by pair. Made once for a model of the plane.
class CAROM_API PassageLevels {
public:
  /// \param least_depth stands for the thickness of points and bare segments [m]
  PassageLevels(const Detector& detector, double least_depth, Passages which);

  /// How deep two outlines may come into each other, beyond their depth at the start; infinite where neither
  /// can be passed [m].
  [[nodiscard]] double allowed(const NearOutlines& of) const;
  /// Less than any two may come deep; infinite if nothing can be passed [m].
  [[nodiscard]] double thinnest() const { return thinnest_; }
  /// The largest distance of vertices from the centre of mass, by body [m].
  [[nodiscard]] const std::vector<double>& reaches() const { return reach_; }

private:
  const Detector* detector_;
  double least_depth_;
  double thinnest_;
  std::vector<double> circle_;     // radius of a circle in each outline of a body [m]
  std::vector<double> of_ground_;  // in each on ground; infinite of one that is not looked for [m]
  std::vector<double> reach_;
};

}  // namespace carom
