// The name that was meant, in messages about one that does not exist.

#include <carom/carom.h>
#include <carom/core/nearest_name.h>

#include "tests/model_error.h"

#include <gtest/gtest.h>

#include <random>
#include <string>
#include <string_view>
#include <vector>

namespace {

using namespace carom;
using namespace carom::planar;

TEST(NearestName, IsTheOneWithFewestChanges) {
  const std::vector<std::string_view> names{"ball", "floor", "upper arm", "lower arm", "x"};
  EXPECT_EQ(nearest_name("bal", names), "ball");
  EXPECT_EQ(nearest_name("Ball", names), "ball");
  EXPECT_EQ(nearest_name("blal", names), "ball");  // letters exchanged
  EXPECT_EQ(nearest_name("uper arm", names), "upper arm");
  EXPECT_EQ(nearest_name("lower_arm", names), "lower arm");
  EXPECT_EQ(nearest_name("flor", names), "floor");
  EXPECT_EQ(nearest_name("wheel", names), "");
  EXPECT_EQ(nearest_name("y", names), "");
  EXPECT_EQ(nearest_name("", names), "");
  EXPECT_EQ(nearest_name("ball", {}), "");
}

// Whatever one change makes of a name of four letters and more, it is found again.
TEST(NearestName, FindsWhatOneChangeHides) {
  std::mt19937 random(7);
  const auto below = [&](std::size_t count) {
    return std::uniform_int_distribution<std::size_t>(0, count - 1)(random);
  };
  for (int repeat = 0; repeat < 300; ++repeat) {
    std::string name;
    for (std::size_t i = 4 + below(12); i > 0; --i) name += static_cast<char>('a' + below(26));
    std::string other = name;
    const std::size_t at = below(name.size());
    switch (below(3)) {
      case 0:
        other.erase(at, 1);
        break;
      case 1:
        other.insert(at, 1, static_cast<char>('a' + below(26)));
        break;
      default:
        other[at] = static_cast<char>('a' + below(26));
    }
    EXPECT_EQ(nearest_name(other, {"0123456789", name, "9876"}), name) << other;
  }
}

TEST(NearestName, IsInTheMessageOfTheSystem) {
  System system;
  system.add(Particle{.mass = 1.0}, "ball");
  const BodyId gone = system.add(Particle{.mass = 1.0}, "balk");
  system.remove(gone);
  EXPECT_MODEL_ERROR((void)system.body("balk"), "body 'balk': there is none; the nearest is 'ball'",
                     "allowed: the name of a body of this system");
  EXPECT_MODEL_ERROR((void)system.body("zebra"), "body 'zebra': there is none; allowed: the name");
  EXPECT_MODEL_ERROR((void)system.joint("ball"), "joint 'ball': there is none; allowed: the name");
}

}  // namespace
