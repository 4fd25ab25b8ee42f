// The scenes in Bullet (https://pybullet.org), built in double precision.

#include "rigid_world.h"

#include <btBulletDynamicsCommon.h>

namespace compare {
namespace {

struct Options {
  int iterations = 10;
  // As it comes, contacts act before they touch, and penetrations are pushed out by velocities that stay.
  // Else contactProcessingThreshold and m_splitImpulsePenetrationThreshold are 0.
  bool as_it_comes = true;
};

class BulletWorld final : public RigidWorld {
public:
  BulletWorld(double step, Options options)
      : RigidWorld(step),
        options_(options),
        dispatcher_(&configuration_),
        world_(&dispatcher_, &broadphase_, &solver_, &configuration_) {
    world_.setGravity({0.0, -gravity, 0.0});
    world_.getSolverInfo().m_numIterations = options.iterations;
    world_.getSolverInfo().m_restitutionVelocityThreshold = 0.0;  // 0.2 m/s as it comes
    if (!options.as_it_comes) world_.getSolverInfo().m_splitImpulsePenetrationThreshold = 0.0;
  }
  ~BulletWorld() final {
    for (const auto& joint : joints_) world_.removeConstraint(joint.get());
    for (const auto& body : bodies_) world_.removeRigidBody(body.get());
    for (const auto& plane : planes_) world_.removeRigidBody(plane.get());
  }

  void add_plane(const Plane& plane) final {
    shapes_.push_back(std::make_unique<btStaticPlaneShape>(btVector3(plane.nx, plane.ny, 0.0),
                                                           plane.nx * plane.x + plane.ny * plane.y));
    btRigidBody::btRigidBodyConstructionInfo info(0.0, nullptr, shapes_.back().get());
    info.m_friction = plane.friction;
    info.m_restitution = plane.restitution;
    planes_.push_back(std::make_unique<btRigidBody>(info));
    world_.addRigidBody(planes_.back().get(), of_planes, of_bodies);
  }

  void add_body(Mass mass, const Body& at, const std::vector<Disc>& discs) final {
    auto whole = std::make_unique<btCompoundShape>();
    for (const Disc& disc : discs) {
      shapes_.push_back(std::make_unique<btSphereShape>(disc.radius));
      const btTransform place(btQuaternion::getIdentity(), btVector3(disc.x, disc.y, 0.0));
      whole->addChildShape(place, shapes_.back().get());
    }
    const bool is_centred = discs.size() == 1;
    btCollisionShape* const shape = is_centred ? shapes_.back().get() : whole.get();
    if (!is_centred) shapes_.push_back(std::move(whole));
    btRigidBody::btRigidBodyConstructionInfo info(mass.mass, nullptr, shape,
                                                  btVector3(mass.inertia, mass.inertia, mass.inertia));
    info.m_startWorldTransform.setOrigin({at.x, at.y, 0.0});
    info.m_friction = 1.0;  // coefficients of a pair are products
    info.m_restitution = 1.0;
    bodies_.push_back(std::make_unique<btRigidBody>(info));
    btRigidBody& body = *bodies_.back();
    if (!options_.as_it_comes) body.setContactProcessingThreshold(0.0);
    body.setLinearVelocity({at.vx, at.vy, 0.0});
    body.setLinearFactor({1.0, 1.0, 0.0});
    body.setAngularFactor({0.0, 0.0, mass.inertia > 0.0 ? 1.0 : 0.0});
    body.setActivationState(DISABLE_DEACTIVATION);  // slow bodies are put to sleep as it comes
    world_.addRigidBody(&body, of_bodies, of_planes);
  }

  void add_spring(const net::Spring& spring) final { springs_.push_back(spring); }

  void add_pin(const Pin& pin) final {
    const btVector3 axis(0.0, 0.0, 1.0), on_after(pin.after_x, 0.0, 0.0), on_before(pin.before_x, 0.0, 0.0);
    btRigidBody& after = *bodies_[static_cast<std::size_t>(pin.after)];
    if (pin.before < 0) {
      joints_.push_back(std::make_unique<btHingeConstraint>(after, on_after, axis));
    } else {
      btRigidBody& before = *bodies_[static_cast<std::size_t>(pin.before)];
      joints_.push_back(std::make_unique<btHingeConstraint>(before, after, on_before, on_after, axis, axis));
    }
    world_.addConstraint(joints_.back().get(), true);
  }

  [[nodiscard]] std::vector<Body> bodies() const final {
    std::vector<Body> all;
    for (const auto& body : bodies_) all.push_back(state(*body));
    return all;
  }

private:
  static constexpr int of_planes = 1, of_bodies = 2;  // groups of contact

  static Body state(const btRigidBody& body) {
    const btVector3 &x = body.getCenterOfMassPosition(), &v = body.getLinearVelocity();
    return {.x = x.x(), .y = x.y(), .vx = v.x(), .vy = v.y(), .spin = body.getAngularVelocity().z()};
  }

  void make_step() final {
    for (const net::Spring& spring : springs_) {
      btRigidBody &a = *bodies_[spring.from], &b = *bodies_[spring.to];
      const net::Pull pull = net::pull(spring, state(a), state(b));
      a.applyCentralForce({pull.x, pull.y, 0.0});
      b.applyCentralForce({-pull.x, -pull.y, 0.0});
    }
    world_.stepSimulation(step(), 0);
  }

  Options options_;
  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_;
  btDbvtBroadphase broadphase_;
  btSequentialImpulseConstraintSolver solver_;
  btDiscreteDynamicsWorld world_;
  std::vector<std::unique_ptr<btCollisionShape>> shapes_;
  std::vector<std::unique_ptr<btRigidBody>> planes_, bodies_;
  std::vector<std::unique_ptr<btTypedConstraint>> joints_;
  std::vector<net::Spring> springs_;
};

auto world_of(Options options) {
  return [options](double step) { return std::make_unique<BulletWorld>(step, options); };
}

}  // namespace

Engine engine() {
  const std::string version =
      std::to_string(btGetVersion() / 100) + "." + std::to_string(btGetVersion() % 100);
  Engine bullet{.name = "Bullet " + version, .cases = {}, .missing = {}, .references = {}};
  const auto add = [&](Scene scene, const std::string& options, bool as_it_comes, Options with) {
    bullet.cases.push_back(rigid_case(scene, options, as_it_comes, world_of(with)));
  };
  for (const Scene scene : all_scenes) {
    if (scene == Scene::chain) {
      add(scene, "10 iterations", true, {});
      add(scene, "100 iterations", false, {.iterations = 100});
    } else {
      const std::string springs = scene == Scene::net ? ", springs as forces of the user" : "";
      add(scene, "no threshold of restitution" + springs, true, {});
      add(scene, "the same, `contactProcessingThreshold` and `m_splitImpulsePenetrationThreshold` 0", false,
          {.as_it_comes = false});
    }
  }
  return bullet;
}

}  // namespace compare
