#pragma once

// Mechanisms with known motions, in absolute coordinates, and a check of how well a run obeys its joints.

#include "tests/reference/reference_data.h"

#include <carom/carom.h>

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

/// Andrews' squeezing mechanism (Hairer and Wanner, Solving Ordinary Differential Equations II, VII.7): seven
/// bodies, whose angles are those of q_angles().
inline Scene squeezing_mechanism() {
  const auto data = carom_test::reference_data("andrews.json");
  const auto& p = data.at("parameters");
  const auto number = [&](const char* name) { return p.at(name).get<double>(); };
  std::vector<double> q;
  for (const auto& text : data.at("q0")) q.push_back(std::stod(text.get<std::string>()));
  const double beta = q[0], theta = q[1], gamma = q[2], phi = q[3], delta = q[4], omega = q[5],
               epsilon = q[6];
  const Vec<2> a(number("xa"), number("ya")), b(number("xb"), number("yb")), c(number("xc"), number("yc"));
  const double da = number("da"), ea = number("ea"), e = number("e"), d = number("d"), rr = number("rr"),
               ra = number("ra"), sa = number("sa"), sb = number("sb"), sc = number("sc"), sd = number("sd"),
               ss = number("ss"), ta = number("ta"), tb = number("tb"), u = number("u"), ua = number("ua"),
               ub = number("ub"), zf = number("zf"), zt = number("zt"), fa = number("fa");
  Scene scene;
  System& system = scene.system;
  /// A body by the place of one of its points.
  const auto add = [&](const char* name, double angle, const Vec<2>& point, const Vec<2>& at) {
    const auto i = scene.bodies.size();
    const Vec<2> turned(std::cos(angle) * point[0] - std::sin(angle) * point[1],
                        std::sin(angle) * point[0] + std::cos(angle) * point[1]);
    scene.bodies.push_back(system.add(
        RigidBody{.mass = {.mass = p.at("m")[i].get<double>(), .inertia = p.at("I")[i].get<double>()},
                  .position = at - turned,
                  .angle = angle},
        name));
    return scene.bodies.back();
  };
  const auto along = [](double angle) { return Vec<2>(std::cos(angle), std::sin(angle)); };
  const auto across = [](double angle) { return Vec<2>(-std::sin(angle), std::cos(angle)); };
  const Vec<2> z = a + zt * along(delta), w = a - u * across(epsilon);
  const BodyId k1 = add("K1", beta, {-ra, 0.0}, Vec<2>::Zero());
  const BodyId k2 = add("K2", beta + theta, {da, 0.0}, rr * along(beta));
  const BodyId k3 = add("K3", gamma, {-sb, sa}, b);
  const BodyId k4 = add("K4", phi + delta, {0.0, e - ea}, z);
  const BodyId k5 = add("K5", delta, {-ta, -tb}, a);
  const BodyId k6 = add("K6", omega + epsilon, {fa - zf, 0.0}, w);
  const BodyId k7 = add("K7", epsilon, {ub, ua}, a);
  const End<2> common{k2, {da - d, 0.0}};
  system.add(Revolute{.from = ground, .to = {k1, {-ra, 0.0}}}, "O");
  system.add(Revolute{.from = {k1, {rr - ra, 0.0}}, .to = {k2, {da, 0.0}}}, "F");
  system.add(Revolute{.from = common, .to = {k3, {-sb, sa - ss}}}, "E with K3");
  system.add(Revolute{.from = common, .to = {k4, {0.0, -ea}}}, "E with K4");
  system.add(Revolute{.from = common, .to = {k6, {fa, 0.0}}}, "E with K6");
  system.add(Revolute{.from = {ground, b}, .to = {k3, {-sb, sa}}}, "B");
  system.add(Revolute{.from = {ground, a}, .to = {k5, {-ta, -tb}}}, "A with K5");
  system.add(Revolute{.from = {ground, a}, .to = {k7, {ub, ua}}}, "A with K7");
  system.add(Revolute{.from = {k5, {zt - ta, -tb}}, .to = {k4, {0.0, e - ea}}}, "G");
  system.add(Revolute{.from = {k7, {ub, ua - u}}, .to = {k6, {fa - zf, 0.0}}}, "H");
  system.add(SpringDamper{.from = {ground, c},
                          .to = {k3, {sd - sb, sa - sc}},
                          .stiffness = number("c0"),
                          .free_length = number("l0")});
  const double torque = number("mom");
  system.add(AppliedTorque{.on = k1, .torque = [torque](double) { return torque; }});
  return scene;
}

/// The angles (or rates) of the reference from those of the bodies: beta, Theta, gamma, Phi, delta, Omega,
/// epsilon.
inline std::vector<double> relative(const std::array<double, 7>& k) {
  return {k[0], k[1] - k[0], k[2], k[3] - k[4], k[4], k[5] - k[6], k[6]};
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
      for (Index island = 0; island < assembly.islands().size(); ++island) {
        joints_.emplace_back(assembly, island);
      }
    }
    std::vector<JointRow> rows;
    for (Index island = 0; island < assembly.islands().size(); ++island) {
      evaluate_positions(assembly, island, now.state().view(), evaluation_);
      joints_[island].evaluate({now.state().view(), evaluation_.rotation.data()}, rows);
      for (const JointRow& row : rows) {
        gap = std::max(gap, std::abs(row.gap));
        speed = std::max(speed,
                         std::abs(IslandJoints::residual(JointLevel::velocity, row, now.state().v.data())));
      }
    }
  }

private:
  std::vector<IslandJoints> joints_;  // by island
  Evaluation evaluation_;
};

}  // namespace joint_scenes
