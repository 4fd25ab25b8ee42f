// Sharp corners that touch each other, in both modes: the limit of rounded ones. Scenes that are symmetric
// stay so, and scenes in a mirror move as in a mirror.

#include "tests/random.h"
#include "tests/shares.h"

#include <carom/carom.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

namespace {

using namespace carom;
using namespace carom::planar;
using carom_test::Random;
using Points = std::vector<Vec<2>>;

constexpr double g = 9.81;
constexpr double step = 1e-3;

enum class Mode { steps, located, events };
constexpr std::array<Mode, 3> all_runs{Mode::steps, Mode::located, Mode::events};

std::string name_of(Mode run) {
  return run == Mode::steps ? "steps" : run == Mode::located ? "located" : "events";
}

Simulation started(const System& system, Mode run) {
  if (run == Mode::events) return Simulation(system, EventDriven{.interval = 0.01});
  TimeStepping options{.step = step};
  if (run == Mode::located) options.impacts = ImpactTimes::located;
  return Simulation(system, options);
}

Vec<2> turned(const Vec<2>& point, double angle) {
  return Space<2>::rotate(std::array{std::cos(angle), std::sin(angle)}.data(), point);
}
Vec<2> mirrored(const Vec<2>& point) { return {-point[0], point[1]}; }

/// A particle, a segment, a polygon, or a block on ground, by the number of its corners.
struct Piece {
  Points corners{};                  // in its frame
  Vec<2> position = Vec<2>::Zero();  // of that
  double angle = 0.0, mass = 1.0;
  Vec<2> velocity = Vec<2>::Zero();
  double spin = 0.0, radius = 0.0;
  bool on_ground = false;

  [[nodiscard]] Piece in_mirror() const {
    Piece out = *this;
    for (Vec<2>& corner : out.corners) corner = mirrored(corner);
    std::reverse(out.corners.begin(), out.corners.end());
    out.position = mirrored(position);
    out.velocity = mirrored(velocity);
    out.angle = -angle;
    out.spin = -spin;
    return out;
  }
};

struct Scene {
  std::vector<Piece> pieces;
  Surface law{};
  double floor = -10.0;

  [[nodiscard]] Scene in_mirror() const {
    Scene out = *this;
    for (Piece& piece : out.pieces) piece = piece.in_mirror();
    return out;
  }
  /// Adds a piece and its image.
  void add_pair(const Piece& piece) {
    pieces.push_back(piece);
    pieces.push_back(piece.in_mirror());
  }
};

BodyId add_body(System& system, const Piece& piece) {
  if (piece.corners.size() < 2)
    return system.add(Particle{.mass = piece.mass, .position = piece.position, .velocity = piece.velocity});
  double size = 0.0;
  for (const Vec<2>& corner : piece.corners) size = std::max(size, corner.norm());
  const BodyId body = system.add(RigidBody{.mass = {piece.mass, 0.4 * piece.mass * size * size},
                                           .position = piece.position,
                                           .angle = piece.angle,
                                           .velocity = piece.velocity,
                                           .spin = piece.spin});
  if (piece.corners.size() == 2) {
    system.add(Segment{.body = body, .from = piece.corners[0], .to = piece.corners[1]});
  } else {
    system.add(Polygon{.body = body, .vertices = piece.corners, .radius = piece.radius});
  }
  return body;
}

/// A scene in motion.
struct Running {
  std::vector<BodyId> bodies;  // by piece; of those on ground any
  Simulation simulation;

  static System system_of(const Scene& scene, std::vector<BodyId>& bodies) {
    System system;
    system.add(Gravity{{0.0, -g}});
    system.set_default_law(scene.law);
    system.add(HalfPlane{.point = {0.0, scene.floor}, .normal = {0.0, 1.0}});
    for (const Piece& piece : scene.pieces) {
      if (!piece.on_ground) {
        bodies.push_back(add_body(system, piece));
        continue;
      }
      Points placed;
      for (const Vec<2>& corner : piece.corners)
        placed.push_back(piece.position + turned(corner, piece.angle));
      system.add(Block{.vertices = placed});
      bodies.emplace_back();
    }
    return system;
  }
  Running(const Scene& scene, Mode run) : simulation(started(system_of(scene, bodies), run)) {}
  [[nodiscard]] Vec<2> place(std::size_t piece) const { return simulation.state().position(bodies[piece]); }
};

/// Largest difference of places between a scene and one in the mirror [m]. \param image by piece, in the
/// second
double asymmetry(const Scene& scene, const Running& one, const Running& other,
                 const std::vector<std::size_t>& image) {
  double largest = 0.0;
  for (std::size_t i = 0; i < scene.pieces.size(); ++i) {
    if (scene.pieces[i].on_ground) continue;
    largest = std::max(largest, (one.place(i) - mirrored(other.place(image[i]))).cwiseAbs().maxCoeff());
  }
  return largest;
}

// --- two cards -------------------------------------------------------------------------------------------

/// Two cards of 0.02 x 1 m, that lean on each other at an angle. \param friction in parts of tan(a)
Scene cards(double a, double friction, double radius = 0.0) {
  Scene scene;
  scene.floor = 0.0;
  scene.law = {.friction = friction * std::tan(a), .normal_restitution = 0.0};
  const double x = 0.01 - radius, y = 0.5 - radius;
  Piece left{.corners = {{-x, -y}, {x, -y}, {x, y}, {-x, y}}, .angle = -a, .radius = radius};
  double lowest = 0.0;
  for (const Vec<2>& corner : left.corners) lowest = std::min(lowest, turned(corner, -a)[1]);
  left.position = {-radius - turned({x, y}, -a)[0], radius - lowest};
  scene.add_pair(left);
  return scene;
}

class Corners : public ::testing::TestWithParam<Mode> {};

INSTANTIATE_TEST_SUITE_P(Runs, Corners, ::testing::ValuesIn(all_runs),
                         [](const auto& of) { return name_of(of.param); });

// Pushed by the other one with P at its upper end, a card of weight m g stands where the moments about its
// lower end balance, P cos(a) = m g sin(a)/2, and the floor holds that, P <= mu m g: mu >= tan(a)/2.
// (Thickness: the lower corner that stands and the upper one that touches are of the same side.)
TEST_P(Corners, CardsLeanOnEachOtherFromHalfTheTangentOn) {
  for (const double a : {0.05, 0.1, 0.3, 0.5}) {
    for (const double radius : {0.0, 1e-4}) {
      SCOPED_TRACE(std::to_string(a) + " rad, radius " + std::to_string(radius));
      for (const double friction : {0.52, 0.7, 0.99}) {
        const Scene scene = cards(a, friction, radius);
        Running run(scene, GetParam());
        run.simulation.run_until(1.0);
        EXPECT_LT((run.place(0) - scene.pieces[0].position).norm(), 1e-9) << friction;
        EXPECT_LT((run.place(1) - scene.pieces[1].position).norm(), 1e-9) << friction;
      }
    }
  }
}

TEST_P(Corners, CardsThatFallDoSoInTheMiddle) {
  for (const double a : {0.2, 0.3, 0.5}) {
    for (const double friction : {0.0, 0.2, 0.45}) {
      SCOPED_TRACE(std::to_string(a) + " rad, " + std::to_string(friction));
      const Scene scene = cards(a, friction);
      Running run(scene, GetParam());
      run.simulation.run_until(0.4);
      EXPECT_LT(run.place(0)[1], scene.pieces[0].position[1] - 1e-5);
      // Rounding, which grows as what is unstable does.
      EXPECT_LT(asymmetry(scene, run, run, {1, 0}), 1e-9);
    }
  }
}

// Without friction at the corners that meet the limit of small radii is that of no radius, to the first
// order.
TEST(CornersLimit, FallingCardsAreTheLimitOfRoundedOnes) {
  const auto place = [](double radius, Mode run) {
    Running cards_fall(cards(0.3, 0.3, radius), run);
    cards_fall.simulation.run_until(0.4);
    return cards_fall.place(0)[1];
  };
  for (const Mode run : all_runs) {
    const double limit = place(0.0, run), near = place(1e-5, run) - limit, far = place(1e-4, run) - limit;
    EXPECT_LT(std::abs(far), 2e-3) << name_of(run);
    EXPECT_NEAR(far / near, 10.0, 1.0) << name_of(run);
  }
}

// --- on a ridge ------------------------------------------------------------------------------------------

/// A ridge whose sides fall by these angles.
Piece ridge(double left, double right) {
  return {.corners = {{0.0, 0.0}, {-1.0, -std::tan(left)}, {0.0, -4.0}, {1.0, -std::tan(right)}},
          .on_ground = true};
}

/// A body that stands on its sharp lower corner, which is at the origin.
Piece on_corner(Random& random) {
  Piece out;
  switch (random.below(3)) {
    case 0:
      out.corners = {{0.0, 0.0}};
      break;
    case 1: {  // from a needle to something blunter than the ridge
      const double x = random.uniform(0.01, 0.3), y = random.uniform(0.05, 0.2);
      out.corners = {{0.0, -y}, {x, 0.0}, {0.0, y}, {-x, 0.0}};
      break;
    }
    default: {
      const double x = random.uniform(0.01, 0.1), y = random.uniform(0.1, 0.2);
      out.corners = {{0.0, -0.1}, {x, y - 0.1}, {-x, y - 0.1}};
    }
  }
  out.position = -out.corners[0];
  out.mass = random.uniform(0.3, 3.0);
  return out;
}

// Dropped exactly onto a ridge, a corner rebounds straight: h = v²/(2 g) until t = sqrt(2 h/g), then e v.
TEST_P(Corners, WhatFallsOnARidgeReboundsStraight) {
  Random random(5);
  for (int trial = 0; trial < 24; ++trial) {
    SCOPED_TRACE(trial);
    const double slope = random.uniform(0.2, 1.2), height = random.uniform(0.05, 0.2);
    Scene scene;
    scene.law = {.friction = 0.3 * random.below(3), .normal_restitution = 0.5};
    scene.pieces = {ridge(slope, slope), on_corner(random)};
    scene.pieces[1].position[1] += height;
    Running run(scene, GetParam());
    const double fall = std::sqrt(2.0 * height / g), after = 0.3 * fall;
    run.simulation.run_until(fall + after);
    const Vec<2> off = run.place(1) - scene.pieces[1].position;
    const double risen = 0.5 * g * fall * after - 0.5 * g * after * after;
    EXPECT_NEAR(off[0], 0.0, 1e-12);
    // Impacts at the start of the next step are late by a step at most.
    const double late = GetParam() == Mode::steps ? 2.0 * g * fall * step : 1e-8;
    EXPECT_NEAR(off[1], risen - height, late);
  }
}

// What stands on a ridge, or on its own corner on that of a block, stays there.
TEST_P(Corners, WhatStandsOnARidgeStandsThere) {
  Random random(6);
  for (int trial = 0; trial < 24; ++trial) {
    SCOPED_TRACE(trial);
    const double slope = random.uniform(0.2, 1.2);
    Scene scene;
    scene.law = {.friction = 0.3 * random.below(2), .normal_restitution = 0.0};
    scene.pieces = {ridge(slope, slope), on_corner(random)};
    Running run(scene, GetParam());
    run.simulation.run_until(0.2);
    EXPECT_LT((run.place(1) - scene.pieces[1].position).norm(), 1e-12);
  }
}

// --- mirrored scenes -------------------------------------------------------------------------------------

Points random_polygon(Random& random) {
  Points corners;
  const unsigned count = 3 + random.below(4);
  for (unsigned k = 0; k < count; ++k) {
    const double at = 6.283185307179586 * (k + random.uniform(0.0, 0.5)) / count;
    corners.emplace_back(0.15 * std::cos(at), 0.15 * std::sin(at));
  }
  return corners;
}

/// Ground, and bodies that fall on it, of which one hits or stands on a corner exactly.
Scene random_scene(Random& random) {
  Scene scene;
  scene.law = {.friction = 0.3 * random.below(3), .normal_restitution = 0.3 * random.below(2)};
  scene.floor = -0.6;
  scene.pieces.push_back(ridge(random.uniform(0.2, 1.2), random.uniform(0.2, 1.2)));
  scene.pieces.push_back(on_corner(random));
  scene.pieces[1].position[1] += 0.05 * random.below(2);
  for (int k = 0; k < 3; ++k) {
    Piece piece{.position = {random.uniform(-0.6, 0.6), 0.65 + 0.4 * k},
                .angle = random.uniform(-3.0, 3.0),
                .mass = random.uniform(0.3, 3.0),
                .velocity = random.vec<2>(),
                .spin = random.uniform(-5.0, 5.0)};
    piece.corners = k < 2 ? random_polygon(random) : Points{{-0.1, 0.0}, {0.1, 0.0}};
    if (random.below(4) == 0) piece.corners.resize(1);
    scene.pieces.push_back(piece);
  }
  return scene;
}

/// Bodies and their images, which meet in the middle with corners first, and something in the middle.
Scene symmetric_scene(Random& random) {
  Scene scene;
  scene.law = {.friction = 0.3 * random.below(3), .normal_restitution = 0.3 * random.below(2)};
  scene.floor = -0.3;
  const double slope = random.uniform(0.2, 1.2);
  Piece top = on_corner(random);
  top.position[1] += 0.05 * random.below(2);
  scene.pieces = {ridge(slope, slope), top};
  for (int k = 0; k < 2; ++k) {
    Piece piece{.corners = random_polygon(random),
                .position = {random.uniform(0.2, 0.5), 0.7 + 0.4 * k},
                .angle = random.uniform(-3.0, 3.0),
                .mass = random.uniform(0.3, 3.0),
                .velocity = {random.uniform(-3.0, 0.0), random.uniform(-1.0, 1.0)},
                .spin = random.uniform(-5.0, 5.0)};
    scene.add_pair(piece);
  }
  return scene;
}

// Rounding grows with every impact, by some tens.
constexpr double largest_asymmetry = 1e-7;

/// A scene whose bodies are moved by 1e-12 m, which is nothing to them, and about a hundred roundings.
Scene moved_by_nothing(const Scene& scene, Random& random) {
  constexpr double nothing = 1e-12;
  Scene out = scene;
  for (Piece& piece : out.pieces) {
    if (!piece.on_ground) piece.position += nothing * random.vec<2>();
  }
  return out;
}

/// Pieces in their own places.
std::vector<std::size_t> themselves(const Scene& scene) {
  std::vector<std::size_t> out(scene.pieces.size());
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = i;
  return out;
}

/// True of a scene whose end nothing decides: moved by 1e-12 m it ends elsewhere too, as where several
/// closings follow each other at once, in an order that rounding tells. Such a scene is chaotic, and not
/// asymmetric.
bool is_undecided(const Scene& scene, const Running& end, Mode run, double until) {
  Random random(1);
  for (int trial = 0; trial < 8; ++trial) {
    Running moved(moved_by_nothing(scene, random), run);
    moved.simulation.run_until(until);
    for (std::size_t i = 0; i < scene.pieces.size(); ++i) {
      if (scene.pieces[i].on_ground) continue;
      if ((moved.place(i) - end.place(i)).cwiseAbs().maxCoeff() > largest_asymmetry) return true;
    }
  }
  return false;
}

/// Scenes that differ from their images, or end in a named error.
struct Differing {
  int decided = 0, undecided = 0, failed = 0;

  /// Runs a scene and what is to be its image. \param image by piece, in the second
  void take(const Scene& scene, const Scene& second, const std::vector<std::size_t>& image, Mode run,
            double until) try {
    Running one(scene, run), other(second, run);
    one.simulation.run_until(until);
    other.simulation.run_until(until);
    if (asymmetry(scene, one, other, image) < largest_asymmetry) return;
    ++(is_undecided(scene, one, run, until) ? undecided : decided);
  } catch (const SolverError&) {
    ++failed;
  }
  /// Measured, of 1000 mirrored and 1000 symmetric scenes: in steps 1 decided one and 3 undecided ones
  /// differ, located none and 26, with events none and 11. Contacts that jam end 5 of the located ones in a
  /// named error, closings at one instant 1 of those with events. The decided one has a contact problem with
  /// several answers, of which principal pivoting takes one by the order of the contacts.
  void expect_few(const carom_test::SeedRange& seeds) const {
    const int count = seeds.count();
    EXPECT_LE(decided, count / 250);
    EXPECT_LE(undecided, 1 + count / 20);
    EXPECT_LE(failed, 1 + count / 200);
  }
};

/// Runs scenes and their images. \param until so far [s]
void expect_mirrored(Mode run, const carom_test::SeedRange& seeds, double until) {
  Differing differing;
  for (std::uint64_t number = seeds.first; number < seeds.last; ++number) {
    SCOPED_TRACE("scene " + std::to_string(number));
    Random random(number);
    const Scene scene = random_scene(random);
    differing.take(scene, scene.in_mirror(), themselves(scene), run, until);
  }
  differing.expect_few(seeds);
}

void expect_symmetric(Mode run, const carom_test::SeedRange& seeds, double until) {
  Differing differing;
  for (std::uint64_t number = seeds.first; number < seeds.last; ++number) {
    SCOPED_TRACE("scene " + std::to_string(number));
    Random random(number);
    const Scene scene = symmetric_scene(random);
    differing.take(scene, scene, {0, 1, 3, 2, 5, 4}, run, until);
  }
  differing.expect_few(seeds);
}

constexpr unsigned few = carom_test::usual_or(20U, 8U);

TEST_P(Corners, AMirroredSceneMovesAsInTheMirror) { expect_mirrored(GetParam(), {100, 100 + few}, 0.3); }
TEST_P(Corners, ASymmetricSceneStaysSymmetric) { expect_symmetric(GetParam(), {200, 200 + few}, 0.3); }

class CornersLong : public ::testing::TestWithParam<Mode> {};
INSTANTIATE_TEST_SUITE_P(Runs, CornersLong, ::testing::ValuesIn(all_runs),
                         [](const auto& of) { return name_of(of.param); });

TEST_P(CornersLong, AMirroredSceneMovesAsInTheMirror) {
  expect_mirrored(GetParam(), carom_test::seeds_from(1000, 200, 2000), 0.4);
}
TEST_P(CornersLong, ASymmetricSceneStaysSymmetric) {
  expect_symmetric(GetParam(), carom_test::seeds_from(5000, 200, 2000), 0.4);
}

}  // namespace
