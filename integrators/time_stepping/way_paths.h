#pragma once

/// \file
/// The way of a step as paths that are searched one after the other: that between its ends on which
/// velocities change evenly; where a body is hit on it, one from each impact to the next.

#include <carom/contact/detection/detector.h>
#include <carom/contact/detection/state_path.h>
#include <carom/core/assembly.h>
#include <carom/core/export.h>
#include <carom/core/state.h>
#include <carom/integrators/run/companion.h>
#include <carom/integrators/time_stepping/step_flights.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace carom {

/// The way of a step, or of a part of one.
struct StepWay {
  const State& start;
  const State& end;                          ///< before bodies are moved out of others
  const std::vector<double>& after_impacts;  ///< velocities behind impacts at the start
  StepFlights& flights;                      ///< of bodies that are hit on it
  std::span<const std::pair<ConstraintKey, ContactMode>>
      acted;                 ///< contacts of the step, as Companion::modes
  ChosenBodies bodies = {};  ///< whose way it is
};

/// Goes along the paths of a way. Keeps memory only.
class CAROM_API WayPaths {
public:
  /// Which path a way has on which nothing is hit.
  enum class Form : std::uint8_t {
    chord,    ///< straight
    parabola  ///< from the velocities behind impacts at its start to those at its end
  };

  /// \param assembly,detector must outlive it
  WayPaths(const Assembly& assembly, const Detector& detector)
      : path_(assembly, detector), whole_(assembly, detector) {}

  /// Begins a way, before its first path.
  void begin(const StepWay& way, Form form);
  /// Goes to the next path that takes time. \returns false behind the last
  [[nodiscard]] bool next();
  /// The path at hand.
  [[nodiscard]] StatePath& path() { return path_; }
  /// The path at hand.
  [[nodiscard]] const StatePath& path() const { return path_; }
  /// A path from where the way begins to where it ends, with the velocities there.
  [[nodiscard]] const StatePath& whole() const { return bends() ? whole_ : path_; }

private:
  void set_whole(const StepWay& way);
  [[nodiscard]] bool bends() const { return !flights_->empty(); }

  StatePath path_, whole_;
  const StepFlights* flights_ = nullptr;  // of the way at hand
  ChosenBodies bodies_;                   // of the way at hand
  std::vector<double> change_, between_;  // of velocities on it; on a path of it
  std::vector<State> corners_;
  std::size_t count_ = 0, corner_ = 0;  // of corners, and that at which the path at hand ends
};

}  // namespace carom
