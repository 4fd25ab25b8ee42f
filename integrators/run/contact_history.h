#pragma once

/// \file
/// Impulses of the contacts of the last step, by key: where sweeps over large islands start in the next one
/// (contact/solvers/nonlinear_cg_solver.h). Contacts of islands that are solved exactly are not kept.

#include <carom/core/constraint_table.h>

#include <array>
#include <vector>

namespace carom {

/// Contacts and their impulses.
struct ContactHistory {
  double step = 0.0;                            ///< length of their step [s]
  ConstraintTable contacts;                     ///< by key
  std::vector<std::array<double, 2>> impulses;  ///< along their rows, in the same order [N s]

  /// Forgets all contacts. \param length of the step whose impulses are to be added [s]
  void start(double length) {
    step = length;
    if (empty()) return;
    contacts.clear();
    impulses.clear();
  }
  /// True if there are no contacts.
  [[nodiscard]] bool empty() const { return impulses.empty(); }
  /// Adds a contact of that step.
  void add(const ConstraintKey& key, const std::array<double, 2>& impulse) {
    contacts.add(key);
    impulses.push_back(impulse);
  }
};

}  // namespace carom
