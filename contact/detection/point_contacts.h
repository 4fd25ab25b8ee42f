#pragma once

/// \file
/// Contacts of bodies with shapes on ground: all pairs of a rounded point and a shape whose gap is closed.

#include <carom/contact/detection/body_features.h>
#include <carom/contact/detection/contact_laws.h>
#include <carom/contact/detection/contact_pair.h>
#include <carom/contact/detection/contact_query.h>
#include <carom/contact/detection/contact_rows.h>
#include <carom/contact/detection/ground_shapes.h>
#include <carom/contact/detection/touched_ground.h>
#include <carom/core/assembly.h>
#include <carom/core/constraint_set.h>
#include <carom/core/export.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace carom {

/// Centres of neighbouring bodies, and a shape that they, or points around them, may touch.
struct CentreRow {
  Index shape = 0;     ///< number of the shape
  Index q = 0;         ///< first coordinate of the first body
  Index stride = 0;    ///< numbers from one body to the next
  Index count = 0;     ///< of bodies
  double reach = 0.0;  ///< no contact has a gap <= 0 whose centre is farther away [m]
};

/// Features of the bodies of an assembly, and the shapes on ground without pieces that they may touch.
class CAROM_API PointContacts {
public:
  /// Throws ModelError where a feature and a shape on ground, of whatever kind, have no contact law.
  /// \param assembly outlives it \param shapes,laws of the assembly, outlive it
  PointContacts(const Assembly& assembly, const GroundShapes& shapes, const ContactLaws& laws);

  /// Facts of the laws with all shapes on ground.
  [[nodiscard]] const LawFacts& law_facts() const { return touched_.facts(); }
  /// True if find() looks at the rotations of bodies.
  [[nodiscard]] bool needs_rotations() const { return needs_rotations_; }

  /// Appends the contacts of consecutive components that a query asks for, ordered by body, feature and
  /// shape.
  void find(Range components, const ContactQuery& query, ConstraintSet& out) const;
  /// False if surely find() finds none.
  [[nodiscard]] bool any_near(Range components, const ContactQuery& query) const;
  /// All rows of centres: together they have all bodies that touch. Made at each call. \param margin largest
  /// gap of what touches [m]
  [[nodiscard]] std::vector<CentreRow> centre_rows(double margin) const;
  /// True if these tell what may touch: all shapes that are touched off the centres are flat.
  [[nodiscard]] bool centres_tell() const;
  /// False if surely no contact of a row, whose shape is at rest, has a gap up to the margin. \param q all
  /// coordinates
  [[nodiscard]] bool may_touch(const CentreRow& row, const double* q) const;
  /// Appends the contacts of one body that a query asks for, in the order of find().
  void find_of(Index body, const ContactQuery& query, ConstraintSet& out) const;
  /// Number of pairs of points of some components and shapes that they may touch.
  [[nodiscard]] std::size_t count_pairs(Range components) const;
  /// Appends all pairs of one component, in the order of find().
  void append_pairs(Index component, std::vector<ContactPair>& out) const;
  /// Distance of the point of a pair from the centre of mass of its body [m].
  [[nodiscard]] double arm(const ContactPair& pair) const {
    if (pair.feature == none) return 0.0;
    const std::array<double, 3>& centre = features_.points()[pair.feature].centre;
    return std::hypot(centre[0], centre[1], centre[2]);
  }
  /// Radius of the point of a pair [m].
  [[nodiscard]] double radius(const ContactPair& pair) const {
    return pair.feature == none ? 0.0 : features_.points()[pair.feature].radius;
  }
  /// Writes the contact of a pair, whatever its gap. \param motion of its shape, null if that is at rest
  void contact(const ContactPair& pair, const StateView& state, const Evaluation& evaluation,
               const GroundMotion* motion, Constraint& out) const;

private:
  template <int D>
  void find_in(Range components, const ContactQuery& query, ConstraintSet& out) const;
  template <int D>
  void find_among(Range components, const ContactQuery& query, ConstraintSet& out) const;
  // Places of shapes among those that a material touches, as bits; all from the last one on share its bit.
  using ShapeBits = std::uint64_t;
  static constexpr ShapeBits all_shapes = ~ShapeBits{0};
  [[nodiscard]] static ShapeBits bit_of(std::size_t place) {
    return ShapeBits{1} << std::min(place, std::size_t{63});
  }
  // Appends the contacts of one feature with some shapes.
  template <int D>
  void add(const BodySlot& body, const BodyFeature& feature, ShapeBits shapes, const ContactQuery& query,
           ConstraintSet& out) const;
  // Writes a contact. \param end the shape at the end of the step
  template <int D>
  void fill(const PlacedFeature<D>& at, const TouchedShape& touched, const Gap& gap, const StateView& state,
            const GroundMotion* motion, const GroundAtEnd& end, Constraint& out) const;
  [[nodiscard]] Index material_of(const CentreRun& centres) const;
  template <class F>
  void for_runs(Range components, F&& f) const;
  [[nodiscard]] bool only_points(Range runs) const;
  // Shapes with which each of some neighbours in a run may have a contact.
  using ShapesOfEach = std::array<ShapeBits, PointRow::most>;
  // Finds them. False if there are none.
  bool find_near(Range bodies, const CentreRun& centres, const ContactQuery& query, ShapesOfEach& near) const;

  const Assembly* assembly_;
  const GroundShapes* shapes_;
  const ContactLaws* laws_;
  BodyFeatures features_;
  TouchedGround touched_;
  bool needs_rotations_;
};

}  // namespace carom
