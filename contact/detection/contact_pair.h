#pragma once

/// \file
/// Pairs of features that may touch, wherever they are.

#include <carom/core/ids.h>

namespace carom {

/// A feature of a body and a shape on ground; a vertex and an outline, of two bodies or of a body and a shape
/// on ground; a limit of a joint, or friction in one; or the rolling resistance of such a contact, which
/// follows it in every list. Numbers are those of one Detector.
struct ContactPair {
  Index body = none;          ///< in the order of assembly; of a joint the first one that it binds
  Index feature = none;       ///< vertex of Outlines where there is an outline; else a point of
                              ///< BodyFeatures, `none` where the body touches at its centre, and of joints
  Index law = none;           ///< number in ContactLaws; `none` of joints
  Index ground_shape = none;  ///< `none` of joints, and where two bodies touch
  Index joint_row = none;     ///< limit of a joint or friction in one; else `none`
  Index other = none;         ///< the second body, where two bodies touch, else `none`
  Index outline = none;       ///< of Outlines, which the vertex touches; `none` of points, centres, joints
  bool rolling = false;       ///< rolling resistance of the contact that the rest names

  /// True of a contact of a vertex and an outline.
  [[nodiscard]] bool has_outline() const { return !rolling && outline != none; }
  /// True if the body touches a piece of a shape on ground.
  [[nodiscard]] bool is_of_pieces() const { return outline != none && ground_shape != none; }
  friend bool operator==(const ContactPair&, const ContactPair&) = default;
};

}  // namespace carom
