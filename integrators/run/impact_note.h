#pragma once

/// \file
/// Note on the impact that a contact took part in: energy that the law added, restitution that was scaled.

namespace carom {

/// Facts of a whole impact, the same in the records of all its contacts. Those of which the work of the
/// impulse is positive made the gain.
struct ImpactNote {
  /// Kinetic energy that the impulses of the impact added, beyond rounding [J]; else 0.
  double energy_gain = 0.0;
  /// Work of this contact's impulse, P.(gamma^- + gamma^+)/2 [J]: its part of the gain where positive.
  double contact_work = 0.0;
  /// Factor of all coefficients of restitution of the impact: 1, less by EnergyGain::limit, 0 where the
  /// contacts jam (ImpactRules::refuse_jams).
  double restitution_factor = 1.0;
  /// An impact with e = 0 that ended a sequence (ImpactRules::sequence_limit, TimeStepping::most_impacts).
  bool cut_sequence = false;
  double rolling_moment = 0.0;  ///< impulse moment of rolling resistance on `body` [N m s]
};

}  // namespace carom
