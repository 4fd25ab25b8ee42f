// Newton's cradle by two laws: contacts of one impact together, and one after the other.
//
//   five equal discs of 1 kg in touch, a sixth arrives at 1 m/s; no friction, e_n = 1, then e_n = 0.9
//   simultaneous    one problem: gamma_n^+ = -e_n gamma_n^- at every contact with an impulse
//   sequential      the contact that approaches fastest alone, until none approaches
//
// With e_n = 1 the sequential law lets exactly one disc leave; the simultaneous one throws the first disc
// back and lets the others leave together. Both keep momentum and, with e_n = 1, energy.
//
// Usage: 09_newtons_cradle <folder>: writes simultaneous_1.csv, sequential_1.csv, simultaneous_0.9.csv and
// sequential_0.9.csv with the places of the discs over time there, and prints the velocities at the end.

#include <carom/carom.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <iomanip>
#include <iostream>
#include <sstream>
#include <string>
#include <vector>

namespace {

using namespace carom;
using namespace carom::planar;

constexpr int count = 6;
constexpr double radius = 0.05, distance = 0.3;  // of the first disc from the others [m]
constexpr double end = 0.8;                      // [s]

/// Runs the cradle; returns the residual of the energy account [J].
double run(ImpactOrder order, double restitution, const std::filesystem::path& folder) {
  System system;
  system.set_default_law({.friction = 0.0, .normal_restitution = restitution});
  std::vector<BodyId> discs;
  for (int i = 0; i < count; ++i) {
    const double x = 2.0 * radius * i - (i == 0 ? distance : 0.0);
    discs.push_back(system.add(
        RigidBody{.mass = disc(1.0, radius), .position = {x, 0.0}, .velocity = {i == 0 ? 1.0 : 0.0, 0.0}},
        "disc " + std::to_string(i + 1)));
    system.add(Disc{.body = discs.back(), .radius = radius});
  }
  Simulation simulation(system, EventDriven{.impact_rules = {.order = order}});
  std::ostringstream name;
  name << to_string(order) << "_" << restitution << ".csv";
  CsvRecorder recorder(simulation, (folder / name.str()).string());
  simulation.run_until(end);
  recorder.detach(simulation);

  std::cout << to_string(order) << ", e_n = " << restitution << ": " << simulation.statistics().impacts
            << " impacts of contacts, velocities";
  double momentum = 0.0;
  for (const BodyId body : discs) {
    const double velocity = simulation.state().velocity(body)[0];
    momentum += velocity;
    std::cout << ' ' << velocity;
  }
  std::cout << " m/s\n  momentum " << momentum << " kg m/s, kinetic energy "
            << simulation.energy().stored(StoredEnergy::kinetic) << " J, residual of the account "
            << simulation.energy().residual() << " J\n";
  return simulation.energy().residual();
}

}  // namespace

int main(int argument_count, char** arguments) try {
  const std::filesystem::path folder = argument_count > 1 ? arguments[1] : ".";
  std::filesystem::create_directories(folder);
  double residual = 0.0;
  for (const double restitution : {1.0, 0.9}) {
    for (const ImpactOrder order : {ImpactOrder::simultaneous, ImpactOrder::sequential}) {
      residual = std::max(residual, std::abs(run(order, restitution, folder)));
    }
  }
  return residual < 1e-12 ? EXIT_SUCCESS : EXIT_FAILURE;
} catch (const std::exception& error) {
  std::cerr << "09_newtons_cradle: " << error.what() << "\n";
  return EXIT_FAILURE;
}
