#pragma once

// Scenes of floors that are made of several pieces, runs of them in all modes, and what slides over them.

#include <carom/carom.h>

#include <array>
#include <cmath>
#include <string>

namespace carom_test::floors {

using namespace carom;
using namespace carom::planar;

constexpr double g = 9.81;

enum class Schedule { at_step_start, located, event_driven, switched };
constexpr std::array<Schedule, 4> runs{Schedule::at_step_start, Schedule::located, Schedule::event_driven,
                                       Schedule::switched};

inline std::string name(Schedule run) {
  constexpr std::array<const char*, 4> names{"time stepping", "located", "event-driven", "switch_to"};
  return names[static_cast<std::size_t>(run)];
}

inline Simulation run_of(const System& system, Schedule run, double until) {
  if (run == Schedule::event_driven) {
    Simulation simulation(system, EventDriven{});
    simulation.run_until(until);
    return simulation;
  }
  const ImpactTimes impacts = run == Schedule::located ? ImpactTimes::located : ImpactTimes::at_step_start;
  Simulation simulation(system, TimeStepping{.step = 1e-3, .impacts = impacts});
  if (run == Schedule::switched) {
    simulation.run_until(0.1);
    simulation.switch_to(EventDriven{});
  }
  simulation.run_until(until);
  return simulation;
}

/// A frame that is turned by an angle, at a place.
struct Frame {
  double angle = 0.0;
  Vec<2> origin = Vec<2>::Zero();
  [[nodiscard]] Vec<2> direction(double x, double y) const {
    return {std::cos(angle) * x - std::sin(angle) * y, std::sin(angle) * x + std::cos(angle) * y};
  }
  [[nodiscard]] Vec<2> place(double x, double y) const { return origin + direction(x, y); }
};

inline planar::Block tile(const Frame& at, double from, double to, double top, double height) {
  return {.vertices = {at.place(from, top - height), at.place(to, top - height), at.place(to, top),
                       at.place(from, top)}};
}

inline System empty(const Frame& at, Surface law) {
  System system;
  system.add(Gravity{at.direction(0.0, -g)});
  system.set_default_law(law);
  return system;
}

inline BodyId add_box(System& system, const Frame& at, double x, double half, double high, double speed) {
  const BodyId body = system.add(RigidBody{.mass = box(1.0, 2.0 * half, 2.0 * high),
                                           .position = at.place(x, high),
                                           .angle = at.angle,
                                           .velocity = at.direction(speed, 0.0)});
  system.add(Polygon{.body = body, .vertices = {{-half, -high}, {half, -high}, {half, high}, {-half, high}}});
  return body;
}

}  // namespace carom_test::floors
