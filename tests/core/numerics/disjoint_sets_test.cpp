#include <carom/core/numerics/disjoint_sets.h>

#include <gtest/gtest.h>

namespace {

using carom::DisjointSets;
using carom::Index;

TEST(DisjointSets, AreNamedByTheirSmallestNumber) {
  DisjointSets sets(6);
  for (Index i = 0; i < 6; ++i) EXPECT_EQ(sets.find(i), i);
  sets.join(5, 3);
  sets.join(4, 5);
  sets.join(4, 3);
  for (const Index i : {3U, 4U, 5U}) EXPECT_EQ(sets.find(i), 3U);
  sets.join(5, 1);
  for (const Index i : {1U, 3U, 4U, 5U}) EXPECT_EQ(sets.find(i), 1U);
  EXPECT_EQ(sets.find(0), 0U);
  EXPECT_EQ(sets.find(2), 2U);
}

}  // namespace
