// The scenes in Box2D (https://box2d.org), single precision.

#include "rigid_world.h"

#include <box2d/box2d.h>

namespace compare {
namespace {

float single(double value) { return static_cast<float>(value); }
b2Vec2 vector(double x, double y) { return {single(x), single(y)}; }

// Of velocities and of positions, as the manual has them.
constexpr int velocity_iterations = 8, position_iterations = 3;

class Box2dWorld final : public RigidWorld {
public:
  explicit Box2dWorld(double step) : RigidWorld(step), world_(vector(0.0, -gravity)) {
    b2BodyDef ground;
    ground_ = world_.CreateBody(&ground);
  }

  void add_plane(const Plane& plane) final {
    // Polygons have a skin, which is solid: the board lies lower by its thickness.
    constexpr double half = 5.0;
    const double depth = half + static_cast<double>(b2_polygonRadius);
    b2PolygonShape board;
    board.SetAsBox(single(plane.reach), single(half),
                   vector(plane.x - depth * plane.nx, plane.y - depth * plane.ny),
                   single(std::atan2(-plane.nx, plane.ny)));
    // Friction of a pair is the root of the product, restitution the larger of both.
    add_shape(*ground_, board, plane.friction * plane.friction, plane.restitution);
  }

  void add_body(Mass mass, const Body& at, const std::vector<Disc>& discs) final {
    b2BodyDef definition;
    definition.type = b2_dynamicBody;
    definition.position = vector(at.x, at.y);
    definition.linearVelocity = vector(at.vx, at.vy);
    definition.fixedRotation = mass.inertia == 0.0;
    b2Body* const body = world_.CreateBody(&definition);
    for (const Disc& disc : discs) {
      b2CircleShape circle;
      circle.m_p = vector(disc.x, disc.y);
      circle.m_radius = single(disc.radius);
      add_shape(*body, circle, 1.0, 0.0);
    }
    b2MassData data;
    data.mass = single(mass.mass);
    data.center.SetZero();
    data.I = single(mass.inertia);
    body->SetMassData(&data);
    bodies_.push_back(body);
  }

  void add_spring(const net::Spring& spring) final {
    b2DistanceJointDef joint;
    joint.bodyA = bodies_[spring.from];
    joint.bodyB = bodies_[spring.to];
    joint.length = single(spring.length);
    joint.stiffness = single(net::stiffness);
    joint.damping = single(net::damping);
    world_.CreateJoint(&joint);
  }

  void add_pin(const Pin& pin) final {
    b2RevoluteJointDef joint;
    joint.bodyA = pin.before < 0 ? ground_ : bodies_[static_cast<std::size_t>(pin.before)];
    joint.bodyB = bodies_[static_cast<std::size_t>(pin.after)];
    joint.localAnchorA = vector(pin.before_x, 0.0);
    joint.localAnchorB = vector(pin.after_x, 0.0);
    world_.CreateJoint(&joint);
  }

  [[nodiscard]] std::vector<Body> bodies() const final {
    std::vector<Body> all;
    for (const b2Body* const body : bodies_) {
      const b2Vec2 x = body->GetPosition(), v = body->GetLinearVelocity();
      all.push_back({.x = static_cast<double>(x.x),
                     .y = static_cast<double>(x.y),
                     .vx = static_cast<double>(v.x),
                     .vy = static_cast<double>(v.y),
                     .spin = static_cast<double>(body->GetAngularVelocity())});
    }
    return all;
  }

private:
  void make_step() final { world_.Step(single(step()), velocity_iterations, position_iterations); }

  static void add_shape(b2Body& body, const b2Shape& shape, double friction, double restitution) {
    b2FixtureDef fixture;
    fixture.shape = &shape;
    fixture.friction = single(friction);
    fixture.restitution = single(restitution);
    fixture.restitutionThreshold = 0.0F;  // 1 m/s as it comes, below which nothing bounces
    fixture.filter.groupIndex = body.GetType() == b2_dynamicBody ? std::int16_t{-1} : std::int16_t{0};
    body.CreateFixture(&fixture);
  }

  b2World world_;
  b2Body* ground_;
  std::vector<b2Body*> bodies_;
};

std::unique_ptr<Box2dWorld> make_world(double step) { return std::make_unique<Box2dWorld>(step); }

}  // namespace

Engine engine() {
  const std::string version = std::to_string(b2_version.major) + "." + std::to_string(b2_version.minor) +
                              "." + std::to_string(b2_version.revision);
  Engine box2d{.name = "Box2D " + version, .cases = {}, .missing = {}, .references = {}};
  for (const Scene scene : all_scenes) {
    const std::string bounce = scene == Scene::chain ? "" : ", `restitutionThreshold = 0`";
    box2d.cases.push_back(rigid_case(scene, "8 and 3 iterations" + bounce, true, make_world));
  }
  return box2d;
}

}  // namespace compare
