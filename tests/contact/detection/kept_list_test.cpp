#include <carom/contact/detection/kept_list.h>

#include <gtest/gtest.h>

namespace {

using carom::KeptList;

TEST(KeptList, HandsOutWhatItWasLeftWith) {
  KeptList<int> list;
  EXPECT_EQ(list.next(), 0);
  list.all()[0] = 7;
  list.next() = 8;
  ASSERT_EQ(list.all().size(), 2U);
  list.clear();
  EXPECT_EQ(list.size(), 0U);
  EXPECT_TRUE(list.all().empty());
  EXPECT_EQ(list.next(), 7);
  EXPECT_EQ(list.size(), 1U);
  EXPECT_EQ(list.next(), 8);
  EXPECT_EQ(list.next(), 0);
}

}  // namespace
