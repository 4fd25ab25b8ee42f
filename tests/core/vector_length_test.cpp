#include <carom/carom.h>
#include <carom/core/vector_length.h>

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <new>

namespace {

using namespace carom;
using namespace carom::planar;

TEST(VectorLength, WithinRoundingOfTheSquareRoot) {
  EXPECT_EQ(length_of<2>({3.0, 4.0}), 5.0);
  EXPECT_EQ(length_of<2>({0.0, 0.0}), 0.0);
  // Three roundings of products, two of sums, one of the root.
  EXPECT_NEAR(length_of<3>({1.0, 2.0, 3.0}), std::sqrt(14.0), 6.0 * 2.3e-16 * std::sqrt(14.0));
}

TEST(VectorLength, NeitherOverflowsNorUnderflows) {
  EXPECT_DOUBLE_EQ(length_of<2>({3e300, 4e300}), 5e300);
  EXPECT_DOUBLE_EQ(length_of<2>({3e-300, 4e-300}), 5e-300);
  EXPECT_GT(length_of<2>({5e-324, 0.0}), 0.0);
}

// Vectors of the parts have no demands on alignment: a part may lie at any address that is a multiple of 8.
TEST(VectorLength, DoesNotDependOnTheAddress) {
  const auto fingerprint_at = [](std::size_t offset, double slope) {
    alignas(64) std::array<std::byte, sizeof(HalfPlane) + 64> memory;
    HalfPlane* const part = new (memory.data() + offset) HalfPlane{.normal = incline(slope)};
    System system;
    system.add(*part, Surface{.friction = 0.1, .normal_restitution = 0.5});
    part->~HalfPlane();
    return system.fingerprint();
  };
  int differing = 0;
  for (int i = 1; i <= 200; ++i) {
    if (fingerprint_at(0, -0.007 * i) != fingerprint_at(8, -0.007 * i)) ++differing;
  }
  EXPECT_EQ(differing, 0);
}

}  // namespace
