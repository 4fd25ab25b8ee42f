#pragma once

/// \file
/// Contacts of bodies with each other: pairs of convex outlines whose gap is closed. Two outlines touch where
/// their materials have a law of contact, unless both are points or a filter parts them
/// (contact/detection/pair_filter.h).

#include <carom/contact/detection/body_outlines.h>
#include <carom/contact/detection/broad_phase.h>
#include <carom/contact/detection/contact_pair.h>
#include <carom/contact/detection/contact_query.h>
#include <carom/contact/detection/corner_meeting.h>
#include <carom/contact/detection/feature_region.h>
#include <carom/contact/detection/gap_convex.h>
#include <carom/contact/detection/law_facts.h>
#include <carom/contact/detection/outline_pair.h>
#include <carom/contact/detection/pair_filter.h>
#include <carom/contact/detection/pair_rows.h>
#include <carom/contact/detection/pair_sides.h>
#include <carom/core/assembly.h>
#include <carom/core/constraint_set.h>
#include <carom/core/export.h>
#include <carom/core/surface.h>

#include <array>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace carom {

struct CornerMeeting;

/// Two outlines that touch, before the rows of their contact are written.
struct BodyTouch {
  Index a = none, b = none;       ///< places of the outlines, that of the lesser key first
  GapPoint gap;                   ///< where they touch
  double allowed_approach = 0.0;  ///< Constraint::allowed_approach [m/s]
  bool of_corners = false;        ///< one of the two of corners that meet
};

/// Memory of a search for contacts of bodies: its answer does not depend on it.
struct BodyContactSearch {
  BroadPhase<2> broad;
  std::vector<Box<2>> boxes;                              ///< around all outlines
  std::vector<Vec<2>> placed;                             ///< vertices of all outlines
  std::vector<RowSide> sides;                             ///< bodies of all outlines
  std::vector<std::pair<Index, Index>> pairs;             ///< of outlines that may touch
  std::vector<BodyTouch> touching;                        ///< contacts among `pairs`
  std::vector<ConstraintKey> lasting;                     ///< contacts of the step before
  std::vector<std::pair<Index, Index>> pairs_of_lasting;  ///< outlines of `lasting` that are of bodies
  SingleConstraint trial;                                 ///< of one that turning may have opened
  std::vector<Index> near;                                ///< outlines near a corner
};

/// An outline where its body is.
[[nodiscard]] inline ConvexOutline placed_outline(const BodyOutline& outline,
                                                  const BodyContactSearch& memory) {
  return {std::span(memory.placed).subspan(outline.vertices.begin, outline.vertices.size()), outline.radius};
}

/// Outlines of the bodies of an assembly, which of them may touch, and by which law.
class CAROM_API BodyContacts {
public:
  /// \param assembly outlives it \param lengths to which features are told apart
  explicit BodyContacts(const Assembly& assembly, const FeatureLengths& lengths = {});

  /// True if no two bodies can touch.
  [[nodiscard]] bool empty() const { return outlines_.empty(); }
  /// Facts of the laws of all pairs.
  [[nodiscard]] const LawFacts& law_facts() const { return law_facts_; }
  /// True if the law of a contact of two outlines has rolling resistance.
  [[nodiscard]] bool resists_rolling(const BodyTouch& touch) const {
    return law_facts_.rolling_resistance &&
           law(outlines_.list()[touch.a], outlines_.list()[touch.b])->resists_rolling();
  }
  /// True if find() looks at the rotations of bodies.
  [[nodiscard]] bool needs_rotations() const { return needs_rotations_; }
  /// The outlines.
  [[nodiscard]] const BodyOutlines& outlines() const { return outlines_; }

  /// Appends the contacts of all bodies that a query asks for, ordered by the first outline, then the second
  /// one, in the order of assembly.
  void find(const ContactQuery& query, BodyContactSearch& memory, ConstraintSet& out) const;
  /// The contacts that find() would append, before their rows are written, for whoever brings them into
  /// another order first. Valid as long as `memory` is left alone.
  [[nodiscard]] std::span<const BodyTouch> find_touching(const ContactQuery& query,
                                                         BodyContactSearch& memory) const;
  /// Writes the contact of two outlines that touch. \param out as made by default
  void write(const BodyTouch& touch, const StateView& state, Constraint& out) const;
  /// Writes the contact of two outlines that find_touching() has found last, without its drift. \param out
  /// any constraint; of the same contact only the numbers are written anew
  void write_rows(const BodyTouch& touch, const BodyContactSearch& memory, const StateView& state,
                  Constraint& out) const;
  /// Law of a pair of outlines.
  [[nodiscard]] const Surface& law(const ContactPair& pair) const {
    return *law(outlines_.list()[outlines_.outline_of(pair.feature)], outlines_.list()[pair.outline]);
  }
  /// The two sides of a pair of outlines.
  [[nodiscard]] PairSides sides(const ContactPair& pair, const StateView& state,
                                const Evaluation& evaluation) const;
  /// The vertex and the outline of a pair of outlines.
  [[nodiscard]] OutlinePair outline_pair(const ContactPair& pair, const StateView& state,
                                         const Evaluation& evaluation) const;

private:
  [[nodiscard]] const Surface* law(const BodyOutline& a, const BodyOutline& b) const;
  [[nodiscard]] bool kinds_may_touch(const BodyOutline& a, const BodyOutline& b) const;
  [[nodiscard]] bool may_touch(const BodyOutline& a, const BodyOutline& b) const;
  void collect_pairs(const ContactQuery& query, BodyContactSearch& memory) const;
  void add_lasting_pairs(const ContactQuery& query, BodyContactSearch& memory) const;
  void add(Index i, Index j, const ContactQuery& query, BodyContactSearch& memory) const;
  [[nodiscard]] CornerMeeting meeting_near(const BodyTouch& touch, const ContactQuery& query,
                                           BodyContactSearch& memory) const;
  [[nodiscard]] HiddenSide hidden_side(const SharpCorner& corner, Index of, Index from,
                                       BodyContactSearch& memory) const;
  void find_hidden_sides(OutlinePair& at, const MeetingCorners& corners, const std::array<Index, 2>& of,
                         const StateView& state, const Evaluation& evaluation) const;
  void add_lasting(BodyTouch touch, const ContactQuery& query, BodyContactSearch& memory) const;
  void fill(const ConstraintKey& key, const BodyOutline& a, const BodyOutline& b, const GapPoint& gap,
            const StateView& state, Constraint& out) const;

  const Assembly* assembly_;
  FeatureLengths lengths_;
  BodyOutlines outlines_;
  PairFilter filter_;
  std::vector<std::optional<Surface>> laws_;  // row-major, by material
  LawFacts law_facts_;
  bool needs_rotations_ = false;
  bool all_may_touch_ = false;     // outlines of any two bodies
  bool in_order_of_keys_ = false;  // outlines are
};

}  // namespace carom
