#pragma once

/// \file
/// Slow contacts of an instant: up to which speed impacts are slow, and how contacts that are slow get closed
/// (docs/method.md, section 7, *Accumulation of impacts*).

#include <carom/contact/active_contact.h>
#include <carom/core/export.h>
#include <carom/integrators/event_driven/event_instant.h>

#include <span>
#include <vector>

namespace carom {

/// Speed of what touches after a fall through the rounding of gaps [m/s], by its loads or by the forces of
/// contact before the event: heavy bodies on a light one throw it back harder than its own weight does.
/// \param pairs of an island
[[nodiscard]] CAROM_API double speed_of_rounding(std::span<const Index> pairs, const EventInstant& at);

/// Contacts up to this speed are slow [m/s]: the option `capture_speed`, or more. Far from the origin, or
/// under heavy bodies, bounces end in the rounding of gaps before they are as slow as the option says: each
/// would begin a little deeper than the one before it. \param pairs of an island
[[nodiscard]] CAROM_API double capture_speed(std::span<const Index> pairs, const EventInstant& at);

/// Closes contacts. Keeps memory only.
class CAROM_API ContactClosing {
public:
  /// Projects away the normal velocities and gaps of contacts, and the sliding of those in the mode `stick`.
  /// Books the energy as that of accumulations. False if some do not close, or only where bodies would move
  /// by more than EventInstant::longest_shift() and than their gaps tell, or change their velocities by more
  /// than what is stopped tells; the state is as before then. \param contacts brought up to date \param at
  /// brought to the state, and is so again \param others pairs that are closed with them once they touch and
  /// approach: what stops one contact may push another
  [[nodiscard]] bool close(std::vector<ActiveContact>& contacts, std::span<const Index> others,
                           EventInstant& at);

private:
  [[nodiscard]] static bool add_approaching(std::vector<ActiveContact>& contacts,
                                            std::span<const Index> others, const EventInstant& at);
  [[nodiscard]] static double speed_to_stop(const ActiveContact& contact, const EventInstant& at);
  [[nodiscard]] double largest_change(const EventInstant& at) const;
  [[nodiscard]] bool project(std::vector<ActiveContact>& contacts, std::span<const Index> others,
                             EventInstant& at) const;

  std::vector<double> before_;  // state
};

}  // namespace carom
