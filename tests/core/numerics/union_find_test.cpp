// Sets that are joined two by two: against labels that are spread over all numbers, and reuse.

#include "tests/random.h"

#include <carom/core/numerics/union_find.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace {

using namespace carom;

TEST(UnionFind, NamesSetsByTheirLeastNumber) {
  UnionFind sets;
  sets.start(6);
  sets.join(5, 3);
  sets.join(4, 5);
  EXPECT_EQ(sets.find(4), 3u);
  EXPECT_EQ(sets.find(0), 0u);
  sets.join(1, 4);
  for (const Index number : {1u, 3u, 4u, 5u}) EXPECT_EQ(sets.find(number), 1u);
  EXPECT_EQ(sets.find(2), 2u);
  sets.start(8);
  for (Index number = 0; number < 8; ++number) EXPECT_EQ(sets.find(number), number);
}

TEST(UnionFind, AgreesWithLabels) {
  carom_test::Random random(1);
  UnionFind sets;
  for (int round = 0; round < 200; ++round) {
    const Index size = 1 + random.below(40);
    sets.start(size);
    std::vector<Index> label(size);
    for (Index i = 0; i < size; ++i) label[i] = i;
    for (Index joins = random.below(2 * size); joins > 0; --joins) {
      const Index a = random.below(size), b = random.below(size);
      sets.join(a, b);
      const Index from = std::max(label[a], label[b]), to = std::min(label[a], label[b]);
      for (Index& of : label) of = of == from ? to : of;
    }
    for (Index i = 0; i < size; ++i) ASSERT_EQ(sets.find(i), label[i]) << "round " << round;
  }
}

}  // namespace
