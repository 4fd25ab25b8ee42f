// A rod and a double pendulum swing against a vertical wall: the impact at the tip acts through the pins.
//
//   M a = f + G^T lambda,  g(q) = 0     uniform rods of 1 m and 1 kg, pinned at the origin, released level
//   wall                                x >= -0.25 m, e_n = 0.5, friction 0.2
//   impact                              (e_n, e_t, mu) law for the tips, with the constrained inverse mass
//
// The double pendulum hits with its tip and with the pin between its rods. Where impacts follow each other
// ever faster they accumulate (Zeno) and the contact is closed; the tip may then rest on the wall for a
// while.
//
// Usage: 07_pendulums_and_wall <folder>: writes rod.csv and double_pendulum.csv with the places of joints and
// tips there, events beside them, and prints the impacts.

#include <carom/carom.h>

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

using namespace carom;
using namespace carom::planar;

constexpr double length = 1.0, mass = 1.0;  // of a rod [m], [kg]
constexpr double wall = -0.25;              // [m]
constexpr double interval = 0.005;          // [s], between rows
constexpr double end = 6.0;                 // [s]

void run(const std::string& title, int links, const std::filesystem::path& folder, const std::string& file) {
  System system;
  system.add(Gravity{{0.0, -9.81}});
  system.set_default_law(Surface{.friction = 0.2, .normal_restitution = 0.5});
  system.add(HalfPlane{.point = {wall, 0.0}, .normal = {1.0, 0.0}}, "wall");
  std::vector<BodyId> rods;
  for (int i = 0; i < links; ++i) {
    const BodyId body =
        system.add(RigidBody{.mass = rod(mass, length), .position = {(i + 0.5) * length, 0.0}});
    const End<2> before = i == 0 ? End<2>(ground) : End<2>(rods.back(), {0.5 * length, 0.0});
    system.add(Revolute{.from = before, .to = {body, {-0.5 * length, 0.0}}});
    system.add(Point{.body = body, .position = {0.5 * length, 0.0}}, i + 1 == links ? "tip" : "elbow");
    rods.push_back(body);
  }
  Simulation simulation(system, EventDriven{.relative_tolerance = 1e-10});

  std::ofstream rows(folder / (file + ".csv"));
  if (!rows) throw FileError("'" + file + ".csv' cannot be written");
  rows << std::setprecision(17) << "time [s]";
  for (int i = 1; i <= links; ++i) rows << ",x" << i << " [m],y" << i << " [m]";
  rows << ",energy [J],lost in impacts [J]\n";
  const double lowest = -9.81 * mass * length * 0.5 * links * links;  // all rods hanging
  for (int i = 0; i * interval <= end + 0.5 * interval; ++i) {
    simulation.run_until(i * interval);
    rows << simulation.time();
    for (const BodyId body : rods) {
      const double angle = simulation.state().angle(body);
      const auto centre = simulation.state().position(body);
      rows << ',' << centre[0] + 0.5 * length * std::cos(angle) << ','
           << centre[1] + 0.5 * length * std::sin(angle);
    }
    const EnergyLedger& energy = simulation.energy();
    rows << ',' << energy.total() - lowest << ',' << energy.lost() << '\n';
  }
  simulation.write_events((folder / (file + "_events.csv")).string());

  std::cout << title << "\n";
  constexpr std::size_t shown = 8;
  std::size_t impacts = 0;
  for (const EventRecord& event : simulation.events()) {
    if (event.kind != EventKind::impact) continue;
    if (++impacts > shown) continue;
    std::cout << "  t = " << std::setw(9) << event.time << " s  " << simulation.name(event) << ": "
              << event.velocity_before[0] << " -> " << event.velocity_after[0] << " m/s, impulse "
              << event.impulse[0] << " N s\n";
  }
  std::cout << "  " << impacts << " impacts\n" << simulation.energy() << "\n";
}

}  // namespace

int main(int count, char** arguments) try {
  const std::filesystem::path folder = count > 1 ? arguments[1] : ".";
  std::filesystem::create_directories(folder);
  std::cout << std::setprecision(7);

  run("Rod", 1, folder, "rod");
  run("Double pendulum", 2, folder, "double_pendulum");
  return EXIT_SUCCESS;
} catch (const std::exception& error) {
  std::cerr << "07_pendulums_and_wall: " << error.what() << "\n";
  return EXIT_FAILURE;
}
