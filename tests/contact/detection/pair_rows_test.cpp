// Rows of contacts between convex outlines: they are the rates of the gap, and drift is theirs.

#include <carom/contact/detection/gap_features.h>
#include <carom/contact/detection/narrow_phase.h>
#include <carom/contact/detection/pair_rows.h>
#include <carom/core/constraint_set.h>

#include "tests/contact/detection/convex_reference.h"
#include "tests/shares.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>

namespace {

using namespace carom;
using carom_test::OwnedOutline;
using carom_test::Random;
using carom_test::random_outline;

using Gaps = std::array<GapPoint, 2>;

// Two bodies that move at constant velocities, with an outline each; the second may be a shape on ground.
struct MovingPair {
  OwnedOutline outline_a, outline_b;  // in the bodies' frames
  BodySlot slot_a{0, 0, 0, 3, 3, 0, 0, 0}, slot_b{1, 3, 3, 3, 3, 2, 0, 1};
  std::array<double, 6> q{}, v{};
  std::function<GroundMotion(double)> ground_motion;  // of b, if it is a shape on ground
  Index feature_a = none, feature_b = none;

  explicit MovingPair(Random& random) : outline_a(random_outline(random)), outline_b(random_outline(random)) {
    for (std::size_t i = 0; i < 6; ++i) {
      q[i] = random.uniform(-1.5, 1.5);
      v[i] = random.uniform(-1.0, 1.0);
    }
  }
  void make_particle(BodySlot& slot, OwnedOutline& outline) {
    slot.q_size = slot.v_size = 2;
    slot.rotation = none;
    outline.vertices = {{0, 0}};
    q[slot.q + 2] = v[slot.v + 2] = 0.0;
  }
  std::array<double, 6> q_at(double time) const {
    std::array<double, 6> moved = q;
    for (std::size_t i = 0; i < 6; ++i) moved[i] += time * v[i];
    return moved;
  }
  OwnedOutline a_at(double time) const { return placed(outline_a, q_at(time).data()); }
  OwnedOutline b_at(double time) const {
    if (!ground_motion) return placed(outline_b, q_at(time).data() + 3);
    const GroundMotion motion = ground_motion(time);
    return outline_b.moved(motion.angle, {motion.point[0], motion.point[1]});
  }
  static OwnedOutline placed(const OwnedOutline& outline, const double* at) {
    return outline.moved(at[2], {at[0], at[1]});
  }
  GapPoint gap_at(double time) const {
    return gap_of_features(a_at(time).view(), feature_a, b_at(time).view(), feature_b);
  }
  SingleConstraint rows_at(double time) const {
    const auto now = q_at(time);
    const StateView state{time, now.data(), v.data(), nullptr};
    const PairSide b =
        ground_motion ? ground_at(time) : PairSide::of_body(slot_b, 7, outline_b.radius, state);
    SingleConstraint rows;
    fill_pair_rows(body_at(time), b, gap_at(time), rows);
    return rows;
  }
  PairSide body_at(double time) const {
    const auto now = q_at(time);
    return PairSide::of_body(slot_a, 4, outline_a.radius, {time, now.data(), v.data(), nullptr});
  }
  PairSide ground_at(double time) const { return PairSide::of_motion(ground_motion(time), outline_b.radius); }
  // Chooses the features that meet now. False if the pair is no good for differences: two vertices whose
  // distance is small against what they move in a step of them.
  bool choose_features(int which) {
    Gaps found;
    const int count = find_gaps(a_at(0).view(), b_at(0).view(), 100.0, found);
    const GapPoint& at = found[static_cast<std::size_t>(which % count)];
    feature_a = at.feature_a;
    feature_b = at.feature_b;
    return at.kind != GapKind::vertices || at.gap + outline_a.radius + outline_b.radius > 0.5;
  }
};

// Central difference of order 6.
template <class F>
double rate(F&& f) {
  const double h = 1e-3;
  const auto slope = [&](double step) { return (f(step) - f(-step)) / (2.0 * step); };
  return (15.0 * slope(h) - 6.0 * slope(2.0 * h) + slope(3.0 * h)) / 10.0;
}
// Errors that the differences leave: rounding, some 1e-15/h; of two vertices 0.5 apart with a speed up to 4,
// 36 (4 h/0.5)^6.
constexpr double tolerance = 3e-11;

void expect_rates(const MovingPair& pair) {
  const SingleConstraint rows = pair.rows_at(0);
  EXPECT_NEAR(rows.velocity(0, pair.v.data()), rate([&](double t) { return pair.gap_at(t).gap; }), tolerance);
  for (int row = 0; row < 2; ++row) {
    const double expected = rate([&](double t) { return pair.rows_at(t).velocity(row, pair.v.data()); });
    EXPECT_NEAR(rows.drift[static_cast<std::size_t>(row)], expected, 10.0 * tolerance) << row;
  }
}

TEST(PairRows, AreTheRatesOfTheGapAndDriftIsTheirs) {
  Random random(11);
  std::array<int, 3> kinds{};
  constexpr int pairs = carom_test::count_of_samples(6000);
  for (int i = 0; i < pairs && !HasFailure(); ++i) {
    SCOPED_TRACE(i);
    MovingPair pair(random);
    if (!pair.choose_features(i % 2)) continue;
    ++kinds[static_cast<std::size_t>(pair.gap_at(0).kind)];
    expect_rates(pair);
  }
  for (const int count : kinds) EXPECT_GT(count, pairs / 20);
}

TEST(PairRows, OfParticles) {
  Random random(12);
  for (int i = 0; i < 600 && !HasFailure(); ++i) {
    SCOPED_TRACE(i);
    MovingPair pair(random);
    if (i % 3 != 0) pair.make_particle(pair.slot_a, pair.outline_a);
    if (i % 3 != 1) pair.make_particle(pair.slot_b, pair.outline_b);
    if (!pair.choose_features(0)) continue;
    const SingleConstraint rows = pair.rows_at(0);
    EXPECT_EQ(rows.columns(), (i % 3 != 0 ? 2 : 3) + (i % 3 != 1 ? 2 : 3));
    expect_rates(pair);
  }
}

// A shape on ground that starts anywhere, with any velocity and acceleration.
std::function<GroundMotion(double)> random_motion(Random& random) {
  const Vec<2> from = random.vec<2>(1.5), speed = random.vec<2>(1.0), bend = random.vec<2>(1.0);
  const double angle = random.uniform(-3, 3), spin = random.uniform(-1, 1), spin_rate = random.uniform(-1, 1);
  return [=](double t) {
    GroundMotion motion;
    for (int d = 0; d < 2; ++d) {
      const auto at = static_cast<std::size_t>(d);
      motion.point[at] = from[d] + t * speed[d] + 0.5 * t * t * bend[d];
      motion.velocity[at] = speed[d] + t * bend[d];
      motion.acceleration[at] = bend[d];
    }
    motion.angle = angle + t * spin + 0.5 * t * t * spin_rate;
    motion.cosine = std::cos(motion.angle);
    motion.sine = std::sin(motion.angle);
    motion.spin = spin + t * spin_rate;
    motion.angular_acceleration = spin_rate;
    return motion;
  };
}

TEST(PairRows, OfAShapeThatMovesAsPrescribed) {
  Random random(13);
  for (int i = 0; i < 2000 && !HasFailure(); ++i) {
    SCOPED_TRACE(i);
    MovingPair pair(random);
    pair.ground_motion = random_motion(random);
    if (!pair.choose_features(i % 2)) continue;
    expect_rates(pair);
    // The place that is touched, later.
    SingleConstraint rows = pair.rows_at(0);
    EXPECT_EQ(rows.bodies, 1);
    EXPECT_EQ(rows.surface_velocity_after, rows.surface_velocity);
    const GroundMotion now = pair.ground_motion(0), after = pair.ground_motion(0.5);
    const GapPoint at = pair.gap_at(0);
    add_motion_after(pair.body_at(0), pair.ground_at(0), at, now, after, 0.0, rows);
    const auto place = [&](double t) {
      const GroundMotion then = pair.ground_motion(0.5 + t);
      const Vec<2> arm = meeting_point(at) - Vec<2>(now.point[0], now.point[1]);
      return OwnedOutline{{arm}, 0.0}
          .moved(then.angle - now.angle, {then.point[0], then.point[1]})
          .vertices[0];
    };
    const Vec<2> velocity(rate([&](double t) { return place(t)[0]; }),
                          rate([&](double t) { return place(t)[1]; }));
    EXPECT_NEAR(rows.surface_velocity_after[0], at.normal.dot(velocity), tolerance);
    EXPECT_NEAR(rows.surface_velocity_after[1], at.normal[1] * velocity[0] - at.normal[0] * velocity[1],
                tolerance);
  }
}

// Over a step the velocity that the row foretells is the rate of the gap at its end, of a body that does not
// turn, wherever it slides on the shape: up to the square of the step.
TEST(PairRows, FollowThePlaceThatIsTouchedAlongAShapeThatTurns) {
  Random random(15);
  std::array<int, 3> kinds{};
  for (int i = 0; i < 2000 && !HasFailure(); ++i) {
    SCOPED_TRACE(i);
    MovingPair pair(random);
    pair.v[2] = 0.0;
    pair.ground_motion = random_motion(random);
    if (!pair.choose_features(i % 2)) continue;
    ++kinds[static_cast<std::size_t>(pair.gap_at(0).kind)];
    const auto error = [&](double step) {
      SingleConstraint rows = pair.rows_at(0);
      add_motion_after(pair.body_at(0), pair.ground_at(0), pair.gap_at(0), pair.ground_motion(0),
                       pair.ground_motion(step), step, rows);
      return rows.velocity_after(0, pair.v.data()) - pair.rows_at(step).velocity(0, pair.v.data());
    };
    // Speeds up to 4 at distances from 0.5 on, (4/0.5)^3 and the like: the third rate of the gap is up to
    // some 2e3 [m/s^3], its half times the square of the step up to 1e-5. Of first order the error was up to
    // 1e-3.
    EXPECT_NEAR(error(1e-4), 0.0, 1e-5);
    EXPECT_NEAR(error(1e-4), 4.0 * error(5e-5), 1e-7);
  }
  for (const int count : kinds) EXPECT_GT(count, 50);
}

TEST(PairRows, AgainstAShapeAtRestHasNoSurfaceVelocity) {
  Random random(14);
  MovingPair pair(random);
  ASSERT_TRUE(pair.choose_features(0));
  const StateView state{0.0, pair.q.data(), pair.v.data(), nullptr};
  SingleConstraint rows;
  fill_pair_rows(PairSide::of_body(pair.slot_a, 4, pair.outline_a.radius, state),
                 PairSide::at_rest(pair.outline_b.radius), pair.gap_at(0), rows);
  EXPECT_EQ(rows.bodies, 1);
  EXPECT_EQ(rows.blocks[0].body, 4U);
  EXPECT_EQ(rows.columns(), 3);
  EXPECT_EQ(rows.surface_velocity, (std::array<double, 3>{}));
}

// Whatever the gap: the forces on the two bodies are opposite and act along one line.
TEST(PairRows, KeepMomentumAndAngularMomentum) {
  Random random(15);
  for (int i = 0; i < 2000 && !HasFailure(); ++i) {
    MovingPair pair(random);
    pair.choose_features(0);
    const SingleConstraint rows = pair.rows_at(0);
    ASSERT_EQ(rows.bodies, 2);
    EXPECT_EQ(rows.blocks[0].body, 4U);
    EXPECT_EQ(rows.blocks[1].body, 7U);
    EXPECT_EQ(rows.rows, 2);
    EXPECT_EQ(rows.gap, pair.gap_at(0).gap);
    for (int row = 0; row < 2; ++row) {
      const double* h = rows.row(row);
      EXPECT_EQ(h[0], -h[3]);
      EXPECT_EQ(h[1], -h[4]);
      const double moment_a = pair.q[0] * h[1] - pair.q[1] * h[0] + h[2];
      const double moment_b = pair.q[3] * h[4] - pair.q[4] * h[3] + h[5];
      EXPECT_NEAR(moment_a + moment_b, 0.0, 4e-15);
    }
    EXPECT_EQ(rows.row(1)[0], rows.row(0)[1]);  // the normal turned clockwise
    EXPECT_EQ(rows.row(1)[1], -rows.row(0)[0]);
  }
}

}  // namespace
