#pragma once

/// \file
/// Finds where things touch: bodies and shapes on ground, or two bodies, whose gap is closed (Johansson 1999,
/// section 4: violated contacts take part in a step), joints at their limits, and dry friction in joints.

#include <carom/contact/detection/body_contacts.h>
#include <carom/contact/detection/contact_pair.h>
#include <carom/contact/detection/contact_query.h>
#include <carom/contact/detection/feature_region.h>
#include <carom/contact/detection/ground_contacts.h>
#include <carom/contact/detection/joint_rows.h>
#include <carom/contact/detection/piece_contacts.h>
#include <carom/core/assembly.h>
#include <carom/core/constraint_set.h>
#include <carom/core/discontinuity.h>
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
        ground_(assembly),
        pieces_(assembly, lengths),
        bodies_(assembly, lengths),
        joints_(assembly) {}

  /// True if a shape on ground moves.
  [[nodiscard]] bool has_moving_ground() const { return ground_.shapes().any_moves(); }
  /// As GroundShapes::place().
  void place(double time, GroundPlaces& places) const { ground_.shapes().place(time, places); }
  /// As GroundShapes::demand_continuous().
  void demand_continuous(const GroundPlaces& before, const GroundPlaces& after) const {
    ground_.shapes().demand_continuous(before, after);
  }
  /// As GroundShapes::list_jumps().
  void list_jumps(double from, double to, std::vector<GroundJump>& out) const {
    ground_.shapes().list_jumps(from, to, out);
  }
  /// As GroundShapes::discontinuities().
  [[nodiscard]] std::vector<Discontinuity> discontinuities() const {
    return ground_.shapes().discontinuities();
  }

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
  /// Appends the contacts of all components that a query asks for, and then those of bodies with each other.
  void find_all(const ContactQuery& query, BodyContactSearch& memory, ConstraintSet& out) const;
  /// True if bodies may touch each other.
  [[nodiscard]] bool bodies_touch() const { return !bodies_.empty(); }
  /// Contacts of bodies with each other.
  [[nodiscard]] const BodyContacts& bodies() const { return bodies_; }
  /// Appends the contacts of one body with shapes on ground that a query asks for.
  void find_of(Index body, const ContactQuery& query, ConstraintSet& out) const {
    ground_.find_of(body, query, out);
    if (!pieces_.empty()) pieces_.find_of(body, query, out);
  }
  /// Contacts of bodies with pieces of shapes on ground.
  [[nodiscard]] const PieceContacts& pieces() const { return pieces_; }
  /// Contacts of bodies with shapes on ground that have no pieces.
  [[nodiscard]] const GroundContacts& ground() const { return ground_; }
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

  /// The two sides of a pair that has an outline (ContactPair::has_outline()).
  [[nodiscard]] PairSides sides(const ContactPair& pair, const StateView& state, const Evaluation& evaluation,
                                const GroundPlaces& places) const;

  /// True if some surface takes more to slip than to slide, or there is friction in joints.
  [[nodiscard]] bool has_static_friction() const {
    return ground_.law_facts().static_friction || bodies_.law_facts().static_friction ||
           joints_.has_friction();
  }
  /// True if find() looks at the rotations of bodies: a feature stands off a centre of mass, or a joint has
  /// limits or friction.
  [[nodiscard]] bool needs_rotations() const {
    return !joints_.empty() || ground_.needs_rotations() || bodies_.needs_rotations();
  }

  /// As contact_name() of the assembly's system.
  [[nodiscard]] std::string name(const ConstraintKey& key) const;

private:
  const Assembly* assembly_;
  GroundContacts ground_;
  PieceContacts pieces_;
  BodyContacts bodies_;
  JointRows joints_;
};

/// True if some law of impact is not Newton's.
[[nodiscard]] inline bool has_other_impact_law(const Detector& detector) {
  return detector.ground().law_facts().other_impact_law || detector.bodies().law_facts().other_impact_law;
}
/// True if some law has rolling resistance.
[[nodiscard]] inline bool resists_rolling(const Detector& detector) {
  return detector.ground().law_facts().rolling_resistance || detector.bodies().law_facts().rolling_resistance;
}
/// True if the law of a pair of shapes has rolling resistance. False of the pair that stands for that
/// resistance, and of joints.
[[nodiscard]] inline bool resists_rolling(const Detector& detector, const ContactPair& pair) {
  if (pair.joint_row != none || pair.rolling) return false;
  if (pair.other != none) return detector.bodies().law(pair).resists_rolling();
  return (pair.is_of_pieces() ? detector.pieces().law(pair) : detector.ground().law(pair)).resists_rolling();
}
/// True if all that can touch are bodies and ground at rest, and GroundContacts::centre_rows() tell what may.
[[nodiscard]] inline bool centres_tell(const Detector& detector) {
  return detector.bodies().empty() && detector.pieces().empty() && detector.joints().empty() &&
         !detector.has_moving_ground() && detector.ground().centres_tell();
}
/// True if the shape on ground of a pair moves.
[[nodiscard]] inline bool moves(const Detector& detector, const ContactPair& pair) {
  return pair.ground_shape != none && detector.pieces().shapes().moves(pair.ground_shape);
}
/// Motion of the shape on ground of a pair; null if there is none or it is at rest.
[[nodiscard]] inline const GroundMotion* motion_of(const Detector& detector, const ContactPair& pair,
                                                   const GroundPlaces& places) {
  return moves(detector, pair) ? detector.pieces().shapes().motion(pair.ground_shape, places) : nullptr;
}
/// The vertex and the outline that the key of a contact names, where both sides are outlines; of other keys
/// nothing.
[[nodiscard]] CAROM_API std::optional<ContactPair> pair_of(const Detector& detector,
                                                           const ConstraintKey& key);
/// Brings rows, gap and drift of a contact of a pair to a state, as long as its vertex stays with one feature
/// of its outline (ConvexOutline), whichever is the nearest: a smooth function of the motion. Key and law
/// stay.
CAROM_API void follow(const Detector& detector, const ContactPair& pair, Index feature,
                      const StateView& state, const Evaluation& evaluation, const GroundPlaces& places,
                      Constraint& contact);
/// The vertex and the outline of a pair that has one (ContactPair::has_outline()).
[[nodiscard]] CAROM_API OutlinePair outline_pair(const Detector& detector, const ContactPair& pair,
                                                 const StateView& state, const Evaluation& evaluation,
                                                 const GroundPlaces& places);

}  // namespace carom
