// The scenes in ODE (https://ode.org).

#include "rigid_world.h"

#include <ode/ode.h>

#include <array>
#include <utility>

namespace compare {
namespace {

class OdeWorld final : public RigidWorld {
public:
  explicit OdeWorld(double step)
      : RigidWorld(step),
        world_(dWorldCreate()),
        discs_(dSimpleSpaceCreate(nullptr)),
        contacts_(dJointGroupCreate(0)) {
    dWorldSetGravity(world_, 0.0, -gravity, 0.0);
  }
  ~OdeWorld() final {
    dJointGroupDestroy(contacts_);
    for (const auto& [geometry, plane] : planes_) dGeomDestroy(geometry);
    dSpaceDestroy(discs_);
    dWorldDestroy(world_);
  }

  void add_plane(const Plane& plane) final {
    const dGeomID geometry =
        dCreatePlane(nullptr, plane.nx, plane.ny, 0.0, plane.nx * plane.x + plane.ny * plane.y);
    planes_.emplace_back(geometry, plane);
  }

  void add_body(Mass mass, const Body& at, const std::vector<Disc>& discs) final {
    const dBodyID body = dBodyCreate(world_);
    dMass of;
    // Particles do not turn: with this inertia friction at their small discs moves them as it does points.
    const double inertia = mass.inertia > 0.0 ? mass.inertia : mass.mass;
    dMassSetParameters(&of, mass.mass, 0.0, 0.0, 0.0, inertia, inertia, inertia, 0.0, 0.0, 0.0);
    dBodySetMass(body, &of);
    dBodySetPosition(body, at.x, at.y, 0.0);
    dBodySetLinearVel(body, at.vx, at.vy, 0.0);
    for (const Disc& disc : discs) {
      const dGeomID sphere = dCreateSphere(discs_, disc.radius);
      dGeomSetBody(sphere, body);
      dGeomSetOffsetPosition(sphere, disc.x, disc.y, 0.0);
    }
    bodies_.push_back(body);
  }

  void add_spring(const net::Spring& spring) final { springs_.push_back(spring); }

  void add_pin(const Pin& pin) final {
    const dJointID joint = dJointCreateHinge(world_, nullptr);
    const dBodyID after = bodies_[static_cast<std::size_t>(pin.after)];
    const dBodyID before = pin.before < 0 ? nullptr : bodies_[static_cast<std::size_t>(pin.before)];
    dJointAttach(joint, after, before);
    const dReal* const centre = dBodyGetPosition(after);
    dJointSetHingeAnchor(joint, centre[0] + pin.after_x, centre[1], 0.0);
    dJointSetHingeAxis(joint, 0.0, 0.0, 1.0);
  }

  [[nodiscard]] std::vector<Body> bodies() const final {
    std::vector<Body> all;
    for (const dBodyID body : bodies_) all.push_back(state(body));
    return all;
  }

private:
  static Body state(dBodyID body) {
    const dReal *const x = dBodyGetPosition(body), *const v = dBodyGetLinearVel(body);
    return {.x = x[0], .y = x[1], .vx = v[0], .vy = v[1], .spin = dBodyGetAngularVel(body)[2]};
  }

  void make_step() final {
    for (const net::Spring& spring : springs_) {
      const dBodyID a = bodies_[spring.from], b = bodies_[spring.to];
      const net::Pull pull = net::pull(spring, state(a), state(b));
      dBodyAddForce(a, pull.x, pull.y, 0.0);
      dBodyAddForce(b, -pull.x, -pull.y, 0.0);
    }
    for (const auto& [geometry, plane] : planes_) {
      now_ = &plane;
      dSpaceCollide2(geometry, reinterpret_cast<dGeomID>(discs_), this, touch);
    }
    dWorldStep(world_, step());
    dJointGroupEmpty(contacts_);
  }

  static void touch(void* self, dGeomID a, dGeomID b) {
    OdeWorld& world = *static_cast<OdeWorld*>(self);
    std::array<dContact, 2> contacts{};
    const int found = dCollide(a, b, static_cast<int>(contacts.size()), &contacts[0].geom, sizeof(dContact));
    for (int i = 0; i < found; ++i) {
      dContact& contact = contacts[static_cast<std::size_t>(i)];
      contact.surface.mode = dContactBounce | dContactApprox1 | dContactFDir1;
      contact.surface.mu = world.now_->friction;
      contact.surface.bounce = world.now_->restitution;
      contact.surface.bounce_vel = 0.0;
      contact.fdir1[0] = world.now_->ny;
      contact.fdir1[1] = -world.now_->nx;
      contact.fdir1[2] = 0.0;
      dJointAttach(dJointCreateContact(world.world_, world.contacts_, &contact),
                   dGeomGetBody(contact.geom.g1), dGeomGetBody(contact.geom.g2));
    }
  }

  dWorldID world_;
  dSpaceID discs_;
  dJointGroupID contacts_;
  std::vector<std::pair<dGeomID, Plane>> planes_;
  const Plane* now_ = nullptr;  // that is searched for contacts
  std::vector<dBodyID> bodies_;
  std::vector<net::Spring> springs_;
};

std::unique_ptr<OdeWorld> make_world(double step) { return std::make_unique<OdeWorld>(step); }

}  // namespace

Engine engine() {
  dInitODE2(0);
  Engine ode{.name = "ODE " COMPARE_VERSION, .cases = {}, .missing = {}, .references = {}};
  for (const Scene scene : all_scenes) {
    const std::string springs = scene == Scene::net ? ", springs as forces of the user" : "";
    ode.cases.push_back(rigid_case(scene, "`dWorldStep`" + springs, true, make_world));
  }
  return ode;
}

}  // namespace compare
