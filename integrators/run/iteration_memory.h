#pragma once

/// \file
/// Which iteration the steps of an island begin with under Iteration::automatic, by how the last ones ended.

#include <carom/core/export.h>
#include <carom/core/ids.h>
#include <carom/integrators/run/time_stepping.h>

#include <vector>

namespace carom {

/// Islands whose last step was not ended by the fixed-point iteration; empty in most runs. Part of the
/// companion, so that a run that continues from a checkpoint begins its steps as the whole run does.
class CAROM_API IterationMemory {
public:
  /// Steps in a row that the fixed-point iteration must fail before steps begin with another iteration.
  static constexpr int patience = 3;
  /// From then on it is tried again in every step of this number.
  static constexpr int retry_interval = 32;

  /// Memory of one island.
  struct Entry {
    Index island = none;                        ///< place in the assembly
    Iteration solved = Iteration::fixed_point;  ///< by which its last step was ended
    int steps = 0;  ///< in a row not ended by the fixed-point iteration, `patience` again after every retry
    friend bool operator==(const Entry&, const Entry&) = default;
  };

  /// The iteration with which the next step of an island begins.
  [[nodiscard]] Iteration first(Index island) const;
  /// Takes the end of a step of one island over into the memory after this step: `before` is the memory
  /// before it. Islands must come in their order; those that are left out are forgotten.
  void record(const IterationMemory& before, Index island, Iteration solved);
  /// Forgets all islands.
  void clear() { entries_.clear(); }
  /// Exchanges what is remembered.
  void swap(IterationMemory& other) { entries_.swap(other.entries_); }

  /// All entries, ordered by island.
  [[nodiscard]] const std::vector<Entry>& entries() const { return entries_; }
  /// Sets one of a checkpoint, behind those there are; false if it cannot be.
  [[nodiscard]] bool append(const Entry& entry);

private:
  [[nodiscard]] const Entry* find(Index island) const;

  std::vector<Entry> entries_;
};

}  // namespace carom
