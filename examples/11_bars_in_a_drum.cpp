// Bars, discs and capsules in a drum that turns.
//
//   bodies       capsules, discs and convex polygons, m_i q_i'' = m_i g + impulses of contact
//   drum         the inside of a circle of radius 1 m, which turns at 1.5 rad/s: phi(t) = 1.5 t; two lifters,
//                walls that turn with it
//   contact      of bodies with each other, with the drum and its lifters: gap >= 0, e_n = e_t = 0, mu = 0.5
//   time stepping h = 1e-3 s, 4 s
//
// The drum lifts what lies in it by friction until it falls back. Its work is all that comes in, and what
// friction and impacts lose goes out; the energy account closes to rounding.
//
// Usage: 11_bars_in_a_drum <folder>: writes course.csv (energies and work over time), and bodies_1.csv to
// bodies_4.csv (outlines of the bodies at four times) there.

#include <carom/carom.h>

#include "examples/scenes/drum.h"

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

constexpr double step = 1e-3;                     // [s]
constexpr double times[] = {0.3, 1.0, 2.0, 4.0};  // [s], of the pictures; the last is the end

/// Writes the outlines of bodies where they are: one line for each vertex.
void write_bodies(const carom::Simulation& now, const std::vector<scenes::DrumBody>& bodies,
                  const std::string& path) {
  std::ofstream file(path);
  if (!file) throw carom::FileError("'" + path + "' cannot be written");
  file << "body,x [m],y [m],radius [m],angle [rad]\n" << std::setprecision(17);
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const double angle = now.state().angle(bodies[i].body);
    const auto place = now.state().position(bodies[i].body);
    for (const carom::Vec<2>& vertex : bodies[i].vertices) {
      file << i << ',' << place[0] + std::cos(angle) * vertex[0] - std::sin(angle) * vertex[1] << ','
           << place[1] + std::sin(angle) * vertex[0] + std::cos(angle) * vertex[1] << ',' << bodies[i].radius
           << ',' << angle << '\n';
    }
  }
}

/// Writes a row a step: energies, the work of the drum, what was lost.
void write_row(const carom::Simulation& now, std::ofstream& file) {
  const carom::EnergyLedger& energy = now.energy();
  file << now.time() << ',' << energy.kinetic() << ',' << energy.potential() << ','
       << energy.flow(carom::EnergyFlow::external) << ',' << energy.lost() << ',' << energy.residual() << ','
       << now.report().contacts.size() << '\n';
}

}  // namespace

int main(int count, char** arguments) try {
  const std::filesystem::path folder = count > 1 ? arguments[1] : ".";
  std::filesystem::create_directories(folder);

  carom::System system;
  const std::vector<scenes::DrumBody> bodies = scenes::add_drum(system, {});
  carom::Simulation simulation(system, carom::TimeStepping{.step = step});
  std::ofstream course(folder / "course.csv");
  course << std::setprecision(17)
         << "time [s],kinetic [J],potential [J],work [J],lost [J],residual [J],contacts\n";
  simulation.observe([&](const carom::Simulation& now) { write_row(now, course); });
  int picture = 0;
  for (const double time : times) {
    simulation.run_until(time);
    write_bodies(simulation, bodies, (folder / ("bodies_" + std::to_string(++picture) + ".csv")).string());
  }

  const carom::EnergyLedger& energy = simulation.energy();
  std::cout << std::setprecision(10) << "At t = " << simulation.time()
            << " s: " << simulation.report().contacts.size() << " contacts\n"
            << "  work of the drum " << energy.flow(carom::EnergyFlow::external) << " J, lost "
            << energy.lost() << " J\n"
            << "  deepest overlap of the run " << -simulation.statistics().deepest_gap
            << " m, largest residual " << simulation.statistics().worst_residual << "\n"
            << energy << "\n";
  return EXIT_SUCCESS;
} catch (const std::exception& error) {
  std::cerr << "11_bars_in_a_drum: " << error.what() << "\n";
  return EXIT_FAILURE;
}
