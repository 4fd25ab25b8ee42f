#pragma once

/// \file
/// The flights of bodies that shapes on ground hit within a step (LocatedMotion), as far as the whole step is
/// looked at afterwards: where the ways of bodies have corners, and how loads accelerate them at its end.

#include <carom/contact/detection/contact_pair.h>
#include <carom/core/export.h>
#include <carom/core/ids.h>
#include <carom/core/state.h>
#include <carom/integrators/time_stepping/located_motion.h>
#include <carom/integrators/time_stepping/step_input.h>

#include <array>
#include <cstddef>
#include <vector>

namespace carom {

/// Flights of a step. Keeps memory.
class CAROM_API StepFlights {
public:
  /// Forgets all: a step begins.
  void clear() {
    corners_.clear();
    last_.clear();
  }
  /// Adds the motion of a body.
  void add(const StepInput& in, const LocatedMotion& motion);
  /// True if no body was hit.
  [[nodiscard]] bool empty() const { return corners_.empty(); }
  /// True of a pair of a shape on ground and a body that is added: its closings are followed by the motion of
  /// the body.
  [[nodiscard]] bool follow(const ContactPair& pair) const;
  /// Writes the corners of the way of all bodies, its ends included: between two of them all coordinates are
  /// taken to change evenly. Of the plane. Returns how many there are; `out` may have more.
  std::size_t write_way(const State& start, const State& end, std::vector<State>& out);
  /// Mean accelerations over a step between two states, impacts left out: of bodies that were hit those of
  /// their last flight. \param v velocities at the start, behind impacts there \param out over all velocities
  /// [m/s^2, rad/s^2]
  void write_accelerations(const std::vector<double>& v, const State& end, double step,
                           std::vector<double>& out) const;

private:
  static constexpr std::size_t most_coordinates = 7, most_velocities = 6;
  // A body is hit.
  struct Corner {
    double share;  // of the step
    BodySlot body;
    std::array<double, most_coordinates> q;  // where it is then
  };
  // The last flight of a body.
  struct LastFlight {
    BodySlot body;
    Index number;  // of the body, in the order of assembly
    std::array<double, most_velocities> acceleration;
  };

  std::vector<Corner> corners_;  // body after body, ascending
  std::vector<LastFlight> last_;
  std::vector<double> shares_;  // of corners, each once
};

}  // namespace carom
