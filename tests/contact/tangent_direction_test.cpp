// Direction of slip by tangential row: the sign of the plane, a unit vector in space. Sliding friction
// opposes slip with the size mu N and the power -mu N |slip|.

#include "tests/random.h"

#include <carom/contact/active_contact.h>
#include <carom/contact/delassus.h>
#include <carom/contact/tangent_direction.h>
#include <carom/core/constraint.h>

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

namespace {

using namespace carom;
using carom_test::Random;

/// Makes a contact of a particle: as many rows as the space has dimensions, at right angles and oblique.
void write_contact(int dimension, Constraint& out) {
  out.add_body(0, 0, dimension);
  out.start_rows(dimension);
  const std::array<double, 9> in_space{2.0 / 3, 2.0 / 3, 1.0 / 3,  -2.0 / 3, 1.0 / 3,
                                       2.0 / 3, 1.0 / 3, -2.0 / 3, 2.0 / 3};
  const std::array<double, 4> in_plane{0.6, 0.8, 0.8, -0.6};
  for (int row = 0; row < dimension; ++row) {
    for (int c = 0; c < dimension; ++c) {
      const auto at = static_cast<std::size_t>(dimension * row + c);
      out.row(row)[c] = dimension == 3 ? in_space[at] : in_plane[at];
    }
  }
}

TEST(TangentDirection, IsASignInThePlane) {
  EXPECT_EQ(TangentDirection::of({3.5, 0.0}).along, (TangentDirection::Numbers{1.0, 0.0}));
  EXPECT_EQ(TangentDirection::of({-5e-324, 0.0}).along, (TangentDirection::Numbers{-1.0, 0.0}));
  EXPECT_TRUE(TangentDirection::of({0.0, 0.0}).is_zero());
  EXPECT_TRUE(TangentDirection::of_sign(-0.0).is_zero());
  for (const ContactMode mode : {ContactMode::slip_positive, ContactMode::slip_negative, ContactMode::stick})
    EXPECT_EQ(TangentDirection::of_mode(mode).mode(1), mode);
  EXPECT_TRUE(TangentDirection::of_mode(ContactMode::open).is_zero());
}

TEST(TangentDirection, IsAUnitVectorInSpace) {
  Random random(3);
  for (int trial = 0; trial < 100; ++trial) {
    const TangentDirection::Numbers slip{random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0)};
    const TangentDirection direction = TangentDirection::of(slip);
    const double length = std::hypot(slip[0], slip[1]);
    EXPECT_NEAR(std::hypot(direction[0], direction[1]), 1.0, 1e-15);
    EXPECT_NEAR(direction[0] * slip[0] + direction[1] * slip[1], length, 1e-15);
    EXPECT_EQ(direction.mode(2), ContactMode::slip);
  }
  EXPECT_EQ(TangentDirection::of({0.0, -2.0}).along, (TangentDirection::Numbers{0.0, -1.0}));
  EXPECT_EQ(TangentDirection{}.mode(2), ContactMode::stick);
}

TEST(TangentDirection, LimitsHaveNone) {
  SingleConstraint limit;
  limit.add_body(0, 0, 3);
  limit.start_rows(1);
  const std::array<double, 3> numbers{1.0, 2.0, 3.0};
  EXPECT_EQ(velocity_along(limit, TangentDirection::of_sign(1.0), numbers.data()), 0.0);
  EXPECT_EQ(acceleration_along(limit, TangentDirection::of_sign(1.0), numbers.data()), 0.0);
}

/// Slips of a contact in a direction; the force and its power against closed forms.
void expect_friction_opposes_slip(int dimension, const std::vector<double>& velocity) {
  constexpr double mu = 0.3, normal = 7.0;
  ActiveContact contact;
  write_contact(dimension, contact.at);
  TangentDirection::Numbers slip{};
  for_tangents(contact.at,
               [&](std::size_t k, int row) { slip[k] = contact.at.velocity(row, velocity.data()); });
  const double speed = std::hypot(slip[0], slip[1]);
  ASSERT_GT(speed, 0.1);
  contact.direction_in_space = TangentDirection::of(slip);
  contact.mode = contact.direction_in_space.mode(contact.at.tangents());
  contact.friction = mu;
  contact.normal = normal;
  contact.set_sliding_friction();

  EXPECT_EQ(contact.slip_direction().along, TangentDirection::of(slip).along);
  EXPECT_NEAR(velocity_along(contact.at, contact.slip_direction(), velocity.data()), speed, 1e-15);
  EXPECT_NEAR(contact.tangential_force(), mu * normal, 1e-15);
  double power = 0.0;
  for (std::size_t k = 0; k < slip.size(); ++k) {
    EXPECT_NEAR(contact.tangential[k], -mu * normal * slip[k] / speed, 1e-15);
    EXPECT_EQ(contact.friction_ratio(k), -contact.slip_direction()[k] * mu);
    power += contact.tangential[k] * slip[k];
  }
  EXPECT_NEAR(power, -mu * normal * speed, 1e-14);
  // As loads on the body: the normal force does no work along the tangents.
  std::vector<double> loads(velocity.size(), 0.0);
  contact.add_force(loads.data());
  double of_loads = 0.0;
  for (std::size_t i = 0; i < loads.size(); ++i) of_loads += loads[i] * velocity[i];
  EXPECT_NEAR(of_loads, power + normal * contact.at.normal_velocity(velocity.data()), 1e-14);
}

TEST(ActiveContact, FrictionOpposesSlip) {
  expect_friction_opposes_slip(2, {1.0, 0.5});
  expect_friction_opposes_slip(2, {-1.0, 0.5});
  expect_friction_opposes_slip(3, {1.0, -0.5, 0.25});
  expect_friction_opposes_slip(3, {-0.2, 0.1, 2.0});
}

TEST(ActiveContact, HasNoDirectionWhereItSticks) {
  ActiveContact contact;
  write_contact(3, contact.at);
  contact.direction_in_space = TangentDirection::of({1.0, 1.0});
  contact.friction = 0.5;
  contact.normal = 2.0;
  EXPECT_TRUE(contact.slip_direction().is_zero());
  contact.set_sliding_friction();
  EXPECT_EQ(contact.tangential_force(), 0.0);
}

/// Particles in space, which answer by their mass.
class Particles final : public BodyResponse {
public:
  explicit Particles(double mass) : mass_(mass) {}
  Range reach(Index body) const override { return {3 * body, 3 * body + 3}; }
  void answer(Index, double* x, std::size_t columns, char* held) override {
    for (std::size_t i = 0; i < 3 * columns; ++i) x[i] /= mass_;
    for (std::size_t j = 0; j < columns; ++j) held[j] = 0;
  }

private:
  double mass_;
};

// The column of a contact that slips is along the edge of its cone: normal and both tangents.
TEST(ActiveContact, SlipsAlongBothTangentsInItsColumn) {
  constexpr double mass = 2.5, mu = 0.4;
  SingleConstraint at;
  write_contact(3, at);
  const TangentDirection slip = TangentDirection::of({3.0, -4.0});
  const std::array<ImpulseDirection, 3> directions{ImpulseDirection{&at, 0, {-slip[0] * mu, -slip[1] * mu}},
                                                   ImpulseDirection{&at, 1}, ImpulseDirection{&at, 2}};
  Particles particles(mass);
  Delassus delassus;
  delassus.build(directions, particles);
  std::array<double, 9> w{};
  delassus.write(w.data());
  EXPECT_NEAR(w[0], 1.0 / mass, 1e-15);
  EXPECT_NEAR(w[3], -0.6 * mu / mass, 1e-15);
  EXPECT_NEAR(w[6], 0.8 * mu / mass, 1e-15);
}

}  // namespace
