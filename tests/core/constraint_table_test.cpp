// Places of keys, also where the table is filled again with the same ones or with others.

#include <carom/core/constraint_table.h>

#include <gtest/gtest.h>

#include <vector>

namespace {

using namespace carom;

ConstraintKey key(Index serial) {
  return {{FeatureKey::Owner::shape, serial, 0}, {FeatureKey::Owner::shape, serial + 1, 1}};
}

void fill(ConstraintTable& table, const std::vector<Index>& serials) {
  table.clear();
  for (const Index serial : serials) table.add(key(serial));
  table.finish();
}

/// Every key is found where it was added, and none of some others.
void expect_places(const ConstraintTable& table, const std::vector<Index>& serials,
                   const std::vector<Index>& others) {
  ASSERT_EQ(table.keys().size(), serials.size());
  for (Index i = 0; i < serials.size(); ++i) {
    EXPECT_EQ(table.find(key(serials[i])), i);
    for (const Index likely : {Index{0}, i, i + 1, none}) EXPECT_EQ(table.find(key(serials[i]), likely), i);
  }
  for (const Index other : others) {
    EXPECT_EQ(table.find(key(other)), none);
    EXPECT_EQ(table.find(key(other), 0), none);
  }
}

std::vector<Index> numbers(Index first, Index count, Index stride) {
  std::vector<Index> out;
  for (Index i = 0; i < count; ++i) out.push_back(first + i * stride);
  return out;
}

TEST(ConstraintTable, FindsFewAndManyKeys) {
  for (const Index count : {0U, 1U, 8U, 9U, 100U, 1000U}) {
    ConstraintTable table;
    fill(table, numbers(3, count, 2));
    expect_places(table, numbers(3, count, 2), {0, 4, 100000});
  }
}

TEST(ConstraintTable, TheSameKeysAgainOtherKeysAndTheFirstOnesAgain) {
  ConstraintTable table;
  const std::vector<Index> first = numbers(0, 50, 2), reversed{first.rbegin(), first.rend()},
                           other = numbers(1, 60, 2), few = numbers(0, 3, 2);
  for (const std::vector<Index>* const keys :
       {&first, &first, &reversed, &first, &other, &few, &other, &first}) {
    fill(table, *keys);
    expect_places(table, *keys, {keys == &other ? Index{2} : Index{1}, 1001});
  }
}

TEST(ConstraintTable, KeysThatWereAddedAndForgottenLeaveNothingBehind) {
  ConstraintTable table;
  const std::vector<Index> first = numbers(0, 50, 2);
  fill(table, first);
  table.clear();
  for (const Index serial : numbers(1, 20, 2)) table.add(key(serial));  // never finished
  EXPECT_EQ(table.find(key(2)), none);
  fill(table, first);
  expect_places(table, first, {1, 3, 5});
}

TEST(ConstraintTable, FewKeysBetweenManyThatBeginAlike) {
  // Slots that were filled for as many keys, of which some are others now.
  ConstraintTable table;
  const std::vector<Index> first = numbers(0, 50, 2), few = numbers(0, 5, 2), some = numbers(0, 20, 2);
  std::vector<Index> longer = few;
  for (const Index serial : numbers(501, 45, 2)) longer.push_back(serial);
  const std::vector<Index>& other = longer;
  for (const std::vector<Index>* const keys : {&first, &few, &other, &some, &first, &few, &first, &other}) {
    fill(table, *keys);
    expect_places(table, *keys, {1, 3, 10001});
  }
  fill(table, {});
  expect_places(table, {}, {0, 2});
  fill(table, first);
  expect_places(table, first, {501});
}

TEST(ConstraintTable, KeysMayBeAddedAfterOthersWereMadeReady) {
  ConstraintTable table;
  std::vector<Index> all = numbers(0, 50, 2);
  fill(table, all);
  table.add(key(1));
  table.finish();
  all.push_back(1);
  expect_places(table, all, {3});
  table.clear();
  all.pop_back();
  fill(table, all);
  expect_places(table, all, {1});
}

}  // namespace
