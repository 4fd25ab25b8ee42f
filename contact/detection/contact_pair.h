#pragma once

/// \file
/// Pairs of features that may touch, wherever they are.

#include <carom/core/ids.h>

namespace carom {

/// A feature of a body and a shape on ground; a vertex of a body and an outline of another one; or a limit of a
/// joint, or friction in one. Numbers are those of one Detector.
struct ContactPair {
  Index body = none;          ///< in the order of assembly; of a joint the first one that it binds
  Index feature = none;       ///< `none` where the body touches at its centre, and of joints
  Index material = none;      ///< of the feature; `none` of joints
  Index ground_shape = none;  ///< `none` of joints
  Index joint_row = none;     ///< limit of a joint or friction in one; `none` of shapes on ground
  Index other = none;    ///< the second body, where two bodies touch, else `none`
  Index outline = none;  ///< its outline in BodyOutlines; the vertex is the `feature` in
                         ///< BodyOutlines::vertices()
  friend bool operator==(const ContactPair&, const ContactPair&) = default;
};

}  // namespace carom
