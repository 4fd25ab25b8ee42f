// From time stepping to the event-driven mode where bodies have sunk into obstacles that move: the places and
// velocities of the obstacles at that time count.

#include "tests/random.h"

#include <carom/carom.h>

#include <Eigen/LU>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

namespace {

using namespace carom;
using namespace carom::planar;
using carom_test::Random;

/// A wall that is pushed to and fro, and turned.
struct MovingWall {
  Vec<2> normal, point, reach;  ///< as described; of the displacement [m]
  double turn = 0.0;            ///< largest angle [rad]
  double rate = 1.0;            ///< angular frequency of both [rad/s]

  [[nodiscard]] HalfPlane part() const {
    const MovingWall wall = *this;
    return {.point = point,
            .normal = normal,
            .motion = PrescribedMotion{
                .displacement = [wall](double t) -> Vec<2> { return std::sin(wall.rate * t) * wall.reach; },
                .velocity = [wall](double t) -> Vec<2> {
                  return wall.rate * std::cos(wall.rate * t) * wall.reach;
                },
                .angle = [wall](double t) { return wall.turn * std::sin(wall.rate * t); },
                .spin = [wall](double t) { return wall.turn * wall.rate * std::cos(wall.rate * t); }}};
  }
  [[nodiscard]] Vec<2> normal_at(double t) const {
    const double angle = turn * std::sin(rate * t), c = std::cos(angle), s = std::sin(angle);
    return {c * normal[0] - s * normal[1], s * normal[0] + c * normal[1]};
  }
  [[nodiscard]] Vec<2> point_at(double t) const { return point + std::sin(rate * t) * reach; }
  [[nodiscard]] double gap(const Vec<2>& at, double t) const { return normal_at(t).dot(at - point_at(t)); }
  /// Velocity of the wall where it is touched, along its normal.
  [[nodiscard]] double speed(const Vec<2>& at, double t) const {
    const double spin = turn * rate * std::cos(rate * t);
    const Vec<2> arm = at - point_at(t);
    return normal_at(t).dot(rate * std::cos(rate * t) * reach + spin * Vec<2>(-arm[1], arm[0]));
  }
};

/// The point nearest to `from` where no gap is negative: it is `from`, on one wall, or on two. NaN: none.
Vec<2> nearest(const std::vector<MovingWall>& walls, const Vec<2>& from, double t) {
  Vec<2> best(std::numeric_limits<double>::quiet_NaN(), 0.0);
  double shortest = std::numeric_limits<double>::infinity();
  const auto consider = [&](const Vec<2>& at) {
    const bool free = std::all_of(walls.begin(), walls.end(),
                                  [&](const MovingWall& wall) { return wall.gap(at, t) >= -1e-13; });
    if (!free || !((at - from).norm() < shortest)) return;
    shortest = (at - from).norm();
    best = at;
  };
  consider(from);
  for (std::size_t i = 0; i < walls.size(); ++i) {
    const Vec<2> a = walls[i].normal_at(t);
    consider(from - walls[i].gap(from, t) * a);
    for (std::size_t j = 0; j < i; ++j) {
      const Vec<2> b = walls[j].normal_at(t);
      Mat<2> rows;
      rows << a.transpose(), b.transpose();
      if (std::abs(rows.determinant()) < 1e-6) continue;
      consider(rows.inverse() * Vec<2>(a.dot(walls[i].point_at(t)), b.dot(walls[j].point_at(t))));
    }
  }
  return best;
}

TEST(ModeSwitch, OutOfMovingWallsTogether) {
  constexpr double restitution = 0.3;
  Random random(73);
  int moved = 0, wedged = 0, struck = 0;
  for (int repeat = 0; repeat < 400; ++repeat) {
    System system;
    std::vector<MovingWall> walls;
    const unsigned count = 2 + random.below(3);
    for (unsigned i = 0; i < count; ++i) {
      MovingWall wall;
      wall.normal = incline(random.uniform(-3.1, 3.1));
      wall.point = random.uniform(-0.02, 0.004) * wall.normal;
      wall.reach = random.vec<2>(0.01);
      wall.turn = random.uniform(-0.5, 0.5);
      wall.rate = random.uniform(1.0, 20.0);
      walls.push_back(wall);
      system.add(
          wall.part(),
          Surface{.friction = 0.2, .normal_restitution = restitution, .tangential_restitution = restitution});
    }
    const BodyId ball = system.add(Particle{.mass = random.uniform(0.1, 10.0)}, "ball");
    const double time = random.uniform(0.1, 3.0);
    const Vec<2> place = random.vec<2>(0.03), wanted = nearest(walls, place, time);
    Simulation simulation(std::move(system), TimeStepping{});
    State state = simulation.state();
    state.time = time;
    state.q = {place[0], place[1]};
    simulation.set_state(state);
    try {
      simulation.switch_to(EventDriven{});
    } catch (const SolverError& error) {
      // No room; or walls that close have no impact that parts them from the ball.
      ++wedged;
      const std::string message = error.what();
      EXPECT_TRUE(std::isnan(wanted[0]) ? message.find("no displacement opens the gaps of") != message.npos ||
                                              message.find("no impact is found") != message.npos
                                        : message.find("no impact is found") != message.npos)
          << repeat << ": " << message;
      EXPECT_NE(message.find("particle 'ball' on half-plane"), std::string::npos) << message;
      continue;
    }
    // Rounding of gaps, magnified in flat corners.
    EXPECT_NEAR(simulation.state().q[0], wanted[0], 1e-11) << repeat;
    EXPECT_NEAR(simulation.state().q[1], wanted[1], 1e-11) << repeat;
    const Vec<2> velocity = simulation.state().velocity(ball);
    for (const MovingWall& wall : walls) {
      if (wall.gap(place, time) > 0.0) continue;
      // The ball was at rest. Answers of contact problems are certified to 1e-12 of velocities of up to 1
      // m/s.
      const double before = -wall.speed(place, time);
      const double after = wall.normal_at(time).dot(velocity) + before;
      EXPECT_GE(after, -restitution * before - 1e-11) << repeat;
    }
    if (wanted != place) ++moved;
    if (velocity.norm() > 0.0) ++struck;
    EXPECT_LE(std::abs(simulation.energy().residual()), 1e-13 * (1.0 + simulation.energy().scale()));
  }
  EXPECT_GT(moved, 100);
  EXPECT_GT(struck, 50);
  EXPECT_GT(wedged, 3);
  EXPECT_LT(wedged, 200);
}

}  // namespace
