#pragma once

// Scenes in other units than m, kg and s, and how they end, in the units.

#include <carom/carom.h>

#include <vector>

namespace carom_test {

/// Units, in m, kg and s.
struct Units {
  double length, mass, time;

  [[nodiscard]] double speed() const { return length / time; }
  [[nodiscard]] double acceleration() const { return speed() / time; }
  [[nodiscard]] double force() const { return mass * acceleration(); }
};

/// Options of the event-driven mode by default, in units.
inline carom::EventDriven event_options_in(const Units& units) {
  carom::EventDriven options;
  options.absolute_tolerance *= units.length;
  options.gap_tolerance *= units.length;
  options.capture_speed *= units.speed();
  options.interval *= units.time;
  options.longest_step *= units.time;
  options.event_limit /= units.time;
  options.step_limit /= units.time;
  return options;
}

/// Places, angles, velocities and spins of planar bodies after some units of time, in the units.
inline std::vector<double> end_in(const Units& units, const carom::System& system, const carom::Mode& mode,
                                  double time) {
  carom::Simulation simulation(system, mode);
  simulation.run_until(time * units.time);
  std::vector<double> end;
  for (const carom::BodyId body : system.bodies()) {
    const carom::Vec<2> x = simulation.state().position(body) / units.length;
    const carom::Vec<2> v = simulation.state().velocity(body) / units.speed();
    const double spin = simulation.state().spin(body) * units.time;
    end.insert(end.end(), {x[0], x[1], simulation.state().angle(body), v[0], v[1], spin});
  }
  return end;
}

}  // namespace carom_test
