#pragma once

// Mechanisms with known motions, in absolute coordinates, and a check of how well a run obeys its joints.

#include "examples/scenes/squeezer.h"
#include "tests/reference/reference_data.h"

#include <carom/carom.h>
#include <carom/core/assembly.h>
#include <carom/core/dynamics/joint_constraints.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <string>
#include <vector>

namespace joint_scenes {

using namespace carom;
using namespace carom::planar;

inline constexpr double g = 9.81;
inline constexpr double quarter = 0.5 * std::numbers::pi;

/// A system and bodies of it to look at.
struct Scene {
  System system;
  std::vector<BodyId> bodies;
};

/// A particle on a rod of 1 m, starting level at rest (IFToMM A01, mirrored).
inline Scene particle_pendulum() {
  Scene scene;
  scene.system.add(Gravity{{0.0, -g}});
  scene.bodies.push_back(scene.system.add(Particle{.mass = 1.0, .position = {1.0, 0.0}}, "bob"));
  scene.system.add(Rod{.from = ground, .to = scene.bodies[0]}, "rod");
  return scene;
}

/// Uniform rods of 1 kg and 1 m, pinned to the origin and to each other, starting level at rest.
inline Scene rod_pendulum(int links) {
  Scene scene;
  scene.system.add(Gravity{{0.0, -g}});
  for (int i = 0; i < links; ++i) {
    const BodyId link = scene.system.add(RigidBody{.mass = rod(1.0, 1.0), .position = {i + 0.5, 0.0}});
    const End<2> before = i == 0 ? End<2>(ground) : End<2>(scene.bodies.back(), {0.5, 0.0});
    scene.system.add(Revolute{.from = before, .to = {link, {-0.5, 0.0}}});
    scene.bodies.push_back(link);
  }
  return scene;
}

/// The slider-crank of smooth_planar.json: crank, connecting rod, slider.
inline Scene slider_crank() {
  const auto data = carom_test::reference_data("smooth_planar.json").at("slider_crank");
  const auto number = [&](const char* name) { return data.at("parameters").at(name).get<double>(); };
  const double l1 = number("l1"), l2 = number("l2");
  const double crank_speed = data.at("initial").at("crank_speed").get<double>();
  const double rod_speed = data.at("initial").at("rod_speed").get<double>();
  Scene scene;
  System& system = scene.system;
  system.add(Gravity{{0.0, -number("g")}});
  const BodyId crank = system.add(RigidBody{.mass = {.mass = number("m1"), .inertia = number("J1")},
                                            .position = {0.5 * l1, 0.0},
                                            .velocity = {0.0, 0.5 * l1 * crank_speed},
                                            .spin = crank_speed},
                                  "crank");
  const BodyId link = system.add(RigidBody{.mass = {.mass = number("m2"), .inertia = number("J2")},
                                           .position = {l1 + 0.5 * l2, 0.0},
                                           .velocity = {0.0, l1 * crank_speed + 0.5 * l2 * rod_speed},
                                           .spin = rod_speed},
                                 "connecting rod");
  const BodyId slider = system.add(
      RigidBody{.mass = {.mass = number("m3"), .inertia = 1e-4}, .position = {l1 + l2, 0.0}}, "slider");
  system.add(Revolute{.from = ground, .to = {crank, {-0.5 * l1, 0.0}}}, "main bearing");
  system.add(Revolute{.from = {crank, {0.5 * l1, 0.0}}, .to = {link, {-0.5 * l2, 0.0}}}, "crank pin");
  system.add(Revolute{.from = {link, {0.5 * l2, 0.0}}, .to = slider}, "wrist pin");
  system.add(Prismatic{.from = ground, .to = slider, .axis = {1.0, 0.0}}, "guide");
  scene.bodies = {crank, link, slider};
  return scene;
}

/// Rods of 1 kg and 1 m upright on the ground, 1 m apart, their tops joined by such rods (IFToMM A02). Where
/// all are in line, rows depend on each other and the motion could branch. The uprights turn clockwise at
/// 1 rad/s. Bodies: the uprights, then the level ones.
inline Scene windows(int number) {
  Scene scene;
  System& system = scene.system;
  system.add(Gravity{{0.0, -g}});
  for (int i = 0; i <= number; ++i) {
    scene.bodies.push_back(system.add(RigidBody{.mass = rod(1.0, 1.0),
                                                .position = {i + 0.0, 0.5},
                                                .angle = quarter,
                                                .velocity = {0.5, 0.0},
                                                .spin = -1.0}));
    system.add(Revolute{.from = {ground, {i + 0.0, 0.0}}, .to = {scene.bodies.back(), {-0.5, 0.0}}});
  }
  for (int i = 0; i < number; ++i) {
    const auto left = static_cast<std::size_t>(i);
    const BodyId level =
        system.add(RigidBody{.mass = rod(1.0, 1.0), .position = {i + 0.5, 1.0}, .velocity = {1.0, 0.0}});
    system.add(Revolute{.from = {scene.bodies[left], {0.5, 0.0}}, .to = {level, {-0.5, 0.0}}});
    system.add(Revolute{.from = {level, {0.5, 0.0}}, .to = {scene.bodies[left + 1], {0.5, 0.0}}});
    scene.bodies.push_back(level);
  }
  return scene;
}

/// Andrews' squeezing mechanism, K1 to K7.
inline Scene squeezing_mechanism() {
  Scene scene;
  for (const scenes::SqueezerBody& body : scenes::add_squeezer(scene.system)) scene.bodies.push_back(body.id);
  return scene;
}

/// The angles (or rates) of the reference from those of the bodies: beta, Theta, gamma, Phi, delta, Omega,
/// epsilon.
inline std::vector<double> relative(const std::array<double, 7>& k) {
  const std::array<double, 7> angles = scenes::squeezer_angles(k);
  return {angles.begin(), angles.end()};
}

/// Follows a run: the largest violations of its joints at the ends of steps.
struct JointCheck {
  double gap = 0.0, speed = 0.0;

  JointCheck() = default;
  explicit JointCheck(Simulation& simulation) {
    simulation.observe([this](const Simulation& now) { look(now); });
  }
  void look(const Simulation& now) {
    const Assembly& assembly = now.assembly();
    if (joints_.empty()) {
      evaluation_ = make_evaluation(assembly);
      for (Index component = 0; component < assembly.components().size(); ++component) {
        joints_.emplace_back(assembly, component);
      }
    }
    for (Index component = 0; component < assembly.components().size(); ++component) {
      evaluate_positions(assembly, component, now.state().view(), evaluation_);
      joints_[component].update({now.state().view(), evaluation_.rotation.data()});
      for (std::size_t i = 0; i < joints_[component].size(); ++i) {
        const JointRow row = joints_[component].row(i);
        gap = std::max(gap, std::abs(row.gap));
        speed = std::max(speed, std::abs(residual(JointLevel::velocity, row, now.state().v.data())));
      }
    }
  }

private:
  std::vector<JointConstraints> joints_;  // by component
  Evaluation evaluation_;
};

}  // namespace joint_scenes
