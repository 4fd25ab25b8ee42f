#pragma once

/// \file
/// Ends of planar joints where their bodies are described, and what joints demand of them.

#include <carom/core/end.h>
#include <carom/core/export.h>
#include <carom/core/part_check.h>
#include <carom/core/space.h>
#include <carom/core/system.h>

#include <string_view>

namespace carom::planar {

/// Position and angle of a body as described.
struct CAROM_API DescribedPlace {
  Vec<2> position = filled<2>(0.0);  ///< of its centre of mass [m]
  double angle = 0.0;                ///< [rad]

  /// A point of the body, in the fixed frame [m].
  [[nodiscard]] Vec<2> point(const Vec<2>& local) const;
};
/// Position and angle of a body of a system, or of the ground, as described.
[[nodiscard]] CAROM_API DescribedPlace described_place(const System& system, BodyId body);

/// The two ends of a joint, with their points.
struct JointEnds {
  End<2> from;
  End<2> to;
};
/// Two ends that coincide, valid and on different bodies. One on ground that was given without a point is
/// where the other one is described.
[[nodiscard]] CAROM_API JointEnds ends_of_point(const PartCheck& check, const End<2>& from, const End<2>& to);
/// Two ends, valid and on different bodies, of which `to` is at a distance from a line fixed to `from`. One
/// on ground that was given without a point is, of all points that satisfy this as described, the nearest to
/// the origin: so lengths along the line are measured from there. \param axis of the line in the frame of
/// `from`, of unit length \param distance of `to` from the line, to its left as one looks along the axis [m]
[[nodiscard]] CAROM_API JointEnds ends_of_line(const PartCheck& check, const End<2>& from, const End<2>& to,
                                               const Vec<2>& axis, double distance);

/// Demands two valid ends on different bodies.
CAROM_API void check_joint_ends(const PartCheck& check, const End<2>& from, const End<2>& to);
/// Demands an axis that is finite and not zero; returns it with unit length.
[[nodiscard]] CAROM_API Vec<2> checked_axis(const PartCheck& check, const Vec<2>& axis,
                                            std::string_view quantity);
/// Demands a body that has an angle: a rigid body, or the ground.
CAROM_API void check_turning_end(const PartCheck& check, BodyId body, std::string_view quantity);

}  // namespace carom::planar
