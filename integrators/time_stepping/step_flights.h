#pragma once

/// \file
/// The flights of bodies that shapes on ground hit within a step (LocatedMotion), as far as the whole step is
/// looked at afterwards: where bodies fly, and how loads accelerate them.

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
  void clear() { flights_.clear(); }
  /// Adds the motion of a body.
  void add(const StepInput& in, const LocatedMotion& motion);
  /// True if no body was hit.
  [[nodiscard]] bool empty() const { return flights_.empty(); }
  /// True of a pair of a shape on ground and a body that is added: its closings are followed by the motion of
  /// the body.
  [[nodiscard]] bool follow(const ContactPair& pair) const;
  /// Writes the corners of the way of all bodies, its ends included. Between two corners velocities change
  /// evenly: those of bodies that were hit over each flight, of others over the step. Of the plane. Returns
  /// how many there are; `out` may have more. \param change of velocities over the step, of bodies that were
  /// not hit
  std::size_t write_way(const State& start, const State& end, const std::vector<double>& change,
                        std::vector<State>& out);
  /// Writes by how much velocities change between two corners. \param change as of write_way() \param from,to
  /// shares of the step
  void write_changes(double from, double to, const std::vector<double>& change,
                     std::vector<double>& out) const;
  /// Mean accelerations over a step between two states, impacts left out: of bodies that were hit those of
  /// their last flight. \param v velocities at the start, behind impacts there \param out over all velocities
  /// [m/s^2, rad/s^2]
  void write_accelerations(const std::vector<double>& v, const State& end, double step,
                           std::vector<double>& out) const;

private:
  static constexpr std::size_t most_coordinates = 7, most_velocities = 6;
  struct Flight {
    BodySlot body;
    Index number;                                // of the body, in the order of assembly
    double begin, end;                           // shares of the step
    double step;                                 // its length [s]
    std::array<double, most_coordinates> q;      // at its begin
    std::array<double, most_velocities> change;  // of the velocities over it
  };
  [[nodiscard]] bool is_last(std::size_t flight) const {
    return flight + 1 == flights_.size() || flights_[flight + 1].number != flights_[flight].number;
  }

  std::vector<Flight> flights_;  // body after body, ascending
  std::vector<double> shares_;   // where they begin within the step, each once
};

}  // namespace carom
