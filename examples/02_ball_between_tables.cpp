// A rubber ball thrown between two tables comes back: Johansson (1999), section 4, figures 3 and 4.
//
//   solid sphere, m = 0.00859 kg, r = 0.0131 m, tables 0.530 m apart, e_n = 0.91, mu = 1.13 below, 0.95 above
//   figure 3: e_t = e_n = 0.91; figure 4: e_t = 0.68; no initial spin; h = 0.000309 s, a flash every 0.0309 s
//
// The paper prints no initial velocity, but a spin of 567 rad/s after the first impact, without saying for
// which e_t. A sphere that sticks leaves with (5/7)(1 + e_t) v/r, so the horizontal speed is 5.444 m/s if
// that was e_t = 0.91 and 6.190 m/s if 0.68: both are shown for both. Vertical speed (-5 m/s) and height
// (0.25 m) are assumptions.
//
// Usage: 02_ball_between_tables <folder>: writes tables_et<e_t>_vx<speed>.csv there and prints the impacts.

#include <carom/carom.h>

#include "examples/scenes/tables.h"

#include <cstdlib>
#include <exception>
#include <filesystem>
#include <iomanip>
#include <iostream>
#include <sstream>

namespace {

void run(const scenes::Tables& tables, const std::filesystem::path& folder) {
  std::cout << "e_t = " << tables.tangential_restitution << ", thrown at " << tables.horizontal_speed
            << " m/s\n";
  carom::System system;
  const carom::BodyId ball = scenes::add_tables(system, tables);

  std::ostringstream file;
  file << "tables_et" << tables.tangential_restitution << "_vx" << std::fixed << std::setprecision(2)
       << tables.horizontal_speed << ".csv";
  carom::Simulation simulation(system, carom::TimeStepping{.step = scenes::tables_step});
  carom::CsvRecorder recorder(simulation, (folder / file.str()).string());
  simulation.observe([ball](const carom::Simulation& now) {
    for (const carom::ContactRecord& contact : now.report().contacts) {
      if (!contact.impact) continue;
      std::cout << "  t = " << std::setw(7) << now.time() << " s  " << now.system().name(contact.obstacle)
                << "  " << std::setw(5) << to_string(contact.mode) << "  spin after " << std::setw(8)
                << now.state().spin(ball) << " rad/s, horizontal speed after " << std::setw(7)
                << now.state().velocity(ball)[0] << " m/s\n";
    }
  });
  simulation.run_until((scenes::flashes - 1) * scenes::strobe_interval);
  recorder.flush();
  const carom::EnergyLedger& energy = simulation.energy();
  std::cout << "  energy " << energy.initial() << " J -> " << energy.total()
            << " J, lost in normal direction " << energy.flow(carom::EnergyFlow::impact_normal)
            << " J, in tangential direction " << energy.flow(carom::EnergyFlow::impact_tangential)
            << " J, residual " << energy.residual() << " J\n\n";
}

}  // namespace

int main(int count, char** arguments) try {
  const std::filesystem::path folder = count > 1 ? arguments[1] : ".";
  std::filesystem::create_directories(folder);
  std::cout << std::setprecision(5);
  for (const double restitution : {0.91, 0.68}) {
    for (const double speed : {5.444387434554974, 6.18975}) {
      run({.tangential_restitution = restitution, .horizontal_speed = speed}, folder);
    }
  }
  return EXIT_SUCCESS;
} catch (const std::exception& error) {
  std::cerr << "02_ball_between_tables: " << error.what() << "\n";
  return EXIT_FAILURE;
}
