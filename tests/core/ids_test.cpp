#include <carom/core/ids.h>

#include <gtest/gtest.h>

#include <type_traits>

namespace {

using namespace carom;

TEST(Ids, NeverGivenIsInvalid) {
  EXPECT_FALSE(BodyId{}.valid());
  EXPECT_FALSE(MaterialId{}.valid());
  EXPECT_TRUE((BodyId{0, 1}.valid()));
}

TEST(Ids, GroundIsValidAndNoOther) {
  EXPECT_TRUE(ground.valid());
  EXPECT_NE(ground, BodyId{});
  EXPECT_NE(ground.serial, none);
}

TEST(Ids, SystemsAreToldApart) {
  EXPECT_NE((BodyId{3, 1}), (BodyId{3, 2}));
  EXPECT_EQ((BodyId{3, 1}), (BodyId{3, 1}));
  EXPECT_LT((BodyId{2, 9}), (BodyId{3, 1}));
}

TEST(Ids, RolesDoNotMix) {
  static_assert(!std::is_convertible_v<BodyId, ElementId>);
  static_assert(!std::is_convertible_v<ShapeId, ObstacleId>);
}

TEST(Ids, RangeIsHalfOpen) {
  constexpr Range range{3, 7};
  EXPECT_EQ(range.size(), 4U);
  EXPECT_FALSE(range.empty());
  EXPECT_TRUE((Range{5, 5}.empty()));
  EXPECT_EQ(Range{}.size(), 0U);
}

}  // namespace
