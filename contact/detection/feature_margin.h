#pragma once

/// \file
/// Which feature of a convex outline is nearest to a vertex of another body, and how far the vertex is from
/// where that changes.
///
/// The normal of such a contact is continuous there, the rate at which it turns is not: the forces of a
/// contact that lasts have a kink or a jump, over which no step of an integrator may pass.

#include <carom/contact/detection/body_outlines.h>
#include <carom/contact/detection/contact_pair.h>
#include <carom/core/assembly.h>
#include <carom/core/evaluation.h>
#include <carom/core/export.h>
#include <carom/core/ids.h>
#include <carom/core/state.h>

namespace carom {

/// Distance of a vertex from the border of the region in which a feature is the nearest one.
struct FeatureMargin {
  double value = 0.0;   ///< positive inside [m]
  double rate = 0.0;    ///< its rate [m/s]
  Index beyond = none;  ///< the feature beyond the border
};

/// The features of the outline of a pair, as ConvexOutline counts them, seen from the vertex of the pair.
class CAROM_API FeatureRegions {
public:
  /// All must outlive it. \param pair of two bodies \param evaluation position group up to date
  FeatureRegions(const Assembly& assembly, const BodyOutlines& outlines, const ContactPair& pair,
                 const StateView& state, const Evaluation& evaluation);

  /// True if there is more than one feature.
  [[nodiscard]] bool has_several() const { return outline_.size() > 1; }
  /// True if a feature is an edge.
  [[nodiscard]] bool is_edge(Index feature) const { return outline_.is_edge(feature); }
  /// The nearest feature.
  [[nodiscard]] Index nearest() const;
  /// Margin of a feature.
  [[nodiscard]] FeatureMargin margin(Index feature) const;

private:
  ConvexOutline outline_;  // in the frame of its body,
  Vec<2> place_, rate_;    // as the vertex and its velocity
};

}  // namespace carom
