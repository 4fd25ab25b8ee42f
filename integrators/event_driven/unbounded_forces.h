#pragma once

/// \file
/// Contacts whose forces grow without bound where a flow comes to (Painleve).

#include <carom/contact/active_set.h>
#include <carom/contact/detection/detector.h>
#include <carom/core/export.h>

#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace carom {

/// Contacts of one clock group whose forces grow without bound, from where they are found to where the event
/// is resolved.
class CAROM_API UnboundedForces {
public:
  /// Forces that have outgrown all others by this are infinite nearby: W_nn - s mu W_nt has fallen to the
  /// inverse part of what it was.
  static constexpr double growth = 1e3;
  /// Least growth of forces that are infinite nearby where steps have come to the rounding of time, which may
  /// be before forces have grown by `growth`.
  static constexpr double least_growth = 1e2;

  /// Forgets all.
  void clear() { found_.reset(); }
  /// Finds forces beyond a bound among closed contacts. True if there are any.
  /// \param contacts with their forces \param bound of forces [N]
  bool find(std::span<const ActiveContact> contacts, double bound);
  /// True if the force of a pair is among those that find() found.
  [[nodiscard]] bool contains(const ContactPair& pair) const;

  /// Reason why the flow ended there, for messages; empty where there are none.
  [[nodiscard]] std::string reason() const { return found_ ? found_->reason : std::string(); }
  /// Sets the reason why the flow ended there, where forces are found.
  void set_reason(std::string reason) {
    if (found_) found_->reason = std::move(reason);
  }

private:
  struct Found {
    std::vector<ContactPair> pairs;
    std::string reason;
  };

  std::unique_ptr<Found> found_;  // hardly any group ever has some, and there are many groups
};

}  // namespace carom
