#pragma once

/// \file
/// A chain of faces on ground between two concave corners, as a vertex of a body sees it: which of its
/// features is the nearest, and how far the vertex is from where that changes.
///
/// At concave corners the chain ends: there a vertex touches two chains. At flat corners one face follows
/// another without a feature between them. So it is where the chain of another shape goes on: a sharp corner
/// is before both faces there, and comes from one to the other without meeting an end of either.

#include <carom/contact/detection/convex_outline.h>
#include <carom/contact/detection/feature_region.h>
#include <carom/core/export.h>
#include <carom/core/space.h>

#include <cstdint>
#include <span>

namespace carom {

/// Places of a chain where one face ends.
enum class ChainCorner : std::uint8_t {
  convex,   ///< the next face turns to the left
  flat,     ///< the next face goes on in one line
  free,     ///< an end of the chain, where the solid ends at a right angle
  concave,  ///< an end of the chain, where another one begins
  joined    ///< an end of the chain, where that of another shape goes on in one line
};

/// A view of a chain. Features are numbered as those of ConvexOutline.
struct CAROM_API FaceChain {
  /// Feature nearest to a point.
  struct Nearest {
    Index feature = none;
    double distance = 0.0;  ///< negative in the solid [m]
  };

  ConvexOutline outline;                 ///< its vertices; radius 0
  std::span<const ChainCorner> corners;  ///< by vertex
  bool is_closed = false;                ///< the last vertex is joined to the first
  std::span<const double> depths;        ///< by face: what is deeper does not touch it [m]
  FeatureLengths lengths{};              ///< to which features are told apart

  /// Number of faces.
  [[nodiscard]] Index faces() const { return outline.size() - (is_closed ? 0U : 1U); }
  /// The feature nearest to a point, and the distance of the point.
  [[nodiscard]] Nearest nearest(const Vec<2>& point) const;
  /// True of a distance from a face that is deeper than its solid is. \param distance negative behind it [m]
  [[nodiscard]] bool is_below(Index feature, double distance) const {
    return outline.is_edge(feature) && distance < -depths[feature - outline.size()];
  }
  /// Margin of a feature. \param rate velocity of the point
  [[nodiscard]] FeatureMargin margin(Index feature, const Vec<2>& point, const Vec<2>& rate) const;
  /// Distance of a point from where its gap has a kink or jumps, if the feature is the nearest one: margin(),
  /// and for a face its concave ends and the depth of the solid too. A vertex passes these only deep in other
  /// ground, as motion does behind an event that is still to be found [m].
  [[nodiscard]] double clearance(Index feature, const Vec<2>& point) const;
  /// The faces that end and begin at a vertex; `none` where there is none.
  [[nodiscard]] Index face_before(Index vertex) const {
    return !is_closed && vertex == 0 ? none : outline.before(vertex);
  }
  [[nodiscard]] Index face_behind(Index vertex) const {
    return !is_closed && vertex + 1 == outline.size() ? none : vertex;
  }

private:
  [[nodiscard]] bool is_beyond(Index vertex, const OutlineEdge& edge, const Vec<2>& point, bool head) const;
  [[nodiscard]] Vec<2> along_both(Index vertex) const;
  [[nodiscard]] FeatureMargin margin_at(Index vertex, const OutlineEdge& edge, const Vec<2>& point,
                                        const Vec<2>& rate, bool head) const;
};

}  // namespace carom
