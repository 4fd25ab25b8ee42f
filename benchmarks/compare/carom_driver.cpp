// The scenes in carom, in both modes, with options as they come and with others that are named.

#include "driver.h"

#include <carom/carom.h>

#include <utility>

namespace compare {
namespace {

using namespace carom::planar;
using carom::BodyId;
using carom::EventDriven;
using carom::Mode;
using carom::Simulation;
using carom::State;
using carom::Surface;
using carom::System;
using carom::TimeStepping;

struct Model {
  System system;
  std::vector<BodyId> bodies;
};

BodyId add_body(System& system, Mass mass, const Body& at) {
  return system.add(RigidBody{.mass = {.mass = mass.mass, .inertia = mass.inertia},
                              .position = {at.x, at.y},
                              .angle = at.angle,
                              .velocity = {at.vx, at.vy},
                              .spin = at.spin});
}

Model make_tables(const Scale&, int start) {
  Model model;
  model.system.add(Gravity{{0.0, -gravity}});
  model.system.add(HalfPlane{.normal = {0.0, 1.0}},
                   Surface{.friction = tables::lower_friction, .normal_restitution = tables::restitution});
  model.system.add(HalfPlane{.point = {0.0, tables::distance}, .normal = {0.0, -1.0}},
                   Surface{.friction = tables::upper_friction, .normal_restitution = tables::restitution});
  model.bodies = {add_body(model.system, tables::of_ball, tables::start(start))};
  model.system.add(Disc{.body = model.bodies[0], .radius = tables::radius});
  return model;
}

Model make_net(const Scale& scale, int) {
  Model model;
  model.system.add(Gravity{{0.0, -gravity}});
  model.system.add(HalfPlane{.normal = incline(net::slope)},
                   Surface{.friction = net::friction, .normal_restitution = net::restitution});
  for (int i = 0; i < scale.net_side * scale.net_side; ++i) {
    const Body at = net::start(scale.net_side, i);
    model.bodies.push_back(model.system.add(Particle{.mass = net::mass, .position = {at.x, at.y}}));
  }
  for (const net::Spring& spring : net::springs(scale.net_side)) {
    model.system.add(SpringDamper{.from = model.bodies[spring.from],
                                  .to = model.bodies[spring.to],
                                  .stiffness = net::stiffness,
                                  .damping = net::damping,
                                  .free_length = spring.length});
  }
  return model;
}

Model make_balls(const Scale& scale, int) {
  Model model;
  model.system.add(Gravity{{0.0, -gravity}});
  model.system.add(HalfPlane{.normal = {0.0, 1.0}},
                   Surface{.friction = balls::friction, .normal_restitution = balls::restitution});
  for (int i = 0; i < scale.balls; ++i) {
    model.bodies.push_back(add_body(model.system, balls::of_ball, balls::start(scale.balls, i)));
    model.system.add(Disc{.body = model.bodies.back(), .radius = balls::radius});
  }
  return model;
}

Model make_chain(const Scale&, int) {
  Model model;
  model.system.add(Gravity{{0.0, -gravity}});
  constexpr double half = 0.5 * chain::length;
  for (int i = 0; i < chain::rods; ++i) {
    model.bodies.push_back(add_body(model.system, chain::of_rod, chain::start(i)));
    const auto before = i == 0 ? carom::End<2>(carom::ground)
                               : carom::End<2>(model.bodies[model.bodies.size() - 2], {half, 0.0});
    model.system.add(Revolute{.from = before, .to = {model.bodies.back(), {-half, 0.0}}});
  }
  return model;
}

Model make_bar(const Scale&, int start) {
  Model model;
  model.system.add(Gravity{{0.0, -gravity}});
  model.system.add(HalfPlane{.normal = incline(bar::slope)},
                   Surface{.friction = bar::friction, .normal_restitution = bar::restitution});
  model.bodies = {add_body(model.system, bar::of_bar, bar::start(start))};
  model.system.add(
      Segment{.body = model.bodies[0], .from = {0.0, -bar::half_length}, .to = {0.0, bar::half_length}});
  return model;
}

class CaromWorld final : public World {
public:
  CaromWorld(Model model, const Mode& mode)
      : ids_(std::move(model.bodies)), simulation_(std::move(model.system), mode) {}

  void advance(double time) final { simulation_.run_until(time); }

  [[nodiscard]] std::vector<Body> bodies() const final {
    std::vector<Body> all;
    const State& state = simulation_.state();
    for (const BodyId id : ids_) {
      const auto q = state.position(id), v = state.velocity(id);
      Body body{.x = q[0], .y = q[1], .vx = v[0], .vy = v[1]};
      if (!is_particle_) {
        body.angle = state.angle(id);
        body.spin = state.spin(id);
      }
      all.push_back(body);
    }
    return all;
  }

  void set_particles() { is_particle_ = true; }

private:
  std::vector<BodyId> ids_;
  Simulation simulation_;
  bool is_particle_ = false;
};

Case make_case(Scene scene, const std::string& options, bool as_it_comes, const Mode& mode) {
  const auto make = [scene, mode](const Scale& scale, int start) -> std::unique_ptr<World> {
    const auto of = [&] {
      switch (scene) {
        case Scene::tables:
          return make_tables(scale, start);
        case Scene::net:
          return make_net(scale, start);
        case Scene::balls:
          return make_balls(scale, start);
        case Scene::chain:
          return make_chain(scale, start);
        case Scene::bar:
          return make_bar(scale, start);
      }
      return Model{};
    };
    auto world = std::make_unique<CaromWorld>(of(), mode);
    if (scene == Scene::net) world->set_particles();
    return world;
  };
  return {scene, options, as_it_comes, make};
}

double step_of(Scene scene) {
  switch (scene) {
    case Scene::tables:
      return tables::step;
    case Scene::net:
      return net::step;
    case Scene::balls:
      return balls::step;
    case Scene::chain:
      return chain::step;
    case Scene::bar:
      return bar::step;
  }
  return 0.0;
}

void add_cases(Engine& engine, Scene scene) {
  const double step = step_of(scene);
  const auto add = [&](const std::string& options, bool as_it_comes, const Mode& mode) {
    engine.cases.push_back(make_case(scene, options, as_it_comes, mode));
  };
  add("time stepping", true, TimeStepping{.step = step});
  if (scene == Scene::chain) {
    add("time stepping, `force_rule = energy_momentum`", false,
        TimeStepping{.step = step, .force_rule = carom::ForceRule::energy_momentum});
  } else {
    using carom::ImpactTimes;
    const bool is_located = TimeStepping{}.impacts == ImpactTimes::located;
    const ImpactTimes other = is_located ? ImpactTimes::at_step_start : ImpactTimes::located;
    add("time stepping, `impacts = " + std::string(to_string(other)) + "`", false,
        TimeStepping{.step = step, .impacts = other});
  }
  add("event-driven", true, EventDriven{});
  if (scene == Scene::net || scene == Scene::chain) {
    add("event-driven, tolerances 1e-6 and 1e-8", false,
        EventDriven{.relative_tolerance = 1e-6, .absolute_tolerance = 1e-8});
  } else {
    add("event-driven, `method = one_step`, `record_events = false`", false,
        EventDriven{.method = carom::FlowMethod::one_step, .record_events = false});
  }
}

}  // namespace

Engine engine() {
  Engine carom{.name = "carom", .cases = {}, .missing = {}, .references = {}};
  for (const Scene scene : all_scenes) add_cases(carom, scene);
  const EventDriven tight{.relative_tolerance = 1e-12, .absolute_tolerance = 1e-13};
  for (const Scene scene : {Scene::net, Scene::chain}) {
    carom.references.push_back(make_case(scene, "event-driven, tolerances 1e-12 and 1e-13", false, tight));
  }
  return carom;
}

}  // namespace compare
