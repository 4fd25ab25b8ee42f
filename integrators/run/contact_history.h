#pragma once

/// \file
/// Impulses of the contacts of the last step, by key: where sweeps over large islands start in the next one
/// (contact/solvers/nonlinear_cg_solver.h). Contacts of islands that are solved exactly are not kept.

#include <carom/core/constraint.h>
#include <carom/core/export.h>
#include <carom/core/ids.h>

#include <array>
#include <span>
#include <vector>

namespace carom {

/// Contacts and their impulses, found by key in a time that does not depend on their number.
class CAROM_API ContactHistory {
public:
  /// Impulse of one contact.
  struct Entry {
    ConstraintKey key;                ///< identity
    std::array<double, 2> impulse{};  ///< along its rows [N s]
  };

  /// Forgets all contacts. \param step length of the step whose impulses are to be added [s]
  void start(double step);
  /// Adds a contact of that step.
  void add(const ConstraintKey& key, const std::array<double, 2>& impulse);
  /// Makes the contacts ready to be found, after the last add().
  void finish();

  /// True if there are none.
  [[nodiscard]] bool empty() const { return entries_.empty(); }
  /// All, in the order of add().
  [[nodiscard]] std::span<const Entry> entries() const { return entries_; }
  /// Length of their step [s].
  [[nodiscard]] double step() const { return step_; }
  /// A contact; null if it is not among them.
  [[nodiscard]] const Entry* find(const ConstraintKey& key) const;

private:
  [[nodiscard]] std::size_t slot_of(const ConstraintKey& key) const;

  double step_ = 0.0;
  std::vector<Entry> entries_;
  std::vector<Index> slots_;  // of a hash table, their number a power of two; none: empty
};

}  // namespace carom
