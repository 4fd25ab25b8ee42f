#include <carom/core/column.h>
#include <carom/core/serial_list.h>

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace {

using namespace carom;

TEST(Column, HoldsOneValueWhileAllAreEqual) {
  Column<double> column;
  for (int i = 0; i < 3; ++i) column.push_back(0.1);
  EXPECT_TRUE(column.uniform());
  EXPECT_EQ(column.stride(), 0U);
  EXPECT_EQ(column.data()[1], 0.1);  // loops take two at once
  column.push_back(0.2);
  column.push_back(0.1);
  EXPECT_FALSE(column.uniform());
  const std::vector<double> expected{0.1, 0.1, 0.1, 0.2, 0.1};
  ASSERT_EQ(column.size(), expected.size());
  for (Index i = 0; i < column.size(); ++i) {
    EXPECT_EQ(column[i], expected[i]);
    EXPECT_EQ(column.data()[i * column.stride()], expected[i]);
  }
}

TEST(Column, TellsApartWhatDiffersInBitsOnly) {
  Column<double> column;
  column.push_back(0.0);
  column.push_back(-0.0);
  EXPECT_FALSE(column.uniform());
  EXPECT_TRUE(std::signbit(column[1]));
}

TEST(Column, CanBeEmptiedAndFilledAgain) {
  Column<double> column;
  for (const double value : {1.0, 2.0, 3.0}) column.push_back(value);
  column.erase(1);
  EXPECT_EQ(column[1], 3.0);
  column.erase(0);
  column.erase(0);
  EXPECT_EQ(column.size(), 0U);
  column.push_back(4.0);
  column.push_back(5.0);
  EXPECT_EQ(column[0], 4.0);
  EXPECT_EQ(column[1], 5.0);
}

TEST(SerialList, FindsBothWaysAcrossGapsAndRemovals) {
  SerialList list;
  std::vector<Index> expected{0, 1, 2, 5, 6, 9};
  for (const Index serial : expected) list.push_back(serial);
  const auto check = [&] {
    ASSERT_EQ(list.size(), expected.size());
    std::vector<Index> slot_of(12, none);
    for (Index slot = 0; slot < expected.size(); ++slot) {
      EXPECT_EQ(list[slot], expected[slot]);
      slot_of[expected[slot]] = slot;
    }
    for (Index serial = 0; serial < 12; ++serial) EXPECT_EQ(list.find(serial), slot_of[serial]);
  };
  check();
  for (const Index slot : {1U, 3U, 3U, 0U}) {
    list.erase(slot);
    expected.erase(expected.begin() + slot);
    check();
  }
}

}  // namespace
