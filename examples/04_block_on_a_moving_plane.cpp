// A block on an inclined plane that oscillates in its own direction with growing amplitude: it sticks, then
// slips downhill, and in the end slips in both directions.
//
//   m a = m g + (lambda_n1 + lambda_n2) n + (lambda_t1 + lambda_t2) t, I alpha = moments of the same forces
//   plane                     slope 0.1 rad, displacement s(t) t along its tangent t, s = c t sin(omega t),
//                             c = 0.018 m/s, omega = 4 pi/s
//   contact at two corners    gap >= 0, e_n = 0; gamma_t is the tangential velocity relative to the plane
//   sticking                  gamma_t = 0 while |lambda_t| <= mu_s lambda_n, mu_s = 0.4
//   slipping                  lambda_t = -mu_k lambda_n sign(gamma_t), mu_k = 0.3
//   event-driven              changes of mode located in time, smooth phases to a relative 1e-9
//   time stepping             h = 1e-3 s, the same law in every step
//
// While it sticks at both corners, the forces of the single corners are not unique, but their sums are.
//
// Usage: 04_block_on_a_moving_plane <folder>: writes event_driven.csv, events.csv and time_stepping.csv there
// and prints when the block slips and sticks.

#include <carom/carom.h>

#include "examples/scenes/shaker.h"

#include <cmath>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <iostream>
#include <string>

namespace {

constexpr double step = 1e-3;      // [s], of time stepping
constexpr double interval = 2e-3;  // [s], between rows of the event-driven run
constexpr double end = 3.0;        // [s]

/// Writes velocities along the plane, and how far the block has slipped on it.
class Recorder {
public:
  Recorder(carom::BodyId block, const scenes::Shaker& shaker, const std::string& path)
      : block_(block), shaker_(shaker), file_(path) {
    if (!file_) throw carom::FileError("'" + path + "' cannot be written");
    file_ << std::setprecision(17)
          << "time [s],velocity of the block [m/s],velocity of the plane [m/s],slipped [m]\n";
  }
  void write(const carom::Simulation& now) {
    const carom::Vec<2> normal = carom::planar::incline(shaker_.slope), tangent(normal[1], -normal[0]);
    const double t = now.time();
    file_ << t << ',' << now.state().velocity(block_).dot(tangent) << ',' << shaker_speed(shaker_, t) << ','
          << now.state().position(block_).dot(tangent) - shaker_displacement(shaker_, t) << '\n';
  }

private:
  carom::BodyId block_;
  scenes::Shaker shaker_;
  std::ofstream file_;
};

carom::State run(const std::string& title, const carom::Mode& mode, const std::filesystem::path& file,
                 const std::filesystem::path& events) {
  const scenes::Shaker shaker;
  carom::System system;
  const carom::BodyId block = scenes::add_shaker(system, shaker);
  carom::Simulation simulation(system, mode);
  Recorder recorder(block, shaker, file.string());
  recorder.write(simulation);
  simulation.observe([&](const carom::Simulation& now) { recorder.write(now); });
  simulation.run_until(end);

  std::cout << title << "\n";
  if (!events.empty()) simulation.write_events(events.string());
  for (const carom::EventRecord& event : simulation.events()) {
    std::cout << "  t = " << std::setw(9) << event.time << " s  " << std::setw(8) << to_string(event.kind)
              << "  " << simulation.name(event) << " (" << to_string(event.mode) << ")\n";
  }
  std::cout << simulation.energy() << "\n";
  return simulation.state();
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
  std::cerr << "04_block_on_a_moving_plane: " << error.what() << "\n";
  return EXIT_FAILURE;
}
