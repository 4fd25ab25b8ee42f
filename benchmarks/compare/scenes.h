#pragma once

/// \file
/// The scenes that other engines are compared over: numbers alone, without any engine. Planar, y upwards,
/// angles counter-clockwise; the bodies of 3D engines move in the plane z = 0. The tangential coefficient of
/// restitution is 0 in all of them: hardly any other engine has one.

#include <cmath>
#include <cstddef>
#include <vector>

namespace compare {

inline constexpr double gravity = 9.81;  ///< [m/s^2]

/// Scenes in the order of the tables.
enum class Scene { tables, net, balls, chain, bar };
inline constexpr Scene all_scenes[] = {Scene::tables, Scene::net, Scene::balls, Scene::chain, Scene::bar};

/// "tables", "net", "balls", "chain", "bar".
[[nodiscard]] const char* name(Scene scene);

/// State of a body.
struct Body {
  double x = 0.0, y = 0.0, angle = 0.0;   ///< of the centre of mass [m, rad]
  double vx = 0.0, vy = 0.0, spin = 0.0;  ///< their rates [m/s, rad/s]
};

/// Mass of a body and its moment of inertia about the axis that is normal to the plane; 0 of a particle.
struct Mass {
  double mass = 0.0, inertia = 0.0;  ///< [kg, kg m^2]
};

/// How much of each scene is run.
struct Scale {
  int starts = 10;          ///< heights that tables and bar are run from
  int net_side = 30;        ///< particles along each side of the net
  int balls = 100;          ///< balls
  double chain_end = 10.0;  ///< end of the swing [s]
  double tables_end = 1.0;  ///< end of the flight between tables [s]
  double net_end = 1.0;     ///< end of the fall of the net [s]

  /// The whole of it, or a trial of seconds.
  static Scale of(bool quick) {
    if (!quick) return {};
    return {.starts = 2, .net_side = 6, .balls = 10, .chain_end = 2.0, .tables_end = 0.5, .net_end = 0.6};
  }
};

/// A ball between two tables (Johansson 1999, section 4, without e_t), from several heights, so that the
/// errors of one phase of impacts within a step do not pass for those of all.
namespace tables {
inline constexpr double step = 1e-4;                      ///< [s]
inline constexpr double mass = 0.00859, radius = 0.0131;  ///< of a solid sphere [kg, m]
inline constexpr double distance = 0.530;                 ///< of the tables [m]
inline constexpr double restitution = 0.91;               ///< e_n
inline constexpr double lower_friction = 1.13, upper_friction = 0.95;
inline constexpr double reach =
    20.0;  ///< tables of finite length extend as far to both sides of the origin [m]
inline constexpr Mass of_ball{mass, 0.4 * mass* radius* radius};
/// The ball at the start.
inline Body start(int i) { return {.y = 0.25 + 0.0017 * i, .vx = 5.444387434554974, .vy = -5.0}; }
}  // namespace tables

/// k x k particles on springs along rows, columns and diagonals fall on a plane that is inclined (the net of
/// the other benchmarks, examples/scenes/net.h).
namespace net {
inline constexpr double step = 1e-4;                     ///< [s]
inline constexpr double mass = 0.1, spacing = 0.1;       ///< [kg, m]
inline constexpr double stiffness = 1e4, damping = 1.0;  ///< [N/m, N s/m]
inline constexpr double slope = 0.1, height = 0.5;  ///< of the plane [rad]; of the net over its origin [m]
inline constexpr double friction = 0.3, restitution = 0.5;  ///< mu, e_n
inline constexpr double reach = 20.0;                       ///< of a plane of finite length [m]
inline Body start(int k, int particle) {
  return {.x = spacing * (particle % k - (k - 1)), .y = height + spacing * (particle / k)};
}
struct Spring {
  std::size_t from, to;
  double length;  ///< free length [m]
};
/// Springs, in the order of rows.
[[nodiscard]] std::vector<Spring> springs(int k);
/// Force that a spring exerts on its first end: stiffness, and dashpot along its line [N].
struct Pull {
  double x, y;
};
inline Pull pull(const Spring& spring, const Body& a, const Body& b) {
  const double dx = b.x - a.x, dy = b.y - a.y, length = std::sqrt(dx * dx + dy * dy);
  const double rate = ((b.vx - a.vx) * dx + (b.vy - a.vy) * dy) / length;
  const double force = (stiffness * (length - spring.length) + damping * rate) / length;
  return {force * dx, force * dy};
}
}  // namespace net

/// Balls side by side that bounce until they roll (the balls of the event benchmark). They do not meet.
namespace balls {
inline constexpr double step = 1e-3;                 ///< [s]
inline constexpr double mass = 0.01, radius = 0.01;  ///< of solid spheres [kg, m]
inline constexpr double friction = 0.3, restitution = 0.9;
inline constexpr double bouncing = 1.0, end = 3.0;  ///< all still bounce; all roll [s]
inline constexpr Mass of_ball{mass, 0.4 * mass* radius* radius};
inline constexpr double reach = 20.0;  ///< of a floor of finite length [m]
inline Body start(int count, int i) {
  const double part = count > 1 ? static_cast<double>(i) / (count - 1) : 1.0;
  return {.x = 0.03 * i, .y = radius + 0.02 + 0.08 * part, .vx = 0.1};
}
}  // namespace balls

/// Ten uniform rods, pinned to the origin and to each other, released in a horizontal line.
namespace chain {
inline constexpr double step = 1e-3;  ///< [s]
inline constexpr int rods = 10;
inline constexpr double mass = 1.0, length = 1.0;  ///< of a rod [kg, m]
inline constexpr double looked_at = 2.0;  ///< when places are compared; later the motion is chaotic [s]
inline constexpr Mass of_rod{mass, mass* length* length / 12.0};
inline Body start(int i) { return {.x = (i + 0.5) * length}; }
/// Centres of the rods from their absolute angles and rates.
[[nodiscard]] std::vector<Body> bodies(const std::vector<double>& angles, const std::vector<double>& rates);
}  // namespace chain

/// A bar falls on an inclined plane (Johansson 1999, section 6, without e_t), from several heights.
namespace bar {
inline constexpr double step = 1.0 / 1200.0;  ///< [s]
inline constexpr Mass of_bar{2.0, 2.0};
inline constexpr double half_length = 1.0;                               ///< contact is at the two ends [m]
inline constexpr double slope = 0.1, friction = 0.1, restitution = 1.0;  ///< [rad], mu, e_n
inline constexpr double end = 3.5;                                       ///< [s]
inline constexpr double reach = 100.0;                                   ///< of a plane of finite length [m]
/// Upright, thrown to the right.
inline Body start(int i) { return {.y = 20.0 + 0.0137 * i, .vx = 10.0}; }
}  // namespace bar

/// All bodies of a scene at a start.
[[nodiscard]] std::vector<Body> bodies_at_start(Scene scene, const Scale& scale, int start);

/// Kinetic energy, and that of gravity over y = 0 [J].
[[nodiscard]] double energy(Mass mass, const Body& body);

/// Energy of all bodies of a scene, springs included [J].
[[nodiscard]] double energy(Scene scene, const Scale& scale, const std::vector<Body>& bodies);

/// When a scene is looked at, and for what.
struct Look {
  double time;  ///< [s]
  bool places, energy;
};
[[nodiscard]] std::vector<Look> looks(Scene scene, const Scale& scale);

/// The numbers of a motion that are compared: of each start and look the places [m] (x and y in turn; of the
/// net its centre of mass, of the chain its last rod) and the energies [J].
struct Seen {
  std::vector<double> places, energies;
};

/// Adds what a look shows.
void look(Scene scene, const Scale& scale, const Look& at, const std::vector<Body>& bodies, Seen& seen);

}  // namespace compare
