#pragma once

/// \file
/// Convex outlines of the bodies of an assembly, which bodies may touch each other with. Collected once.

#include <carom/contact/detection/convex_outline.h>
#include <carom/contact/detection/outline_features.h>
#include <carom/core/assembly.h>
#include <carom/core/constraint.h>
#include <carom/core/contact_filter.h>
#include <carom/core/evaluation.h>
#include <carom/core/export.h>
#include <carom/core/space.h>
#include <carom/core/state.h>

#include <span>
#include <vector>

namespace carom {

/// A convex outline fixed to a body: a point, a disc, a capsule or a polygon.
struct BodyOutline : OutlineFeatures {
  Index body = none;      ///< in the order of assembly
  Index material = none;  ///< number among body_materials()
  ContactFilter filter;   ///< what it may touch
  double radius = 0.0;    ///< rounding radius [m]
  double reach = 0.0;     ///< radius of a circle around the centre of mass that holds it [m]

  /// True of a point without radius. Two of them do not touch each other.
  [[nodiscard]] bool is_point() const { return vertices.size() == 1 && radius == 0.0; }
  /// True if it has sides: a polygon that is not rounded.
  [[nodiscard]] bool has_sides() const { return vertices.size() > 2 && radius == 0.0; }
};

/// All outlines, ordered by body.
class CAROM_API BodyOutlines {
public:
  /// Of nothing that can touch.
  BodyOutlines() = default;
  /// Of all bodies of the plane. Throws ModelError for a polygon that is not convex.
  explicit BodyOutlines(const Assembly& assembly);

  [[nodiscard]] bool empty() const { return list_.empty(); }                    ///< true if there is none
  [[nodiscard]] const std::vector<BodyOutline>& list() const { return list_; }  ///< all outlines
  /// Vertices of all outlines in the frames of their bodies, from the centres of mass [m].
  [[nodiscard]] std::span<const Vec<2>> vertices() const { return vertices_; }
  /// Place of the outline of a vertex.
  [[nodiscard]] Index outline_of(Index vertex) const { return outline_of_[vertex]; }
  /// An outline in the frame of its body.
  [[nodiscard]] ConvexOutline described(const BodyOutline& outline) const {
    return {vertices().subspan(outline.vertices.begin, outline.vertices.size()), outline.radius};
  }
  /// True if a vertex stands off the centre of mass.
  [[nodiscard]] bool any_off_centre() const;
  /// True if those of lesser keys come first.
  [[nodiscard]] bool are_in_order_of_keys() const { return in_order_of_keys_; }
  /// Place of the outline of a key; `none` if there is none.
  [[nodiscard]] Index find(const FeatureKey& key) const;

  /// Writes the vertices of an outline where its body is. The position group of `evaluation` must be up to
  /// date. \param out as many points as it has vertices
  void place(const BodyOutline& outline, const BodySlot& body, const StateView& state,
             const Evaluation& evaluation, Vec<2>* out) const;

private:
  void add(BodyOutline outline, std::span<const Vec<2>> vertices);

  std::vector<BodyOutline> list_;
  std::vector<Vec<2>> vertices_;
  std::vector<Index> outline_of_;  // by vertex
  // First outlines of bodies that touch at their centres, and of shapes, by serial number; none: it has none.
  std::vector<Index> of_body_, of_shape_;
  bool in_order_of_keys_ = true;
};

}  // namespace carom
