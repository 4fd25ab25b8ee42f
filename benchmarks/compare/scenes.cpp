#include "scenes.h"

namespace compare {

const char* name(Scene scene) {
  switch (scene) {
    case Scene::tables:
      return "tables";
    case Scene::net:
      return "net";
    case Scene::balls:
      return "balls";
    case Scene::chain:
      return "chain";
    case Scene::bar:
      return "bar";
  }
  return "";
}

std::vector<net::Spring> net::springs(int k) {
  std::vector<Spring> all;
  const auto add = [&](int from, int to) {
    const Body a = start(k, from), b = start(k, to);
    all.push_back(
        {static_cast<std::size_t>(from), static_cast<std::size_t>(to), std::hypot(b.x - a.x, b.y - a.y)});
  };
  for (int row = 0; row < k; ++row) {
    for (int column = 0; column < k; ++column) {
      const int here = row * k + column;
      if (column + 1 < k) add(here, here + 1);
      if (row + 1 == k) continue;
      add(here, here + k);
      if (column + 1 < k) add(here, here + k + 1);
      if (column > 0) add(here, here + k - 1);
    }
  }
  return all;
}

std::vector<Body> chain::bodies(const std::vector<double>& angles, const std::vector<double>& rates) {
  std::vector<Body> all;
  Body end;  // of the rod before
  for (std::size_t i = 0; i < angles.size(); ++i) {
    const double x = length * std::cos(angles[i]), y = length * std::sin(angles[i]), spin = rates[i];
    all.push_back({.x = end.x + 0.5 * x,
                   .y = end.y + 0.5 * y,
                   .angle = angles[i],
                   .vx = end.vx - 0.5 * spin * y,
                   .vy = end.vy + 0.5 * spin * x,
                   .spin = spin});
    end.x += x;
    end.y += y;
    end.vx -= spin * y;
    end.vy += spin * x;
  }
  return all;
}

std::vector<Body> bodies_at_start(Scene scene, const Scale& scale, int start) {
  std::vector<Body> all;
  switch (scene) {
    case Scene::tables:
      return {tables::start(start)};
    case Scene::net:
      for (int i = 0; i < scale.net_side * scale.net_side; ++i) all.push_back(net::start(scale.net_side, i));
      return all;
    case Scene::balls:
      for (int i = 0; i < scale.balls; ++i) all.push_back(balls::start(scale.balls, i));
      return all;
    case Scene::chain:
      for (int i = 0; i < chain::rods; ++i) all.push_back(chain::start(i));
      return all;
    case Scene::bar:
      return {bar::start(start)};
  }
  return all;
}

double energy(Mass mass, const Body& body) {
  return 0.5 * mass.mass * (body.vx * body.vx + body.vy * body.vy) +
         0.5 * mass.inertia * body.spin * body.spin + mass.mass * gravity * body.y;
}

namespace {

Mass mass_of(Scene scene) {
  switch (scene) {
    case Scene::tables:
      return tables::of_ball;
    case Scene::net:
      return {net::mass, 0.0};
    case Scene::balls:
      return balls::of_ball;
    case Scene::chain:
      return chain::of_rod;
    case Scene::bar:
      return bar::of_bar;
  }
  return {};
}

}  // namespace

double energy(Scene scene, const Scale& scale, const std::vector<Body>& bodies) {
  double sum = 0.0;
  for (const Body& body : bodies) sum += energy(mass_of(scene), body);
  if (scene == Scene::net) {
    for (const net::Spring& spring : net::springs(scale.net_side)) {
      const Body &a = bodies[spring.from], &b = bodies[spring.to];
      const double stretch = std::hypot(b.x - a.x, b.y - a.y) - spring.length;
      sum += 0.5 * net::stiffness * stretch * stretch;
    }
  }
  return sum;
}

std::vector<Look> looks(Scene scene, const Scale& scale) {
  switch (scene) {
    case Scene::tables:
      return {{scale.tables_end, true, true}};
    case Scene::net:
      return {{scale.net_end, true, true}};
    case Scene::balls:
      return {{balls::bouncing, true, true}, {balls::end, true, false}};
    case Scene::chain:
      if (scale.chain_end <= chain::looked_at) return {{scale.chain_end, true, true}};
      return {{chain::looked_at, true, false}, {scale.chain_end, false, true}};
    case Scene::bar:
      return {{bar::end, true, true}};
  }
  return {};
}

void look(Scene scene, const Scale& scale, const Look& at, const std::vector<Body>& bodies, Seen& seen) {
  if (at.energy) seen.energies.push_back(energy(scene, scale, bodies));
  if (!at.places) return;
  if (scene == Scene::net) {
    double x = 0.0, y = 0.0;
    for (const Body& body : bodies) {
      x += body.x;
      y += body.y;
    }
    const auto count = static_cast<double>(bodies.size());
    seen.places.insert(seen.places.end(), {x / count, y / count});
    return;
  }
  const std::size_t first = scene == Scene::chain ? bodies.size() - 1 : 0;
  for (std::size_t i = first; i < bodies.size(); ++i) {
    seen.places.insert(seen.places.end(), {bodies[i].x, bodies[i].y});
  }
}

}  // namespace compare
