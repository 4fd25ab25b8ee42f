#pragma once

/// \file
/// Records a run as comma-separated values, digits exact (each number reads back to the same double).

#include <carom/core/export.h>
#include <carom/core/ids.h>
#include <carom/integrators/callback_id.h>

#include <memory>
#include <string>
#include <vector>

namespace carom {

class Simulation;

/// Writes a row for the present state and one after every accepted step: time, positions, angles, velocities
/// and spins of the chosen bodies, and every term of the energy ledger. The first line names the columns
/// with their units, e.g. "time [s],lower.x [m],...,kinetic [J]". The fields of a body stay empty once it was
/// removed from the model. A row that cannot be written is a FileError out of Simulation::step(), after the
/// step; the other observers are called all the same.
class CAROM_API CsvRecorder {
public:
  /// Options of the record.
  struct Options {
    std::vector<BodyId> bodies{};  ///< all bodies if empty
    int every_steps = 1;           ///< a row after every so many steps, >= 1
    bool energies = true;          ///< the energy ledger too
  };

  /// Records `simulation` into a file until the simulation ends or detach(). Throws FileError if it cannot be
  /// written, ModelError for a body that is not in the model.
  CsvRecorder(Simulation& simulation, const std::string& path, const Options& options);
  /// Records everything at every step.
  CsvRecorder(Simulation& simulation, const std::string& path);

  /// Writes what is still in memory. Throws FileError if it cannot be written.
  void flush();
  /// Ends the recording of this simulation and writes what is still in memory. Throws FileError if it cannot
  /// be written; ModelError if the simulation is not the one that is recorded, or no longer is.
  void detach(Simulation& simulation);
  /// Rows written so far, without the header.
  [[nodiscard]] long rows() const;

private:
  struct Impl;
  std::shared_ptr<Impl> impl_;
  CallbackId observer_;
};

}  // namespace carom
