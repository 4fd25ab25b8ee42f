#pragma once

// Scenes of textbook_contacts.json: a ladder at a wall, a disc over an edge and in a half-pipe, an oscillator
// with dry friction, a break of three discs, a superball.

#include "tests/reference/reference_data.h"

#include <carom/carom.h>

#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

namespace carom_test {

/// Coordinates and velocities at a time, in the order of the state.
struct KnownState {
  double time = 0.0;  // [s]
  std::vector<double> q, v;
};

/// A scene, its known states, and the instants of its events.
struct TextbookScene {
  std::string name;
  carom::System system;
  carom::ImpactRules rules{};
  std::vector<KnownState> states;
  std::vector<double> times;       // of events [s]
  std::vector<std::string> kinds;  // of events
};

inline void add_sliding_ladder(TextbookScene& scene, const Json& data) {
  using namespace carom::planar;
  const carom::Surface smooth{.friction = 0.0, .normal_restitution = 0.0};
  scene.system.add(Gravity{{0.0, -9.81}});
  scene.system.add(HalfPlane{.normal = {0.0, 1.0}}, smooth, "floor");
  scene.system.add(HalfPlane{.normal = {1.0, 0.0}}, smooth, "wall");
  const double half = 0.5 * data.at("length").get<double>(), theta = data.at("theta");
  const carom::BodyId ladder =
      scene.system.add(RigidBody{.mass = rod(data.at("mass"), 2.0 * half),
                                 .position = {half * std::cos(theta), half * std::sin(theta)},
                                 .angle = -theta},
                       "ladder");
  scene.system.add(Segment{.body = ladder, .from = {-half, 0.0}, .to = {half, 0.0}});
}

inline void add_disc_over_an_edge(TextbookScene& scene, const Json& data) {
  using namespace carom::planar;
  const double radius = data.at("radius"), speed = data.at("speed"), friction = data.at("friction");
  scene.system.add(Gravity{{0.0, -9.81}});
  scene.system.add(Block{.vertices = {{-2.0, -1.0}, {0.0, -1.0}, {0.0, 0.0}, {-2.0, 0.0}}},
                   carom::Surface{.friction = friction, .normal_restitution = 0.0}, "table");
  const carom::BodyId body = scene.system.add(RigidBody{.mass = disc(1.0, radius),
                                                        .position = {-0.1, radius},
                                                        .velocity = {speed, 0.0},
                                                        .spin = friction > 0.0 ? -speed / radius : 0.0},
                                              "disc");
  scene.system.add(Disc{.body = body, .radius = radius});
}

inline void add_ball_in_a_bowl(TextbookScene& scene, const Json& data) {
  using namespace carom::planar;
  const double bowl = data.at("bowl"), radius = data.at("radius"), theta = data.at("theta");
  const double arm = bowl - radius;
  scene.system.add(Gravity{{0.0, -9.81}});
  scene.system.add(CircleInside{.centre = {0.0, 0.0}, .radius = bowl},
                   carom::Surface{.friction = data.at("friction"), .normal_restitution = 0.0}, "bowl");
  const carom::BodyId body = scene.system.add(
      RigidBody{.mass = disc(1.0, radius), .position = {arm * std::sin(theta), -arm * std::cos(theta)}},
      "ball");
  scene.system.add(Disc{.body = body, .radius = radius});
}

inline void add_rubbed_oscillator(TextbookScene& scene, const Json& data) {
  using namespace carom::planar;
  scene.system.add(Gravity{{0.0, -9.81}});
  scene.system.add(HalfPlane{.normal = {0.0, 1.0}},
                   carom::Surface{.friction = data.at("friction"),
                                  .normal_restitution = 0.0,
                                  .static_friction = data.at("static_friction").get<double>()},
                   "floor");
  const carom::BodyId mass = scene.system.add(
      Particle{.mass = data.at("mass"), .position = {data.at("start").get<double>(), 0.0}}, "mass");
  constexpr double length = 10.0;  // to the anchor: the spring stays on one side of it
  scene.system.add(SpringDamper{.from = {carom::ground, {-length, 0.0}},
                                .to = mass,
                                .stiffness = data.at("stiffness"),
                                .free_length = length});
}

inline void add_break_of_discs(TextbookScene& scene, const Json& data) {
  using namespace carom::planar;
  scene.system.set_default_law({.friction = 0.0, .normal_restitution = data.at("e")});
  for (std::size_t i = 0; i < 3; ++i) {
    const Json &centre = data.at("centres")[i], &velocity = data.at("velocity");
    const double radius = data.at("radii")[i];
    const carom::Vec<2> start = i == 0 ? vector_of(velocity) : carom::Vec<2>{0.0, 0.0};
    const carom::BodyId body = scene.system.add(RigidBody{
        .mass = disc(data.at("masses")[i], radius), .position = vector_of(centre), .velocity = start});
    scene.system.add(Disc{.body = body, .radius = radius});
  }
  if (data.at("order") == "sequential") scene.rules.order = carom::ImpactOrder::sequential;
}

inline void add_superball(TextbookScene& scene, const Json& data) {
  using namespace carom::planar;
  const carom::Surface rubber{
      .friction = data.at("friction"), .normal_restitution = 1.0, .tangential_restitution = 1.0};
  if (data.at("gravity") > 0.0) scene.system.add(Gravity{{0.0, -data.at("gravity").get<double>()}});
  scene.system.add(HalfPlane{.normal = {0.0, 1.0}}, rubber, "lower plate");
  scene.system.add(HalfPlane{.point = {0.0, data.at("height").get<double>()}, .normal = {0.0, -1.0}}, rubber,
                   "upper plate");
  const double radius = data.at("radius");
  const Json& velocity = data.at("velocity");
  const carom::BodyId ball = scene.system.add(RigidBody{.mass = solid_sphere(data.at("mass"), radius),
                                                        .position = {0.0, radius},
                                                        .velocity = vector_of(velocity),
                                                        .spin = data.at("spin")},
                                              "ball");
  scene.system.add(Disc{.body = ball, .radius = radius});
}

/// All cases of a family.
inline std::vector<TextbookScene> textbook_scenes(const std::string& family) {
  const auto add = family == "sliding_ladder"      ? &add_sliding_ladder
                   : family == "disc_over_an_edge" ? &add_disc_over_an_edge
                   : family == "ball_in_a_bowl"    ? &add_ball_in_a_bowl
                   : family == "rubbed_oscillator" ? &add_rubbed_oscillator
                   : family == "break_of_discs"    ? &add_break_of_discs
                                                   : &add_superball;
  const Json cases = reference_data("textbook_contacts.json").at(family);
  std::vector<TextbookScene> scenes(cases.size());
  for (std::size_t i = 0; i < cases.size(); ++i) {
    TextbookScene& scene = scenes[i];
    scene.name = family + " " + std::to_string(i);
    add(scene, cases[i]);
    for (const Json& state : cases[i].at("states"))
      scene.states.push_back({state.at("t"), state.at("q"), state.at("v")});
    for (const Json& event : cases[i].at("events")) {
      scene.times.push_back(event.at("t"));
      scene.kinds.push_back(event.at("kind"));
    }
  }
  return scenes;
}

}  // namespace carom_test
