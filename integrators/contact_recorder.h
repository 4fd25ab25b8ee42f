#pragma once

/// \file
/// Records the contacts of a run as comma-separated values, digits exact.

#include <carom/core/export.h>
#include <carom/integrators/callback_id.h>

#include <memory>
#include <string>

namespace carom {

class Simulation;

/// Writes a row for every contact of every accepted step (StepReport::contacts): names of both parts, point,
/// normal, gap, velocities before and after, impulse, mean force over the step, mode. A contact that lasts
/// through several parts of a step (step control, located impacts) has a row of each, with their mean force.
/// Of an impact the mean force stays empty: it has no duration. In the event-driven mode rows are of impacts
/// only. The first line names the columns with their units. A row that cannot be written is a FileError out
/// of Simulation::step(), after the step.
class CAROM_API ContactRecorder {
public:
  /// Records `simulation` into a file until the simulation ends or detach(). Throws FileError if it cannot be
  /// written.
  ContactRecorder(Simulation& simulation, const std::string& path);

  /// Writes what is still in memory. Throws FileError if it cannot be written.
  void flush();
  /// Ends the recording and writes what is still in memory. Throws FileError if it cannot be written;
  /// ModelError if the simulation is not the one that is recorded, or no longer is.
  void detach(Simulation& simulation);
  /// Rows written so far, without the header.
  [[nodiscard]] long rows() const;

private:
  struct Impl;
  std::shared_ptr<Impl> impl_;
  CallbackId observer_;
};

}  // namespace carom
