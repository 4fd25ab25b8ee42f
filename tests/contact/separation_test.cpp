// Bodies are moved apart by the smallest displacement, without a simulation or a model: places on a plane.

#include <carom/carom.h>
#include <carom/contact/separation.h>
#include <carom/core/constraint_set.h>

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

namespace {

using namespace carom;

/// Discs with masses in a box, or without one.
class Discs final : public GapSource, public BodyResponse {
public:
  struct Disc {
    double mass = 1.0, radius = 1.0;
    std::array<double, 2> place{};  ///< of the centre
    friend bool operator==(const Disc&, const Disc&) = default;
  };

  explicit Discs(std::vector<Disc> list) : discs(std::move(list)), lengths_(2 * discs.size(), 1.0) {}

  std::vector<Disc> discs;
  /// Walls at x = 0 and at x = width, both of them infinite; 0: none.
  double width = 0.0;
  /// The first two are tied to each other: their distance along x is this, if it is positive.
  double rod = 0.0;

  std::span<Constraint> find(double margin) override {
    found_.clear();
    for (Index a = 0; a < discs.size(); ++a) {
      for (Index b = a + 1; b < discs.size(); ++b) add_pair(a, b, margin);
      if (width == 0.0) continue;
      const double x = discs[a].place[0], r = discs[a].radius;
      add_wall(a, 0, x - r, 1.0, margin);
      add_wall(a, 1, width - x - r, -1.0, margin);
    }
    return found_;
  }
  Index bodies() const override { return static_cast<Index>(discs.size()); }
  Index first_together(Index body) const override { return rod > 0.0 && body == 1 ? 0 : body; }
  Range velocities() const override { return {0, static_cast<Index>(2 * discs.size())}; }
  const std::vector<double>& lengths() const override { return lengths_; }
  double rounding() const override { return 1e-15; }
  void begin() override { from_ = discs; }
  std::span<const Range> select(std::span<const Constraint> contacts) override {
    std::vector<bool> taken(discs.size());
    for (const Constraint& contact : contacts) {
      for (int b = 0; b < contact.bodies; ++b) taken[contact.blocks[static_cast<std::size_t>(b)].body] = true;
    }
    if (rod > 0.0 && (taken[0] || taken[1])) taken[0] = taken[1] = true;
    selected_.clear();
    for (Index i = 0; i < discs.size(); ++i) {
      if (taken[i]) selected_.push_back({2 * i, 2 * i + 2});
    }
    return selected_;
  }
  BodyResponse& response() override { return *this; }
  void move(const double* displacement) override {
    for (const Range v : selected_) {
      for (Index i = 0; i < 2; ++i)
        discs[v.begin / 2].place[i] = from_[v.begin / 2].place[i] + displacement[v.begin + i];
    }
  }
  void update() override { ++updates; }
  bool is_off(double depth) override {
    return rod > 0.0 && std::abs(discs[1].place[0] - discs[0].place[0] - rod) > depth;
  }
  void close_joints(const double* displacement, double* sum) override {
    if (rod == 0.0) return;
    // J d0 = J d - j, by the inverse masses.
    const double j = discs[1].place[0] - discs[0].place[0] - rod;
    const double along = displacement[2] - displacement[0] - j;
    const double w0 = 1.0 / discs[0].mass, w1 = 1.0 / discs[1].mass;
    sum[0] -= along * w0 / (w0 + w1);
    sum[2] += along * w1 / (w0 + w1);
  }
  /// With the rod two answer together; else each by its mass.
  Range reach(Index body) const override {
    if (rod > 0.0 && body < 2) return {0, 4};
    return {2 * body, 2 * body + 2};
  }
  void answer(Index body, double* x, std::size_t columns, char* held) override {
    const bool tied = rod > 0.0 && body < 2;
    const std::size_t size = tied ? 4 : 2;
    for (std::size_t c = 0; c < columns; ++c, x += size) {
      held[c] = 0;
      for (std::size_t i = 0; i < size; ++i) x[i] /= discs[tied ? i / 2 : body].mass;
      if (!tied) continue;
      const double both = (discs[0].mass * x[0] + discs[1].mass * x[2]) / (discs[0].mass + discs[1].mass);
      x[0] = x[2] = both;
    }
  }

  int updates = 0;

private:
  Constraint& add(Index a, Index serial, double gap) {
    Constraint& contact = found_.add();
    contact.gap = gap;
    contact.key = {{FeatureKey::Owner::body, a, 0}, {FeatureKey::Owner::body, serial, 0}};
    contact.add_body(a, 2 * a, 2);
    return contact;
  }
  void add_wall(Index a, Index wall, double gap, double normal, double margin) {
    if (gap > margin) return;
    Constraint& contact = add(a, wall, gap);
    contact.key.b.owner = FeatureKey::Owner::obstacle;
    contact.start_rows(1);
    contact.row(0)[0] = normal;
    contact.row(0)[1] = 0.0;
  }
  void add_pair(Index a, Index b, double margin) {
    const double x = discs[a].place[0] - discs[b].place[0], y = discs[a].place[1] - discs[b].place[1];
    const double distance = std::hypot(x, y), gap = distance - discs[a].radius - discs[b].radius;
    if (gap > margin) return;
    Constraint& contact = add(a, b, gap);
    contact.add_body(b, 2 * b, 2);
    contact.start_rows(1);
    double* const row = contact.row(0);
    row[0] = x / distance;
    row[1] = y / distance;
    row[2] = -row[0];
    row[3] = -row[1];
  }

  std::vector<Disc> from_;
  std::vector<double> lengths_;
  ConstraintSet found_;
  std::vector<Range> selected_;
};

constexpr double rounding = 1e-14;  // of places of a few metres

TEST(Separation, TwoGoApartAgainstTheirMasses) {
  Discs discs({{1.0, 1.0, {0.0, 0.0}}, {3.0, 1.0, {1.6, 0.0}}});
  SolverChain chain;
  const Separation out = Separator().separate(discs, chain);
  EXPECT_TRUE(out.moved);
  EXPECT_EQ(out.left, nullptr);
  EXPECT_NEAR(discs.discs[0].place[0], -0.3, rounding);
  EXPECT_NEAR(discs.discs[1].place[0], 1.7, rounding);
  EXPECT_NEAR(out.shift, 0.3, rounding);
  EXPECT_EQ(discs.discs[0].place[1], 0.0);
}

TEST(Separation, WhatTouchesOrIsApartStays) {
  Discs discs({{1.0, 1.0, {0.0, 0.0}}, {1.0, 1.0, {2.0, 0.0}}, {1.0, 1.0, {5.0, 0.0}}});
  const auto before = discs.discs;
  SolverChain chain;
  const Separation out = Separator().separate(discs, chain);
  EXPECT_FALSE(out.moved);
  EXPECT_EQ(out.shift, 0.0);
  EXPECT_EQ(discs.discs, before);
  EXPECT_EQ(discs.updates, 0);
}

TEST(Separation, OneThatIsPushedPushesTheNext) {
  // The middle one cannot go to the left without the right wall's neighbour: all three share the way.
  Discs discs({{1.0, 1.0, {1.0, 0.0}}, {2.0, 1.0, {2.5, 0.0}}, {4.0, 1.0, {4.8, 0.0}}});
  discs.width = 6.5;
  SolverChain chain;
  const Separation out = Separator().separate(discs, chain);
  EXPECT_EQ(out.left, nullptr);
  // The first is held by the wall at 0; the second comes to 3, the third to 5, where it leaves room.
  EXPECT_NEAR(discs.discs[0].place[0], 1.0, rounding);
  EXPECT_NEAR(discs.discs[1].place[0], 3.0, rounding);
  EXPECT_NEAR(discs.discs[2].place[0], 5.0, rounding);
}

TEST(Separation, WithoutRoomItSaysWhatIsLeft) {
  Discs discs({{1.0, 1.0, {0.9, 0.0}}});
  discs.width = 1.5;
  SolverChain chain;
  const Separation out = Separator().separate(discs, chain);
  ASSERT_NE(out.left, nullptr);
  EXPECT_EQ(out.together.size(), 2u);
  EXPECT_LT(out.left->gap, -0.1);
}

TEST(Separation, TheNormalTurnsWithThePlaces) {
  // A disc between two that stay nearly where they are, by their masses: it leaves along the middle.
  Discs discs({{1e9, 1.0, {-0.9, 0.0}}, {1e9, 1.0, {0.9, 0.0}}, {1.0, 1.0, {0.0, 1.5}}});
  SolverChain chain;
  const Separation out = Separator().separate(discs, chain);
  EXPECT_EQ(out.left, nullptr);
  const auto& place = discs.discs[2].place;
  EXPECT_NEAR(place[0], 0.0, rounding);
  // The two go apart to 1 each; the third then stands on both at the height sqrt(4 - 1).
  EXPECT_NEAR(place[1], std::sqrt(3.0), 1e-9);
  for (const Constraint& contact : discs.find(1.0)) EXPECT_GE(contact.gap, -1e-14);
}

TEST(Separation, WhatARodTiesMovesTogether) {
  Discs discs({{1.0, 0.5, {0.3, 0.0}}, {1.0, 0.5, {2.3, 0.0}}, {2.0, 0.5, {3.1, 0.0}}});
  discs.width = 100.0;
  discs.rod = 2.0;
  SolverChain chain;
  const Separation out = Separator().separate(discs, chain);
  EXPECT_EQ(out.left, nullptr);
  EXPECT_NEAR(discs.discs[0].place[0], 0.5, rounding);
  EXPECT_NEAR(discs.discs[1].place[0], 2.5, rounding);
  EXPECT_NEAR(discs.discs[2].place[0], 3.5, rounding);
}

TEST(Separation, MovesTheLeastInTheSenseOfTheMasses) {
  // d = M^-1 G^T y with y >= 0 says so: what pulls would be less, what is not along normals more.
  Discs discs({{1.0, 1.0, {0.0, 0.0}}, {2.0, 1.0, {1.5, 0.4}}, {0.5, 1.0, {-0.7, 1.2}}});
  const auto before = discs.discs;
  SolverChain chain;
  ASSERT_EQ(Separator().separate(discs, chain).left, nullptr);
  std::array<double, 2> momentum{};
  for (std::size_t i = 0; i < before.size(); ++i) {
    for (std::size_t k = 0; k < 2; ++k)
      momentum[k] += before[i].mass * (discs.discs[i].place[k] - before[i].place[k]);
  }
  EXPECT_NEAR(momentum[0], 0.0, rounding);
  EXPECT_NEAR(momentum[1], 0.0, rounding);
  for (const Constraint& contact : discs.find(1.0)) EXPECT_GE(contact.gap, -rounding);
}

}  // namespace
