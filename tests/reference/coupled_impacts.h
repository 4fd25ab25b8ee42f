#pragma once

// Scenes of coupled_impacts.json: a ball between tables that move, a bar in a corner, boxes that meet, a
// string and a net on springs, a chain against a wall.

#include "tests/reference/reference_data.h"

#include <carom/carom.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

namespace carom_test {

/// A scene, how long it runs, and its coordinates and velocities at the end in the order of the state.
struct CoupledScene {
  std::string name;
  carom::System system;
  double end = 0.0;                // [s]
  std::vector<double> q, v;        // at the end
  std::vector<double> times;       // of impacts [s]
  std::vector<std::string> modes;  // of impacts; empty where there is one only
  bool constant_loads = false;     // between impacts
  bool turns = false;              // a body turns
};

inline carom::Surface surface_of(const Json& at, const Json& law) {
  return {.friction = at.value("friction", 0.0),
          .normal_restitution = law.at("e_n").get<double>(),
          .tangential_restitution = law.value("e_t", 0.0)};
}

/// a sin(w t + phase) along both axes.
inline carom::planar::PrescribedMotion vibration(const Json& table) {
  using carom::Vec;
  const auto part = [table](double t, int derivative) {
    Vec<2> sum;
    for (int axis = 0; axis < 2; ++axis) {
      const Json& of = table.at(axis == 0 ? "x" : "y");
      const double a = of[0], w = of[1], at = w * t + of[2].get<double>();
      sum[axis] = derivative == 0   ? a * std::sin(at)
                  : derivative == 1 ? a * w * std::cos(at)
                                    : -a * w * w * std::sin(at);
    }
    return sum;
  };
  return {.displacement = [part](double t) { return part(t, 0); },
          .velocity = [part](double t) { return part(t, 1); },
          .acceleration = [part](double t) { return part(t, 2); }};
}

inline void add_weight(carom::System& system) { system.add(carom::planar::Gravity{{0.0, -9.81}}); }

inline void add_moved_tables(CoupledScene& scene, const Json& data) {
  using namespace carom::planar;
  add_weight(scene.system);
  for (const char* name : {"lower", "upper"}) {
    const Json& table = data.at(name);
    scene.system.add(HalfPlane{.point = {0.0, table.at("height").get<double>()},
                               .normal = {0.0, name[0] == 'l' ? 1.0 : -1.0},
                               .motion = vibration(table)},
                     surface_of(table, data), name);
  }
  const double radius = data.at("radius");
  const carom::BodyId ball = scene.system.add(RigidBody{.mass = disc(data.at("mass"), radius),
                                                        .position = vector_of(data.at("position")),
                                                        .velocity = vector_of(data.at("velocity")),
                                                        .spin = data.at("spin")});
  scene.system.add(Disc{.body = ball, .radius = radius});
  scene.constant_loads = true;
}

inline void add_bar_in_a_corner(CoupledScene& scene, const Json& data) {
  using namespace carom::planar;
  add_weight(scene.system);
  scene.system.add(HalfPlane{.normal = {0.0, 1.0}}, surface_of(data, data), "floor");
  scene.system.add(HalfPlane{.normal = {1.0, 0.0}}, surface_of(data, data), "wall");
  const double length = data.at("length");
  const carom::BodyId bar = scene.system.add(RigidBody{.mass = rod(data.at("mass"), length),
                                                       .position = vector_of(data.at("position")),
                                                       .angle = data.at("angle"),
                                                       .velocity = vector_of(data.at("velocity")),
                                                       .spin = data.at("spin")});
  scene.system.add(Segment{.body = bar, .from = {-0.5 * length, 0.0}, .to = {0.5 * length, 0.0}});
  scene.constant_loads = scene.turns = true;
}

inline void add_boxes_that_meet(CoupledScene& scene, const Json& data) {
  using namespace carom::planar;
  scene.system.set_default_law(surface_of(data, data));
  for (const Json& each : data.at("bodies")) {
    const double a = each.at("size")[0], b = each.at("size")[1];
    const carom::BodyId body = scene.system.add(RigidBody{.mass = box(each.at("mass"), a, b),
                                                          .position = vector_of(each.at("position")),
                                                          .angle = each.at("angle"),
                                                          .velocity = vector_of(each.at("velocity")),
                                                          .spin = each.at("spin")});
    scene.system.add(Polygon{
        .body = body,
        .vertices = {{-0.5 * a, -0.5 * b}, {0.5 * a, -0.5 * b}, {0.5 * a, 0.5 * b}, {-0.5 * a, 0.5 * b}}});
  }
  scene.constant_loads = scene.turns = true;
}

inline void add_string_on_a_floor(CoupledScene& scene, const Json& data) {
  using namespace carom::planar;
  add_weight(scene.system);
  scene.system.add(HalfPlane{.normal = {0.0, 1.0}}, surface_of(data, data), "floor");
  carom::BodyId below{};
  for (std::size_t i = 0; i < data.at("masses").size(); ++i) {
    const carom::BodyId body =
        scene.system.add(Particle{.mass = data.at("masses")[i],
                                  .position = {0.0, data.at("heights")[i].get<double>()},
                                  .velocity = {0.0, data.at("speeds")[i].get<double>()}});
    // Of no free length: linear along both axes.
    scene.system.add(
        SpringDamper{.from = carom::ground, .to = body, .stiffness = data.at("ground_stiffness")});
    if (i > 0)
      scene.system.add(SpringDamper{.from = below,
                                    .to = body,
                                    .stiffness = data.at("stiffness"),
                                    .damping = data.at("damping"),
                                    .free_length = data.at("free_length")});
    below = body;
  }
}

inline void add_net_on_an_incline(CoupledScene& scene, const Json& data) {
  using namespace carom::planar;
  add_weight(scene.system);
  scene.system.add(HalfPlane{.normal = incline(data.at("slope").get<double>())}, surface_of(data, data),
                   "plane");
  std::vector<carom::BodyId> bodies;
  for (std::size_t i = 0; i < data.at("positions").size(); ++i) {
    bodies.push_back(scene.system.add(Particle{.mass = data.at("mass"),
                                               .position = vector_of(data.at("positions")[i]),
                                               .velocity = vector_of(data.at("velocities")[i])}));
  }
  const std::size_t size = data.at("size");
  for (std::size_t i = 0; i < size; ++i) {
    for (std::size_t j = 0; j < size; ++j) {
      const auto tie = [&](std::size_t other) {
        scene.system.add(SpringDamper{
            .from = bodies[i * size + j], .to = bodies[other], .stiffness = data.at("stiffness")});
      };
      if (i + 1 < size) tie((i + 1) * size + j);
      if (j + 1 < size) tie(i * size + j + 1);
    }
  }
}

/// Angles of the rods from the x axis, as coordinates of bodies: centres follow.
inline std::array<std::vector<double>, 2> rods_at(const Json& angles, const Json& rates, double length) {
  std::array<std::vector<double>, 2> at;
  double x = 0.0, y = 0.0, u = 0.0, w = 0.0;
  for (std::size_t i = 0; i < 2; ++i) {
    const double c = 0.5 * length * std::cos(angles[i].get<double>()),
                 s = 0.5 * length * std::sin(angles[i].get<double>());
    const double rate = rates[i];
    x += c, y += s, u -= s * rate, w += c * rate;
    at[0].insert(at[0].end(), {x, y, angles[i].get<double>()});
    at[1].insert(at[1].end(), {u, w, rate});
    x += c, y += s, u -= s * rate, w += c * rate;
  }
  return at;
}

inline void add_chain_against_a_wall(CoupledScene& scene, const Json& data) {
  using namespace carom::planar;
  add_weight(scene.system);
  scene.system.add(HalfPlane{.point = {data.at("wall").get<double>(), 0.0}, .normal = {-1.0, 0.0}},
                   surface_of(data, data), "wall");
  const double length = data.at("length");
  const auto start = rods_at(data.at("angles"), data.at("rates"), length);
  carom::BodyId before = carom::ground;
  for (std::size_t i = 0; i < 2; ++i) {
    const carom::BodyId body = scene.system.add(RigidBody{.mass = rod(data.at("mass"), length),
                                                          .position = {start[0][3 * i], start[0][3 * i + 1]},
                                                          .angle = start[0][3 * i + 2]});
    scene.system.add(
        Revolute{.from = {before, i == 0 ? carom::Vec<2>(0.0, 0.0) : carom::Vec<2>(0.5 * length, 0.0)},
                 .to = {body, {-0.5 * length, 0.0}}});
    before = body;
  }
  scene.system.add(Point{.body = before, .position = {0.5 * length, 0.0}});
  const auto end = rods_at(data.at("angles_at_end"), data.at("rates_at_end"), length);
  scene.q = end[0], scene.v = end[1];
  scene.turns = true;
}

/// Numbers of an array of numbers, or of pairs of numbers.
inline std::vector<double> flat(const Json& data) {
  std::vector<double> numbers;
  for (const Json& each : data) {
    if (each.is_array()) {
      for (const Json& one : each) numbers.push_back(one);
    } else {
      numbers.push_back(each);
    }
  }
  return numbers;
}

/// All scenes of a family.
inline std::vector<CoupledScene> coupled_scenes(const std::string& family) {
  std::vector<CoupledScene> scenes;
  const Json all = reference_data("coupled_impacts.json").at(family);
  for (const Json& data : all) {
    CoupledScene scene;
    scene.name = family + " " + std::to_string(scenes.size());
    scene.end = data.at("end");
    for (const Json& impact : data.at("impacts")) {
      scene.times.push_back(impact.at("t"));
      if (impact.contains("mode")) scene.modes.push_back(impact.at("mode"));
    }
    if (family == "moved_tables") add_moved_tables(scene, data);
    if (family == "bar_in_a_corner") add_bar_in_a_corner(scene, data);
    if (family == "boxes_that_meet") add_boxes_that_meet(scene, data);
    if (family == "string_on_a_floor") add_string_on_a_floor(scene, data);
    if (family == "net_on_an_incline") add_net_on_an_incline(scene, data);
    if (family == "chain_against_a_wall") {
      add_chain_against_a_wall(scene, data);
    } else if (family == "string_on_a_floor") {
      for (const double y : flat(data.at("y"))) scene.q.insert(scene.q.end(), {0.0, y});
      for (const double v : flat(data.at("v"))) scene.v.insert(scene.v.end(), {0.0, v});
    } else {
      scene.q = flat(data.at("q")), scene.v = flat(data.at("v"));
    }
    scenes.push_back(std::move(scene));
  }
  return scenes;
}

}  // namespace carom_test
