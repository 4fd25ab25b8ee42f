#pragma once

/// \file
/// Andrews' squeezing mechanism: seven rigid bodies in three loops, driven by a constant torque. Shared by
/// the example and the tests. Geometry and numbers: E. Hairer and G. Wanner, Solving Ordinary Differential
/// Equations II, section VII.7; start: the test set for initial value problems, "Andrews' squeezing
/// mechanism".

#include <carom/carom.h>

#include <array>
#include <cmath>
#include <vector>

namespace scenes {

/// The angles beta, Theta, gamma, Phi, delta, Omega, epsilon at the start [rad]; rates are zero.
inline constexpr std::array squeezer_start{
    -0.0617138900142764496358948458001, 0.0,
    0.455279819163070380255912382449,   0.222668390165885884674473185609,
    0.487364979543842550225598953530,   -0.222668390165885884674473185609,
    1.23054744454982119249735015568};

/// Masses of the bodies K1 to K7 [kg] and their moments of inertia [kg m^2].
inline constexpr std::array squeezer_masses{0.04325, 0.00365, 0.02373, 0.00706, 0.0705, 0.00706, 0.05498};
inline constexpr std::array squeezer_inertias{2.194e-6, 4.41e-7,  5.255e-6, 5.667e-7,
                                              1.169e-5, 5.667e-7, 1.912e-5};
inline constexpr double squeezer_torque = 0.033;  ///< on K1 [N m]

/// A body of the mechanism with the points that make it out: its joints, in its own frame [m].
struct SqueezerBody {
  carom::BodyId id;
  std::vector<carom::Vec<2>> points;
};

/// The whole mechanism; returns K1 to K7.
inline std::vector<SqueezerBody> add_squeezer(carom::System& system) {
  using namespace carom;
  using namespace carom::planar;
  constexpr double d = 0.028, da = 0.0115, e = 0.02, ea = 0.01421, rr = 0.007, ra = 0.00092, ss = 0.035,
                   sa = 0.01874, sb = 0.01043, sc = 0.018, sd = 0.02, ta = 0.02308, tb = 0.00916, u = 0.04,
                   ua = 0.01228, ub = 0.00449, zf = 0.02, zt = 0.04, fa = 0.01421;
  const Vec<2> a(-0.06934, -0.00227), b(-0.03635, 0.03273), c(0.014, 0.072);
  const auto [beta, theta, gamma, phi, delta, omega, epsilon] = squeezer_start;

  std::vector<SqueezerBody> bodies;
  // A body by the place of one of its points.
  const auto add = [&](const char* name, double angle, const Vec<2>& point, const Vec<2>& at,
                       std::vector<Vec<2>> outline) {
    const std::size_t i = bodies.size();
    const Vec<2> turned(std::cos(angle) * point[0] - std::sin(angle) * point[1],
                        std::sin(angle) * point[0] + std::cos(angle) * point[1]);
    const MassProperties<2> mass{.mass = squeezer_masses[i], .inertia = squeezer_inertias[i]};
    bodies.push_back({system.add(RigidBody{.mass = mass, .position = at - turned, .angle = angle}, name),
                      std::move(outline)});
    return bodies.back().id;
  };
  const auto along = [](double angle) { return Vec<2>(std::cos(angle), std::sin(angle)); };
  const auto across = [](double angle) { return Vec<2>(-std::sin(angle), std::cos(angle)); };

  const BodyId k1 = add("K1", beta, {-ra, 0.0}, {0.0, 0.0}, {{-ra, 0.0}, {rr - ra, 0.0}});
  const BodyId k2 = add("K2", beta + theta, {da, 0.0}, rr * along(beta), {{da, 0.0}, {da - d, 0.0}});
  const BodyId k3 = add("K3", gamma, {-sb, sa}, b, {{-sb, sa - ss}, {-sb, sa}, {sd - sb, sa - sc}});
  const BodyId k4 = add("K4", phi + delta, {0.0, e - ea}, a + zt * along(delta), {{0.0, -ea}, {0.0, e - ea}});
  const BodyId k5 = add("K5", delta, {-ta, -tb}, a, {{-ta, -tb}, {zt - ta, -tb}});
  const BodyId k6 =
      add("K6", omega + epsilon, {fa - zf, 0.0}, a - u * across(epsilon), {{fa, 0.0}, {fa - zf, 0.0}});
  const BodyId k7 = add("K7", epsilon, {ub, ua}, a, {{ub, ua}, {ub, ua - u}});

  const End<2> common(k2, {da - d, 0.0});
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
  system.add(SpringDamper{
      .from = {ground, c}, .to = {k3, {sd - sb, sa - sc}}, .stiffness = 4530.0, .free_length = 0.07785});
  system.add(AppliedTorque{.on = k1, .torque = [](double) { return squeezer_torque; }});
  return bodies;
}

/// The angles of the literature from those of the bodies: beta, Theta, gamma, Phi, delta, Omega, epsilon.
inline std::array<double, 7> squeezer_angles(const std::array<double, 7>& k) {
  return {k[0], k[1] - k[0], k[2], k[3] - k[4], k[4], k[5] - k[6], k[6]};
}

}  // namespace scenes
