// Floors of several pieces: what slides over a seam between two tops in one plane does not meet the side that
// the neighbour covers, however near to the seam it starts, in every mode.

#include "tests/integrators/floor_scenes.h"
#include "tests/random.h"
#include "tests/shares.h"

#include <carom/carom.h>

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <vector>

namespace {

using namespace carom_test;
using namespace carom_test::floors;
using namespace carom;
using namespace carom::planar;

// The front edge stands on the seam and nothing moves yet.
TEST(FloorsOfPieces, ABoxThatStandsAtTheSeamIsPushedOverIt) {
  for (const Schedule run : runs) {
    System system = empty({}, {.friction = 0.0, .normal_restitution = 0.0});
    system.add(tile({}, -1.0, 0.0, 0.0, 1.0));
    system.add(tile({}, 0.0, 3.0, 0.0, 1.0));
    const BodyId body = add_box(system, {}, -0.5, 0.5, 0.25, 0.0);
    system.add(AppliedForce{.on = body, .force = [](double) { return Vec<2>(2.0, 0.0); }});
    const Simulation simulation = run_of(system, run, 1.0);
    // Linear in time under a constant force: exact in all modes but for rounding and tolerances.
    EXPECT_NEAR(simulation.state().velocity(body)[0], 2.0, 1e-9) << name(run);
  }
}

TEST(FloorsOfPieces, AParticleAtAnyDistanceBeforeTheSeamPassesIt) {
  for (const Schedule run : runs) {
    for (const double before : {0.0, 1e-16, 1e-13, 1e-12, 1e-11, 1e-10, 1e-9, 1e-8}) {
      System system = empty({}, {.friction = 0.0, .normal_restitution = 0.0});
      system.add(tile({}, -1.0, 0.0, 0.0, 1.0));
      system.add(tile({}, 0.0, 3.0, 0.0, 1.0));
      const BodyId body =
          system.add(Particle{.mass = 1.0, .position = {-before, 0.0}, .velocity = {1.0, 0.0}});
      const Simulation simulation = run_of(system, run, 1.0);
      EXPECT_NEAR(simulation.state().position(body)[0], 1.0 - before, 1e-9) << name(run) << ", " << before;
    }
  }
}

// The sides of such a floor and of its walls lie in one plane as well, and go around its corners: faces of
// one line that are touched to different depths.
TEST(FloorsOfPieces, BoxesOfBlocksHoldWhatFallsIntoThem) {
  constexpr double half = 0.1, wide = 0.4, thick = 0.3;
  for (const Schedule run : runs) {
    for (const double angle : {0.0, 0.3}) {
      for (const double under : {0.1, 0.5, 2.0}) {
        for (const double sides_from : {0.0, -0.5 * under, -under}) {
          SCOPED_TRACE(name(run) + ", " + std::to_string(angle) + " rad, " + std::to_string(under) + " m, " +
                       std::to_string(sides_from) + " m");
          const Frame at{angle, Vec<2>(0.2, 0.1)};
          System system = empty(at, {.friction = 0.3, .normal_restitution = 0.5});
          const double reach = wide + (sides_from < 0.0 ? 0.0 : thick);
          system.add(tile(at, -reach, reach, 0.0, under));
          system.add(tile(at, -wide - thick, -wide, 1.0, 1.0 - sides_from));
          system.add(tile(at, wide, wide + thick, 1.0, 1.0 - sides_from));
          const BodyId body = system.add(RigidBody{.mass = box(1.0, 2.0 * half, 2.0 * half),
                                                   .position = at.place(0.02, 0.5),
                                                   .angle = 0.4,
                                                   .velocity = at.direction(0.5, -1.0)});
          system.add(Polygon{.body = body,
                             .vertices = {{-half, -half}, {half, -half}, {half, half}, {-half, half}}});
          const Simulation simulation = run_of(system, run, 0.6);
          const Vec<2> place = simulation.state().position(body) - at.origin;
          constexpr double late = 5e-3;  // a step
          EXPECT_GE(place.dot(at.direction(0.0, 1.0)), half - late);
          EXPECT_LE(place.dot(at.direction(0.0, 1.0)), 0.5);
          EXPECT_LE(std::abs(place.dot(at.direction(1.0, 0.0))), wide - half + late);
        }
      }
    }
  }
}

// The corner of the edge and the rear corner of the box both touch: not in one place, so that the rear one
// has opened although the edge pushes, and takes no part in the impact. Both modes see the same impacts.
TEST(FloorsOfPieces, ABoxThatTipsOverAnEdgeIsHitAsItStands) {
  carom_test::Random random(1);
  for (int scene = 0; scene < 20; ++scene) {
    const double half = random.uniform(0.05, 0.15), high = random.uniform(0.5, 1.5) * half,
                 speed = random.uniform(1.0, 3.0), beyond = random.uniform(0.1, 0.3) * half,
                 gap = random.uniform(0.01, 0.05);
    const auto end_of = [&](Schedule run) {
      System system = empty({}, {.friction = 0.0, .normal_restitution = 0.1});
      system.add(tile({}, -2.0, 0.0, 0.0, 1.0));
      // The front one is off the edge when the rear one, twice as fast, meets it.
      const double at = beyond - 2.0 * gap;
      std::array<BodyId, 2> boxes{add_box(system, {}, at, half, high, 2.0 * speed),
                                  add_box(system, {}, at + 2.0 * half + gap, half, high, speed)};
      const Simulation simulation = run_of(system, run, gap / speed + 0.005);
      return std::array{simulation.state().spin(boxes[0]), simulation.state().spin(boxes[1])};
    };
    const auto located = end_of(Schedule::located), events = end_of(Schedule::event_driven);
    for (std::size_t i = 0; i < 2; ++i) EXPECT_NEAR(located[i], events[i], 0.05 * speed) << scene;
  }
}

// A real step, of 0.1 mm, is met: only what lies in one plane is a floor.
TEST(FloorsOfPieces, AHigherTopIsAWall) {
  for (const Schedule run : runs) {
    System system = empty({}, {.friction = 0.0, .normal_restitution = 0.0});
    system.add(tile({}, -1.0, 0.0, 0.0, 1.0));
    system.add(tile({}, 0.0, 3.0, 1e-4, 1.0));
    const BodyId body = system.add(Particle{.mass = 1.0, .position = {-0.5, 0.0}, .velocity = {1.0, 0.0}});
    const Simulation simulation = run_of(system, run, 1.0);
    EXPECT_LT(simulation.state().position(body)[0], 2e-3) << name(run);
  }
}

/// A row of tiles, blocks and terrain, in a frame that is turned, with tops that scatter by rounding.
class Row {
public:
  explicit Row(std::uint64_t seed) : random_(seed) {
    if (random_.below(3) > 0) frame_.angle = random_.uniform(-3.0, 3.0);
    if (random_.below(3) > 0) frame_.origin = random_.vec<2>(100.0);
    friction_ = random_.below(2) == 0 ? 0.0 : 0.2;
    const double restitution = random_.below(2) == 0 ? 0.0 : 0.3;
    system_ = empty(frame_, {.friction = friction_, .normal_restitution = restitution});
    add_tiles();
    add_slider();
  }

  /// How far off the closed form the slider is at the end [m].
  [[nodiscard]] double error(Schedule run) const {
    constexpr double end = 1.0;
    const Simulation simulation = run_of(system_, run, end);
    const Vec<2> moved = simulation.state().position(body_) - start_;
    const double acceleration = force_ - friction_ * g;
    return std::abs(moved.dot(frame_.direction(1.0, 0.0)) - (speed_ * end + 0.5 * acceleration * end * end));
  }

private:
  void add_tiles() {
    const double scatter = random_.below(3) == 0 ? 0.0 : std::pow(10.0, random_.uniform(-16.0, -11.0));
    const unsigned kind = random_.below(5), tiles = 2 + random_.below(3);
    if (kind == 4)
      system_.add(HalfPlane{.point = frame_.place(0.0, 0.0), .normal = frame_.direction(0.0, 1.0)});
    double x = -1.0;
    for (unsigned k = 0; k < tiles; ++k) {
      const double length = k + 1 == tiles ? 4.0 : random_.uniform(0.3, 1.0),
                   height = random_.uniform(0.1, 1.0);
      const double top = scatter * random_.uniform(-1.0, 1.0);
      if (kind == 1 || (kind == 2 && k % 2 == 1)) {
        system_.add(
            Terrain{.vertices = {frame_.place(x, top), frame_.place(x + length, top)}, .depth = height});
      } else {
        system_.add(tile(frame_, x, x + length, top, height));
      }
      x += length;
      if (k == 0) seam_ = x;
    }
  }
  void add_slider() {
    speed_ = random_.below(3) == 0 ? 0.0 : random_.uniform(0.2, 2.0);
    force_ = random_.uniform(0.5, 2.0) + 10.0 * friction_;
    const double before = random_.below(2) == 0 ? 0.0 : std::pow(10.0, random_.uniform(-16.0, -8.0));
    const double half = random_.uniform(0.05, 0.25), high = random_.uniform(0.02, 0.1);
    switch (random_.below(3)) {
      case 0:
        body_ = system_.add(Particle{.mass = 1.0,
                                     .position = frame_.place(seam_ - before, 0.0),
                                     .velocity = frame_.direction(speed_, 0.0)});
        break;
      case 1:
        body_ = add_box(system_, frame_, seam_ - before - half, half, high, speed_);
        break;
      default:
        body_ = system_.add(RigidBody{.mass = rod(1.0, 2.0 * half),
                                      .position = frame_.place(seam_ - before - half, 0.0),
                                      .angle = frame_.angle,
                                      .velocity = frame_.direction(speed_, 0.0)});
        system_.add(Segment{.body = body_, .from = {-half, 0.0}, .to = {half, 0.0}});
    }
    start_ = State(Simulation(system_, TimeStepping{.step = 1e-3}).state()).position(body_);
    const Vec<2> force = frame_.direction(force_, 0.0);
    system_.add(AppliedForce{.on = body_, .force = [force](double) { return force; }});
  }

  Random random_;
  Frame frame_;
  System system_;
  BodyId body_;
  Vec<2> start_ = Vec<2>::Zero();
  double seam_ = 0.0, friction_ = 0.0, speed_ = 0.0, force_ = 0.0;
};

void expect_floors(SeedRange seeds) {
  for (std::uint64_t seed = seeds.first; seed < seeds.last; ++seed) {
    const Row row(seed);
    for (const Schedule run : runs) {
      // Time stepping takes friction of the first step from rest as of sliding: h v at most.
      const double allowed = run == Schedule::event_driven ? 1e-6 : 1e-3;
      EXPECT_LT(row.error(run), allowed) << "seed " << seed << ", " << name(run);
    }
  }
}

TEST(FloorsOfPieces, RowsOfTilesAreFloors) { expect_floors(seeds_from(1, 12)); }

TEST(FloorsOfPiecesLong, RowsOfTilesAreFloors) { expect_floors(seeds_from(100, 200, 4000)); }

}  // namespace
