#pragma once

/// \file
/// Accumulations of impacts (Zeno): infinitely many in a finite time, which the latest of them foreshadow.

#include <carom/core/constraint.h>
#include <carom/core/export.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace carom {

/// The latest impacts of one clock group.
class CAROM_API Accumulation {
public:
  /// Forgets all: a new motion.
  void clear();
  /// Remembers an impact. \param time not before that of the last one [s]
  void remember(double time, const ConstraintKey& contact);
  /// Remembers the impacts of another group too.
  void take(const Accumulation& other);
  /// Time at which infinitely many impacts would have ended [s], by the times up to an impact that is not
  /// remembered yet; NaN where the intervals do not shrink in a constant ratio.
  [[nodiscard]] double end(double time) const;
  /// Time at which infinitely many impacts would have ended [s], by the times up to an impact that is not
  /// remembered yet: by the times of all impacts, or, where their intervals do not shrink in a constant
  /// ratio, by those of impacts of the constraints that close. (Impacts of other contacts may have come in
  /// between.) NaN where neither do.
  [[nodiscard]] double end(double time, std::span<const Constraint> closing) const;

private:
  static constexpr std::size_t remembered = 32;
  // Contacts that no impact has any more are let go of now and then: in a gas every impact has another one.
  // While the impacts of two groups are put together they have up to twice as many.
  static constexpr std::size_t most_contacts = 2 * remembered;

  [[nodiscard]] const ConstraintKey& contact(std::size_t impact) const { return contacts_[of_[impact]]; }
  void forget_contacts();
  [[nodiscard]] std::uint8_t place(const ConstraintKey& contact);
  void insert(std::size_t before, double time, const ConstraintKey& contact);
  void forget_first(std::size_t count);

  // Hardly any group has more than one or two contacts, and there are many groups.
  std::vector<double> times_;            // of the impacts, ascending
  std::vector<std::uint8_t> of_;         // by impact: place of its contact
  std::vector<ConstraintKey> contacts_;  // of impacts, each once
};

}  // namespace carom
