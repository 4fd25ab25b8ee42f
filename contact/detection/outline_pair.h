#pragma once

/// \file
/// A vertex of one side and an outline of the other, each in its own frame.

#include <carom/contact/detection/convex_outline.h>
#include <carom/contact/detection/corner_meeting.h>
#include <carom/contact/detection/face_chain.h>
#include <carom/contact/detection/feature_region.h>
#include <carom/contact/detection/gap_point.h>
#include <carom/contact/detection/placed_outline.h>
#include <carom/core/evaluation.h>
#include <carom/core/ground_shape_kind.h>
#include <carom/core/layout.h>
#include <carom/core/space.h>
#include <carom/core/state.h>

#include <optional>

namespace carom {

/// Frame of a body, or of a shape on ground, and how it moves.
struct PlaneFrame {
  Vec<2> centre = Vec<2>::Zero();    ///< of mass, or the point about which a shape on ground turns [m]
  Vec<2> velocity = Vec<2>::Zero();  ///< of the centre [m/s]
  double spin = 0.0;                 ///< [rad/s]
  double cosine = 1.0, sine = 0.0;   ///< of its angle

  /// The frame of what is at rest.
  PlaneFrame() = default;
  /// The frame of a body. \param evaluation position group up to date
  PlaneFrame(const BodySlot& body, const StateView& state, const Evaluation& evaluation)
      : centre(state.q[body.q], state.q[body.q + 1]), velocity(state.v[body.v], state.v[body.v + 1]) {
    if (body.v_size > 2) spin = state.v[body.v + 2];
    if (body.rotation == none) return;
    cosine = evaluation.rotation[body.rotation];
    sine = evaluation.rotation[body.rotation + 1];
  }
  /// The frame of a shape on ground. \param motion null: it is at rest
  explicit PlaneFrame(const GroundMotion* motion) {
    if (motion == nullptr) return;
    centre = {motion->point[0], motion->point[1]};
    velocity = {motion->velocity[0], motion->velocity[1]};
    spin = motion->spin;
    cosine = motion->cosine;
    sine = motion->sine;
  }
  /// A direction of the frame, in space.
  [[nodiscard]] Vec<2> turned(const Vec<2>& at) const {
    return {cosine * at[0] - sine * at[1], sine * at[0] + cosine * at[1]};
  }
  /// A direction of space, in the frame.
  [[nodiscard]] Vec<2> turned_back(const Vec<2>& at) const {
    return {cosine * at[0] + sine * at[1], cosine * at[1] - sine * at[0]};
  }
  /// A place of the frame, in space [m].
  [[nodiscard]] Vec<2> outside(const Vec<2>& local) const { return centre + turned(local); }
  /// A place in space, in the frame [m].
  [[nodiscard]] Vec<2> inside(const Vec<2>& point) const { return turned_back(Vec<2>(point - centre)); }
  /// Velocity of what is fixed to the frame. \param arm from the centre, in space [m]
  [[nodiscard]] Vec<2> velocity_at(const Vec<2>& arm) const {
    return {velocity[0] - spin * arm[1], velocity[1] + spin * arm[0]};
  }
};

/// A gap that was found in a frame, in space.
[[nodiscard]] inline GapPoint in_space(const PlaneFrame& frame, const GapPoint& gap) {
  GapPoint out = gap;
  out.normal = frame.turned(gap.normal);
  out.point_a = frame.outside(gap.point_a);
  out.point_b = frame.outside(gap.point_b);
  return out;
}

/// A vertex and an outline that it may touch. A view.
struct OutlinePair {
  PlaneFrame vertex_frame, outline_frame;
  Vec<2> vertex = Vec<2>::Zero();  ///< in its frame [m]
  ConvexOutline around;            ///< outline that the vertex is part of, in its frame
  ConvexOutline outline;           ///< in its frame
  std::optional<FaceChain> chain;  ///< given if the outline is a chain on ground
  FeatureLengths lengths{};        ///< to which features are told apart
  bool is_hollow = false;          ///< the outline is a circle that the vertex is inside of
  Index corner = none;  ///< vertex of the outline that may meet the vertex of the pair; `none`: none is near
  HiddenSide hidden = HiddenSide::neither;            ///< the side of that corner that a neighbour covers
  HiddenSide hidden_of_vertex = HiddenSide::neither;  ///< the side of the vertex that one covers

  /// The vertex, in the frame of the outline [m].
  [[nodiscard]] Vec<2> vertex_at_outline() const {
    return outline_frame.inside(vertex_frame.outside(vertex));
  }
  /// The outline as the narrow phase sees it.
  [[nodiscard]] PlacedOutline touched() const {
    if (is_hollow) return PlacedOutline::outside_of(outline);
    return chain ? PlacedOutline(*chain) : PlacedOutline(outline);
  }
  /// True if neither side is rounded.
  [[nodiscard]] bool is_sharp() const { return outline.radius + around.radius == 0.0; }
};

/// Two corners that are near each other, in space.
struct MeetingCorners {
  SharpCorner of_vertex, of_outline;
};

/// The corners of a pair that may meet: its vertex, and that of the outline which is so near that what sinks
/// there may be behind either of its edges (OutlinePair::corner is set to it). Nothing of rounded outlines
/// and of chains, and where none is near.
[[nodiscard]] CAROM_API std::optional<MeetingCorners> corners_that_meet(OutlinePair& pair);

}  // namespace carom
