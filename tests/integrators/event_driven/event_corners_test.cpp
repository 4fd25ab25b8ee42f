// Sharp corners that slide into each other along a wall, or past each other: no closing is missed, and none
// is found where corners only stand near each other.

#include "tests/integrators/event_driven/body_scenes.h"
#include "tests/integrators/event_run.h"
#include "tests/random.h"

#include <carom/carom.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

namespace {

using namespace body_scenes;
using namespace carom_test;

// Projections leave gaps at rounding; output within a step is as exact as the tolerances of the integrator,
// 1e-9 m.
constexpr double allowed_overlap = 1e-8;

double lowest(const std::vector<Vec<2>>& points, const Vec<2>& normal) {
  double lowest = 1.0;
  for (const Vec<2>& point : points) lowest = std::min(lowest, normal.dot(point));
  return lowest;
}

// A box slides down a face of a block to the corner at which that stands on a plane. There its own corner
// passes that of the block, closely, and meets the plane. (Two bodies of a pile in which they went 0.037 m
// into each other.)
TEST(EventCorners, ClosingsBesideACornerThatIsPassedAreFound) {
  System system;
  system.add(Gravity{{0.0, -g}});
  system.set_default_law({.friction = 0.3, .normal_restitution = 0.3});
  const double half = std::sqrt(0.5);
  const Vec<2> normal(-half, half);
  system.add(HalfPlane{.normal = normal});
  system.add(planar::Block{.vertices = {{0.0089812731490516648, 0.0094959047419975184},
                                        {0.16652362866793002, 0.16652362866793002},
                                        {0.017439484472083128, 0.23645524828516346}}});
  const double width = 0.21593500890969016, height = 0.0947863246924509;
  const BodyId body = system.add(RigidBody{.mass = box(1.1657, width, height),
                                           .position = {0.10447353440590382, 0.2667986202782795},
                                           .angle = 2.538506054496946,
                                           .velocity = {-0.01565683297524793, -0.010289576582085009},
                                           .spin = 0.16166781010408499});
  system.add(Polygon{.body = body, .vertices = corners_of(width, height)});
  Simulation simulation(system, EventDriven{.interval = 1e-3});
  const LedgerWatch ledger(simulation);
  double deepest = 0.0;
  simulation.observe([&](const Simulation& now) {
    deepest = std::max(deepest, -lowest(placed(now.state(), body, corners_of(width, height)), normal));
  });
  simulation.run_until(0.1);
  EXPECT_LT(deepest, allowed_overlap);
  EXPECT_TRUE(ledger.closes());
  EXPECT_GT(events_of(simulation, EventKind::impact).size(), 2U);
}

/// Two polygons on one plane, thrown at each other. Trapezoids lie on their longer sides, so that the corners
/// on the plane meet; rhombuses stand on a side, with a corner in front.
class SlidingPair {
public:
  explicit SlidingPair(std::uint64_t number) : random_(number) {
    system_.add(Gravity{{0.0, -g}});
    system_.set_default_law(
        {.friction = 0.3 * random_.below(3), .normal_restitution = 0.3 * random_.below(3)});
    tilt_ = random_.below(2) * random_.uniform(-0.3, 0.3);
    normal_ = Vec<2>(-std::sin(tilt_), std::cos(tilt_));
    system_.add(HalfPlane{.normal = normal_});
    add(-1.0);
    add(1.0);
  }

  [[nodiscard]] const System& system() const { return system_; }
  /// The deepest that anything is in anything [m].
  [[nodiscard]] double deepest(const State& state) const {
    const std::vector<Vec<2>> a = placed(state, bodies_[0], corners_[0]),
                              b = placed(state, bodies_[1], corners_[1]);
    return -std::min({separation(a, b), lowest(a, normal_), lowest(b, normal_)});
  }

private:
  void add(double side) {
    const unsigned kind = random_.below(3);
    const double half = random_.uniform(0.1, 0.3), height = random_.uniform(0.05, 0.2);
    const double top = kind == 2 ? half : half * random_.uniform(0.2, 0.9);
    std::vector<Vec<2>> corners{{-half, 0.0}, {half, 0.0}, {top, height}, {-top, height}};
    if (kind == 1) corners = {{-half, 0.0}, {0.0, -height}, {half, 0.0}, {0.0, height}};
    const MassProperties<2> mass = polygon(1.5 + 0.5 * side, corners);
    for (Vec<2>& corner : corners) corner -= mass.centre;
    const double turn = kind == 1 ? side * std::atan2(height, half) : 0.0;
    double low = 1.0;
    for (const Vec<2>& corner : corners)
      low = std::min(low, std::sin(turn) * corner[0] + std::cos(turn) * corner[1]);
    const Vec<2> along(normal_[1], -normal_[0]);
    bodies_.push_back(system_.add(RigidBody{.mass = centred(mass),
                                            .position = 0.45 * side * along - low * normal_,
                                            .angle = tilt_ + turn,
                                            .velocity = -side * random_.uniform(0.5, 3.0) * along}));
    system_.add(Polygon{.body = bodies_.back(), .vertices = corners});
    corners_.push_back(corners);
  }

  Random random_;
  System system_;
  double tilt_ = 0.0;
  Vec<2> normal_;
  std::vector<BodyId> bodies_;
  std::vector<std::vector<Vec<2>>> corners_;
};

/// Impacts of some scenes, and how many of these ended with an error, which must name parts.
struct PairRuns {
  std::int64_t impacts = 0;
  int failed = 0;
};

PairRuns run_pairs(std::uint64_t first, std::uint64_t count) {
  PairRuns runs;
  for (std::uint64_t number = first; number < first + count; ++number) {
    SCOPED_TRACE("scene " + std::to_string(number));
    const SlidingPair pair(number);
    // Corners that met without touching were found again and again.
    Simulation simulation(pair.system(), EventDriven{.event_limit = 1e5, .record_events = false});
    const LedgerWatch ledger(simulation);
    double deepest = 0.0;
    simulation.observe(
        [&](const Simulation& now) { deepest = std::max(deepest, pair.deepest(now.state())); });
    try {
      simulation.run_until(0.8);
    } catch (const SolverError& error) {
      EXPECT_FALSE(error.failure().parts.empty()) << error.what();
      ++runs.failed;
    }
    EXPECT_LT(deepest, allowed_overlap);
    EXPECT_TRUE(ledger.closes());
    runs.impacts += simulation.statistics().impacts;
  }
  return runs;
}

TEST(EventCorners, CornersThatSlideIntoEachOtherAlongAPlaneDoNotOverlap) {
  const PairRuns runs = run_pairs(120, 80);
  EXPECT_EQ(runs.failed, 0);  // 131 and 199 did not come to an end
  EXPECT_GT(runs.impacts, 80);
}

// In one scene of 2,000 both corners strike an edge of the other, and no solver answers for all that touches.
TEST(EventCornersLong, CornersThatSlideIntoEachOtherAlongAPlaneDoNotOverlap) {
  const PairRuns runs = run_pairs(0, 2000);
  EXPECT_LE(runs.failed, 2);
  EXPECT_GT(runs.impacts, 2000);
}

// A box that spins falls on a floor: 10,000 turns in each step of 1 s hid the first closings, and it was hit
// as much as 0.1 ms late, or sank in. The time is that at which one of its four corners, each on its cycloid,
// is first down.
TEST(EventCorners, FirstClosingOfABoxThatSpinsFast) {
  constexpr double width = 0.03, height = 0.02, fall = 0.3;
  for (const double spin : {1e2, 1e4, 6e4, 1e5}) {
    System system;
    system.add(Gravity{{0.0, -g}});
    system.add(HalfPlane{.normal = {0.0, 1.0}}, Surface{.friction = 0.3, .normal_restitution = 0.3});
    const BodyId body =
        system.add(RigidBody{.mass = box(1.0, width, height), .position = {0.0, fall}, .spin = spin});
    system.add(Polygon{.body = body, .vertices = corners_of(width, height)});
    const double arm = 0.5 * std::hypot(width, height), corner = std::atan2(height, width);
    const auto lowest_at = [&](double time) {
      const double turned = spin * time;
      const double down = std::max(std::abs(std::sin(turned + corner)), std::abs(std::sin(turned - corner)));
      return fall - 0.5 * g * time * time - arm * down;
    };
    // Nothing is hit before the circle around the box is down; a dip between two looks is 1e-10 m deep at
    // most.
    double time = std::sqrt(2.0 * (fall - arm) / g) - 1e-9;
    const double look = 2e-4 / spin;
    while (lowest_at(time + look) > 0.0) time += look;
    double end = time + look;
    for (int i = 0; i < 60; ++i) {
      const double middle = 0.5 * (time + end);
      (lowest_at(middle) > 0.0 ? time : end) = middle;
    }
    Simulation simulation(system, EventDriven{});
    simulation.run_until(end + 1e-6);
    ASSERT_FALSE(simulation.events().empty()) << spin;
    // The angle after 10,000 turns is known to 1e-12 rad, and corners come down with g t at the least.
    EXPECT_NEAR(simulation.events().front().time, end, 1e-9) << spin;
  }
}

}  // namespace
