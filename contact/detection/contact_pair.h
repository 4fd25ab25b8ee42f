#pragma once

/// \file
/// Pairs of features that may touch, wherever they are.

#include <carom/core/ids.h>

namespace carom {

/// A feature of a body and a shape on ground; a vertex of a body and an outline of another one or of a shape
/// on ground; a vertex of such a shape and an outline of a body; or a limit of a joint, or friction in one.
/// The rolling resistance of such a contact is a pair too, which follows it in every list. Numbers are those
/// of one Detector.
struct ContactPair {
  Index body = none;            ///< in the order of assembly; of a joint the first one that it binds
  Index feature = none;         ///< `none` where the body touches at its centre, and of joints
  Index material = none;        ///< of the feature; `none` of joints
  Index ground_shape = none;    ///< `none` of joints
  Index joint_row = none;       ///< limit of a joint or friction in one; `none` of shapes on ground
  Index other = none;           ///< the second body, where two bodies touch, else `none`
  Index outline = none;         ///< its outline in BodyOutlines; the vertex is the `feature` in
                                ///< BodyOutlines::vertices()
  Index ground_outline = none;  ///< in GroundPieces, which the vertex touches
  Index ground_vertex = none;   ///< in GroundPieces, which touches the `outline` of the body
  bool rolling = false;         ///< rolling resistance of the contact that the rest names

  /// True of a contact if one side is an outline, of a body or on ground.
  [[nodiscard]] bool has_outline() const {
    if (rolling) return false;
    return other != none || ground_outline != none || ground_vertex != none;
  }
  /// True if the body touches a piece of a shape on ground.
  [[nodiscard]] bool is_of_pieces() const { return ground_outline != none || ground_vertex != none; }
  friend bool operator==(const ContactPair&, const ContactPair&) = default;
};

}  // namespace carom
