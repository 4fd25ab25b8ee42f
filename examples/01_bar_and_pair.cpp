// A bar and a pair of particles on a spring fall on an inclined plane, strike it with friction and rebound:
// Johansson (1999), section 6, figures 6 to 8.
//
//   m a = m g + F            M = diag(m, m, I) for the bar; F the spring's force for the pair
//   gap = n.(x_C - p) >= 0   at both ends of the bar, at both particles
//   impact law               xi = (e gamma^- + gamma^+)/(1 + e), Signorini in the normal and Coulomb in the
//                            tangential direction, e_n = e_t = 1, mu = 0.1
//   time stepping            h = 1/1200 s, trapezoidal impulses, to t = 3.5 s
//
// Usage: 01_bar_and_pair <folder>: writes bar.csv and pair.csv there and prints impacts and energies.

#include <carom/carom.h>

#include "examples/scenes/incline.h"

#include <cstdlib>
#include <exception>
#include <filesystem>
#include <iomanip>
#include <iostream>
#include <string>

namespace {

constexpr double step = 1.0 / 1200;  // [s], the paper's
constexpr double end = 3.5;          // [s]

void print_impacts_of(const carom::Simulation& simulation) {
  for (const carom::ContactRecord& contact : simulation.report().contacts) {
    if (!contact.impact) continue;
    std::cout << "  impact at t = " << simulation.time() << " s: " << simulation.name(contact.key) << "\n    "
              << to_string(contact.mode) << ", P_n = " << contact.impulse[0]
              << " N s, P_t = " << contact.impulse[1] << " N s, normal velocity "
              << contact.velocity_before[0] << " -> " << contact.velocity_after[0] << " m/s, tangential "
              << contact.velocity_before[1] << " -> " << contact.velocity_after[1] << " m/s, found "
              << -1e3 * contact.gap << " mm deep\n";
  }
}

void run(const std::string& title, const carom::System& system, const std::filesystem::path& file) {
  std::cout << title << "\n";
  carom::Simulation simulation(system, carom::TimeStepping{.step = step});
  carom::CsvRecorder recorder(simulation, file.string());
  simulation.observe(print_impacts_of);
  simulation.run_until(end);
  recorder.flush();
  std::cout << "  energies at t = " << simulation.time() << " s\n"
            << simulation.energy() << "  " << simulation.statistics().steps << " steps, at most "
            << simulation.statistics().most_sweeps << " sweeps in one\n\n";
}

}  // namespace

int main(int count, char** arguments) try {
  const std::filesystem::path folder = count > 1 ? arguments[1] : ".";
  std::filesystem::create_directories(folder);
  std::cout << std::setprecision(7);

  const scenes::Incline incline;  // the paper's numbers
  carom::System with_bar;
  scenes::add_plane(with_bar, incline);
  scenes::add_bar(with_bar, incline);
  run("Bar of 2 kg, 2 m, I = 2 kg m^2", with_bar, folder / "bar.csv");

  carom::System with_pair;
  scenes::add_plane(with_pair, incline);
  scenes::add_pair(with_pair, incline);
  run("Two particles of 1 kg on a spring of 1000 N/m, free length 2 m", with_pair, folder / "pair.csv");
  return EXIT_SUCCESS;
} catch (const std::exception& error) {
  std::cerr << "01_bar_and_pair: " << error.what() << "\n";
  return EXIT_FAILURE;
}
