#include <carom/contact/detection/pair_filter.h>

#include "tests/contact/detection/placed_model.h"

#include <carom/carom.h>

#include <gtest/gtest.h>

namespace {

using namespace carom;
using namespace carom::planar;

/// Three bars in a chain from the ground, and a ball; in an order of assembly of its own.
struct Chain {
  Chain() {
    ball = system.add(Particle{.mass = 1.0});
    BodyId last = ground;
    for (BodyId& bar : bars) {
      bar = system.add(RigidBody{.mass = rod(1.0, 1.0)});
      system.add(Segment{.body = bar, .from = {-0.5, 0.0}, .to = {0.5, 0.0}});
      system.add(Revolute{.from = last, .to = bar});
      last = bar;
    }
  }

  [[nodiscard]] bool may_touch(BodyId a, BodyId b) const {
    const carom_test::PlacedModel model(system);
    const Layout& layout = *model.assembly.layout();
    const PairFilter filter(model.assembly);
    EXPECT_EQ(filter.may_touch(layout.index(a), layout.index(b)),
              filter.may_touch(layout.index(b), layout.index(a)));
    return filter.may_touch(layout.index(a), layout.index(b));
  }

  System system;
  BodyId ball, bars[3];
};

TEST(PairFilter, NeitherOneBodyNorThoseThatAJointBinds) {
  const Chain chain;
  for (int i = 0; i < 3; ++i) {
    EXPECT_TRUE(chain.may_touch(chain.ball, chain.bars[i]));
    for (int j = 0; j < 3; ++j)
      EXPECT_EQ(chain.may_touch(chain.bars[i], chain.bars[j]), i - j == 2 || j - i == 2);
  }
}

TEST(PairFilter, DecisionsComeBeforeJoints) {
  Chain chain;
  chain.system.allow_contact(chain.bars[1], chain.bars[0]);
  chain.system.allow_contact(chain.bars[2], chain.ball, false);
  EXPECT_TRUE(chain.may_touch(chain.bars[0], chain.bars[1]));
  EXPECT_FALSE(chain.may_touch(chain.bars[1], chain.bars[2]));
  EXPECT_FALSE(chain.may_touch(chain.ball, chain.bars[2]));
  EXPECT_TRUE(chain.may_touch(chain.ball, chain.bars[1]));
}

TEST(PairFilter, FiltersPartWhatIsLeft) {
  System system;
  const BodyId ball = system.add(Particle{.mass = 1.0, .filter = {.groups = 2, .touches = 4}});
  const BodyId bar = system.add(RigidBody{.mass = rod(1.0, 1.0)}),
               bare = system.add(RigidBody{.mass = rod(1.0, 1.0)});
  const BodyId still = system.add(Particle{.mass = 1.0, .contact = false});
  system.add(Point{.body = bar, .filter = {.groups = 1}});
  system.add(Point{.body = bar, .filter = {.groups = 4}});
  const carom_test::PlacedModel model(system);
  const PairFilter filter(model.assembly);
  const auto index = [&](BodyId body) { return model.assembly.layout()->index(body); };
  EXPECT_TRUE(filter.may_touch(index(ball), index(bar)));
  EXPECT_FALSE(filter.may_touch(index(ball), {.groups = 2, .touches = 4}, index(bar), {.groups = 1}));
  EXPECT_TRUE(filter.may_touch(index(ball), {.groups = 2, .touches = 4}, index(bar), {.groups = 4}));
  EXPECT_FALSE(filter.may_touch(index(bar), {}, index(bar), {}));
  // Nothing of these can touch.
  EXPECT_FALSE(filter.may_touch(index(bare), index(bar)));
  EXPECT_FALSE(filter.may_touch(index(still), index(bar)));
  EXPECT_EQ(filter.filter(index(bar)), (ContactFilter{.groups = 5}));
}

}  // namespace
