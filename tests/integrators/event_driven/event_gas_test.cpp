// A gas of discs in a box, event-driven: energy, no overlap at any event, and the same motion as a simple
// simulator of hard discs, which knows closed forms only.

#include "tests/integrators/event_driven/body_scenes.h"
#include "tests/random.h"

#include <carom/carom.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

namespace {

using namespace body_scenes;
using namespace carom_test;

/// Equal discs without friction and without loss between four walls.
struct HardDiscs {
  double radius = 0.2, side = 10.0;
  std::vector<Vec<2>> x, v;

  /// Discs near the places of a square lattice.
  HardDiscs(int across, std::uint64_t seed) : side(across) {
    Random random(seed);
    for (int i = 0; i < across * across; ++i) {
      const double dx = random.uniform(-0.2, 0.2);
      const double dy = random.uniform(-0.2, 0.2);
      const double u = random.uniform(-1.0, 1.0);
      const double w = random.uniform(-1.0, 1.0);
      x.emplace_back(i % across + 0.5 + dx, i / across + 0.5 + dy);
      v.emplace_back(u, w);
    }
  }
  /// When two discs meet, from now; infinity: never. In plain numbers, since it is asked of all pairs at
  /// every impact, and tests are not optimised.
  [[nodiscard]] double meeting(std::size_t i, std::size_t j) const {
    const double *const xi = x[i].data(), *const xj = x[j].data(), *const vi = v[i].data(),
                        *const vj = v[j].data();
    const double d0 = xi[0] - xj[0], d1 = xi[1] - xj[1], u0 = vi[0] - vj[0], u1 = vi[1] - vj[1];
    const double along = d0 * u0 + d1 * u1, rho = 2.0 * radius;
    if (!(along < 0.0)) return never;
    const double across = d0 * u1 - d1 * u0;
    const double root = rho * rho * (u0 * u0 + u1 * u1) - across * across;
    if (!(root > 0.0)) return never;
    return std::max(0.0, (d0 * d0 + d1 * d1 - rho * rho) / (-along + std::sqrt(root)));
  }
  [[nodiscard]] double wall(std::size_t i, int k) const {
    if (v[i][k] > 0.0) return std::max(0.0, (side - radius - x[i][k]) / v[i][k]);
    return v[i][k] < 0.0 ? std::max(0.0, (radius - x[i][k]) / v[i][k]) : never;
  }
  /// Goes on for a length of time. Returns the number of impacts.
  int advance(double length) {
    int impacts = 0;
    for (;;) {
      double first = length;
      std::size_t a = x.size(), b = x.size();
      int axis = -1;
      for (std::size_t i = 0; i < x.size(); ++i) {
        for (int k = 0; k < 2; ++k) {
          if (const double at = wall(i, k); at < first) first = at, a = i, axis = k;
        }
        for (std::size_t j = i + 1; j < x.size(); ++j) {
          if (const double at = meeting(i, j); at < first) first = at, a = i, b = j, axis = -1;
        }
      }
      for (std::size_t i = 0; i < x.size(); ++i) x[i] += first * v[i];
      length -= first;
      if (a == x.size()) return impacts;
      ++impacts;
      if (axis >= 0) {
        v[a][axis] = -v[a][axis];
        continue;
      }
      const Vec<2> n = (x[a] - x[b]).normalized();
      const Vec<2> change = n.dot(v[a] - v[b]) * n;
      v[a] -= change;
      v[b] += change;
    }
  }
  [[nodiscard]] System system() const {
    System out;
    out.set_default_law({.friction = 0.0, .normal_restitution = 1.0, .tangential_restitution = 0.0});
    for (std::size_t i = 0; i < x.size(); ++i) add_disc(out, 1.0, radius, x[i], v[i]);
    const Vec<2> middle(0.5 * side, 0.5 * side);
    for (const Vec<2>& normal : {Vec<2>(1.0, 0.0), Vec<2>(-1.0, 0.0), Vec<2>(0.0, 1.0), Vec<2>(0.0, -1.0)}) {
      out.add(HalfPlane{.point = middle - 0.5 * side * normal, .normal = normal});
    }
    return out;
  }
  static constexpr double never = std::numeric_limits<double>::infinity();
};

std::vector<Vec<2>> places(const Simulation& simulation) {
  std::vector<Vec<2>> out;
  for (const BodyId body : simulation.system().bodies()) out.push_back(simulation.state().position(body));
  return out;
}

double farthest(const std::vector<Vec<2>>& a, const std::vector<Vec<2>>& b) {
  double most = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) most = std::max(most, (a[i] - b[i]).norm());
  return most;
}

TEST(EventGas, KeepsItsEnergyOverTenThousandImpacts) {
  const HardDiscs start(10, 3);
  Simulation simulation(start.system(), EventDriven{.interval = 0.5, .record_events = false});
  const double before = simulation.energy().kinetic();
  // Discs in free flight between two looks come nearest to each other at their impacts, where the gap is
  // zero to the rounding of places.
  double overlap = 0.0;
  while (simulation.statistics().impacts < 10'000) {
    simulation.step();
    const std::vector<Vec<2>> x = places(simulation);
    for (std::size_t i = 0; i < x.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        overlap = std::max(overlap, 2.0 * start.radius - (x[i] - x[j]).norm());
      }
      for (int k = 0; k < 2; ++k) {
        overlap = std::max({overlap, start.radius - x[i][k], x[i][k] + start.radius - start.side});
      }
    }
  }
  EXPECT_NEAR(simulation.energy().kinetic(), before, 1e-9 * before);
  EXPECT_LE(overlap, 1e-11);
}

TEST(EventGas, NoDiscsOverlapAtAnyImpact) {
  const HardDiscs start(10, 4);
  Simulation simulation(start.system(), EventDriven{.interval = 10.0});
  simulation.run_until(10.0);
  ASSERT_GT(simulation.events().size(), 500U);
  std::size_t of_two = 0;
  for (const EventRecord& event : simulation.events()) {
    ASSERT_EQ(event.kind, EventKind::impact);
    if (!event.other.valid()) continue;
    ++of_two;
    const auto& a = event.motions[0].position;
    const auto& b = event.motions[1].position;
    EXPECT_NEAR(std::hypot(a[0] - b[0], a[1] - b[1]), 2.0 * start.radius, 1e-11);
  }
  EXPECT_GT(of_two, 200U);
}

// Two motions of a gas part as e^(lambda t). The library's differs from that of the simple simulator by no
// more than what a change of all velocities by 1e-12 makes of the latter, but for luck: events are located to
// half of that.
TEST(EventGas, MovesAsHardDiscsByClosedForms) {
  for (const std::uint64_t seed : {5U, 6U}) {
    HardDiscs plain(10, seed), changed(10, seed);
    for (std::size_t i = 0; i < changed.v.size(); ++i) changed.v[i][i % 2] += i % 3 == 0 ? 1e-12 : -1e-12;
    Simulation simulation(plain.system(), EventDriven{.interval = 0.25});
    int impacts = 0;
    bool diverged = false;
    double time = 0.0;
    while (!diverged) {
      time += 0.25;
      simulation.run_until(time);
      impacts += plain.advance(0.25);
      changed.advance(0.25);
      const double by_change = farthest(plain.x, changed.x),
                   difference = farthest(plain.x, places(simulation));
      diverged = by_change > 1e-6;
      if (diverged) break;
      EXPECT_LE(difference, 3.0 * by_change + 1e-12) << "at t = " << time << " s, seed " << seed;
      EXPECT_EQ(simulation.statistics().impacts, impacts);
    }
    EXPECT_GT(impacts, 300);
  }
}

}  // namespace
