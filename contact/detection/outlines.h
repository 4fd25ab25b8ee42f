#pragma once

/// \file
/// All outlines of a model: those of bodies, which these touch each other with, and those on ground, each in
/// its own frame. Which of them may touch, by which law, and what the contact of two of them is.

#include <carom/contact/detection/contact_laws.h>
#include <carom/contact/detection/contact_pair.h>
#include <carom/contact/detection/contact_query.h>
#include <carom/contact/detection/covering_ground.h>
#include <carom/contact/detection/feature_region.h>
#include <carom/contact/detection/gap_point.h>
#include <carom/contact/detection/outline_list.h>
#include <carom/contact/detection/outline_pair.h>
#include <carom/contact/detection/pair_sides.h>
#include <carom/core/assembly.h>
#include <carom/core/constraint_set.h>
#include <carom/core/export.h>
#include <carom/core/surface.h>

#include <array>
#include <optional>

namespace carom {

/// Two outlines that touch, before the rows of their contact are written.
struct Touch {
  Index a = none, b = none;       ///< numbers of the outlines, that of the lesser key first
  GapPoint gap;                   ///< where they touch, in space
  double allowed_approach = 0.0;  ///< Constraint::allowed_approach [m/s]
  bool of_corners = false;        ///< one of the two of corners that meet
};

/// All outlines of a model, which of them may touch, by which law, and what the contact of two of them is.
class CAROM_API Outlines : public OutlineList {
public:
  /// Throws ModelError where a body's polygon is not convex. Outlines of bodies are listed where these can
  /// touch each other or a piece of the ground. \param assembly outlives it \param lengths to which features
  /// are told apart
  explicit Outlines(const Assembly& assembly, const FeatureLengths& lengths = {});

  /// Laws between bodies, and between these and all shapes on ground.
  [[nodiscard]] const ContactLaws& laws() const { return laws_; }
  /// True if bodies may touch each other.
  [[nodiscard]] bool bodies_touch() const { return laws_.bodies_touch(); }

  /// Number of the law between two outlines; `none`: there is none, so that they do not touch. \param a of a
  /// body
  [[nodiscard]] Index number_of_law(Index a, Index b) const;
  /// Law between two outlines that may touch. \param a of a body
  [[nodiscard]] const Surface& law(Index a, Index b) const { return laws_[number_of_law(a, b)]; }
  /// True if an outline of a body and one on ground may touch.
  [[nodiscard]] bool may_touch(const BodyOutline& a, const GroundOutline& b) const {
    return carom::may_touch(a.filter, shapes().filter(b.shape));
  }
  /// Name of the contact of two outlines. \param a of a body
  [[nodiscard]] ConstraintKey key_of(Index a, Index b, const GapPoint& gap) const;
  /// The vertex and the outline that the key of a contact names, where both sides are outlines; of other keys
  /// nothing.
  [[nodiscard]] std::optional<ContactPair> pair_of(const ConstraintKey& key) const;
  /// The two sides of a pair. \param places of all shapes on ground
  [[nodiscard]] PairSides sides(const ContactPair& pair, const StateView& state, const Evaluation& evaluation,
                                const GroundPlaces& places) const;
  /// The vertex and the outline of a pair. \param places of all shapes on ground
  [[nodiscard]] OutlinePair outline_pair(const ContactPair& pair, const StateView& state,
                                         const Evaluation& evaluation, const GroundPlaces& places) const;
  /// The side of a corner of a shape on ground that other shapes there cover, of those which a body may
  /// touch. \param corner in space \param filter of the body \param places of all shapes on ground
  [[nodiscard]] HiddenSide covered_side(const SharpCorner& corner, Index shape, const ContactFilter& filter,
                                        const GroundPlaces& places) const {
    return covering_.side(corner, shape, filter, places, shapes(), on_ground());
  }
  /// Writes the contact of two outlines. \param out as ConstraintHead::start_contact() leaves it
  void write(const Touch& touch, const ContactQuery& query, Constraint& out) const;
  /// True of a contact that was closed in the step before and is a little open now, as its turning explains;
  /// its allowed approach is set then. \param memory overwritten
  [[nodiscard]] bool lasts(Touch& touch, const ContactQuery& query, SingleConstraint& memory) const;

private:
  Outlines(const Assembly& assembly, const FeatureLengths& lengths, bool between_bodies);
  void cover(OutlinePair& at, const MeetingCorners& corners, const std::array<Index, 2>& of,
             const StateView& state, const Evaluation& evaluation, const GroundPlaces& places) const;
  void cover_by_bodies(OutlinePair& at, const MeetingCorners& corners, const std::array<Index, 2>& of,
                       const StateView& state, const Evaluation& evaluation) const;

  ContactLaws laws_;
  CoveringGround covering_;
};

}  // namespace carom
