#include <carom/contact/detection/body_features.h>

#include "tests/contact/detection/placed_model.h"

#include <carom/carom.h>

#include <gtest/gtest.h>

#include <vector>

namespace {

using namespace carom;
using namespace carom::planar;

TEST(BodyFeatures, NothingIsCollectedUnlessAsked) {
  const BodyFeatures features;
  EXPECT_TRUE(features.centres().empty());
  EXPECT_TRUE(features.points().empty());
  EXPECT_TRUE(features.of({3, 4}).centres.empty());
  EXPECT_TRUE(features.of({3, 4}).points.empty());
  EXPECT_FALSE(features.any_off_centre());
}

TEST(BodyFeatures, ComeByBodyThenShape) {
  System system;
  const MaterialId steel = system.material("steel");
  const BodyId plate = system.add(RigidBody{.mass = box(1.0, 1.0, 1.0)}),
               wheel = system.add(RigidBody{.mass = disc(1.0, 1.0)});
  const ShapeId rim = system.add(Disc{.body = wheel, .radius = 1.0, .material = steel});
  const ShapeId edge = system.add(Segment{.body = plate, .from = {-1, 0}, .to = {1, 0}});
  const carom_test::PlacedModel model(system);
  const BodyFeatures features(model.assembly);
  ASSERT_EQ(features.points().size(), 3U);
  ASSERT_EQ(features.centres().size(), 1U);  // the wheel touches around its centre
  EXPECT_EQ(features.points()[features.centres()[0].points].key.serial, rim.serial);
  EXPECT_TRUE(features.any_off_centre());
  const Layout& layout = *model.assembly.layout();
  for (Index i = 1; i < 3; ++i) EXPECT_LE(features.points()[i - 1].body, features.points()[i].body);
  Index points = 0;
  for (Index component = 0; component < model.assembly.components().size(); ++component) {
    const Range own = features.of({component, component + 1}).points;
    points += own.size();
    for (Index i = own.begin; i < own.end; ++i) {
      const BodyFeature& point = features.points()[i];
      const bool is_rim = point.body == layout.index(wheel);
      EXPECT_EQ(point.key.serial, (is_rim ? rim : edge).serial);
      EXPECT_EQ(point.radius, is_rim ? 1.0 : 0.0);
      EXPECT_EQ(features.materials()[point.material].material, is_rim ? steel : MaterialId{});
    }
  }
  EXPECT_EQ(points, 3U);
}

TEST(BodyFeatures, UncoupledDiscsAreOneRun) {
  System system;
  std::vector<BodyId> discs;
  for (int i = 0; i < 9; ++i) {
    discs.push_back(system.add(RigidBody{.mass = disc(1.0, 0.1)}));
    system.add(Disc{.body = discs.back(), .radius = 0.1 * (i + 1)});
  }
  // Not around the centre; two of them; joined to the next.
  system.add(
      Disc{.body = system.add(RigidBody{.mass = disc(1.0, 0.1)}), .radius = 0.1, .centre = {0.1, 0.0}});
  const BodyId twice = system.add(RigidBody{.mass = disc(1.0, 0.1)});
  for (int i = 0; i < 2; ++i) system.add(Disc{.body = twice, .radius = 0.1});
  system.add(SpringDamper{.from = {discs[6]}, .to = {discs[7]}, .stiffness = 1.0});
  const carom_test::PlacedModel model(system);
  const BodyFeatures features(model.assembly);
  ASSERT_EQ(features.centres().size(), 3U);
  const auto demand = [&](std::size_t run, Index bodies, double radius) {
    EXPECT_EQ(features.centres()[run].bodies.size(), bodies);
    EXPECT_EQ(features.centres()[run].radius, radius);
    EXPECT_EQ(features.points()[features.centres()[run].points].body, features.centres()[run].bodies.begin);
  };
  demand(0, 6, 0.1 * 6);
  demand(1, 2, 0.1 * 8);
  demand(2, 1, 0.1 * 9);
  // Parts of a run belong to several components.
  const auto demand_runs = [&](Range of, Index begin, Index end) {
    EXPECT_EQ(features.of(of).centres.begin, begin);
    EXPECT_EQ(features.of(of).centres.end, end);
  };
  demand_runs({0, 1}, 0, 1);
  demand_runs({5, 6}, 0, 1);
  demand_runs({0, 7}, 0, 2);
}

TEST(BodyFeatures, NeighboursThatTouchAtTheirCentresAreOneRun) {
  System system;
  const MaterialId steel = system.material("steel");
  std::vector<BodyId> balls;
  for (std::size_t i = 0; i < 6; ++i) {
    balls.push_back(system.add(Particle{.mass = 1.0, .material = i < 4 ? MaterialId{} : steel}));
    if (i > 0) system.add(SpringDamper{.from = balls[i - 1], .to = balls[i], .stiffness = 1.0});
  }
  system.add(Particle{.mass = 1.0, .contact = false});
  const carom_test::PlacedModel model(system);
  const BodyFeatures features(model.assembly);
  EXPECT_TRUE(features.points().empty());
  EXPECT_FALSE(features.any_off_centre());
  ASSERT_EQ(features.centres().size(), 2U);
  EXPECT_EQ(features.centres()[0].bodies.size(), 4U);
  EXPECT_EQ(features.centres()[1].bodies.size(), 2U);
  const Layout& layout = *model.assembly.layout();
  for (Index material = 0; material < 2; ++material) {
    const FeatureKey first = features.first_of(material, layout);
    EXPECT_EQ(first.owner, FeatureKey::Owner::body);
    EXPECT_EQ(first.serial,
              features.materials()[material].material == steel ? balls[4].serial : balls[0].serial);
  }
}

}  // namespace
