#pragma once

/// \file
/// Features of the bodies of an assembly that can touch: rounded points of their shapes, and the centres of
/// bodies without extent. Collected once.

#include <carom/core/assembly.h>
#include <carom/core/constraint.h>
#include <carom/core/contact_filter.h>
#include <carom/core/export.h>

#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace carom {

/// A rounded point of a body.
struct BodyFeature {
  Index body = none;               ///< in the order of assembly
  Index material = none;           ///< number in BodyFeatures::materials()
  FeatureKey key;                  ///< identity
  std::array<double, 3> centre{};  ///< in the body's frame, from the centre of mass [m]
  double radius = 0.0;             ///< [m]

  /// The feature of a body which touches at its centre of mass. \param place of the body in the order of
  /// assembly
  [[nodiscard]] static BodyFeature at_centre(const BodySlot& body, Index place, Index material) {
    return {place, material, {FeatureKey::Owner::body, body.serial, 0}, {}, 0.0};
  }
};

/// Material and filter of features: what laws of contact depend on. In place of a material, numbers of
/// features name both.
struct FeatureMaterial {
  MaterialId material{};   ///< may be no material
  ContactFilter filter{};  ///< what features of it may touch
  friend bool operator==(const FeatureMaterial&, const FeatureMaterial&) = default;
};

/// Neighbouring bodies of one kind that touch at their centres of mass, or with one rounded point each around
/// them; of one component, or uncoupled; all with the same filter.
struct CentreRun {
  Range bodies;           ///< in the order of assembly
  Index material = none;  ///< number in BodyFeatures::materials(), of those without extent
  Index points = none;    ///< the first of their rounded points, which follow one another; `none`: no extent
  double radius = 0.0;    ///< the largest [m]
  ContactFilter filter{};

  /// Distance of a centre, beyond which no gap of its point is <= `margin` [m].
  [[nodiscard]] double reach(double margin) const {
    if (points == none) return margin;
    // No distance less its radius is missed by the rounding of this sum.
    constexpr double slack = 4.0 * std::numeric_limits<double>::epsilon();
    return margin + (radius + slack * (std::abs(margin) + radius));
  }
};

/// All features that can touch, ordered by body.
class CAROM_API BodyFeatures {
public:
  /// Ranges of centres() that have bodies of some components, and of the points() of these.
  struct OfComponents {
    Range centres, points;
  };

  /// Of nothing that can touch.
  BodyFeatures() = default;
  /// Of all bodies.
  explicit BodyFeatures(const Assembly& assembly);

  /// Bodies that touch at their centres.
  [[nodiscard]] const std::vector<CentreRun>& centres() const { return centres_; }
  /// Rounded points of shapes.
  [[nodiscard]] const std::vector<BodyFeature>& points() const { return points_; }
  /// Ranges of centres() and points() that consecutive components have.
  [[nodiscard]] OfComponents of(Range components) const {
    if (of_component_.empty()) return {};
    const OfComponents &first = of_component_[components.begin], &last = of_component_[components.end - 1];
    return {{first.centres.begin, last.centres.end}, {first.points.begin, last.points.end}};
  }
  /// Materials that features have, each with every filter that they have with it.
  [[nodiscard]] const std::vector<FeatureMaterial>& materials() const { return materials_; }
  /// The first feature of a material.
  [[nodiscard]] FeatureKey first_of(Index material, const Layout& layout) const;
  /// True of one of the points() that does not belong to centres().
  [[nodiscard]] bool is_beside_centres(const BodyFeature& point) const;
  /// True if a point stands off the centre of mass.
  [[nodiscard]] bool any_off_centre() const;

private:
  [[nodiscard]] Index number_of(const FeatureMaterial& material);
  void collect_points(const Assembly& assembly);
  void collect_centres(const Assembly& assembly);

  std::vector<CentreRun> centres_;
  std::vector<BodyFeature> points_;
  std::vector<FeatureMaterial> materials_;
  std::vector<OfComponents> of_component_;  // empty where nothing was collected
};

}  // namespace carom
