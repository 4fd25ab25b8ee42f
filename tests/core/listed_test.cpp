// Names in a message: some of them, and how many more there are.

#include <carom/core/listed.h>

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace {

using namespace carom;

TEST(Listed, NamesSomeAndCountsTheRest) {
  const std::vector<std::string> names{"disc 'rim'", "disc #1", "box #2"};
  EXPECT_EQ(listed({}, 3), "");
  EXPECT_EQ(listed(std::span(names).first(1), 3), "disc 'rim'");
  EXPECT_EQ(listed(names, 3), "disc 'rim', disc #1, box #2");
  EXPECT_EQ(listed(names, 2), "disc 'rim', disc #1 and 1 more");
  EXPECT_EQ(listed(names, 1), "disc 'rim' and 2 more");
}

}  // namespace
