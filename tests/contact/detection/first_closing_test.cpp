// The first closing of a gap along a path, against closed forms, without a run of either mode.

#include "tests/contact/detection/placed_model.h"

#include <carom/carom.h>
#include <carom/contact/detection/body_pairs.h>
#include <carom/contact/detection/first_closing.h>
#include <carom/core/constraint_set.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <random>
#include <utility>
#include <vector>

namespace {

using namespace carom;
using namespace carom::planar;

constexpr double g = 9.81;
constexpr double noise = 5e-14;  // [m]

/// A model whose bodies start as described: coordinates are parabolas in time, or chords.
class Parabolas final : public PairPath {
public:
  /// \param of_all set_acceleration()
  explicit Parabolas(System system, const Vec<2>& of_all = Vec<2>::Zero())
      : model_(std::move(system)), detector_(model_.assembly), start_(model_.state) {
    acceleration_.assign(start_.v.size(), 0.0);
    set_acceleration(of_all);
  }

  [[nodiscard]] PathSample sample(double time, PathLook how) override {
    ++looks_;
    // An interpolation of a given error between two exact times.
    const double off = how == PathLook::between ? error_ * std::sin(std::numbers::pi * time) : 0.0;
    model_.state.time = time;
    for (std::size_t i = 0; i < start_.v.size(); ++i) {
      model_.state.v[i] = start_.v[i] + time * acceleration_[i];
      model_.state.q[i] = start_.q[i] + time * (start_.v[i] + 0.5 * time * acceleration_[i]);
    }
    model_.state.q[1] += off;
    model_.update();
    detector_.place(time, places_);
    return {model_.state.view(), acceleration_.data(), model_.evaluation, places_};
  }

  /// Everything accelerates so [m/s^2].
  void set_acceleration(const Vec<2>& of_all) {
    for (std::size_t i = 0; i < acceleration_.size(); i += 3) {
      acceleration_[i] = of_all[0];
      acceleration_[i + 1] = of_all[1];
    }
  }
  /// Looks between exact ones are this wrong at t = 0.5 s [m].
  void set_error(double error) { error_ = error; }
  [[nodiscard]] int looks() const { return looks_; }

  /// All pairs that may touch.
  [[nodiscard]] std::vector<ContactPair> pairs() const {
    std::vector<ContactPair> out;
    std::vector<Index> bodies;
    for (Index c = 0; c < model_.assembly.components().size(); ++c) {
      const std::vector<ContactPair> own = detector_.pairs(c);
      out.insert(out.end(), own.begin(), own.end());
      bodies.push_back(c);
    }
    if (detector_.bodies_touch()) BodyPairs(detector_.outlines()).append(bodies, out);
    return out;
  }

  /// The first closing of any pair up to a time; infinity if there is none. \param share of the bound of the
  /// rate that the search is told
  [[nodiscard]] double closing(double end, ClosingRule rule, double share = 1.0) {
    double first = never;
    for (const ContactPair& pair : pairs()) {
      std::optional<BodyPairBound> bound;
      if (pair.has_outline()) bound = bound_of_pair(detector_.outlines(), pair);
      if (bound && !bound->closes_alone()) continue;
      const PairGap gap{detector_, pair, bound ? &*bound : nullptr};
      std::array<GapLook, 2> ends{GapLook{0.0}, GapLook{end}};
      double speed = 0.0;
      for (GapLook& look : ends) {
        const PathSample at = sample(look.time, PathLook::exact);
        look.gap = gap_in(gap, at);
        if (bound)
          speed = std::max(speed, bound->most_speed(at.state.v, motion_of(detector_, pair, at.places)));
        if (!bound && start_.v.size() > 2) {
          SingleConstraint contact;
          detector_.contact(pair, at.state, at.evaluation, at.places, contact);
          rule.sixth = std::pow(start_.v[2], 4) * std::hypot(contact.drift[0], contact.drift[1]);
        }
      }
      rule.fastest = bound ? share * speed : never;
      first = std::min(first, first_closing(*this, gap, rule, ends[0], ends[1]));
    }
    return first;
  }

private:
  carom_test::PlacedModel model_;
  Detector detector_;
  State start_;
  GroundPlaces places_;
  std::vector<double> acceleration_;
  double error_ = 0.0;
  int looks_ = 0;
};

/// Flights under constant loads, or other motions of which nothing is known beforehand.
ClosingRule rule_of(bool flies_freely, double level = 0.0) {
  ClosingRule rule;
  rule.noise = noise;
  rule.fine = 1e-10;
  rule.found = 0.25 * noise;
  rule.level = level;
  rule.flies_freely = flies_freely;
  return rule;
}

constexpr double radius = 0.1;

BodyId add_disc(System& system, const Vec<2>& place, const Vec<2>& velocity, double spin = 0.0) {
  const BodyId body =
      system.add(RigidBody{.mass = disc(1.0, radius), .position = place, .velocity = velocity, .spin = spin});
  system.add(Disc{.body = body, .radius = radius});
  return body;
}

BodyId add_bar(System& system, double length, double height, const Vec<2>& place, const Vec<2>& velocity,
               double spin) {
  const BodyId body = system.add(
      RigidBody{.mass = box(1.0, length, height), .position = place, .velocity = velocity, .spin = spin});
  const double x = 0.5 * length, y = 0.5 * height;
  system.add(Polygon{.body = body, .vertices = {{-x, -y}, {x, -y}, {x, y}, {-x, y}}});
  return body;
}

System with_surface() {
  System system;
  system.set_default_law(Surface{.friction = 0.0, .normal_restitution = 0.5});
  return system;
}

void add_floor(System& system, bool is_block) {
  if (is_block) {
    system.add(planar::Block{.vertices = {{-50.0, -1.0}, {50.0, -1.0}, {50.0, 0.0}, {-50.0, 0.0}}});
  } else {
    system.add(HalfPlane{.normal = Vec<2>(0.0, 1.0)});
  }
}

struct Floor {
  bool is_block, flies_freely;
};

class FirstClosing : public testing::TestWithParam<Floor> {
protected:
  [[nodiscard]] Parabolas thrown(double height, const Vec<2>& velocity, double gravity) const {
    System system = with_surface();
    add_floor(system, GetParam().is_block);
    add_disc(system, {0.0, height}, velocity, 3.0);
    return Parabolas(std::move(system), {0.0, -gravity});
  }
};

INSTANTIATE_TEST_SUITE_P(Floors, FirstClosing,
                         testing::Values(Floor{false, true}, Floor{false, false}, Floor{true, true},
                                         Floor{true, false}));

TEST_P(FirstClosing, OfADiscOnAParabolaIsItsRoot) {
  Parabolas path = thrown(1.0, {2.0, 3.0}, g);
  const double fall = (3.0 + std::sqrt(9.0 + 2.0 * g * (1.0 - radius))) / g;
  EXPECT_NEAR(path.closing(1.5, rule_of(GetParam().flies_freely)), fall, 1e-13);
  EXPECT_EQ(path.closing(0.8, rule_of(GetParam().flies_freely)), never);
}

TEST_P(FirstClosing, OfAGrazingDiscIsFoundWhereItIsBelowTheLevel) {
  constexpr double dip = 1e-9;
  for (const double level : {0.0, -0.05}) {
    const ClosingRule rule = rule_of(GetParam().flies_freely, level);
    Parabolas above = thrown(radius + level + 0.5 * g * 0.25 + dip, {1.0, -0.5 * g}, -g);
    EXPECT_EQ(above.closing(1.1, rule), never) << level;
    Parabolas below = thrown(radius + level + 0.5 * g * 0.25 - dip, {1.0, -0.5 * g}, -g);
    EXPECT_NEAR(below.closing(1.1, rule), 0.5 - std::sqrt(2.0 * dip / g), 1e-9) << level;
  }
}

// The corner comes down between the ends, at which the bar lies flat.
TEST_P(FirstClosing, OfATurningBarIsThatOfTheCornerThatDipsBetweenTwoLooks) {
  constexpr double height = 0.9, spin = std::numbers::pi;
  System system = with_surface();
  add_floor(system, GetParam().is_block);
  add_bar(system, 2.0, 0.1, {0.0, height}, {0.0, 0.0}, spin);
  Parabolas path(std::move(system));
  const double turn = std::asin(height / std::hypot(1.0, 0.05)) - std::atan(0.05);
  EXPECT_NEAR(path.closing(1.0, rule_of(GetParam().flies_freely)), turn / spin, 1e-12);
}

TEST_P(FirstClosing, OfRandomParabolasIsTheExactRoot) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  int closings = 0;
  for (int i = 0; i < 200; ++i) {
    const double gap = 1e-3 + 2.0 * unit(random), speed = 10.0 * (unit(random) - 0.5);
    const double gravity = 20.0 * (unit(random) - 0.3), end = 0.1 + unit(random);
    Parabolas path = thrown(radius + gap, {5.0 * unit(random), speed}, gravity);
    // gap + speed t - gravity/2 t^2 = 0, its first positive root
    const double inside = speed * speed + 2.0 * gravity * gap;
    double exact = never;
    if (inside > 0.0) {
      const double root = std::sqrt(inside);
      for (const double t : {2.0 * gap / (-speed + root), 2.0 * gap / (-speed - root)}) {
        if (t > 0.0) exact = std::min(exact, t);
      }
    }
    if (std::abs(exact - end) < 1e-9) continue;
    const double found = path.closing(end, rule_of(GetParam().flies_freely));
    if (exact > end) {
      EXPECT_EQ(found, never) << i;
      continue;
    }
    ++closings;
    EXPECT_NEAR(found, exact, 1e-12 + 1e-13 / std::sqrt(inside)) << i;
  }
  EXPECT_GT(closings, 50);
}

// A level below zero is how deep a step may let something come into another thing: it is found although at
// both ends of the chord nothing is near.
TEST(FirstClosingOnAChord, ThroughAThinWallIsFoundAtALevelBelowZero) {
  constexpr double half = 1e-3, way = 20.0, allowed = 1e-4;
  System system = with_surface();
  system.add(Wall{.from = {0.0, -1.0}, .to = {0.0, 1.0}, .radius = half});
  add_disc(system, {-0.5 * way, 0.0}, {way, 0.0});
  Parabolas path(std::move(system));
  ClosingRule rule = rule_of(true, -allowed);
  EXPECT_NEAR(path.closing(1.0, rule), 0.5 - (radius + half - allowed) / way, 1e-13);
  EXPECT_LT(path.looks(), 200);
  rule.level = -(radius + half) - 1e-6;  // deeper than it can be
  EXPECT_EQ(path.closing(1.0, rule), never);
}

TEST(FirstClosingOnAChord, OfABarThroughAThinSharpBlockIsFoundAtALevelBelowZero) {
  constexpr double half = 1e-3, way = 20.0, allowed = 1e-4;
  System system = with_surface();
  system.add(planar::Block{.vertices = {{-half, -1.0}, {half, -1.0}, {half, 1.0}, {-half, 1.0}}});
  add_bar(system, 0.2, 0.1, {-0.5 * way, 0.0}, {way, 0.0}, 0.0);
  Parabolas path(std::move(system));
  EXPECT_NEAR(path.closing(1.0, rule_of(true, -allowed)), 0.5 - (0.1 + half - allowed) / way, 1e-12);
}

TEST(FirstClosingOfTwoBodies, OfDiscsInFreeFlightIsTheRootOfTheirDistance) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  int closings = 0;
  for (int i = 0; i < 400; ++i) {
    std::array<double, 6> drawn{};  // in turn: compilers evaluate arguments in different orders
    for (double& number : drawn) number = unit(random);
    const Vec<2> apart(1.0 + drawn[0], 2.0 * radius + 1e-3 + std::abs(drawn[1]));
    const Vec<2> velocity(-2.0 + drawn[2], -1.0 + drawn[3]), common(drawn[4], drawn[5]);
    System system = with_surface();
    add_disc(system, {0.0, 0.0}, common);
    add_disc(system, apart, common + velocity);
    Parabolas path(std::move(system));
    path.set_acceleration({0.3, -g});
    const double a = velocity.squaredNorm(), b = apart.dot(velocity);
    const double c = apart.squaredNorm() - 4.0 * radius * radius;
    const double inside = b * b - a * c;
    const double exact = inside > 0.0 && b < 0.0 ? c / (-b + std::sqrt(inside)) : never;
    const double found = path.closing(1.0, rule_of(i % 2 == 0));
    if (exact > 1.0) {
      EXPECT_EQ(found, never) << i;
      continue;
    }
    ++closings;
    EXPECT_NEAR(found, exact, 1e-12 + 1e-13 / std::sqrt(inside)) << i;
  }
  EXPECT_GT(closings, 50);
}

TEST(FirstClosingOfTwoBodies, OfDiscsThatPassIsFoundWhereTheyOverlap) {
  constexpr double dip = 1e-9, speed = 3.0;
  for (const double off : {dip, -dip}) {
    System system = with_surface();
    add_disc(system, {-1.0, 2.0 * radius + off}, {speed, 0.0});
    add_disc(system, {0.0, 0.0}, {0.0, 0.0});
    Parabolas path(std::move(system));
    const double found = path.closing(1.0, rule_of(true));
    if (off > 0.0) {
      EXPECT_EQ(found, never);
    } else {
      EXPECT_NEAR(found, (1.0 - std::sqrt(4.0 * radius * dip)) / speed, 1e-8);
    }
  }
}

TEST(FirstClosingOfTwoBodies, OfATurningBarAndABoxThatRises) {
  constexpr double spin = 2.0, rise = 0.5, below = 0.7;
  System system = with_surface();
  add_bar(system, 2.0, 0.1, {0.0, 0.0}, {0.0, 0.0}, spin);
  add_bar(system, 10.0, 0.2, {0.0, -below - 0.1}, {0.0, rise}, 0.0);
  Parabolas path(std::move(system));
  // The lower corner of the bar: sin(w t) + 0.05 cos(w t) = below - rise t.
  double t = 0.3;
  for (int i = 0; i < 20; ++i) {
    const double f = std::sin(spin * t) + 0.05 * std::cos(spin * t) - below + rise * t;
    t -= f / (spin * std::cos(spin * t) - 0.05 * spin * std::sin(spin * t) + rise);
  }
  EXPECT_NEAR(path.closing(1.0, rule_of(true)), t, 1e-12);
}

// Bounds are the caller's word: one that is too small hides a dip that looks at the ends do not show, and
// nothing says so.
TEST(FirstClosingOnAChord, WithABoundThatIsTooSmallHidesADipBetweenTheEnds) {
  System system = with_surface();
  add_floor(system, true);
  add_bar(system, 2.0, 0.1, {0.0, 0.9}, {0.0, 0.0}, std::numbers::pi);
  Parabolas path(std::move(system));
  EXPECT_LT(path.closing(1.0, rule_of(true)), 1.0);
  EXPECT_EQ(path.closing(1.0, rule_of(true), 0.1), never);
  // At 0.5 s the bar stands on its end, in the floor: a bound that allows for that much of a fall finds it.
  EXPECT_LT(path.closing(0.5, rule_of(true), 0.6), 0.5);
}

TEST(FirstClosingOnAChord, IsThatOfTheExactMotionWhereLooksAreInterpolated) {
  for (const double error : {1e-8, 1e-3}) {
    System system = with_surface();
    add_floor(system, true);
    add_disc(system, {0.0, 1.0}, {1.0, 0.0});
    Parabolas path(std::move(system));
    path.set_acceleration({0.0, -g});
    path.set_error(error);
    ClosingRule rule = rule_of(false);
    rule.misleading = 1e-8;
    EXPECT_NEAR(path.closing(1.0, rule), std::sqrt(2.0 * (1.0 - radius) / g), 1e-13) << error;
  }
}

}  // namespace
