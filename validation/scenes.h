#pragma once

/// \file
/// Scenes of the reference problems, shared by the report and the tests. SI units, gravity 9.81 m/s^2
/// downwards. Bodies that start in contact may start `depth` inside: time stepping then sees the contact in
/// the first step, whatever the rounding.

#include <carom/carom.h>

#include <cmath>

namespace scenes {

inline constexpr double reference_gravity = 9.81;  // [m/s^2]

/// A system and the body to look at.
struct BodyScene {
  carom::System system;
  carom::BodyId body;
};

inline BodyScene scene_with_gravity() {
  BodyScene scene;
  scene.system.add(carom::planar::Gravity{{0.0, -reference_gravity}});
  return scene;
}

/// A particle over a smooth level floor.
inline BodyScene ball_above_floor(double height, double restitution) {
  BodyScene scene = scene_with_gravity();
  scene.system.add(carom::planar::HalfPlane{.normal = {0.0, 1.0}},
                   carom::Surface{.friction = 0.0, .normal_restitution = restitution}, "floor");
  scene.body = scene.system.add(carom::planar::Particle{.mass = 1.0, .position = {0.0, height}}, "ball");
  return scene;
}

/// A round body over a level floor; without gravity if it is in contact at the start (`height` 0).
/// \param height of its lowest point
inline BodyScene round_body(const carom::MassProperties<2>& mass, double radius,
                            const carom::Surface& surface, double height, const carom::Vec<2>& velocity,
                            double spin) {
  using namespace carom::planar;
  BodyScene scene = height == 0.0 ? BodyScene{} : scene_with_gravity();
  scene.system.add(HalfPlane{.normal = {0.0, 1.0}}, surface, "floor");
  scene.body = scene.system.add(
      RigidBody{.mass = mass, .position = {0.0, radius + height}, .velocity = velocity, .spin = spin},
      "ball");
  scene.system.add(Disc{.body = scene.body, .radius = radius});
  return scene;
}

/// A body of 1 kg in contact with a plane that falls to the right: round, or a particle for radius 0.
struct Downhill {
  double slope = 0.0;  ///< [rad]
  double friction = 0.0;
  double inertia = 0.0;  ///< [kg m^2]
  double radius = 0.0;   ///< [m]
  double speed = 0.0, forward_spin = 0.0;
  double depth = 0.0;  ///< at the start [m]

  [[nodiscard]] carom::Vec<2> normal() const { return carom::planar::incline(-slope); }
  [[nodiscard]] carom::Vec<2> tangent() const { return {normal()[1], -normal()[0]}; }
  [[nodiscard]] carom::Vec<2> start() const { return (radius - depth) * normal(); }
  [[nodiscard]] double distance(const carom::State& state, carom::BodyId body) const {
    return tangent().dot(carom::Vec<2>(state.position(body)) - start());
  }
  [[nodiscard]] double speed_of(const carom::State& state, carom::BodyId body) const {
    return tangent().dot(carom::Vec<2>(state.velocity(body)));
  }
};
inline BodyScene downhill(const Downhill& at) {
  using namespace carom::planar;
  BodyScene scene = scene_with_gravity();
  scene.system.add(HalfPlane{.normal = at.normal()},
                   carom::Surface{.friction = at.friction, .normal_restitution = 0.0}, "plane");
  if (at.radius == 0.0) {
    scene.body = scene.system.add(
        Particle{.mass = 1.0, .position = at.start(), .velocity = at.speed * at.tangent()}, "body");
    return scene;
  }
  scene.body = scene.system.add(RigidBody{.mass = {.mass = 1.0, .inertia = at.inertia},
                                          .position = at.start(),
                                          .velocity = at.speed * at.tangent(),
                                          .spin = -at.forward_spin},
                                "body");
  scene.system.add(Disc{.body = scene.body, .radius = at.radius});
  return scene;
}

/// A block of 1 kg on a rough floor, held by a spring of 100 N/m, 0.2 m from its rest.
inline BodyScene coulomb_oscillator(double depth = 0.0) {
  using namespace carom::planar;
  BodyScene scene = scene_with_gravity();
  scene.system.add(HalfPlane{.normal = {0.0, 1.0}},
                   carom::Surface{.friction = 0.3, .normal_restitution = 0.0}, "floor");
  scene.body = scene.system.add(Particle{.mass = 1.0, .position = {0.2, -depth}}, "block");
  scene.system.add(SpringDamper{
      .from = {carom::ground, {-5.0, -depth}}, .to = scene.body, .stiffness = 100.0, .free_length = 5.0});
  return scene;
}

/// A ladder of 2 m and 1 kg with its foot on a rough floor, leaning on a smooth wall at the angle theta to
/// the floor.
inline BodyScene ladder(double friction, double theta, double depth = 0.0) {
  using namespace carom::planar;
  constexpr double length = 2.0;
  BodyScene scene = scene_with_gravity();
  scene.system.add(HalfPlane{.normal = {0.0, 1.0}},
                   carom::Surface{.friction = friction, .normal_restitution = 0.0}, "floor");
  scene.system.add(HalfPlane{.normal = {1.0, 0.0}},
                   carom::Surface{.friction = 0.0, .normal_restitution = 0.0}, "wall");
  const carom::Vec<2> half(0.5 * length * std::cos(theta), 0.5 * length * std::sin(theta));
  scene.body = scene.system.add(
      RigidBody{.mass = rod(1.0, length), .position = half - carom::Vec<2>(depth, depth), .angle = -theta},
      "ladder");
  scene.system.add(Segment{.body = scene.body, .from = {-0.5 * length, 0.0}, .to = {0.5 * length, 0.0}});
  return scene;
}

/// Painleve's rod: of half length 1 m and 1 kg, its lower left tip slides on the floor.
struct PainleveRod {
  double theta = 0.0;  ///< between rod and floor [rad]
  double friction = 0.0;
  double omega = 0.0;      ///< spin [rad/s]
  double tip_speed = 0.0;  ///< along the floor [m/s]
  double depth = 0.0;      ///< [m]

  [[nodiscard]] carom::Vec<2> lever() const { return {std::cos(theta), std::sin(theta)}; }  // tip to centre
};
inline BodyScene painleve_rod(const PainleveRod& at) {
  using namespace carom::planar;
  BodyScene scene = scene_with_gravity();
  scene.system.add(HalfPlane{.normal = {0.0, 1.0}},
                   carom::Surface{.friction = at.friction, .normal_restitution = 0.0}, "floor");
  const carom::Vec<2> lever = at.lever();
  scene.body = scene.system.add(
      RigidBody{.mass = rod(1.0, 2.0),
                .position = lever - carom::Vec<2>(0.0, at.depth),
                .angle = at.theta,
                .velocity = carom::Vec<2>(at.tip_speed, 0.0) + at.omega * carom::Vec<2>(-lever[1], lever[0]),
                .spin = at.omega},
      "rod");
  scene.system.add(Point{.body = scene.body, .position = {-1.0, 0.0}});
  return scene;
}

/// A rectangle 2b x 2h of 1 kg, tilted about its left corner, at rest.
inline BodyScene rocking_block(double b, double h, double tilt, double depth = 0.0) {
  using namespace carom::planar;
  BodyScene scene = scene_with_gravity();
  scene.system.add(HalfPlane{.normal = {0.0, 1.0}},
                   carom::Surface{.friction = 2.0, .normal_restitution = 0.0}, "floor");
  const double c = std::cos(tilt), s = std::sin(tilt);
  scene.body = scene.system.add(RigidBody{.mass = box(1.0, 2.0 * b, 2.0 * h),
                                          .position = {c * b - s * h, s * b + c * h - depth},
                                          .angle = tilt},
                                "block");
  scene.system.add(Point{.body = scene.body, .position = {-b, -h}}, "left");
  scene.system.add(Point{.body = scene.body, .position = {b, -h}}, "right");
  return scene;
}

/// x'' + x = F cos(w t) with a stop: free space is x < wall.
struct ImpactOscillator {
  double force = 0.0, frequency = 0.0;  ///< F [N], w [rad/s]
  double wall = 0.0, restitution = 0.0;
  double position = 0.0, speed = 0.0;  ///< at the start
};
inline BodyScene impact_oscillator(const ImpactOscillator& at) {
  using namespace carom::planar;
  BodyScene scene;
  scene.system.add(HalfPlane{.point = {at.wall, 0.0}, .normal = {-1.0, 0.0}},
                   carom::Surface{.friction = 0.0, .normal_restitution = at.restitution}, "stop");
  scene.body = scene.system.add(
      Particle{.mass = 1.0, .position = {at.position, 0.0}, .velocity = {at.speed, 0.0}}, "mass");
  // Of no free length: linear, and without force across its line.
  scene.system.add(SpringDamper{.from = {carom::ground, {0.0, 0.0}}, .to = scene.body, .stiffness = 1.0});
  scene.system.add(AppliedForce{.on = scene.body, .force = [=](double t) {
                                  return carom::Vec<2>(at.force * std::cos(at.frequency * t), 0.0);
                                }});
  return scene;
}

/// A table y = A sin(w t + phase), a ball above it.
struct VibratingTable {
  double amplitude = 0.0, frequency = 0.0, phase = 0.0;  ///< A [m], w [rad/s], [rad]
  double restitution = 0.0;
  double height = 0.0, speed = 0.0;  ///< of the ball at the start, upwards
};
inline BodyScene vibrating_table(const VibratingTable& at) {
  using namespace carom::planar;
  using carom::Vec;
  const double size = at.amplitude, w = at.frequency, phase = at.phase;
  BodyScene scene = scene_with_gravity();
  scene.system.add(
      HalfPlane{
          .normal = {0.0, 1.0},
          .motion = {.displacement = [=](double t) { return Vec<2>(0.0, size * std::sin(w * t + phase)); },
                     .velocity = [=](double t) { return Vec<2>(0.0, size * w * std::cos(w * t + phase)); },
                     .acceleration =
                         [=](double t) { return Vec<2>(0.0, -size * w * w * std::sin(w * t + phase)); }}},
      carom::Surface{.friction = 0.0, .normal_restitution = at.restitution}, "table");
  scene.body = scene.system.add(
      Particle{.mass = 1.0, .position = {0.0, at.height}, .velocity = {0.0, at.speed}}, "ball");
  return scene;
}

/// A body of which one point touches the floor at the start and approaches, without gravity: one impact.
inline BodyScene struck_point(const carom::MassProperties<2>& mass, const carom::Vec<2>& point,
                              const carom::Surface& surface, const carom::Vec<2>& velocity) {
  using namespace carom::planar;
  BodyScene scene;
  scene.system.add(HalfPlane{.normal = {0.0, 1.0}}, surface, "floor");
  scene.body =
      scene.system.add(RigidBody{.mass = mass, .position = {0.0, -point[1]}, .velocity = velocity}, "body");
  scene.system.add(Point{.body = scene.body, .position = point});
  return scene;
}

}  // namespace scenes
