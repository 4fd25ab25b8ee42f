// The fingerprint of a model: of its parameters, and of nothing else.

#include <carom/bodies/particle.h>
#include <carom/bodies/rigid_body.h>
#include <carom/bodies/shape_disc.h>
#include <carom/bodies/shape_point.h>
#include <carom/bodies/shape_polygon.h>
#include <carom/bodies/shape_segment.h>
#include <carom/contact/detection/half_space.h>
#include <carom/core/system.h>
#include <carom/joints/applied_load.h>
#include <carom/joints/gravity.h>
#include <carom/joints/spring_damper.h>

#include <gtest/gtest.h>

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace {

using namespace carom;
using namespace carom::planar;

// One model with every kind of part, a field of which can be changed.
struct Everything {
  Particle dot{.mass = 1.0};
  RigidBody plate{.mass = disc(1.0, 1.0)};
  SpringDamper spring{.stiffness = 1.0, .damping = 2.0, .free_length = 3.0};
  Vec<2> spring_point{0.5, 0.25};
  bool swap_ends = false;
  Gravity gravity{{0.0, -9.81}};
  Disc disc_shape{.radius = 0.5};
  Point point_shape{};
  Segment segment{.from = {0, 0}, .to = {1, 0}};
  Polygon polygon_shape{.vertices = {{0, 0}, {1, 0}, {0, 1}}};
  HalfPlane floor{.normal = {0, 1}};
  Surface surface{.friction = 0.1, .normal_restitution = 0.2, .tangential_restitution = 0.3};
  Surface between{.friction = 0.4, .normal_restitution = 0.5, .tangential_restitution = 0.6};
  int load_on = 0;
  int materials_of = 0;  // 1, 2, 3: of the particle, the disc, the half-plane
  bool has_between = true, has_surface = true;
  std::string name;

  System make() const {
    System system;
    const MaterialId steel = system.material("steel"), ice = system.material("ice");
    Particle first = dot;
    if (materials_of == 1) first.material = steel;
    const BodyId a = system.add(first, name), b = system.add(plate);
    SpringDamper link = spring;
    link.from = swap_ends ? End<2>(b, spring_point) : End<2>(a);
    link.to = swap_ends ? End<2>(a) : End<2>(b, spring_point);
    system.add(link);
    system.add(gravity);
    system.add(AppliedForce{.on = load_on == 0 ? a : b, .force = [](double) { return Vec<2>(1.0, 0.0); }});
    Disc round = disc_shape;
    round.body = b;
    if (materials_of == 2) round.material = steel;
    system.add(round);
    Point tip = point_shape;
    tip.body = b;
    system.add(tip);
    Segment edge = segment;
    edge.body = b;
    system.add(edge);
    Polygon outline = polygon_shape;
    outline.body = b;
    system.add(outline);
    HalfPlane bottom = floor;
    if (materials_of == 3) bottom.material = steel;
    if (has_surface) {
      system.add(bottom, surface);
    } else {
      system.add(bottom);
    }
    if (has_between) system.between(steel, ice, between);
    return system;
  }
};

TEST(SystemFingerprint, ChangesWithEveryParameter) {
  const std::vector<std::pair<std::string, std::function<void(Everything&)>>> changes{
      {"nothing", [](Everything&) {}},
      {"mass of particle", [](Everything& e) { e.dot.mass = 1.5; }},
      {"contact of particle", [](Everything& e) { e.dot.contact = false; }},
      {"mass of plate", [](Everything& e) { e.plate.mass.mass = 1.5; }},
      {"inertia of plate", [](Everything& e) { e.plate.mass.inertia = 1.5; }},
      {"stiffness", [](Everything& e) { e.spring.stiffness = 1.5; }},
      {"damping", [](Everything& e) { e.spring.damping = 1.5; }},
      {"free length", [](Everything& e) { e.spring.free_length = 1.5; }},
      {"point x", [](Everything& e) { e.spring_point[0] = 1.5; }},
      {"point y", [](Everything& e) { e.spring_point[1] = 1.5; }},
      {"ends swapped", [](Everything& e) { e.swap_ends = true; }},
      {"gravity x", [](Everything& e) { e.gravity.acceleration[0] = 1.5; }},
      {"gravity y", [](Everything& e) { e.gravity.acceleration[1] = 1.5; }},
      {"disc radius", [](Everything& e) { e.disc_shape.radius = 1.5; }},
      {"disc centre x", [](Everything& e) { e.disc_shape.centre[0] = 1.5; }},
      {"disc centre y", [](Everything& e) { e.disc_shape.centre[1] = 1.5; }},
      {"point shape", [](Everything& e) { e.point_shape.position[1] = 1.5; }},
      {"segment from", [](Everything& e) { e.segment.from[0] = 1.5; }},
      {"segment to", [](Everything& e) { e.segment.to[1] = 1.5; }},
      {"polygon vertex", [](Everything& e) { e.polygon_shape.vertices[2][1] = 1.5; }},
      {"polygon size", [](Everything& e) { e.polygon_shape.vertices.emplace_back(-1.0, 0.5); }},
      {"half-plane point", [](Everything& e) { e.floor.point[1] = 1.5; }},
      {"half-plane normal", [](Everything& e) { e.floor.normal[0] = 1.5; }},
      {"surface friction", [](Everything& e) { e.surface.friction = 0.7; }},
      {"surface e_n", [](Everything& e) { e.surface.normal_restitution = 0.7; }},
      {"surface e_t", [](Everything& e) { e.surface.tangential_restitution = 0.7; }},
      {"between friction", [](Everything& e) { e.between.friction = 0.7; }},
      {"between e_n", [](Everything& e) { e.between.normal_restitution = 0.7; }},
      {"between e_t", [](Everything& e) { e.between.tangential_restitution = 0.7; }},
      {"no between", [](Everything& e) { e.has_between = false; }},
      {"no surface", [](Everything& e) { e.has_surface = false; }},
      {"load on plate", [](Everything& e) { e.load_on = 1; }},
      {"material of particle", [](Everything& e) { e.materials_of = 1; }},
      {"material of disc", [](Everything& e) { e.materials_of = 2; }},
      {"material of half-plane", [](Everything& e) { e.materials_of = 3; }},
  };
  std::map<std::uint64_t, std::string> seen;
  for (const auto& [what, change] : changes) {
    Everything model;
    change(model);
    const auto [at, is_new] = seen.emplace(model.make().fingerprint(), what);
    EXPECT_TRUE(is_new) << what << " has the fingerprint of " << at->second;
  }
}

TEST(SystemFingerprint, DoesNotSeeNamesTokensAndInitialValues) {
  Everything model;
  const std::uint64_t print = model.make().fingerprint();
  EXPECT_EQ(model.make().fingerprint(), print);
  model.name = "lower";
  EXPECT_EQ(model.make().fingerprint(), print);
  // A checkpoint brings positions and velocities of its own.
  model.dot.position = {1, 2};
  model.dot.velocity = {1, 2};
  model.plate.angle = 3.0;
  model.plate.spin = 3.0;
  EXPECT_EQ(model.make().fingerprint(), print);
}

TEST(SystemFingerprint, ForgetsWhatWasRemoved) {
  System system;
  const BodyId kept = system.add(Particle{.mass = 1.0});
  const std::uint64_t print = system.fingerprint();
  system.remove(system.add(RigidBody{.mass = disc(1.0, 1.0)}));
  system.remove(system.add(SpringDamper{.from = ground, .to = kept}));
  system.remove(system.add(HalfPlane{.normal = {0, 1}}, Surface{.friction = 0.0, .normal_restitution = 0.5}));
  EXPECT_EQ(system.fingerprint(), print);
}

// The value that earlier versions gave: checkpoints of such models are still accepted.
TEST(SystemFingerprint, IsThatOfEarlierVersions) {
  System system;
  const MaterialId steel = system.material("steel"), ice = system.material("ice");
  const BodyId ball = system.add(Particle{.mass = 1.0, .material = steel});
  const BodyId plate = system.add(RigidBody{.mass = box(2.0, 1.0, 0.5)});
  system.add(Disc{.body = plate, .radius = 0.25, .material = steel});
  system.add(SpringDamper{.from = ball, .to = plate, .stiffness = 3.0});
  system.add(HalfPlane{.normal = {0.0, 1.0}, .material = ice});
  system.add(
      HalfPlane{.point = {-2.0, 0.0},
                .normal = {1.0, 0.0},
                .motion = {.displacement = [](double) { return Vec<2>(0.0, 0.0); }, .breaks = {1.0}}},
      Surface{.friction = 0.1, .normal_restitution = 0.2, .static_friction = 0.3, .stribeck_speed = 0.5});
  system.between(steel, ice, {.friction = 0.4, .normal_restitution = 0.5, .tangential_restitution = 0.6});
  EXPECT_EQ(system.fingerprint(), 14331642320107730341U);
}

}  // namespace
