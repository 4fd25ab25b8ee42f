#include <carom/carom.h>
#include <carom/core/assembly.h>

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <string>
#include <vector>

namespace {

using namespace carom;
using namespace carom::planar;

constexpr double g = 9.81;

std::vector<VibrationMode> modes_of(const System& system) {
  const Assembly assembly(system);
  return find_modes(assembly, find_equilibrium(assembly, assembly.initial_state()).state);
}

// Uniform links with the angles t_k from the vertical: centre i is displaced by l (t_0 + ... + t_(i-1) +
// t_i/2). With n_j links beyond link j the Lagrangian gives M_ij = m l^2 (n_j + 1/2) for i < j, M_ii = m l^2
// (n_i + 1/3), K_ii = m g l (n_i + 1/2).
TEST(Modes, HangingChainOfPinnedRods) {
  constexpr int links = 12;
  constexpr double mass = 0.8, length = 0.6;
  System system;
  system.add(Gravity{{0.0, -g}});
  BodyId before;
  for (int i = 0; i < links; ++i) {
    const BodyId link = system.add(RigidBody{
        .mass = rod(mass, length), .position = {0.0, -length * (i + 0.5)}, .angle = -0.5 * std::numbers::pi});
    const End<2> end = i == 0 ? End<2>(ground) : End<2>(before, {0.5 * length, 0.0});
    system.add(Revolute{.from = end, .to = {link, {-0.5 * length, 0.0}}});
    before = link;
  }
  Eigen::MatrixXd inertia(links, links), stiffness = Eigen::MatrixXd::Zero(links, links);
  for (int i = 0; i < links; ++i) {
    for (int j = 0; j < links; ++j) {
      const int beyond = links - 1 - std::max(i, j);
      inertia(i, j) = mass * length * length * (beyond + (i == j ? 1.0 / 3.0 : 0.5));
    }
    stiffness(i, i) = mass * g * length * (links - 1 - i + 0.5);
  }
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> reference(stiffness, inertia);
  const std::vector<VibrationMode> modes = modes_of(system);
  ASSERT_EQ(modes.size(), static_cast<std::size_t>(links));
  for (int i = 0; i < links; ++i) {
    const double expected = std::sqrt(reference.eigenvalues()[i]);
    const VibrationMode& mode = modes[static_cast<std::size_t>(i)];
    EXPECT_NEAR(mode.frequency() / expected, 1.0, 1e-9) << i;
    EXPECT_EQ(mode.eigenvalue.real(), 0.0);
    // The angles of the links, up to the sign.
    Eigen::VectorXd angles(links);
    for (int k = 0; k < links; ++k) angles[k] = mode.shape[3 * k + 2].real();
    const Eigen::VectorXd shape = reference.eigenvectors().col(i);
    const double sign = angles.dot(shape) > 0.0 ? 1.0 : -1.0;
    EXPECT_LT((sign * angles - shape).norm(), 1e-8 * shape.norm()) << i;
  }
}

// Along the spring sqrt(k/m), across it a pendulum of the stretched length.
TEST(Modes, MassOnASpring) {
  constexpr double mass = 1.7, k = 90.0, free_length = 0.9;
  System system;
  system.add(Gravity{{0.0, -g}});
  const BodyId body = system.add(Particle{.mass = mass, .position = {0.0, -1.0}});
  system.add(SpringDamper{.from = ground, .to = body, .stiffness = k, .free_length = free_length});
  const std::vector<VibrationMode> modes = modes_of(system);
  ASSERT_EQ(modes.size(), 2U);
  EXPECT_NEAR(modes[0].frequency(), std::sqrt(g / (free_length + mass * g / k)), 1e-9);
  EXPECT_NEAR(modes[1].frequency(), std::sqrt(k / mass), 1e-9);
  EXPECT_NEAR(modes[1].shape[1].real(), 1.0 / std::sqrt(mass), 1e-12);
}

System sliders(double friction) {
  System system;
  system.add(Gravity{{0.0, -g}});
  system.add(HalfPlane{.normal = {0.0, 1.0}}, Surface{.friction = friction, .normal_restitution = 0.0});
  const BodyId slider = system.add(Particle{.mass = 2.0}, "slider");
  const BodyId mass = system.add(Particle{.mass = 0.5, .position = {1.0, 1.0}, .contact = false});
  const BodyId carriage =
      system.add(RigidBody{.mass = {.mass = 0.5, .inertia = 1.0}, .position = {1.0, 1.0}});
  system.add(Revolute{.from = carriage, .to = mass});
  system.add(Prismatic{.from = {ground, {0.0, 1.0}}, .to = carriage, .axis = {1.0, 0.0}});
  system.add(SpringDamper{.from = slider, .to = mass, .stiffness = 50.0, .free_length = std::sqrt(2.0)});
  return system;
}

// A slider on the floor and a mass above it on a guide, a spring between them under 45 degrees. Sticking, the
// slider is ground; without friction both move against each other, and together.
TEST(Modes, SliderOnASpring) {
  const std::vector<VibrationMode> stuck = modes_of(sliders(0.3));
  ASSERT_EQ(stuck.size(), 1U);
  EXPECT_NEAR(stuck[0].frequency(), std::sqrt(0.5 * 50.0 / 1.0), 1e-9);
  EXPECT_LT(std::abs(stuck[0].shape[0]), 1e-14);

  const System loose = sliders(0.0);
  const Assembly assembly(loose);
  const std::vector<VibrationMode> sliding = find_modes(assembly, assembly.initial_state());
  ASSERT_EQ(sliding.size(), 2U);
  EXPECT_EQ(sliding[0].frequency(), 0.0);
  EXPECT_NEAR(sliding[1].frequency(), std::sqrt(0.5 * 50.0 * (1.0 / 1.0 + 1.0 / 2.0)), 1e-9);
}

TEST(Modes, StickingWheelOnASpring) {
  constexpr double mass = 1.5, radius = 0.4, k = 60.0;
  System system;
  system.add(Gravity{{0.0, -g}});
  system.add(HalfPlane{.normal = {0.0, 1.0}}, Surface{.friction = 0.5, .normal_restitution = 0.0});
  const BodyId wheel = system.add(RigidBody{.mass = disc(mass, radius), .position = {1.0, radius}});
  system.add(Disc{.body = wheel, .radius = radius});
  system.add(SpringDamper{.from = {ground, {0.0, radius}}, .to = wheel, .stiffness = k, .free_length = 1.0});
  const std::vector<VibrationMode> modes = modes_of(system);
  ASSERT_EQ(modes.size(), 1U);
  EXPECT_NEAR(modes[0].frequency(), std::sqrt(k / (1.5 * mass)), 1e-9);
}

// A rod that stands on a sticking end, held by a spring at its top: the normal force takes stiffness away.
TEST(Modes, StickingRodWithASpringAtItsTop) {
  constexpr double mass = 2.0, length = 1.2, k = 40.0;
  System system;
  system.add(Gravity{{0.0, -g}});
  system.add(HalfPlane{.normal = {0.0, 1.0}}, Surface{.friction = 0.5, .normal_restitution = 0.0});
  const BodyId body = system.add(
      RigidBody{.mass = rod(mass, length), .position = {0.0, 0.5 * length}, .angle = 0.5 * std::numbers::pi});
  system.add(Point{.body = body, .position = {-0.5 * length, 0.0}});
  system.add(SpringDamper{.from = {ground, {-1.0, length}},
                          .to = {body, {0.5 * length, 0.0}},
                          .stiffness = k,
                          .free_length = 1.0});
  const std::vector<VibrationMode> modes = modes_of(system);
  ASSERT_EQ(modes.size(), 1U);
  const double inertia = mass * length * length / 3.0;
  EXPECT_NEAR(modes[0].frequency(), std::sqrt((k * length * length - 0.5 * mass * g * length) / inertia),
              1e-9);
}

TEST(Modes, InvertedPendulumGrows) {
  System system;
  system.add(Gravity{{0.0, -g}});
  const BodyId body =
      system.add(RigidBody{.mass = rod(1.0, 1.0), .position = {0.0, 0.5}, .angle = 0.5 * std::numbers::pi});
  system.add(Revolute{.from = ground, .to = {body, {-0.5, 0.0}}});
  const std::vector<VibrationMode> modes = modes_of(system);
  ASSERT_EQ(modes.size(), 1U);
  EXPECT_NEAR(modes[0].eigenvalue.real(), std::sqrt(1.5 * g), 1e-9);
  EXPECT_EQ(modes[0].frequency(), 0.0);
  EXPECT_EQ(modes[0].damping_ratio(), -1.0);
}

TEST(Modes, DampedOscillators) {
  constexpr double mass = 2.0, k = 50.0;
  for (const double c : {3.0, 60.0}) {  // oscillates; creeps
    System system;
    system.add(Gravity{{0.0, -g}});
    const BodyId body = system.add(Particle{.mass = mass, .position = {0.0, -1.4}});
    system.add(SpringDamper{.from = ground, .to = body, .stiffness = k, .damping = c, .free_length = 1.0});
    const std::vector<VibrationMode> modes = modes_of(system);
    const double side = std::sqrt(g / (1.0 + mass * g / k));
    const std::complex<double> root =
        std::sqrt(std::complex<double>(0.25 * c * c / (mass * mass) - k / mass));
    std::vector<std::complex<double>> expected{{0.0, side}, -0.5 * c / mass + root};
    if (c > 20.0) expected.push_back(-0.5 * c / mass - root);
    ASSERT_EQ(modes.size(), expected.size());
    for (const std::complex<double>& value : expected) {
      EXPECT_TRUE(std::any_of(modes.begin(), modes.end(), [&](const VibrationMode& mode) {
        return std::abs(mode.eigenvalue - value) < 1e-9;
      })) << value;
    }
    for (const VibrationMode& mode : modes) {
      EXPECT_NEAR(mass * mode.shape.squaredNorm(), 1.0, 1e-12);
      if (c < 20.0 && mode.damping_ratio() > 1e-6) {
        EXPECT_NEAR(mode.damping_ratio(), 0.5 * c / std::sqrt(k * mass), 1e-9);
      }
    }
  }
}

TEST(Modes, RefuseWhatIsNotAtRest) {
  System system;
  system.add(Gravity{{0.0, -g}});
  const BodyId body = system.add(Particle{.mass = 1.0, .position = {0.0, -1.0}}, "bob");
  system.add(SpringDamper{.from = ground, .to = body, .stiffness = 50.0, .free_length = 1.0});
  const Assembly assembly(system);
  const auto message = [&](const State& state) -> std::string {
    try {
      static_cast<void>(linearise(assembly, state));
    } catch (const ModelError& error) {
      return error.what();
    }
    return {};
  };
  State state = assembly.initial_state();
  EXPECT_NE(message(state).find("'bob' is out of balance by 9.81"), std::string::npos) << message(state);
  state.velocity(body)[0] = 0.5;
  EXPECT_NE(message(state).find("'bob' moves"), std::string::npos) << message(state);
}

}  // namespace
