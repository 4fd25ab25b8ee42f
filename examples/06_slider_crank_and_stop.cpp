// A slider-crank, driven by a torque, whose slider hits a limit (stop): the impact acts through all pins.
//
//   M a = f + G^T lambda,  g(q) = 0    crank, connecting rod, slider; three pins and a guide
//   motor                              torque -0.05 N m - 0.001 N m s times the speed of the crank
//   stop                               x <= 0.42 m for the slider, restitution 0.6
//   impact                             by the constrained inverse mass: the impulse of the stop turns the
//   crank
//                                      back
//
// Usage: 06_slider_crank_and_stop <folder>: writes event_driven.csv, events.csv and time_stepping.csv there
// and prints the impacts with the impulses of the main bearing.

#include <carom/carom.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <iostream>
#include <numbers>
#include <string>

namespace {

using namespace carom;
using namespace carom::planar;

constexpr double crank_length = 0.153, rod_length = 0.306;                   // [m]
constexpr double crank_mass = 0.038, rod_mass = 0.038, slider_mass = 0.076;  // [kg]
constexpr double reach = 0.42;     // of the slider, where the stop is [m]
constexpr double step = 1e-5;      // [s], of time stepping
constexpr double interval = 1e-3;  // [s], between rows
constexpr double end = 1.5;        // [s]

struct Mechanism {
  System system;
  JointId bearing, guide;
};

Mechanism make_mechanism() {
  Mechanism made;
  System& system = made.system;
  system.add(Gravity{{0.0, -9.81}});
  // Upright: the slider stands where the rod reaches.
  const double slope = std::asin(crank_length / rod_length), x = rod_length * std::cos(slope);
  const BodyId crank = system.add(RigidBody{.mass = rod(crank_mass, crank_length),
                                            .position = {0.0, 0.5 * crank_length},
                                            .angle = 0.5 * std::numbers::pi},
                                  "crank");
  const BodyId link = system.add(
      RigidBody{
          .mass = rod(rod_mass, rod_length), .position = {0.5 * x, 0.5 * crank_length}, .angle = -slope},
      "connecting rod");
  const BodyId slider =
      system.add(RigidBody{.mass = box(slider_mass, 0.06, 0.04), .position = {x, 0.0}}, "slider");
  made.bearing = system.add(
      Revolute{.from = ground, .to = {crank, {-0.5 * crank_length, 0.0}}, .zero_angle = 0.0}, "main bearing");
  system.add(Revolute{.from = {crank, {0.5 * crank_length, 0.0}}, .to = {link, {-0.5 * rod_length, 0.0}}});
  system.add(Revolute{.from = {link, {0.5 * rod_length, 0.0}}, .to = slider});
  made.guide =
      system.add(Prismatic{.from = ground, .to = slider, .axis = {1.0, 0.0}, .zero_distance = 0.0}, "guide");
  system.add(Motor{.joint = made.bearing,
                   .torque = [](double, double, double rate) { return -0.05 - 0.001 * rate; }});
  system.add(Stop{.joint = made.guide, .upper = reach, .restitution = 0.6}, "stop");
  return made;
}

State run(const std::string& title, const Mode& mode, const std::filesystem::path& file,
          const std::filesystem::path& events) {
  const Mechanism made = make_mechanism();
  Simulation simulation(made.system, mode);
  std::ofstream rows(file);
  if (!rows) throw FileError("'" + file.string() + "' cannot be written");
  rows << std::setprecision(17)
       << "time [s],slider [m],crank [rad],speed of the crank [rad/s],kinetic [J],gravity [J],"
          "lost in impacts [J],work of the motor [J]\n";
  for (int i = 0; i * interval <= end + 0.5 * interval; ++i) {
    simulation.run_until(std::min(end, i * interval));
    const State& state = simulation.state();
    const EnergyLedger& energy = simulation.energy();
    rows << simulation.time() << ',' << state.coordinate(made.guide) << ',' << state.coordinate(made.bearing)
         << ',' << state.rate(made.bearing) << ',' << energy.stored(StoredEnergy::kinetic) << ','
         << energy.stored(StoredEnergy::gravity) << ',' << energy.flow(EnergyFlow::impact_normal) << ','
         << energy.flow(EnergyFlow::external) << '\n';
  }
  std::cout << title << "\n";
  for (const EventRecord& event : simulation.events()) {
    if (event.kind != EventKind::impact) continue;
    std::cout << "  t = " << event.time << " s  slider " << event.velocity_before[0] << " -> "
              << event.velocity_after[0] << " m/s, impulse " << event.impulse[0] << " N s\n";
  }
  if (!events.empty()) simulation.write_events(events.string());
  std::cout << simulation.energy() << "\n";
  return simulation.state();
}

}  // namespace

int main(int count, char** arguments) try {
  const std::filesystem::path folder = count > 1 ? arguments[1] : ".";
  std::filesystem::create_directories(folder);
  std::cout << std::setprecision(7);

  const State exact = run("Event-driven", EventDriven{}, folder / "event_driven.csv", folder / "events.csv");
  const State stepped = run("Time stepping", TimeStepping{.step = step}, folder / "time_stepping.csv", {});
  std::cout << "The modes end " << std::abs(exact.q[2] - stepped.q[2]) << " rad of the crank apart.\n";
  return EXIT_SUCCESS;
} catch (const std::exception& error) {
  std::cerr << "06_slider_crank_and_stop: " << error.what() << "\n";
  return EXIT_FAILURE;
}
