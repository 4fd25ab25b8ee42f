// Constraints of one instant keep their rows packed, wherever the constraints themselves are moved.

#include "tests/allocation_counter.h"
#include "tests/constraint_sets.h"
#include "tests/random.h"

#include <carom/core/constraint_set.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

namespace {

using namespace carom;
using carom_test::numbers_of;
using carom_test::Random;

/// Writes a constraint whose every number follows from its name. \param columns of each of its bodies
void write(Index name, int rows, const std::vector<int>& columns, Constraint& out) {
  out.key.a.serial = name;
  out.gap = -static_cast<double>(name);
  Index body = 10 * name;
  for (const int width : columns) {
    out.add_body(body, 6 * body, width);
    ++body;
  }
  out.start_rows(rows);
  for (int i = 0; i < rows * out.columns(); ++i) out.row(0)[i] = 100.0 * name + i;
}

/// True if all numbers of a constraint are those of its name.
bool is_whole(const Constraint& at) {
  const double name = at.key.a.serial;
  if (at.gap != -name) return false;
  const std::vector<double> numbers = numbers_of(at);
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    if (numbers[i] != 100.0 * name + static_cast<double>(i)) return false;
  }
  return true;
}

/// Bodies that a constraint may have: on ground and against each other, in the plane and in space.
const std::vector<std::vector<int>> kinds_of_bodies{{2},    {3},    {6},       {3, 3},
                                                    {2, 3}, {6, 6}, {3, 3, 3}, {6, 6, 6}};

TEST(ConstraintSet, RowsAreAsWideAsTheBodiesAndStandBehindOneAnother) {
  ConstraintSet set;
  write(1, 2, {3}, set.add());
  write(2, 2, {3, 3}, set.add());
  write(3, 3, {6}, set.add());
  EXPECT_EQ(set[1].row(0), set[0].row(2));
  EXPECT_EQ(set[2].row(0), set[1].row(2));
  EXPECT_EQ(set[2].row(1) - set[2].row(0), 6);
  for (const Constraint& at : set) EXPECT_TRUE(is_whole(at));
}

TEST(ConstraintSet, RowsOfTwoBodiesInSpaceHaveRoom) {
  ConstraintSet set;
  write(4, 3, {6, 6}, set.add());
  SingleConstraint alone;
  write(4, 3, {6, 6}, alone);
  EXPECT_EQ(numbers_of(set[0]).size(), 36U);
  EXPECT_TRUE(is_whole(set[0]));
  EXPECT_EQ(numbers_of(alone), numbers_of(set[0]));
}

TEST(ConstraintSet, RowsStayWhereTheyAreWhileTheListGrows) {
  ConstraintSet set;
  write(1, 2, {3, 3}, set.add());
  const double* const rows = set[0].row(0);
  for (Index i = 2; i < 1000; ++i) write(i, 2, {3, 3}, set.add());
  EXPECT_EQ(set[0].row(0), rows);
  EXPECT_TRUE(std::all_of(set.begin(), set.end(), is_whole));
}

TEST(ConstraintSet, ACopyHasRowsOfItsOwn) {
  ConstraintSet set;
  for (Index i = 0; i < 5; ++i) write(i, 2, {3}, set.add());
  ConstraintSet copy = set;
  SingleConstraint alone(set[3]);
  set[3].row(0)[0] = -1.0;
  EXPECT_TRUE(is_whole(copy[3]));
  EXPECT_TRUE(is_whole(alone));
  copy[2].row(1)[1] = -1.0;
  EXPECT_TRUE(is_whole(set[2]));
  ConstraintSet taken = std::move(copy);
  EXPECT_TRUE(copy.empty());  // NOLINT(bugprone-use-after-move): it can be used again
  write(9, 2, {3}, copy.add());
  EXPECT_TRUE(is_whole(copy[0]));
  EXPECT_EQ(taken.size(), 5U);
  EXPECT_TRUE(is_whole(taken[3]));
  SingleConstraint moved = std::move(alone);  // its room is within it
  alone.row(0)[0] = -1.0;
  EXPECT_TRUE(is_whole(moved));
}

TEST(ConstraintSet, ASingleOneKeepsItsNumbersWhicheverItTakes) {
  SingleConstraint alone;
  Index name = 0;
  for (int round = 0; round < 2; ++round) {
    for (const std::vector<int>& bodies : kinds_of_bodies) {
      ConstraintSet set;
      write(++name, 3, bodies, set.add());
      alone = set[0];
      set.clear();
      write(0, 1, {2}, set.add());
      EXPECT_TRUE(is_whole(alone)) << name;
      const SingleConstraint copy = alone;
      EXPECT_TRUE(is_whole(copy)) << name;
    }
  }
}

TEST(ConstraintSet, OneToBeAContactIsAsMadeByDefaultButForWhatContactsWrite) {
  ConstraintSet set;
  Constraint& limit = set.add();
  write(1, 1, {2}, limit);
  limit.normals = 0;
  limit.attached = 1;
  limit.of_joint = {2.0, 3.0, 7};
  limit.drift[0] = limit.surface_velocity[1] = limit.surface_velocity_after[2] = limit.allowed_approach = 1.0;
  for (int round = 0; round < 2; ++round) {
    set.clear();
    const Constraint& at = set.add_contact();
    EXPECT_EQ(at.normals, 1);
    EXPECT_EQ(at.attached, 0);
    EXPECT_EQ(at.of_joint.source, none);
    EXPECT_EQ(at.of_joint.friction_bound, 0.0);
    EXPECT_EQ(at.allowed_approach, 0.0);
    for (const auto& numbers : {at.drift, at.surface_velocity, at.surface_velocity_after})
      EXPECT_EQ(numbers, (std::array<double, 3>{}));
    set[0].allowed_approach = set[0].drift[1] = set[0].surface_velocity[0] = 1.0;
  }
}

// A limit has one row, and neither velocity nor force along a tangent, wherever it stands.
TEST(ConstraintSet, ALimitHasNothingAlongATangent) {
  constexpr std::size_t velocities = 2000;
  const std::vector<double> v(velocities, 1.0);
  std::vector<double> load(velocities);
  const auto expect_nothing = [&](Constraint& limit) {
    EXPECT_EQ(limit.tangential_velocity(v.data()), 0.0);
    EXPECT_EQ(limit.tangential_acceleration(v.data()), 0.0);
    EXPECT_EQ(limit.sliding_speed(v.data()), 0.0);
    EXPECT_EQ(limit.speed(limit.tangent_row(), v.data()), 0.0);
    for (int c = 0; c < limit.columns(); ++c) EXPECT_EQ(limit.row(1)[c], 0.0);
    std::fill(load.begin(), load.end(), 0.0);
    limit.add_transposed(0, 2.0, load.data());
    limit.add_transposed(limit.tangent_row(), 3.0, load.data());
    std::vector<double> expected(velocities, 0.0);
    limit.add_transposed(0, 2.0, expected.data());
    EXPECT_EQ(load, expected);
  };
  ConstraintSet set;
  for (int round = 0; round < 3; ++round) {
    set.clear();
    for (Index i = 0; i < 16; ++i) {
      const std::vector<int>& bodies =
          kinds_of_bodies[(i + static_cast<Index>(round)) % kinds_of_bodies.size()];
      const bool is_limit = (i + static_cast<Index>(round)) % 2 == 0;
      write(i + 1, is_limit ? 1 : 3, bodies, set.add());
    }
    for (Constraint& at : set) {
      if (at.tangents() > 0) continue;
      expect_nothing(at);
      SingleConstraint alone(at);
      expect_nothing(alone);
    }
    EXPECT_TRUE(std::all_of(set.begin(), set.end(), is_whole)) << "no row is written over another one";
  }
}

// Whatever is done to a list, each constraint has the rows that were written with it.
TEST(ConstraintSet, RowsGoWithTheirConstraintsThroughAllChanges) {
  Random random(52);
  ConstraintSet set, other;
  Index name = 0;
  const auto pick = [&](std::size_t count) {
    return static_cast<std::size_t>(random.uniform(0.0, 0.999) * static_cast<double>(count));
  };
  for (int round = 0; round < 3000; ++round) {
    switch (pick(7)) {
      case 0:
        set.remove_if([&](const Constraint& at) { return at.key.a.serial % 3 == 0; });
        break;
      case 1:
        std::sort(set.begin(), set.end(), [](const Constraint& a, const Constraint& b) {
          return a.key.a.serial % 17 < b.key.a.serial % 17;
        });
        break;
      case 2:
        std::swap(set, other);
        break;
      case 3:
        if (set.size() > 1) std::swap(set[pick(set.size())], set[pick(set.size())]);
        break;
      case 4:
        other.assign(set);
        break;
      case 5:
        if (round % 5 == 0) set.resize(set.size() / 2);
        break;
      default:
        break;
    }
    const int rows = 1 + static_cast<int>(pick(3));
    write(++name, rows, kinds_of_bodies[pick(kinds_of_bodies.size())], set.add());
    if (!other.empty() && round % 2 == 0) set[pick(set.size())].take(other[pick(other.size())]);
    if (set.size() > 60) set.clear();
    ASSERT_TRUE(std::all_of(set.begin(), set.end(), is_whole)) << round;
    ASSERT_TRUE(std::all_of(other.begin(), other.end(), is_whole)) << round;
  }
}

TEST(ConstraintSet, ASetThatIsMadeAnewTakesNoMemory) {
  ConstraintSet set, copy;
  const auto make = [&](Index first) {
    set.clear();
    for (Index i = 0; i < 200; ++i)
      write(first + i, 2, i % 3 == 0 ? std::vector<int>{3} : std::vector<int>{3, 3}, set.add_contact());
    copy.assign(set);
  };
  make(0);
  make(1);
  make(2);  // each place has had two bodies
  std::vector<std::vector<int>> bodies{{3}, {3, 3}};
  const std::int64_t before = carom_test::allocations();
  for (Index round = 3; round < 20; ++round) {
    set.clear();
    for (Index i = 0; i < 200; ++i) write(i, 2, bodies[(i + round) % 2], set.add_contact());
    copy.assign(set);
    set.remove_if([](const Constraint& at) { return at.key.a.serial % 4 == 0; });
    std::swap(set[3], set[5]);
    const SingleConstraint alone(set[3]);
    ASSERT_TRUE(is_whole(alone));
  }
  EXPECT_LE(carom_test::allocations() - before, 17);  // those of numbers_of()
}

}  // namespace
