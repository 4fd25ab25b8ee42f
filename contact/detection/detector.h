#pragma once

/// \file
/// Finds where things touch: bodies and shapes on ground, or two bodies, whose gap is closed (Johansson 1999,
/// section 4: violated contacts take part in a step), joints at their limits, and dry friction in joints.

#include <carom/contact/detection/body_touches.h>
#include <carom/contact/detection/contact_pair.h>
#include <carom/contact/detection/contact_query.h>
#include <carom/contact/detection/feature_region.h>
#include <carom/contact/detection/ground_touches.h>
#include <carom/contact/detection/joint_rows.h>
#include <carom/contact/detection/outlines.h>
#include <carom/contact/detection/point_contacts.h>
#include <carom/core/assembly.h>
#include <carom/core/constraint_set.h>
#include <carom/core/export.h>

#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace carom {

/// From a state to the constraints that are active in it.
class CAROM_API Detector {
public:
  /// Throws ModelError where a feature and a shape on ground have no contact law. \param assembly outlives it
  /// \param lengths to which features of outlines are told apart
  explicit Detector(const Assembly& assembly, const FeatureLengths& lengths = {})
      : assembly_(&assembly),
        outlines_(assembly, lengths),
        points_(assembly, outlines_.shapes(), outlines_.laws()),
        on_ground_(outlines_),
        joints_(assembly),
        needs_rotations_(!joints_.empty() || points_.needs_rotations() ||
                         (bodies_touch() && outlines_.of_bodies().any_off_centre())) {}
  Detector(const Detector&) = delete;
  Detector& operator=(const Detector&) = delete;

  /// True if a shape on ground moves.
  [[nodiscard]] bool has_moving_ground() const { return shapes().any_moves(); }
  /// As GroundShapes::place().
  void place(double time, GroundPlaces& places) const { shapes().place(time, places); }
  /// The shapes on ground.
  [[nodiscard]] const GroundShapes& shapes() const { return outlines_.shapes(); }

  /// Appends the contacts of one component whose gap is <= `margin` [m]: with shapes on ground without
  /// pieces, ordered by body, then feature, then shape; with pieces, ordered by body; then the limits of
  /// joints. The position group of `evaluation` must be up to date. Places the ground by itself.
  void find(Index component, const StateView& state, const Evaluation& evaluation, double margin,
            ConstraintSet& out) const;
  /// Appends the contacts of one component whose gap is <= `margin` [m]: with shapes on ground without
  /// pieces, ordered by body, then feature, then shape; with pieces, ordered by body; then the limits of
  /// joints. The position group of `evaluation` must be up to date.
  /// \param places the ground, which must be of the state's time
  /// \param after the ground at the end of the step that begins with the state, for
  /// Constraint::surface_velocity_after; null: no time passes
  /// \param lasting contacts of the step before, found also where turning may have opened them; null: none
  void find(Index component, const StateView& state, const Evaluation& evaluation, const GroundPlaces& places,
            const GroundPlaces* after, double margin, ConstraintSet& out,
            const LastingContacts* lasting = nullptr) const {
    find(Range{component, component + 1}, {state, evaluation, places, after, margin, lasting}, out);
  }
  /// Appends the contacts of some components with shapes on ground, and the limits of their joints, that a
  /// query asks for: component by component where shapes on ground have pieces, otherwise all contacts before
  /// all limits.
  void find(Range components, const ContactQuery& query, ConstraintSet& out) const;
  /// Appends what find() does of all components, and the contacts of bodies with each other.
  void find_all(const ContactQuery& query, BodyContactSearch& memory, ConstraintSet& out) const;
  /// Appends the contacts of bodies with each other that a query asks for, ordered by the first outline, then
  /// the second one, in the order of assembly.
  void find_between_bodies(const ContactQuery& query, BodyContactSearch& memory, ConstraintSet& out) const;
  /// Appends the contacts of one body with shapes on ground that a query asks for.
  void find_of(Index body, const ContactQuery& query, ConstraintSet& out) const;
  /// True if bodies may touch each other.
  [[nodiscard]] bool bodies_touch() const { return outlines_.bodies_touch(); }
  /// Outlines of bodies and on ground, and what the contacts of two of them are.
  [[nodiscard]] const Outlines& outlines() const { return outlines_; }
  /// Contacts of the outlines of bodies with pieces of shapes on ground.
  [[nodiscard]] const GroundTouches& on_ground() const { return on_ground_; }
  /// Contacts of rounded points of bodies with shapes on ground that have no pieces.
  [[nodiscard]] const PointContacts& points() const { return points_; }
  /// Limits of joints, and friction in them.
  [[nodiscard]] const JointRows& joints() const { return joints_; }
  /// Says which contacts of a step turning may have opened. \param contacts of the step, as
  /// Companion::modes \param step length of a step that gaps may come from [s]
  /// \param slack openings that are none
  void remember(std::span<const std::pair<ConstraintKey, ContactMode>> contacts, double step,
                const OpeningSlack& slack, LastingContacts& out) const;

  /// All pairs of one component, in the order of find(); without those of two bodies. Made at each call.
  [[nodiscard]] std::vector<ContactPair> pairs(Index component) const;
  /// The contact of a pair, or its rolling resistance, whatever its gap, with the ground at `places`, which
  /// must be of the state's time. The position group of `evaluation` must be up to date.
  void contact(const ContactPair& pair, const StateView& state, const Evaluation& evaluation,
               const GroundPlaces& places, Constraint& out) const;

  /// Law of a pair, of whatever sides; of the rolling resistance of a contact that of the contact. Joints
  /// have none.
  [[nodiscard]] const Surface& law(const ContactPair& pair) const { return outlines_.laws()[pair.law]; }
  /// Facts of the laws of all pairs that may touch.
  [[nodiscard]] LawFacts law_facts() const {
    LawFacts all = points_.law_facts();
    all.add(outlines_.laws().facts_of_bodies());
    return all;
  }
  /// True if some surface takes more to slip than to slide, or there is friction in joints.
  [[nodiscard]] bool has_static_friction() const {
    return law_facts().static_friction || joints_.has_friction();
  }
  /// True if find() looks at the rotations of bodies: a feature stands off a centre of mass, or a joint has
  /// limits or friction.
  [[nodiscard]] bool needs_rotations() const { return needs_rotations_; }

  /// As contact_name() of the assembly's system.
  [[nodiscard]] std::string name(const ConstraintKey& key) const;

private:
  const Assembly* assembly_;
  Outlines outlines_;
  PointContacts points_;  // of shapes and laws of the outlines
  GroundTouches on_ground_;
  JointRows joints_;
  bool needs_rotations_;
};

/// True if some law of impact is not Newton's.
[[nodiscard]] inline bool has_other_impact_law(const Detector& detector) {
  return detector.law_facts().other_impact_law;
}
/// True if some law has rolling resistance.
[[nodiscard]] inline bool resists_rolling(const Detector& detector) {
  return detector.law_facts().rolling_resistance;
}
/// True if the law of a pair of shapes has rolling resistance. False of the pair that stands for that
/// resistance, and of joints.
[[nodiscard]] inline bool resists_rolling(const Detector& detector, const ContactPair& pair) {
  return pair.joint_row == none && !pair.rolling && detector.law(pair).resists_rolling();
}
/// True if all that can touch are bodies and ground at rest, and PointContacts::centre_rows() tell what may.
[[nodiscard]] inline bool centres_tell(const Detector& detector) {
  return !detector.bodies_touch() && !detector.outlines().ground_touches() && detector.joints().empty() &&
         !detector.has_moving_ground() && detector.points().centres_tell();
}
/// True if the shape on ground of a pair moves.
[[nodiscard]] inline bool moves(const Detector& detector, const ContactPair& pair) {
  return pair.ground_shape != none && detector.shapes().moves(pair.ground_shape);
}
/// Motion of the shape on ground of a pair; null if there is none or it is at rest.
[[nodiscard]] inline const GroundMotion* motion_of(const Detector& detector, const ContactPair& pair,
                                                   const GroundPlaces& places) {
  return moves(detector, pair) ? detector.shapes().motion(pair.ground_shape, places) : nullptr;
}
/// Brings rows, gap and drift of a contact of a pair to a state, as long as its vertex stays with one feature
/// of its outline (ConvexOutline), whichever is the nearest: a smooth function of the motion. Key and law
/// stay.
CAROM_API void follow(const Detector& detector, const ContactPair& pair, Index feature,
                      const StateView& state, const Evaluation& evaluation, const GroundPlaces& places,
                      Constraint& contact);
}  // namespace carom
