#include "rigid_world.h"

namespace compare {
namespace {

/// A plane through the origin that rises with +x, lowered for points that touch as discs.
Plane incline(double slope, double friction, double restitution, double reach) {
  const double nx = -std::sin(slope), ny = std::cos(slope);
  return {-point_radius * nx, -point_radius * ny, nx, ny, friction, restitution, reach};
}

void build_net(const Scale& scale, RigidWorld& world) {
  world.add_plane(incline(net::slope, net::friction, net::restitution, net::reach));
  for (int i = 0; i < scale.net_side * scale.net_side; ++i) {
    world.add_body({net::mass, 0.0}, net::start(scale.net_side, i), {{0.0, 0.0, point_radius}});
  }
  for (const net::Spring& spring : net::springs(scale.net_side)) world.add_spring(spring);
}

void build_chain(RigidWorld& world) {
  constexpr double half = 0.5 * chain::length;
  for (int i = 0; i < chain::rods; ++i) {
    world.add_body(chain::of_rod, chain::start(i), {});
    world.add_pin({i - 1, i, i == 0 ? 0.0 : half, -half});
  }
}

}  // namespace

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

void build(Scene scene, const Scale& scale, int start, RigidWorld& world) {
  switch (scene) {
    case Scene::tables:
      world.add_plane({0.0, 0.0, 0.0, 1.0, tables::lower_friction, tables::restitution, tables::reach});
      world.add_plane(
          {0.0, tables::distance, 0.0, -1.0, tables::upper_friction, tables::restitution, tables::reach});
      world.add_body(tables::of_ball, tables::start(start), {{0.0, 0.0, tables::radius}});
      return;
    case Scene::net:
      return build_net(scale, world);
    case Scene::balls:
      world.add_plane({0.0, 0.0, 0.0, 1.0, balls::friction, balls::restitution, balls::reach});
      for (int i = 0; i < scale.balls; ++i) {
        world.add_body(balls::of_ball, balls::start(scale.balls, i), {{0.0, 0.0, balls::radius}});
      }
      return;
    case Scene::chain:
      return build_chain(world);
    case Scene::bar:
      world.add_plane(incline(bar::slope, bar::friction, bar::restitution, bar::reach));
      world.add_body(bar::of_bar, bar::start(start),
                     {{0.0, -bar::half_length, point_radius}, {0.0, bar::half_length, point_radius}});
      return;
  }
}

}  // namespace compare
