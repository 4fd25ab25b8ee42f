// Boxes in a row on a floor without friction, which bump into each other face to face: each is a group of its
// own between impacts, and stands elsewhere than where it was when the others were looked at.

#include "tests/integrators/event_driven/body_scenes.h"
#include "tests/random.h"
#include "tests/shares.h"

#include <carom/carom.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

namespace {

using namespace body_scenes;
using namespace carom_test;

constexpr double height = 0.1;  // [m]

struct Car {
  double mass, width, place, velocity;
};

/// A row of boxes of one height: corners meet corners, and nothing tips.
std::vector<Car> random_row(Random& random) {
  std::vector<Car> row(3 + random.below(4));
  double right = 0.0;
  for (Car& car : row) {
    car = {random.uniform(0.5, 2.0), random.uniform(0.05, 0.3), 0.0, random.uniform(-1.0, 1.0)};
    car.place = right + 0.5 * car.width;
    right += car.width + random.uniform(0.01, 0.05);
  }
  return row;
}

/// Moves points with widths on a line from impact to impact, each of one pair. False where two impacts are so
/// close to each other that rounding decides their order.
bool run_on_a_line(std::vector<Car>& row, double restitution, double end) {
  constexpr double apart = 1e-6;  // [s]; e times smaller each time where one is between two
  constexpr int most = 1000;
  double time = 0.0;
  for (int impacts = 0; impacts < most; ++impacts) {
    double first = std::numeric_limits<double>::infinity(), second = first;
    std::size_t which = 0;
    for (std::size_t i = 0; i + 1 < row.size(); ++i) {
      const double gap = row[i + 1].place - row[i].place - 0.5 * (row[i].width + row[i + 1].width);
      const double approach = row[i].velocity - row[i + 1].velocity;
      const double after = approach > 0.0 ? gap / approach : std::numeric_limits<double>::infinity();
      if (after < first) {
        second = first;
        first = after;
        which = i;
      } else {
        second = std::min(second, after);
      }
    }
    const double step = std::min(first, end - time);
    for (Car& car : row) car.place += step * car.velocity;
    time += step;
    if (!(first < end - time + step)) return true;
    if (first < apart || second - first < apart) return false;
    Car &a = row[which], &b = row[which + 1];
    const double impulse =
        (1.0 + restitution) * (a.velocity - b.velocity) * a.mass * b.mass / (a.mass + b.mass);
    a.velocity -= impulse / a.mass;
    b.velocity += impulse / b.mass;
  }
  return false;
}

System on_a_floor(const std::vector<Car>& row, double restitution) {
  System system;
  system.add(Gravity{{0.0, -g}});
  system.set_default_law({.friction = 0.0, .normal_restitution = restitution});
  system.add(HalfPlane{.normal = {0.0, 1.0}});
  for (const Car& car : row) {
    add_box(system, car.mass, car.width, height, {car.place, 0.5 * height}, 0.0, {car.velocity, 0.0});
  }
  return system;
}

/// \param allowed difference of places [m]
void expect_rows(const SeedRange& seeds, const Mode& mode, double end, double allowed) {
  int compared = 0;
  for (std::uint64_t seed = seeds.first; seed < seeds.last; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    std::vector<Car> row = random_row(random);
    const double restitution = random.uniform(0.3, 1.0);
    Simulation simulation(on_a_floor(row, restitution), mode);
    if (!run_on_a_line(row, restitution, end)) continue;
    ++compared;
    ASSERT_NO_THROW(simulation.run_until(end));
    std::size_t i = 0;
    for (const BodyId body : simulation.system().bodies()) {
      EXPECT_NEAR(simulation.state().position(body)[0], row[i].place, allowed) << "box " << i;
      ++i;
    }
  }
  EXPECT_GE(2 * compared, seeds.count());  // else hardly anything was tried
}

constexpr double end = 0.2;  // some ten impacts [s]

// Impacts are located to 1e-12 s, and each magnifies what is off by a few.
TEST(RowsOfBoxes, BumpAsPointsOnALine) { expect_rows(seeds_from(1, 60), EventDriven{}, end, 1e-9); }
TEST(RowsOfBoxesLong, BumpAsPointsOnALine) { expect_rows(seeds_from(100, 2000), EventDriven{}, end, 1e-9); }
TEST(RowsOfBoxes, BumpAsPointsOnALineLocated) {
  const TimeStepping located{.step = 1e-3, .impacts = ImpactTimes::located};
  expect_rows(seeds_from(1, 60), located, end, 1e-9);
}

}  // namespace
