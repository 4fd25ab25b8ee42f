#include <carom/bodies/particle.h>
#include <carom/core/assembly.h>
#include <carom/core/system.h>

#include "tests/model_error.h"
#include "tests/random.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace {

using namespace carom;

constexpr double epsilon = std::numeric_limits<double>::epsilon();
constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

template <class D>
class ParticleTest : public testing::Test {
protected:
  static constexpr int dimension = D::value;
  using Body = generic::Particle<dimension>;
};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(ParticleTest, Dimensions);

TYPED_TEST(ParticleTest, DefaultsToNoMassAndContact) {
  const typename TestFixture::Body particle;
  EXPECT_TRUE(std::isnan(particle.mass));
  EXPECT_TRUE(particle.contact);
  EXPECT_FALSE(particle.material.valid());
}

TYPED_TEST(ParticleTest, StartsWhereItWasDescribed) {
  constexpr int D = TestFixture::dimension;
  carom_test::Random random(61);
  System system;
  std::vector<typename TestFixture::Body> particles;
  for (int i = 0; i < 5; ++i) {
    particles.push_back({.mass = 1.0 + i, .position = random.vec<D>(), .velocity = random.vec<D>()});
    system.add(particles.back());
  }
  const Assembly assembly(system);
  const State state = assembly.initial_state();
  const std::vector<BodyId> ids = system.bodies();
  for (std::size_t i = 0; i < 5; ++i) {
    EXPECT_EQ(Vec<D>(state.position(ids[i])), particles[i].position);
    EXPECT_EQ(Vec<D>(state.velocity(ids[i])), particles[i].velocity);
    const BodySlot slot = assembly.layout()->bodies()[i];
    EXPECT_EQ(assembly.body_kinds()[slot.kind]->mass(slot.slot), particles[i].mass);
  }
  EXPECT_EQ(assembly.length_scales(), std::vector<double>(5 * D, 1.0));
}

TYPED_TEST(ParticleTest, MassAndItsInverseWorkOnARange) {
  constexpr int D = TestFixture::dimension;
  System system;
  for (const double mass : {1.0, 2.0, 4.0, 8.0}) system.add(typename TestFixture::Body{.mass = mass});
  const Assembly assembly(system);
  const BodyKind& kind = *assembly.body_kinds()[0];
  const std::vector<double> v(2 * D, 3.0);
  std::vector<double> p(2 * D), a(2 * D);
  kind.apply_mass({1, 3}, v.data(), p.data());
  kind.apply_inverse_mass({1, 3}, v.data(), a.data());
  for (int i = 0; i < D; ++i) {
    const auto first = static_cast<std::size_t>(i), second = static_cast<std::size_t>(i + D);
    EXPECT_EQ(p[first], 6.0);
    EXPECT_EQ(p[second], 12.0);
    EXPECT_EQ(a[first], 1.5);
    EXPECT_EQ(a[second], 0.75);
  }
  EXPECT_EQ(kind.kinetic_energy({1, 3}, v.data()), 0.5 * (2.0 + 4.0) * 9.0 * D);
}

TYPED_TEST(ParticleTest, KineticEnergyIsHalfMomentumTimesVelocity) {
  constexpr int D = TestFixture::dimension;
  carom_test::Random random(62);
  System system;
  for (int i = 0; i < 50; ++i) {
    system.add(typename TestFixture::Body{.mass = random.uniform(0.1, 10.0), .velocity = random.vec<D>()});
  }
  const Assembly assembly(system);
  const State state = assembly.initial_state();
  const BodyKind& kind = *assembly.body_kinds()[0];
  std::vector<double> p(state.v.size());
  kind.apply_mass({0, 50}, state.v.data(), p.data());
  double half = 0.0;
  for (std::size_t i = 0; i < p.size(); ++i) half += 0.5 * p[i] * state.v[i];
  EXPECT_NEAR(kind.kinetic_energy({0, 50}, state.v.data()), half, 50 * epsilon * half);
}

TYPED_TEST(ParticleTest, AdvancesByAddition) {
  constexpr int D = TestFixture::dimension;
  System system;
  for (int i = 0; i < 2; ++i) system.add(typename TestFixture::Body{.mass = 1.0});
  const Assembly assembly(system);
  const std::vector<double> q0(2 * D, 1.5), delta(2 * D, 0.25);
  std::vector<double> q1(2 * D);
  assembly.body_kinds()[0]->advance({0, 2}, q0.data(), delta.data(), q1.data());
  EXPECT_EQ(q1, std::vector<double>(2 * D, 1.75));
}

TYPED_TEST(ParticleTest, TellsOfItsContactPoint) {
  System system;
  const MaterialId rubber = system.material("rubber");
  system.add(typename TestFixture::Body{.mass = 1.0, .material = rubber});
  system.add(typename TestFixture::Body{.mass = 1.0, .contact = false});
  const BodyKind& kind = *system.body_kinds().entries()[0].kind;
  EXPECT_TRUE(kind.has_contact_point(0));
  EXPECT_EQ(kind.material(0), rubber);
  EXPECT_FALSE(kind.has_contact_point(1));
  EXPECT_FALSE(kind.has_orientation());
  EXPECT_EQ(kind.label(), "particle");
}

TYPED_TEST(ParticleTest, RefusesImpossibleNumbersByName) {
  constexpr int D = TestFixture::dimension;
  using Particle = typename TestFixture::Body;
  System system;
  EXPECT_MODEL_ERROR(system.add(Particle{}, "dot"), "particle 'dot'", "mass is nan kg", "finite and > 0");
  for (const double bad : {0.0, -3.0, nan, infinity}) {
    EXPECT_MODEL_ERROR(system.add(Particle{.mass = bad}), "particle #0", "mass is " + to_text(bad) + " kg");
  }
  for (const double bad : {nan, infinity, -infinity}) {
    for (int i = 0; i < D; ++i) {
      Particle particle{.mass = 1.0};
      particle.position[i] = bad;
      EXPECT_MODEL_ERROR(system.add(particle), "particle #0", "position is " + to_text(bad) + " m", "finite");
      particle = {.mass = 1.0};
      particle.velocity[i] = bad;
      EXPECT_MODEL_ERROR(system.add(particle), "particle #0", "velocity is " + to_text(bad) + " m/s",
                         "finite");
    }
  }
  System other;
  EXPECT_MODEL_ERROR(system.add(Particle{.mass = 1.0, .material = other.material("rubber")}), "particle #0",
                     "material is unknown", "a material of this system");
  EXPECT_TRUE(system.bodies().empty());
}

}  // namespace
