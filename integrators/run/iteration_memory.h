#pragma once

/// \file
/// Which iteration the steps of a component begin with under Iteration::automatic, by how the last ones
/// ended.

#include <carom/core/export.h>
#include <carom/core/ids.h>
#include <carom/integrators/run/time_stepping.h>

#include <span>
#include <vector>

namespace carom {

/// Components whose last step was not ended by the fixed-point iteration; empty in most runs. Part of the
/// companion, so that a run that continues from a checkpoint begins its steps as the whole run does.
class CAROM_API IterationMemory {
public:
  /// Steps in a row that the fixed-point iteration must fail before steps begin with another iteration.
  static constexpr int patience = 3;
  /// From then on it is tried again in every step of this number.
  static constexpr int retry_interval = 32;

  /// Memory of one component.
  struct Entry {
    Index component = none;                     ///< place in the assembly
    Iteration solved = Iteration::fixed_point;  ///< by which its last step was ended
    int steps = 0;  ///< in a row not ended by the fixed-point iteration, `patience` again after every retry
    friend bool operator==(const Entry&, const Entry&) = default;
  };

  /// The iteration with which the next step of a component begins.
  [[nodiscard]] Iteration first(Index component) const;
  /// The iteration with which the next step of several components that contact joins begins: the strongest of
  /// those of the components.
  [[nodiscard]] Iteration first(std::span<const Index> components) const;
  /// Takes the end of a step of one component over into the memory after this step: `before` is the memory
  /// before it. Each component comes once, in any order; those that are left out are forgotten.
  void record(const IterationMemory& before, Index component, Iteration solved);
  /// Forgets all components.
  void clear() { entries_.clear(); }
  /// Exchanges what is remembered.
  void swap(IterationMemory& other) { entries_.swap(other.entries_); }

  /// All entries, ordered by component.
  [[nodiscard]] const std::vector<Entry>& entries() const { return entries_; }
  /// Sets one of a checkpoint, behind those there are; false if it cannot be.
  [[nodiscard]] bool append(const Entry& entry);

private:
  [[nodiscard]] const Entry* find(Index component) const;

  std::vector<Entry> entries_;
};

}  // namespace carom
