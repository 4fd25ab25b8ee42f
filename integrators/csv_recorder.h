#pragma once

/// \file
/// Records a run as comma-separated values, digits exact (each number reads back to the same double).

#include <carom/core/export.h>
#include <carom/core/ids.h>

#include <memory>
#include <string>
#include <vector>

namespace carom {

class Simulation;

/// Writes a row for the present state and one after every accepted step: time, positions, angles, velocities
/// and spins of the chosen bodies, and every term of the energy ledger. The first line names the columns
/// with their units, e.g. "time [s],lower.x [m],...,kinetic [J]".
class CAROM_API CsvRecorder {
public:
  /// What to record.
  struct Options {
    std::vector<BodyId> bodies{};  ///< all bodies if empty
    int every_steps = 1;           ///< a row after every so many steps, >= 1
    bool energies = true;          ///< the energy ledger too
  };

  /// Records `simulation` into a file until the simulation ends. Throws FileError if it cannot be written,
  /// ModelError for a body that is not in the model.
  CsvRecorder(Simulation& simulation, const std::string& path, const Options& options);
  /// Records everything at every step.
  CsvRecorder(Simulation& simulation, const std::string& path);

  /// Writes what is still in memory. Throws FileError if it cannot be written.
  void flush();
  /// Rows written so far, without the header.
  [[nodiscard]] long rows() const;

private:
  struct Impl;
  std::shared_ptr<Impl> impl_;
};

}  // namespace carom
