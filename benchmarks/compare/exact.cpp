#include "exact.h"

#include <algorithm>
#include <limits>

namespace compare {
namespace {

/// A sphere over a floor at y = 0 and, if `ceiling` is finite, below a plane at that height.
struct Sphere {
  Mass mass;
  double radius, restitution, lower_friction, upper_friction;
  double ceiling = std::numeric_limits<double>::infinity();

  void fly(Body& body, double time) const {
    body.x += time * body.vx;
    body.y += time * (body.vy - 0.5 * gravity * time);
    body.vy -= gravity * time;
    body.angle += time * body.spin;
  }

  /// The contact moves along the plane with the velocity of the centre and the rim.
  void hit(Body& body, double side) const {
    const double normal = mass.mass * (1.0 + restitution) * std::abs(body.vy);
    const double friction = (side > 0.0 ? lower_friction : upper_friction) * normal;
    const double slip = body.vx + side * radius * body.spin;
    const double stick = -slip / (1.0 / mass.mass + radius * radius / mass.inertia);
    const double tangential = std::clamp(stick, -friction, friction);
    body.vx += tangential / mass.mass;
    body.spin += side * radius * tangential / mass.inertia;
    body.vy *= -restitution;
  }

  /// Bounces that are slower than this are over: the ball rolls [m/s].
  static constexpr double slowest = 1e-10;

  void advance(Body& body, double span) const {
    while (span > 0.0) {
      const double fall = body.y - radius, rise = ceiling - radius - body.y;
      const double down =
          (body.vy + std::sqrt(std::max(0.0, body.vy * body.vy + 2.0 * gravity * fall))) / gravity;
      const double root = body.vy * body.vy - 2.0 * gravity * rise;
      const bool up = body.vy > 0.0 && root >= 0.0;
      const double flight = up ? (body.vy - std::sqrt(root)) / gravity : down;
      if (flight >= span) return fly(body, span);
      fly(body, flight);
      span -= flight;
      body.y = up ? ceiling - radius : radius;
      hit(body, up ? -1.0 : 1.0);
      if (up || std::abs(body.vy) > slowest) continue;
      body.vy = 0.0;
      body.x += span * body.vx;
      body.angle += span * body.spin;
      return;
    }
  }
};

/// The bar: gaps of its ends along parabolas with a constant spin, their zeros by bisection.
struct Falling {
  double nx = -std::sin(bar::slope), ny = std::cos(bar::slope);

  /// Lever from the centre to an end: side -1 is the lower one at the start.
  static void lever(const Body& body, double side, double& x, double& y) {
    x = -side * bar::half_length * std::sin(body.angle);
    y = side * bar::half_length * std::cos(body.angle);
  }

  static Body after(Body body, double time) {
    body.x += time * body.vx;
    body.y += time * (body.vy - 0.5 * gravity * time);
    body.vy -= gravity * time;
    body.angle += time * body.spin;
    return body;
  }

  double gap(const Body& body, double side) const {
    double x, y;
    lever(body, side, x, y);
    return nx * (body.x + x) + ny * (body.y + y);
  }

  /// Coulomb's law at one contact: it sticks, or slips against its motion.
  void hit(Body& body, double side) const {
    double x, y;
    lever(body, side, x, y);
    const double tx = ny, ty = -nx;
    const double arm_n = x * ny - y * nx, arm_t = x * ty - y * tx;  // moments of unit impulses
    const Mass of = bar::of_bar;
    const double w_nn = 1.0 / of.mass + arm_n * arm_n / of.inertia;
    const double w_tt = 1.0 / of.mass + arm_t * arm_t / of.inertia, w_nt = arm_n * arm_t / of.inertia;
    const double normal_speed = nx * body.vx + ny * body.vy + arm_n * body.spin;
    const double slip = tx * body.vx + ty * body.vy + arm_t * body.spin;
    const double wanted = -(1.0 + bar::restitution) * normal_speed;
    const double determinant = w_nn * w_tt - w_nt * w_nt;
    double normal = (w_tt * wanted + w_nt * slip) / determinant;
    double tangential = (-w_nn * slip - w_nt * wanted) / determinant;
    if (std::abs(tangential) > bar::friction * normal) {
      const double against = slip > 0.0 ? -bar::friction : bar::friction;
      normal = wanted / (w_nn + against * w_nt);
      tangential = against * normal;
    }
    body.vx += (normal * nx + tangential * tx) / of.mass;
    body.vy += (normal * ny + tangential * ty) / of.mass;
    body.spin += (normal * arm_n + tangential * arm_t) / of.inertia;
  }

  void advance(Body& body, double span) const {
    constexpr double glance = 1e-4;  // no end dips below the plane for a shorter time [s]
    double flown = 0.0;              // since the last impact, after which the body is `body` [s]
    while (flown < span) {
      const double next = std::min(flown + glance, span);
      const Body there = after(body, next);
      const double side = gap(there, -1.0) < gap(there, 1.0) ? -1.0 : 1.0;
      if (gap(there, side) >= 0.0) {
        flown = next;
        continue;
      }
      double open = flown, closed = next;
      for (int i = 0; i < 60; ++i) {
        const double middle = 0.5 * (open + closed);
        (gap(after(body, middle), side) >= 0.0 ? open : closed) = middle;
      }
      body = after(body, open);
      hit(body, side);
      span -= open;
      flown = 0.0;
    }
    body = after(body, span);
  }
};

Seen seen_of_balls(const Scale& scale) {
  const Sphere sphere{balls::of_ball, balls::radius, balls::restitution, balls::friction, balls::friction};
  std::vector<Body> bodies;
  for (int i = 0; i < scale.balls; ++i) bodies.push_back(balls::start(scale.balls, i));
  Seen seen;
  double time = 0.0;
  for (const Look& at : looks(Scene::balls, scale)) {
    for (Body& body : bodies) sphere.advance(body, at.time - time);
    time = at.time;
    look(Scene::balls, scale, at, bodies, seen);
  }
  return seen;
}

template <class Motion>
Seen seen_of_starts(Scene scene, const Scale& scale, const Motion& motion, Body (*start)(int)) {
  Seen seen;
  const Look at = looks(scene, scale).front();
  for (int i = 0; i < scale.starts; ++i) {
    std::vector<Body> body{start(i)};
    motion.advance(body[0], at.time);
    look(scene, scale, at, body, seen);
  }
  return seen;
}

}  // namespace

bool has_closed_form(Scene scene) { return scene != Scene::net && scene != Scene::chain; }

Seen exact(Scene scene, const Scale& scale) {
  if (scene == Scene::balls) return seen_of_balls(scale);
  if (scene == Scene::bar) return seen_of_starts(scene, scale, Falling{}, bar::start);
  const Sphere sphere{tables::of_ball,        tables::radius,         tables::restitution,
                      tables::lower_friction, tables::upper_friction, tables::distance};
  return seen_of_starts(scene, scale, sphere, tables::start);
}

}  // namespace compare
