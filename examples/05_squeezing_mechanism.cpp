// Andrews' squeezing mechanism: seven rigid bodies, ten pins, one degree of freedom, a spring and a constant
// torque, for the 0.03 s in which it turns two and a half times.
//
//   M a = f + G^T lambda,  g(q) = 0      21 coordinates, 20 rows of pins; dynamics in absolute coordinates
//   start                                at rest, closed up to rounding
//   event-driven                         accelerations and multipliers from one sparse system, relative 1e-12
//   time stepping                        h = 1e-5 s, reactions in the middle of the step, velocities
//                                        satisfy the pins at its end
//
// Reference at 0.03 s: the test set for initial value problems ("Andrews' squeezing mechanism").
//
// Usage: 05_squeezing_mechanism <folder>: writes angles.csv and outline.csv there and prints how far both
// modes are from the reference.

#include <carom/carom.h>

#include "examples/scenes/squeezer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <iostream>
#include <string>
#include <vector>

namespace {

constexpr double end = 0.03;         // [s]
constexpr double interval = 5e-5;    // [s], between rows
constexpr double step = 1e-5;        // [s], of time stepping
constexpr double tolerance = 1e-12;  // of the event-driven mode
constexpr int outlines = 7;          // drawn
// beta, Theta, gamma, Phi, delta, Omega, epsilon at 0.03 s [rad]
constexpr std::array reference{15.81077119629904,   -15.75637105984298, 0.04082224013073101,
                               -0.5347301163226948, 0.5244099658805303, 0.5347301163226948,
                               1.048080741042263};
constexpr std::array names{"beta", "Theta", "gamma", "Phi", "delta", "Omega", "epsilon"};

std::ofstream open(const std::filesystem::path& path) {
  std::ofstream file(path);
  if (!file) throw carom::FileError("'" + path.string() + "' cannot be written");
  file << std::setprecision(17);
  return file;
}

std::array<double, 7> angles(const carom::State& state, const std::vector<scenes::SqueezerBody>& bodies) {
  std::array<double, 7> of_bodies{};
  for (std::size_t i = 0; i < of_bodies.size(); ++i) of_bodies[i] = state.angle(bodies[i].id);
  return scenes::squeezer_angles(of_bodies);
}

void write_outline(std::ostream& out, double time, const carom::State& state,
                   const std::vector<scenes::SqueezerBody>& bodies) {
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const double c = std::cos(state.angle(bodies[i].id)), s = std::sin(state.angle(bodies[i].id));
    for (const carom::Vec<2>& point : bodies[i].points) {
      const auto centre = state.position(bodies[i].id);
      out << time << ",K" << i + 1 << ',' << centre[0] + c * point[0] - s * point[1] << ','
          << centre[1] + s * point[0] + c * point[1] << '\n';
    }
  }
}

/// Runs to the end and returns the largest error of the angles.
double run(const std::string& title, const carom::Mode& mode, const std::filesystem::path& folder) {
  carom::System system;
  const std::vector<scenes::SqueezerBody> bodies = scenes::add_squeezer(system);
  carom::Simulation simulation(system, mode);
  if (!folder.empty()) {
    std::ofstream rows = open(folder / "angles.csv"), outline = open(folder / "outline.csv");
    rows << "time [s]";
    for (const char* const name : names) rows << ',' << name << " [rad]";
    rows << ",reaction at O [N]\n";
    outline << "time [s],body,x [m],y [m]\n";
    const int count = static_cast<int>(std::lround(end / interval));
    for (int i = 0; i <= count; ++i) {
      simulation.run_until(std::min(end, i * interval));
      rows << simulation.time();
      for (const double angle : angles(simulation.state(), bodies)) rows << ',' << angle;
      const carom::JointReaction pin = simulation.reaction(simulation.system().joint("O"));
      rows << ',' << std::hypot(pin.force[0], pin.force[1]) << '\n';
      if (i % (count / (outlines - 1)) == 0)
        write_outline(outline, simulation.time(), simulation.state(), bodies);
    }
  }
  simulation.run_until(end);
  const std::array<double, 7> found = angles(simulation.state(), bodies);
  double error = 0.0;
  for (std::size_t i = 0; i < found.size(); ++i) error = std::max(error, std::abs(found[i] - reference[i]));
  std::cout << title << ": " << simulation.mobility().degrees_of_freedom
            << " degree of freedom; angles at 0.03 s differ from the reference by at most " << error
            << " rad\n"
            << simulation.energy() << "\n";
  return error;
}

}  // namespace

int main(int count, char** arguments) try {
  const std::filesystem::path folder = count > 1 ? arguments[1] : ".";
  std::filesystem::create_directories(folder);
  std::cout << std::setprecision(7);

  run("Event-driven", carom::EventDriven{.relative_tolerance = tolerance, .absolute_tolerance = tolerance},
      folder);
  run("Time stepping", carom::TimeStepping{.step = step}, {});
  return EXIT_SUCCESS;
} catch (const std::exception& error) {
  std::cerr << "05_squeezing_mechanism: " << error.what() << "\n";
  return EXIT_FAILURE;
}
