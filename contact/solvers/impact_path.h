#pragma once

/// \file
/// The impact of one planar contact by the energetic law, exactly (Routh; Stronge 1990), rolling resistance
/// included.

#include <carom/core/export.h>

#include <optional>

namespace carom {

/// One planar contact.
struct ImpactPathInput {
  double wnn = 0.0, wnt = 0.0, wtt = 0.0;  ///< W [1/kg]
  double friction = 0.0;                   ///< mu
  double restitution = 0.0;                ///< e_*, of energy
  double normal = 0.0, tangential = 0.0;   ///< gamma^- [m/s]
  /// Of the row of rolling resistance; all zero where there is none.
  double wnr = 0.0, wtr = 0.0, wrr = 0.0;  ///< W [1/(kg m), 1/(kg m), 1/(kg m^2)]
  double rolling_resistance = 0.0;         ///< rho [m]
  double spin = 0.0;                       ///< omega^- [rad/s]
};

/// Impulses and velocities at the end of the path.
struct ImpactPathEnd {
  double normal_impulse = 0.0, tangential_impulse = 0.0;  ///< [N s]
  double normal = 0.0, tangential = 0.0;                  ///< gamma^+ [m/s]
  bool sticks = false;                                    ///< at the end
  double rolling_moment = 0.0;                            ///< impulse of it [N m s]
  double spin = 0.0;                                      ///< omega^+ [rad/s]
};

/// Follows the normal impulse: slip until it stops, then stick or reversed slip, and so does rolling;
/// compression to gamma_n = 0, expansion until its work is -e_*^2 times that of compression. Friction and
/// moment never do positive work on the way, so nothing is gained. Zero impulses where gamma_n >= 0. Nothing
/// where no impulse ends the compression (W_nn = 0).
[[nodiscard]] CAROM_API std::optional<ImpactPathEnd> follow_impact(const ImpactPathInput& contact);

}  // namespace carom
