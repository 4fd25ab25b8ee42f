// Pairs that may close on a path: all that touch on it are listed, with bounds that hold; what is far away is
// not. By comparison with all pairs at many times.

#include "tests/contact/detection/moved_model.h"
#include "tests/model_error.h"
#include "tests/random.h"
#include "tests/shares.h"

#include <carom/carom.h>
#include <carom/contact/detection/body_pairs.h>
#include <carom/contact/detection/swept_pairs.h>
#include <carom/core/constraint_set.h>
#include <carom/core/numerics/never.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <utility>
#include <vector>

namespace {

using namespace carom;
using namespace carom::planar;
using carom_test::add_outline;
using carom_test::body_outline;
using carom_test::every_pair;
using carom_test::ground_outline;
using carom_test::MovedModel;
using carom_test::OwnedOutline;
using carom_test::Random;
using carom_test::random_accelerations;
using carom_test::random_outline;
using carom_test::reference_gap;

constexpr int bodies = 5, looks = 24;
// Corners tell their features apart to 1e-9 m (FeatureLengths); gaps are computed to much less.
constexpr double of_corners = 4e-9;

Vec<2> random_place(Random& random) { return {random.uniform(-5.0, 5.0), random.uniform(0.0, 5.0)}; }

/// Something of every kind over a half-plane, a block, a wall, a peg, in a drum; blocks that move.
System random_scene(Random& random) {
  System system;
  system.set_default_law({.friction = 0.2, .normal_restitution = 0.3});
  system.add(HalfPlane{.point = {0.0, -1.0}, .normal = {random.uniform(-0.2, 0.2), 1.0}});
  const Vec<2> corner = random_place(random), from = random_place(random), centre = random_place(random);
  system.add(planar::Block{.vertices = {corner, corner + Vec<2>(1.0, 0.2), corner + Vec<2>(0.3, 1.2)}});
  system.add(Wall{.from = from, .to = from + Vec<2>(random.uniform(0.5, 2.0), 0.5), .radius = 0.02});
  system.add(Peg{.centre = centre, .radius = 0.3});
  system.add(CircleInside{.centre = {0.0, 2.0}, .radius = 7.0});
  const Vec<2> pivot = random_place(random), speed = random.vec<2>(3.0);
  const double spin = random.uniform(-4.0, 4.0), bend = random.uniform(-3.0, 3.0);
  system.add(planar::Block{
      .vertices = {pivot, pivot + Vec<2>(1.5, 0.0), pivot + Vec<2>(1.5, 0.3)},
      .pivot = pivot,
      .motion = {.displacement = [speed, bend](double t) { return Vec<2>(t * speed + t * t * bend * speed); },
                 .velocity = [speed, bend](double t) { return Vec<2>(speed + 2.0 * t * bend * speed); },
                 .angle = [spin](double t) { return spin * t; },
                 .spin = [spin](double) { return spin; }}});
  for (int i = 0; i < bodies; ++i) {
    const OwnedOutline outline = random_outline(random);
    const Vec<2> place = random_place(random), velocity = random.vec<2>(6.0);
    add_outline(
        system, outline,
        {.mass = disc(1.0, 0.5), .position = place, .velocity = velocity, .spin = random.uniform(-8.0, 8.0)});
  }
  return system;
}

MovedModel random_model(Random& random) {
  System system = random_scene(random);
  const double span = random.uniform(0.02, 0.5);
  return {std::move(system), span, random_accelerations(random, bodies, 20.0)};
}

double time_of(const MovedModel& model, int look) {
  return model.start.time + look * (model.end.time - model.start.time) / (looks - 1);
}

/// All pairs of a model.
std::vector<ContactPair> all_pairs(const MovedModel& model) {
  std::vector<ContactPair> out;
  std::vector<Index> all;
  for (Index body = 0; body < model.assembly.layout()->bodies().size(); ++body) all.push_back(body);
  for (Index component = 0; component < model.assembly.components().size(); ++component) {
    const std::vector<ContactPair> own = model.detector.pairs(component);
    out.insert(out.end(), own.begin(), own.end());
  }
  if (model.detector.bodies_touch()) BodyPairs(model.detector.outlines()).append(all, out);
  return out;
}

/// Gaps of some pairs at all looks, from states of closed form.
std::vector<std::vector<double>> gaps_of(const MovedModel& model, std::span<const ContactPair> pairs) {
  std::vector<std::vector<double>> out(pairs.size());
  Evaluation evaluation = make_evaluation(model.assembly);
  GroundPlaces places;
  SingleConstraint contact;
  for (int look = 0; look < looks; ++look) {
    const State at = model.at(time_of(model, look));
    evaluate_positions(model.assembly, at.view(), evaluation);
    model.detector.place(at.time, places);
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      model.detector.contact(pairs[i], at.view(), evaluation, places, contact);
      out[i].push_back(contact.gap);
    }
  }
  return out;
}

bool lists(std::span<const SweptPair> list, const ContactPair& pair) {
  return std::any_of(list.begin(), list.end(), [&](const SweptPair& of) { return of.pair == pair; });
}

/// False of two points that have no radius: BodyPairBound::closes_alone().
bool closes_alone(const MovedModel& model, const ContactPair& pair) {
  return !pair.has_outline() || bound_of_pair(model.detector.outlines(), pair).closes_alone();
}

TEST(SweptPairs, ListAllThatCloseAtAnyTime) {
  Random random(1);
  constexpr unsigned trials = carom_test::count_of_samples(100U);
  std::size_t closed = 0, listed = 0, all = 0;
  for (unsigned trial = 0; trial < trials; ++trial) {
    const MovedModel model = random_model(random);
    SweptPairs pairs(model.assembly, model.detector, FlatPairs::all);
    ASSERT_FALSE(pairs.find_outlines(model.path).empty());  // the drum is everywhere
    const std::span<const SweptPair> found = pairs.find_pairs(model.path, every_pair);
    const std::vector<ContactPair> every = all_pairs(model);
    const std::vector<std::vector<double>> gaps = gaps_of(model, every);
    for (std::size_t i = 0; i < every.size(); ++i) {
      if (!closes_alone(model, every[i])) continue;
      ++all;
      if (*std::min_element(gaps[i].begin(), gaps[i].end()) > 0.0) continue;
      ++closed;
      EXPECT_TRUE(lists(found, every[i])) << trial << ' ' << i;
    }
    listed += found.size();
  }
  // Else hardly anything was tried, or everything is listed.
  EXPECT_GT(closed, 3 * trials);
  EXPECT_LT(2 * listed, all);
}

TEST(SweptPairs, ListAllOutlinesThatOverlapAtAnyTime) {
  Random random(2);
  int closed = 0, listed = 0, all = 0;
  for (int trial = 0; trial < 30; ++trial) {
    const MovedModel model = random_model(random);
    const Outlines& outlines = model.detector.outlines();
    SweptPairs pairs(model.assembly, model.detector, FlatPairs::all);
    const std::span<const NearOutlines> found = pairs.find_outlines(model.path);
    const auto count = static_cast<Index>(outlines.of_bodies().list().size());
    const auto expect_listed = [&](NearOutlines of, auto outline_b) {
      bool overlap = false;
      for (int look = 0; look < looks && !overlap; look += 2) {
        const State at = model.at(time_of(model, look));
        overlap = reference_gap(body_outline(model, of.a, at), outline_b(at)).gap <= 0;
      }
      const bool is_listed = std::find(found.begin(), found.end(), of) != found.end();
      EXPECT_TRUE(is_listed || !overlap) << trial << ": " << of.a << ' ' << of.b << ' ' << of.piece;
      closed += overlap ? 1 : 0;
      listed += is_listed ? 1 : 0;
      ++all;
    };
    for (Index a = 0; a < count; ++a) {
      for (Index b = a + 1; b < count; ++b)
        expect_listed({.a = a, .b = b}, [&](const State& at) { return body_outline(model, b, at); });
      for (Index piece = 0; piece < outlines.on_ground().size(); ++piece) {
        const Index ground = outlines.on_ground().outline(piece);
        if (outlines.on_ground().outlines()[ground].is_hollow()) continue;
        expect_listed({.a = a, .piece = piece},
                      [&](const State& at) { return ground_outline(model, ground, at.time); });
      }
    }
  }
  EXPECT_GT(closed, 80);
  EXPECT_LT(2 * listed, all);
}

/// True of two sharp outlines that overlap at a time. A corner of one that is in the other is before one side
/// of it at a time, which may become another: its gap jumps then.
bool overlaps(const MovedModel& model, const ContactPair& pair, double time) {
  const Outlines& outlines = model.detector.outlines();
  const State at = model.at(time);
  const auto outline_of = [&](Index outline) {
    return outlines.is_on_ground(outline) ? ground_outline(model, outlines.on_ground(outline), time)
                                          : body_outline(model, outline, at);
  };
  const OwnedOutline a = outline_of(outlines.outline_of(pair.feature)), b = outline_of(pair.outline);
  return a.radius == 0.0 && b.radius == 0.0 && reference_gap(a, b).gap <= 0;
}

TEST(SweptPairs, RatesStayBelowTheirBoundsUnlessSharpOutlinesOverlap) {
  Random random(3);
  double nearest = 0.0;
  int bounded = 0, overlap = 0;
  for (int trial = 0; trial < 100; ++trial) {
    const MovedModel model = random_model(random);
    SweptPairs pairs(model.assembly, model.detector, FlatPairs::all);
    (void)pairs.find_outlines(model.path);
    const std::span<const SweptPair> found = pairs.find_pairs(model.path, every_pair);
    std::vector<ContactPair> listed;
    for (const SweptPair& of : found) listed.push_back(of.pair);
    const std::vector<std::vector<double>> gaps = gaps_of(model, listed);
    for (std::size_t i = 0; i < found.size(); ++i) {
      ASSERT_LT(found[i].fastest, never);  // no limits of joints here
      const double way = found[i].fastest * model.path.length() / (looks - 1);
      for (int look = 1; look < looks; ++look) {
        const auto k = static_cast<std::size_t>(look);
        const double change = std::abs(gaps[i][k] - gaps[i][k - 1]);
        ++bounded;
        if (change <= way + of_corners) {
          nearest = std::max(nearest, change / way);
          continue;
        }
        ++overlap;
        EXPECT_TRUE(found[i].pair.has_outline() && (overlaps(model, found[i].pair, time_of(model, look)) ||
                                                    overlaps(model, found[i].pair, time_of(model, look - 1))))
            << trial << ' ' << i << ' ' << look << ": " << change << " of " << way;
      }
    }
  }
  EXPECT_GT(bounded, 10000);
  EXPECT_LT(100 * overlap, bounded);
  EXPECT_GT(nearest, 0.99);  // bounds are no larger than need be
}

TEST(SweptPairs, TellKeysGapsAndBodiesWhereThePathBegins) {
  Random random(4);
  const MovedModel model = random_model(random);
  SweptPairs pairs(model.assembly, model.detector, FlatPairs::all);
  (void)pairs.find_outlines(model.path);
  int of_two = 0;
  for (const SweptPair& of : pairs.find_pairs(model.path, every_pair)) {
    const PathSample at = model.path.begin();
    SingleConstraint contact;
    model.detector.contact(of.pair, at.state, at.evaluation, at.places, contact);
    EXPECT_EQ(of.key, contact.key);
    EXPECT_EQ(of.gap, contact.gap);
    std::vector<Index> moved_by(of.moved_by().begin(), of.moved_by().end()), expected{of.pair.body};
    if (of.pair.other != none) expected.push_back(of.pair.other);
    std::sort(moved_by.begin(), moved_by.end());
    std::sort(expected.begin(), expected.end());
    EXPECT_EQ(moved_by, expected);
    of_two += of.pair.other != none ? 1 : 0;
    EXPECT_EQ(of.outlines.a == none, !of.pair.has_outline());
    EXPECT_EQ(of.gap_of(model.detector).bound != nullptr, of.pair.has_outline());
  }
  EXPECT_GT(of_two, 0);
}

OwnedOutline round_outline(double radius) { return {{{0.0, 0.0}}, radius}; }

// Of discs the bounds are exact: a little nearer, and they are listed.
TEST(SweptPairs, DoNotListWhatIsFartherThanTheWay) {
  constexpr double radius = 0.1, speed = 2.0, span = 0.5;
  for (const double more : {-1e-6, 1e-6}) {
    System system;
    system.set_default_law({.friction = 0.0, .normal_restitution = 0.0});
    system.add(HalfPlane{.normal = {0.0, 1.0}});
    const double low = radius + speed * span + more, high = low + 2.0 * radius + speed * span + more;
    add_outline(system, round_outline(radius),
                {.mass = disc(1.0, radius), .position = {0.0, low}, .velocity = {0.0, -speed}});
    add_outline(system, round_outline(radius),
                {.mass = disc(1.0, radius), .position = {0.0, high}, .velocity = {0.0, -2.0 * speed}});
    const MovedModel model(std::move(system), span);
    SweptPairs pairs(model.assembly, model.detector, FlatPairs::all);
    (void)pairs.find_outlines(model.path);
    int with_floor = 0, between = 0;
    for (const SweptPair& of : pairs.find_pairs(model.path, every_pair))
      ++(of.pair.has_outline() ? between : with_floor);
    EXPECT_EQ(with_floor, more > 0.0 ? 0 : 1);
    EXPECT_EQ(between, more > 0.0 ? 0 : 1);
  }
}

// Of what moves evenly without turning, boxes are exact.
TEST(SweptPairs, OutlinesThatPassSideBySideAreListedWhereTheirBoxesOverlap) {
  constexpr double radius = 0.1;
  for (const double more : {-1e-9, 1e-9}) {
    System system;
    system.set_default_law({.friction = 0.0, .normal_restitution = 0.0});
    for (const double side : {-1.0, 1.0}) {
      add_outline(system, round_outline(radius),
                  {.mass = disc(1.0, radius),
                   .position = {side * (radius + 0.5 * more), side},
                   .velocity = {0.0, -2.0 * side}});
    }
    const MovedModel model(std::move(system), 1.0);
    SweptPairs pairs(model.assembly, model.detector, FlatPairs::all);
    EXPECT_EQ(pairs.find_outlines(model.path).size(), more > 0.0 ? 0U : 1U);
    EXPECT_EQ(pairs.find_pairs(model.path, every_pair).size(), more > 0.0 ? 0U : 1U);
  }
}

TEST(SweptPairs, RefuseBodiesThatAreNowhere) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  Random random(5);
  MovedModel model = random_model(random);
  SweptPairs pairs(model.assembly, model.detector, FlatPairs::all);
  for (const double bad : {nan, std::numeric_limits<double>::infinity()}) {
    for (State* const wrong : {&model.start, &model.end}) {
      for (const std::size_t coordinate : {0U, 1U, 2U}) {
        const double good = std::exchange(wrong->q[coordinate], bad);
        model.path.set(model.start, model.end, model.change.data());
        EXPECT_MODEL_ERROR((void)pairs.find_outlines(model.path), "body 0", "must be finite");
        wrong->q[coordinate] = good;
      }
    }
  }
  model.path.set(model.start, model.end, model.change.data());
  EXPECT_FALSE(pairs.find_outlines(model.path).empty());
}

}  // namespace
