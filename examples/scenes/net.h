#pragma once

/// \file
/// A net of particles on springs that falls on an inclined plane. Shared by tests and benchmarks.

#include <carom/carom.h>

#include <cmath>
#include <cstddef>
#include <vector>

namespace scenes {

/// k x k particles on springs to their 4 neighbours and along both diagonals, in rows from the lowest
/// upwards. The plane goes through the origin and rises with +x; the lower right corner of the net, the
/// nearest to the plane, starts at (0, height).
struct Net {
  int k = 10;              ///< particles along each side
  double prestress = 0.0;  ///< part of its length by which each spring starts stretched
  double tilt = 0.0;  ///< of the net, counter-clockwise; equal to `slope`, its lowest row lies along it [rad]
  double height = 0.5;       ///< [m]
  bool diagonals = true;     ///< springs along the diagonals too
  double mass = 0.1;         ///< of each particle [kg]
  double spacing = 0.1;      ///< [m]
  double stiffness = 1e4;    ///< [N/m]
  double damping = 1.0;      ///< [N s/m]
  double slope = 0.1;        ///< of the plane [rad]
  double friction = 0.3;     ///< coefficient of friction
  double restitution = 0.5;  ///< e_n; e_t is 0
};

inline constexpr double net_gravity = 9.81;  ///< [m/s^2]
inline constexpr double net_step = 1e-4;     ///< [s]

/// Number of particles.
inline int particles(const Net& net) { return net.k * net.k; }

/// Number of springs.
inline int springs(const Net& net) {
  return 2 * net.k * (net.k - 1) + (net.diagonals ? 2 * (net.k - 1) * (net.k - 1) : 0);
}

/// Start of a particle [m].
inline carom::Vec<2> start(const Net& net, int particle) {
  const double right = net.spacing * (particle % net.k - (net.k - 1));
  const double up = net.spacing * (particle / net.k);
  const double c = std::cos(net.tilt), s = std::sin(net.tilt);
  return {c * right - s * up, net.height + s * right + c * up};
}

/// Calls f(from, to) for the particles at the ends of each spring.
template <class F>
void for_springs(const Net& net, F&& f) {
  const int k = net.k;
  for (int row = 0; row < k; ++row) {
    for (int column = 0; column < k; ++column) {
      const int here = row * k + column;
      if (column + 1 < k) f(here, here + 1);
      if (row + 1 == k) continue;
      f(here, here + k);
      if (!net.diagonals) continue;
      if (column + 1 < k) f(here, here + k + 1);
      if (column > 0) f(here, here + k - 1);
    }
  }
}

/// Free length of the spring between two particles [m].
inline double free_length(const Net& net, int from, int to) {
  return (1.0 - net.prestress) * (start(net, to) - start(net, from)).norm();
}

/// Gravity, the plane and the net.
inline void add_net(carom::System& system, const Net& net) {
  using namespace carom::planar;
  system.add(Gravity{{0.0, -net_gravity}});
  system.add(HalfPlane{.point = {0.0, 0.0}, .normal = incline(net.slope)},
             carom::Surface{.friction = net.friction, .normal_restitution = net.restitution});
  std::vector<carom::BodyId> ids;
  for (int i = 0; i < particles(net); ++i) {
    ids.push_back(system.add(Particle{.mass = net.mass, .position = start(net, i)}));
  }
  for_springs(net, [&](int from, int to) {
    system.add(SpringDamper{.from = ids[static_cast<std::size_t>(from)],
                            .to = ids[static_cast<std::size_t>(to)],
                            .stiffness = net.stiffness,
                            .damping = net.damping,
                            .free_length = free_length(net, from, to)});
  });
}

}  // namespace scenes
