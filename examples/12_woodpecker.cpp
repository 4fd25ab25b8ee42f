// A wooden woodpecker pecks its way down a pole (Glocker, thesis, TU Munich 1995).
//
//   A sleeve with clearance sits on the pole; a bird hangs on it by a torsional spring. While the sleeve
//   jams, the bird swings; when it swings back the sleeve comes free and both fall, until the beak hits the
//   pole and throws the bird back, which jams the sleeve again. Gravity feeds what friction and the impacts
//   take: a limit cycle.
//
// The sleeve may move sideways within its clearance and touches with four corners, two on each side of the
// pole; angles are not taken small. Masses, lengths and coefficients are Glocker's.
//
// Usage: 12_woodpecker <folder>: writes course.csv with the motion, cycles.csv with a line for each cycle and
// events.csv there, prints the cycles, and compares the motion with time stepping at two steps.

#include <carom/carom.h>

#include <algorithm>
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

constexpr double g = 9.81;                       // [m/s^2]
constexpr double pole = 2.5e-3;                  // its radius [m]
constexpr double inner = 3.1e-3, half = 5.8e-3;  // radius and half height of the sleeve's hole [m]
constexpr double hinge = 1e-2;                   // from the middle of the sleeve to the spring [m]
constexpr double arm = 1.5e-2;                   // from the spring to the bird's centre of mass [m]
constexpr double back = 2.01e-2, up = 2e-2;      // the beak, from there [m]
constexpr double stiffness = 5.6e-3;             // [N m/rad]
constexpr double least_pause = 0.05;  // between the pecks of two cycles, longer than within one [s]
constexpr double compared = 0.1;      // time stepping is, until then [s]

struct Toy {
  System system;
  BodyId sleeve, bird;
};

// Tilt at which the sleeve jams: inner cos(a) - half sin(a) = pole.
double jammed() {
  double angle = 0.1;
  for (int i = 0; i < 60; ++i) angle = std::asin((inner * std::cos(angle) - pole) / half);
  return angle;
}

Toy woodpecker() {
  Toy toy;
  System& system = toy.system;
  system.add(Gravity{{0.0, -g}});
  const MaterialId wood = system.material("pole"), brass = system.material("sleeve"),
                   beak = system.material("beak");
  system.between(wood, brass, Surface{.friction = 0.3, .normal_restitution = 0.0});
  system.between(wood, beak, Surface{.friction = 0.3, .normal_restitution = 0.5});
  constexpr ContactFilter left{.groups = 1, .touches = 1}, right{.groups = 2, .touches = 2};
  system.add(HalfPlane{.point = {-pole, 0.0}, .normal = {-1.0, 0.0}, .material = wood, .filter = left},
             "left side");
  system.add(HalfPlane{.point = {pole, 0.0}, .normal = {1.0, 0.0}, .material = wood, .filter = right},
             "right side");

  // It slides down, the bird swings: close to the cycle, in which it soon is.
  constexpr double speed = -0.3411, spin = -7.4583, angle = -0.2788;
  const double tilt = -jammed() + 1e-9;
  const Vec<2> joint{hinge * std::cos(tilt), hinge * std::sin(tilt)};
  const Vec<2> to_bird{arm * std::cos(angle), arm * std::sin(angle)};
  toy.sleeve = system.add(
      RigidBody{.mass = {.mass = 3e-4, .inertia = 5e-9}, .angle = tilt, .velocity = {0.0, speed}}, "sleeve");
  toy.bird = system.add(RigidBody{.mass = {.mass = 4.5e-3, .inertia = 7e-7},
                                  .position = joint + to_bird,
                                  .angle = angle,
                                  .velocity = {-spin * to_bird[1], speed + spin * to_bird[0]},
                                  .spin = spin},
                        "bird");
  system.add(Revolute{.from = {toy.sleeve, {hinge, 0.0}}, .to = {toy.bird, {-arm, 0.0}}}, "hinge");
  system.add(TorsionalSpring{.from = toy.sleeve, .to = toy.bird, .stiffness = stiffness}, "spring");
  for (const double y : {half, -half}) {
    const std::string edge = y > 0.0 ? "upper" : "lower";
    system.add(Point{.body = toy.sleeve, .position = {-inner, y}, .material = brass, .filter = left},
               edge + " left");
    system.add(Point{.body = toy.sleeve, .position = {inner, y}, .material = brass, .filter = right},
               edge + " right");
  }
  system.add(Point{.body = toy.bird, .position = {-back, up}, .material = beak, .filter = right}, "beak");
  return toy;
}

// The first peck of a cycle.
struct Peck {
  double time = 0.0, height = 0.0, impulse = 0.0;  // [s], of the bird [m], normal [N s]
};

std::vector<Peck> first_pecks(const Simulation& simulation, BodyId bird) {
  std::vector<Peck> pecks;
  double last = -1.0;
  for (const EventRecord& event : simulation.events()) {
    if (event.kind != EventKind::impact || event.body != bird || event.impulse[0] <= 0.0) continue;
    if (event.time - last > least_pause) {
      pecks.push_back({event.time, event.motions[0].position[1], event.impulse[0]});
    }
    last = event.time;
  }
  return pecks;
}

// Largest difference of two positions of the toy [m], [rad].
double difference(const State& a, const State& b) {
  double largest = 0.0;
  for (std::size_t i = 0; i < a.q.size(); ++i) largest = std::max(largest, std::abs(a.q[i] - b.q[i]));
  return largest;
}

}  // namespace

int main(int count, char** arguments) try {
  const std::filesystem::path folder = count > 1 ? arguments[1] : ".";
  std::filesystem::create_directories(folder);
  const Toy toy = woodpecker();
  Simulation simulation(toy.system, EventDriven{.interval = 1e-3});
  CsvRecorder recorder(simulation, (folder / "course.csv").string());
  simulation.run_until(compared);
  const State at_compared = simulation.state();
  simulation.run_until(2.5);
  recorder.detach(simulation);
  simulation.write_events((folder / "events.csv").string());

  std::ofstream table(folder / "cycles.csv");
  if (!table) throw FileError("'cycles.csv' cannot be written");
  table << std::setprecision(17) << "cycle,time [s],period [s],descent [m],impulse [N s]\n";
  std::cout << "cycle   first peck [s]   period [s]   descent [mm]   impulse of the beak [mN s]\n";
  const std::vector<Peck> pecks = first_pecks(simulation, toy.bird);
  double shortest = 1.0, longest = 0.0;
  for (std::size_t i = 1; i < pecks.size(); ++i) {
    const double period = pecks[i].time - pecks[i - 1].time, down = pecks[i - 1].height - pecks[i].height;
    table << i << ',' << pecks[i].time << ',' << period << ',' << down << ',' << pecks[i].impulse << '\n';
    std::cout << std::setw(5) << i << std::fixed << std::setprecision(5) << std::setw(17) << pecks[i].time
              << std::setw(13) << period << std::setprecision(3) << std::setw(15) << 1e3 * down
              << std::setw(29) << 1e3 * pecks[i].impulse << '\n'
              << std::defaultfloat;
    if (i + 5 < pecks.size()) continue;
    shortest = std::min(shortest, period);
    longest = std::max(longest, period);
  }
  std::cout << simulation.energy() << std::setprecision(3) << "time stepping differs after " << compared
            << " s, with steps of\n";
  double errors[2];
  for (int i = 0; i < 2; ++i) {
    const double step = i == 0 ? 4e-5 : 1e-5;
    Simulation steps(toy.system, TimeStepping{.step = step});
    steps.run_until(compared);
    errors[i] = difference(steps.state(), at_compared);
    std::cout << "  " << step << " s by " << errors[i] << '\n';
  }
  // 1e-9 of the energy lost, and of the period, come from the tolerance of a step; the cycle was reached.
  const bool closes = std::abs(simulation.energy().residual()) < 1e-9 * simulation.energy().lost();
  const bool pecks_on = pecks.size() > 12 && longest - shortest < 1e-9 * longest;
  return closes && pecks_on && errors[1] < 0.5 * errors[0] ? EXIT_SUCCESS : EXIT_FAILURE;
} catch (const std::exception& error) {
  std::cerr << "12_woodpecker: " << error.what() << "\n";
  return EXIT_FAILURE;
}
