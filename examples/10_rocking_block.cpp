// A slender block rocks on its corners until it stands (Housner 1963).
//
//   block 2b x 2h on level ground, released at rest at a tilt theta_0 about a corner that does not slip
//   theta'' = -p^2 sin(alpha - theta),   p^2 = 3 g/(4 R),   tan alpha = b/h,   R^2 = b^2 + h^2
//   at each impact (e = 0) the spin is multiplied by  r = 1 - (3/2) sin^2 alpha
//
// Energy gives the spin before impact n: w_n = r^(n-1) p sqrt(2 (cos(alpha - theta_0) - cos alpha)). The
// library knows none of this: it solves the contact problem of both corners. Intervals shrink towards a
// finite time, where the event-driven mode closes both corners.
//
// Usage: 10_rocking_block <folder>: writes course.csv with the motion, impacts.csv with the spins before the
// impacts beside the closed form, and events.csv there, and prints the first impacts.

#include <carom/carom.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <iostream>

namespace {

using namespace carom;
using namespace carom::planar;

constexpr double b = 0.2, h = 0.8, g = 9.81;  // half width and height [m], [m/s^2]
constexpr double share = 0.5;                 // theta_0 / alpha
constexpr int compared = 30;                  // impacts

}  // namespace

int main(int count, char** arguments) try {
  const std::filesystem::path folder = count > 1 ? arguments[1] : ".";
  std::filesystem::create_directories(folder);
  const double alpha = std::atan2(b, h), tilt = share * alpha;
  const double p = std::sqrt(0.75 * g / std::hypot(b, h));
  const double ratio = 1.0 - 1.5 * std::sin(alpha) * std::sin(alpha);
  const double first = p * std::sqrt(2.0 * (std::cos(alpha - tilt) - std::cos(alpha)));

  System system;
  system.add(Gravity{{0.0, -g}});
  system.set_default_law(Surface{.friction = 2.0, .normal_restitution = 0.0});
  system.add(HalfPlane{.normal = {0.0, 1.0}}, "floor");
  const double c = std::cos(tilt), s = std::sin(tilt);
  const BodyId block = system.add(
      RigidBody{
          .mass = box(1.0, 2.0 * b, 2.0 * h), .position = {c * b - s * h, s * b + c * h}, .angle = tilt},
      "block");
  system.add(Point{.body = block, .position = {-b, -h}}, "left");
  system.add(Point{.body = block, .position = {b, -h}}, "right");
  Simulation simulation(system, EventDriven{.relative_tolerance = 1e-12, .absolute_tolerance = 1e-14});
  CsvRecorder recorder(simulation, (folder / "course.csv").string());
  simulation.run_until(12.0);
  recorder.detach(simulation);
  simulation.write_events((folder / "events.csv").string());

  std::ofstream table(folder / "impacts.csv");
  if (!table) throw FileError("'impacts.csv' cannot be written");
  table << std::setprecision(17) << "impact,time [s],spin before [rad/s],closed form [rad/s]\n";
  std::cout << std::setprecision(10)
            << "impact      time [s]     spin [rad/s]     closed form          difference\n";
  int impacts = 0;
  double worst = 0.0, last = -1.0;
  for (const EventRecord& event : simulation.events()) {
    if (event.kind != EventKind::impact || event.time == last) continue;  // of two corners at once
    last = event.time;
    const double spin = std::abs(event.motions[0].velocity_before[2]);
    const double expected = first * std::pow(ratio, impacts);
    ++impacts;
    table << impacts << ',' << event.time << ',' << spin << ',' << expected << '\n';
    if (impacts <= compared) worst = std::max(worst, std::abs(spin - expected));
    if (impacts <= 8) {
      std::cout << std::setw(6) << impacts << std::setw(14) << event.time << std::setw(17) << spin
                << std::setw(16) << expected << std::setw(20) << spin - expected << '\n';
    }
  }
  std::cout << impacts << " impacts; the first " << compared << " differ from the closed form by at most "
            << worst << " rad/s\n"
            << simulation.energy() << '\n';
  const bool closes = std::abs(simulation.energy().residual()) < 1e-9;
  return closes && worst < 1e-10 && impacts >= compared ? EXIT_SUCCESS : EXIT_FAILURE;
} catch (const std::exception& error) {
  std::cerr << "10_rocking_block: " << error.what() << "\n";
  return EXIT_FAILURE;
}
