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

/// Such contacts of one clock group, from where they are found to where the event is resolved.
class CAROM_API UnboundedForces {
public:
  /// Forces that have outgrown all others by this are infinite nearby: W_nn - s mu W_nt has fallen to the
  /// inverse part of what it was.
  static constexpr double growth = 1e3;
  /// Likewise where steps have come to the rounding of time, which may be before that.
  static constexpr double least_growth = 1e2;

  /// Forgets all.
  void clear() { found_.reset(); }
  /// Finds them among closed contacts, with their forces. True if there are any. \param bound of forces [N]
  bool find(std::span<const ActiveContact> contacts, double bound);
  /// True if that of a pair is one.
  [[nodiscard]] bool contains(const ContactPair& pair) const;

  /// Reason why the flow ended there, for messages; empty where there are none.
  [[nodiscard]] std::string reason() const { return found_ ? found_->reason : std::string(); }
  /// Sets it, where some are found.
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
