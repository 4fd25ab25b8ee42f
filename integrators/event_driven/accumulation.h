#pragma once

/// \file
/// Accumulations of impacts (Zeno): infinitely many in a finite time, which the latest of them foreshadow.

#include <carom/core/constraint.h>
#include <carom/core/export.h>

#include <cstddef>
#include <span>
#include <vector>

namespace carom {

/// The latest impacts of one clock group.
class CAROM_API Accumulation {
public:
  /// Forgets all: a new motion.
  void clear() { impacts_.clear(); }
  /// Remembers an impact. \param time not before that of the last one [s]
  void remember(double time, const ConstraintKey& contact);
  /// Remembers the impacts of another group too.
  void take(const Accumulation& other);
  /// Time at which infinitely many impacts would have ended [s], by the times up to an impact that is not
  /// remembered yet; NaN where the intervals do not shrink in a constant ratio.
  [[nodiscard]] double end(double time) const;
  /// Likewise where impacts of other contacts may have come in between, which had nothing to do with these:
  /// of all impacts, or else of those of the constraints that close.
  [[nodiscard]] double end(double time, std::span<const Constraint> closing) const;

private:
  struct Impact {
    double time;
    ConstraintKey contact;
    friend bool operator==(const Impact&, const Impact&) = default;
  };
  static constexpr std::size_t remembered = 32;
  std::vector<Impact> impacts_;  // in time
};

}  // namespace carom
