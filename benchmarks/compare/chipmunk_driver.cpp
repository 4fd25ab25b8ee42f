// The scenes in Chipmunk (https://chipmunk-physics.net).

#include "rigid_world.h"

#include <chipmunk/chipmunk.h>

namespace compare {
namespace {

struct Options {
  int iterations = 10;
  double slop = 0.1;   // penetration that is left, for scenes in pixels by default [m]
  double bias = -1.0;  // errorBias of joints, the part left after a second; < 0: as it comes
};

class ChipmunkWorld final : public RigidWorld {
public:
  ChipmunkWorld(double step, const Options& options)
      : RigidWorld(step), options_(options), space_(cpSpaceNew()) {
    cpSpaceSetGravity(space_, cpv(0.0, -gravity));
    cpSpaceSetIterations(space_, options.iterations);
    cpSpaceSetCollisionSlop(space_, options.slop);
  }
  ~ChipmunkWorld() final {
    // Bodies last: shapes and constraints point to them.
    for (cpConstraint* const constraint : constraints_) {
      cpSpaceRemoveConstraint(space_, constraint);
      cpConstraintFree(constraint);
    }
    for (cpShape* const shape : shapes_) {
      cpSpaceRemoveShape(space_, shape);
      cpShapeFree(shape);
    }
    for (cpBody* const body : bodies_) {
      cpSpaceRemoveBody(space_, body);
      cpBodyFree(body);
    }
    cpSpaceFree(space_);
  }

  void add_plane(const Plane& plane) final {
    // A thick board: a thin one would be passed through by what is fast and small.
    constexpr double half = 5.0;
    const cpVect centre = cpv(plane.x - half * plane.nx, plane.y - half * plane.ny);
    const cpVect along = cpv(plane.reach * plane.ny, -plane.reach * plane.nx);
    add_shape(
        cpSegmentShapeNew(cpSpaceGetStaticBody(space_), cpvsub(centre, along), cpvadd(centre, along), half),
        plane.friction, plane.restitution);
  }

  void add_body(Mass mass, const Body& at, const std::vector<Disc>& discs) final {
    // A particle does not turn.
    cpBody* const body = cpBodyNew(mass.mass, mass.inertia > 0.0 ? mass.inertia : INFINITY);
    cpBodySetPosition(body, cpv(at.x, at.y));
    cpBodySetVelocity(body, cpv(at.vx, at.vy));
    cpSpaceAddBody(space_, body);
    bodies_.push_back(body);
    for (const Disc& disc : discs) {
      cpShape* const shape = add_shape(cpCircleShapeNew(body, disc.radius, cpv(disc.x, disc.y)), 1.0, 1.0);
      cpShapeSetFilter(shape, cpShapeFilterNew(1, CP_ALL_CATEGORIES, CP_ALL_CATEGORIES));
    }
  }

  void add_spring(const net::Spring& spring) final {
    add_constraint(cpDampedSpringNew(bodies_[spring.from], bodies_[spring.to], cpvzero, cpvzero,
                                     spring.length, net::stiffness, net::damping));
  }

  void add_pin(const Pin& pin) final {
    cpBody* const before =
        pin.before < 0 ? cpSpaceGetStaticBody(space_) : bodies_[static_cast<std::size_t>(pin.before)];
    add_constraint(cpPivotJointNew2(before, bodies_[static_cast<std::size_t>(pin.after)],
                                    cpv(pin.before_x, 0.0), cpv(pin.after_x, 0.0)));
  }

  [[nodiscard]] std::vector<Body> bodies() const final {
    std::vector<Body> all;
    for (const cpBody* const body : bodies_) {
      const cpVect x = cpBodyGetPosition(body), v = cpBodyGetVelocity(body);
      all.push_back({.x = x.x, .y = x.y, .vx = v.x, .vy = v.y, .spin = cpBodyGetAngularVelocity(body)});
    }
    return all;
  }

private:
  void make_step() final { cpSpaceStep(space_, step()); }

  /// Coefficients of a pair are products.
  cpShape* add_shape(cpShape* shape, double friction, double restitution) {
    cpShapeSetFriction(shape, friction);
    cpShapeSetElasticity(shape, restitution);
    shapes_.push_back(cpSpaceAddShape(space_, shape));
    return shape;
  }

  void add_constraint(cpConstraint* constraint) {
    if (options_.bias >= 0.0) cpConstraintSetErrorBias(constraint, options_.bias);
    constraints_.push_back(cpSpaceAddConstraint(space_, constraint));
  }

  Options options_;
  cpSpace* space_;
  std::vector<cpBody*> bodies_;
  std::vector<cpShape*> shapes_;
  std::vector<cpConstraint*> constraints_;
};

auto world_of(const Options& options) {
  return [options](double step) { return std::make_unique<ChipmunkWorld>(step, options); };
}

}  // namespace

Engine engine() {
  Engine chipmunk{
      .name = std::string("Chipmunk ") + cpVersionString, .cases = {}, .missing = {}, .references = {}};
  for (const Scene scene : all_scenes) {
    chipmunk.cases.push_back(rigid_case(scene, "10 iterations", true, world_of({})));
  }
  chipmunk.cases.push_back(
      rigid_case(Scene::balls, "`collisionSlop` 1e-5 m", false, world_of({.slop = 1e-5})));
  chipmunk.cases.push_back(rigid_case(Scene::chain, "100 iterations, `errorBias = 0`", false,
                                      world_of({.iterations = 100, .bias = 0.0})));
  return chipmunk;
}

}  // namespace compare
