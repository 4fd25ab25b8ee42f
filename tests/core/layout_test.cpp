#include <carom/core/errors.h>
#include <carom/core/layout.h>

#include "tests/model_error.h"

#include <gtest/gtest.h>

namespace {

using namespace carom;

// A particle (serial 4), a rigid body (serial 1), a particle (serial 2); serials 0 and 3 were removed.
Layout planar_layout() {
  return Layout(2, 7,
                {BodySlot{4, 0, 0, 2, 2, none, 0, 0}, BodySlot{1, 2, 2, 3, 3, 0, 1, 0},
                 BodySlot{2, 5, 5, 2, 2, none, 0, 1}});
}

TEST(Layout, CountsWhatTheSlotsHold) {
  const Layout layout = planar_layout();
  EXPECT_EQ(layout.dimension(), 2);
  EXPECT_EQ(layout.q_size(), 7U);
  EXPECT_EQ(layout.v_size(), 7U);
  EXPECT_EQ(layout.rotation_size(), 2U);
}

TEST(Layout, CoordinatesAndVelocitiesMayDifferInNumber) {
  const Layout layout(3, 7, {BodySlot{0, 0, 0, 7, 6, 0, 0, 0}, BodySlot{1, 7, 6, 7, 6, 9, 0, 1}});
  EXPECT_EQ(layout.q_size(), 14U);
  EXPECT_EQ(layout.v_size(), 12U);
  EXPECT_EQ(layout.rotation_size(), 18U);
}

TEST(Layout, FindsBodiesByIdentity) {
  const Layout layout = planar_layout();
  EXPECT_EQ(layout.index({4, 7}), 0U);
  EXPECT_EQ(layout.index({1, 7}), 1U);
  EXPECT_EQ(layout.index({2, 7}), 2U);
  EXPECT_EQ(layout.slot({2, 7}).q, 5U);
  for (Index body = 0; body < 3; ++body) EXPECT_EQ(layout.index(layout.id(body)), body);
}

TEST(Layout, RefusesWhatIsNotInTheModel) {
  const Layout layout = planar_layout();
  for (const BodyId bad : {BodyId{3, 7}, BodyId{0, 7}, BodyId{5, 7}, BodyId{4, 8}}) {
    EXPECT_FALSE(layout.contains(bad));
    EXPECT_MODEL_ERROR(layout.index(bad), "#" + std::to_string(bad.serial), "not in this model", "allowed");
  }
  EXPECT_FALSE(layout.contains(ground));
  EXPECT_MODEL_ERROR(layout.slot(ground), "ground", "allowed: a body of this model");
  EXPECT_MODEL_ERROR(layout.slot(BodyId{}), "never given", "allowed: a body of this model");
}

}  // namespace
