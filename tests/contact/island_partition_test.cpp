// Islands among constraints with one to three bodies.

#include "tests/constraint_sets.h"
#include <carom/contact/island_partition.h>
#include <carom/core/constraint_set.h>

#include <gtest/gtest.h>

#include <vector>

namespace {

using namespace carom;

SingleConstraint between(std::initializer_list<Index> bodies) {
  SingleConstraint made;
  for (const Index body : bodies) made.add_body(body, 3 * body, 3);
  return made;
}

void expect_range(const Range& found, Index begin, Index end) {
  EXPECT_EQ(found.begin, begin);
  EXPECT_EQ(found.end, end);
}

constexpr auto alone = [](Index body) { return body; };

TEST(IslandPartition, LeavesWhatIsInOrderAlone) {
  ConstraintSet list =
      carom_test::set_of({between({0}), between({0}), between({2}), between({5}), between({5})});
  IslandPartition partition;
  const auto islands = partition.arrange(std::span(list), 6, alone);
  ASSERT_EQ(islands.size(), 3u);
  expect_range(islands[0], 0, 2);
  expect_range(islands[1], 2, 3);
  expect_range(islands[2], 3, 5);
}

TEST(IslandPartition, JoinsOverSharedBodies) {
  // 4-1 and 1-0 share a body; 2 stands alone; three bodies 6, 7, 8 are joined by one constraint.
  ConstraintSet list =
      carom_test::set_of({between({2}), between({4, 1}), between({8, 7, 6}), between({7}), between({1, 0})});
  for (std::size_t i = 0; i < list.size(); ++i) list[i].of_joint.source = static_cast<Index>(i);
  IslandPartition partition;
  const auto islands = partition.arrange(std::span(list), 9, alone);
  ASSERT_EQ(islands.size(), 3u);
  std::vector<Index> order;
  for (const Constraint& constraint : list) order.push_back(constraint.of_joint.source);
  EXPECT_EQ(order, (std::vector<Index>{1, 4, 0, 2, 3}));
  expect_range(islands[0], 0, 2);
  expect_range(islands[2], 3, 5);
}

TEST(IslandPartition, NodesMayStandForSeveralBodies) {
  ConstraintSet list = carom_test::set_of({between({0}), between({1}), between({2}), between({3})});
  IslandPartition partition;
  const auto islands = partition.arrange(std::span(list), 4, [](Index body) { return body % 2; });
  ASSERT_EQ(islands.size(), 2u);
  EXPECT_EQ(list[1].body(), 2u);
  EXPECT_EQ(list[2].body(), 1u);
}

TEST(IslandPartition, NothingHasNoIslands) {
  ConstraintSet list;
  EXPECT_TRUE(IslandPartition().arrange(std::span(list), 3, alone).empty());
}

}  // namespace
