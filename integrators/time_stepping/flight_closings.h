#pragma once

/// \file
/// Contacts that close in a flight of a body, and when.
///
/// A body may come to a face and leave it again within a flight: at its end another one is closed. Where a
/// look on the way finds more that is closed, that is looked for too.

#include <carom/core/constraint_set.h>
#include <carom/core/export.h>
#include <carom/integrators/time_stepping/flight_look.h>
#include <carom/integrators/time_stepping/motion_phase.h>

#include <cstddef>
#include <span>
#include <vector>

namespace carom {

/// A contact that closes in a flight.
struct FlightClosing {
  ConstraintKey key;
  double gap, rate;     ///< where it was found [m, m/s]
  double acceleration;  ///< of the gap there, without the contact [m/s^2]
  double speed;         ///< size of what the rate is the sum of [m/s]
  double share;         ///< of the step, where it was found; then when it closes
  bool rebounds;        ///< it closes fast, or nothing presses it (CaptureRule)
};

/// Finds what closes first. Keeps memory.
class CAROM_API FlightClosings {
public:
  /// Contacts that close first, as one instant, in a flight at whose end the body is; none if nothing closes.
  /// \param known contacts that take part in the flight
  [[nodiscard]] std::span<const FlightClosing> find(const LocatedBody& at, const MotionPhase& flight,
                                                    std::span<const ConstraintKey> known, FlightLook& look);

private:
  void add(const LocatedBody& at, const MotionPhase& flight, double share, const ConstraintSet& found);
  void locate(const LocatedBody& at, const MotionPhase& flight, std::size_t which, FlightLook& look);

  std::vector<ConstraintKey> known_;
  std::vector<FlightClosing> list_;
};

}  // namespace carom
