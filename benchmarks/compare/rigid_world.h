#pragma once

/// \file
/// The scenes for engines of rigid bodies that know planes, spheres or discs, springs and pins: they say how
/// one of each is made, `build` makes the scene of them.

#include "driver.h"

#include <cstddef>
#include <vector>

namespace compare {

/// A fixed plane, or the upper side of a thick board as long as `2 reach` where an engine has no infinite
/// ones.
struct Plane {
  double x, y, nx, ny;           ///< a point of it [m], its unit normal into free space
  double friction, restitution;  ///< mu and e_n against every body
  double reach;                  ///< [m]
};

/// A disc (in space: a sphere) fixed to a body, alone in contact with planes.
struct Disc {
  double x, y, radius;  ///< centre in the frame of the body, radius [m]
};

/// Points touch as discs of this radius, over planes that lie lower by as much: the same gap [m].
inline constexpr double point_radius = 1e-5;

/// A pin through the world or a body before and a body after, at points of theirs.
struct Pin {
  int before;  ///< -1: the world
  int after;
  double before_x, after_x;  ///< on the x axes of their frames [m]
};

/// World of an engine of rigid bodies. Bodies touch planes, never each other.
class RigidWorld : public SteppedWorld {
public:
  using SteppedWorld::SteppedWorld;
  virtual void add_plane(const Plane& plane) = 0;
  virtual void add_body(Mass mass, const Body& at, const std::vector<Disc>& discs) = 0;
  virtual void add_spring(const net::Spring& spring) = 0;
  virtual void add_pin(const Pin& pin) = 0;
  /// Called when all planes, bodies, springs and pins have been added.
  virtual void finish() {}
};

/// Step of a scene [s].
[[nodiscard]] double step_of(Scene scene);

/// Makes the scene in an empty world.
void build(Scene scene, const Scale& scale, int start, RigidWorld& world);

/// A case of a world that `make(step)` makes empty.
template <class Make>
Case rigid_case(Scene scene, const std::string& options, bool as_it_comes, Make make) {
  return {scene, options, as_it_comes, [scene, make](const Scale& scale, int start) {
            auto world = make(step_of(scene));
            build(scene, scale, start, *world);
            world->finish();
            return std::unique_ptr<World>(std::move(world));
          }};
}

}  // namespace compare
