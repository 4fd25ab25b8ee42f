#pragma once

/// \file
/// The contact law of a pair of surfaces (docs/method.md, section 2; Johansson 1999, section 2).

#include <carom/core/export.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <string_view>

namespace carom {

/// Law of impact: the quantity that the coefficient of restitution e_n is a ratio of (docs/contact_law.md).
/// For one contact without friction, and wherever W_nt = 0, the three agree.
enum class ImpactLaw : std::uint8_t {
  newton,   ///< of velocities: gamma_n^+ = -e_n gamma_n^- (Johansson 1999; Moreau)
  poisson,  ///< of impulses: P_n of the expansion is e_n times that of the compression (Glocker, Pfeiffer
            ///< 1995)
  /// Of energies: the normal work of the expansion is -e_n^2 times that of the compression (Stronge 1990).
  energetic
};

/// Name of a law: "newton", "poisson", "energetic".
[[nodiscard]] CAROM_API std::string_view to_string(ImpactLaw law);

/// Coefficients of the contact law between two surfaces. `friction` and `normal_restitution` are required.
struct Surface {
  double friction = std::numeric_limits<double>::quiet_NaN();  ///< coefficient of sliding friction mu_k, >= 0
  double normal_restitution = std::numeric_limits<double>::quiet_NaN();  ///< e_n in [0, 1]
  double tangential_restitution = 0.0;                                   ///< e_t in [0, 1]
  /// Coefficient of static friction mu_s >= mu_k; NaN: the same as `friction`.
  double static_friction = std::numeric_limits<double>::quiet_NaN();
  /// Speed over which mu - mu_k falls by a factor of e, >= 0 [m/s]; 0: at once. Needs static_friction.
  double stribeck_speed = 0.0;
  /// Law of impact. The energetic one has no tangential restitution, and none of rolling.
  ImpactLaw impact_law = ImpactLaw::newton;
  /// Rolling resistance rho >= 0: a moment of at most rho P_n acts against the relative spin [m].
  double rolling_resistance = 0.0;
  double rolling_restitution = 0.0;  ///< e_r in [0, 1], of the relative spin at an impact

  /// True if static friction is larger than sliding friction.
  [[nodiscard]] bool has_static_friction() const { return static_friction > friction; }
  /// True if friction falls with the speed of sliding.
  [[nodiscard]] bool falls_with_speed() const { return stribeck_speed > 0.0; }
  /// True if impacts are not solved by Newton's law.
  [[nodiscard]] bool has_other_impact_law() const { return impact_law != ImpactLaw::newton; }
  /// True if a moment acts against rolling.
  [[nodiscard]] bool resists_rolling() const { return rolling_resistance > 0.0; }
  /// Coefficient of a contact that sticks: mu_s.
  [[nodiscard]] double sticking_friction() const {
    return has_static_friction() ? static_friction : friction;
  }
  /// Coefficient at a sliding speed >= 0 [m/s]: mu_k + (mu_s - mu_k) exp(-speed/stribeck_speed); with the
  /// stribeck_speed 0 mu_s at rest and mu_k at any other speed.
  [[nodiscard]] double friction_at(double speed) const {
    if (!has_static_friction()) return friction;
    if (falls_with_speed()) {
      return friction + (static_friction - friction) * std::exp(-speed / stribeck_speed);
    }
    return speed > 0.0 ? friction : static_friction;
  }
  /// Coefficient of a contact that slides at a speed >= 0 [m/s], at 0 the limit of slow sliding; below 0 the
  /// curve is continued.
  [[nodiscard]] double sliding_friction(double speed) const {
    return falls_with_speed() ? friction_at(speed) : friction;
  }
};

}  // namespace carom
