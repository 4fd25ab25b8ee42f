#pragma once

/// \file
/// Derivatives of the row of a scalar condition on the distance d between the ends of two planar bodies.
///
/// With the direction a of a condition, numbers p that move d by d_p and the axis by s_p (1 for the angle of
/// `from`, if the axis turns with it), a' = J a and rates along the motion d1 = sum d_p v_p, d2 = the drift
/// of d, s the rate of the axis:
///
///     dG_p/dq_r = a.d_pr + s_r a'.d_p + s_p a'.d_r - s_p s_r a.d,      drift = a.d2 + 2 s a'.d1 - s^2 a.d
///
/// and for a distance, of which a is the direction itself, dG_p/dq_r = a.d_pr + (a'.d_p)(a'.d_r) / |d| and
/// drift = a.d2 + (a'.d1)^2 / |d|. The drift's derivatives follow by the same rules.

#include <carom/core/joint_kind.h>
#include <carom/core/space.h>

#include <span>

namespace carom::planar {

/// A vector turned counter-clockwise by 90 degrees.
inline Vec<2> turned(const Vec<2>& a) { return {-a[1], a[0]}; }

/// One of the numbers that move the ends.
struct EndMotion {
  Vec<2> path;         ///< d_p
  Vec<2> bend;         ///< d_pp; those of two numbers are zero
  double rate, swing;  ///< v_p, s_p
};

/// Condition at one configuration.
struct ConditionGeometry {
  Vec<2> a;        ///< its direction
  Vec<2> between;  ///< d
  Vec<2> apart;    ///< d1
  Vec<2> drift;    ///< d2
  double spin;     ///< s
};

/// Derivatives of the row of a line. \param swings whether its axis turns with `from`
void differentiate_line(const ConditionGeometry& at, bool swings, std::span<const EndMotion> motions,
                        JointRowDerivative& out);
/// Derivatives of the row of a distance.
void differentiate_distance(const ConditionGeometry& at, std::span<const EndMotion> motions,
                            JointRowDerivative& out);

}  // namespace carom::planar
