// A ball with spin bounces in a box of inclined planes, slides, rolls and comes to rest, in both modes.
//
//   m a = m g, I alpha = 0              between contacts; a disc, m = 0.5 kg, r = 0.05 m, I = m r^2/2
//   gap_i = n_i.(x - p_i) - r >= 0      floor (falls by 0.2 rad), left and right wall (lean out by 0.15 rad)
//   impact law                          xi = (e gamma^- + gamma^+)/(1 + e), Signorini in the normal and
//                                       Coulomb in the tangential direction, e_n = 0.5, e_t = 0, mu = 0.1
//   lasting contact                     a_n = 0, lambda_n >= 0, |lambda_t| <= mu lambda_n; while sliding
//                                       lambda_t = -mu lambda_n sign(gamma_t)
//   event-driven                        events located in time, smooth phases to a relative 1e-9
//   time stepping                       h = 1e-3 s
//
// Impacts accumulate (Zeno) several times: on the floor, between floor and wall, and on both in the corner.
//
// Usage: 03_ball_in_a_box <folder>: writes event_driven.csv, events.csv and time_stepping.csv there; prints
// events by kind and energies.

#include <carom/carom.h>

#include "examples/scenes/box.h"

#include <cmath>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <iomanip>
#include <iostream>
#include <string>

namespace {

constexpr double step = 1e-3;      // [s], of time stepping
constexpr double interval = 2e-3;  // [s], between rows of the event-driven run
constexpr double end = 3.2;        // [s]

carom::State run(const std::string& title, const carom::Mode& mode, const std::filesystem::path& file,
                 const std::filesystem::path& events) {
  carom::System system;
  const carom::BodyId ball = scenes::add_box(system, {});
  carom::Simulation simulation(system, mode);
  carom::CsvRecorder recorder(simulation, file.string());
  simulation.run_until(end);
  recorder.flush();

  std::cout << title << "\n";
  if (!events.empty()) {
    simulation.write_events(events.string());
    const carom::Statistics& statistics = simulation.statistics();
    for (std::size_t kind = 0; kind < carom::event_kind_count; ++kind) {
      if (statistics.events[kind] == 0) continue;
      std::cout << "  " << std::setw(5) << statistics.events[kind] << "  "
                << to_string(static_cast<carom::EventKind>(kind)) << "\n";
    }
    std::cout << "  " << statistics.flow_steps << " steps of the integrator, " << statistics.flow_evaluations
              << " evaluations; last event at t = " << simulation.events().back().time << " s\n";
  }
  const carom::State& state = simulation.state();
  std::cout << "  at t = " << end << " s: ball at (" << state.position(ball).transpose() << ") m, velocity ("
            << state.velocity(ball).transpose() << ") m/s, spin " << state.spin(ball) << " rad/s\n"
            << simulation.energy() << "\n";
  return state;
}

}  // namespace

int main(int count, char** arguments) try {
  const std::filesystem::path folder = count > 1 ? arguments[1] : ".";
  std::filesystem::create_directories(folder);
  std::cout << std::setprecision(7);

  const carom::State exact = run("Event-driven", carom::EventDriven{.interval = interval},
                                 folder / "event_driven.csv", folder / "events.csv");
  const carom::State stepped =
      run("Time stepping", carom::TimeStepping{.step = step}, folder / "time_stepping.csv", {});
  std::cout << "The modes end " << std::hypot(exact.q[0] - stepped.q[0], exact.q[1] - stepped.q[1])
            << " m apart.\n";
  return EXIT_SUCCESS;
} catch (const std::exception& error) {
  std::cerr << "03_ball_in_a_box: " << error.what() << "\n";
  return EXIT_FAILURE;
}
