// Clock groups are taken in the order of their times.

#include <carom/integrators/event_driven/group_queue.h>

#include <gtest/gtest.h>

#include <vector>

namespace {

using namespace carom;

std::vector<Index> take_all(GroupQueue& queue) {
  std::vector<Index> order;
  while (!queue.empty()) order.push_back(queue.take());
  return order;
}

TEST(GroupQueue, GroupsAtOneTimeInTheOrderOfAssembly) {
  GroupQueue queue;
  EXPECT_TRUE(queue.empty());
  queue.fill(4, 1.0);
  EXPECT_EQ(take_all(queue), (std::vector<Index>{0, 1, 2, 3}));
  queue.fill(2, 0.0);
  queue.fill(3, 0.0);
  EXPECT_EQ(take_all(queue), (std::vector<Index>{0, 1, 2}));
}

TEST(GroupQueue, TheEarliestFirst) {
  GroupQueue queue;
  queue.fill(3, 1.0);
  EXPECT_EQ(queue.take(), 0U);
  queue.put(0, 2.0);
  EXPECT_EQ(queue.take(), 1U);
  queue.put(1, 1.5);
  EXPECT_EQ(queue.take(), 2U);
  queue.put(2, 2.0);
  EXPECT_EQ(take_all(queue), (std::vector<Index>{1, 0, 2}));
}

}  // namespace
