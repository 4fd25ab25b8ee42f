// Contacts that all separate have an answer: no impulses. With strong friction on a long lever there may be
// others, as if something pulled the contact back; of several contacts too the one without impulses is taken.

#include <carom/carom.h>

#include <gtest/gtest.h>

#include <cmath>
#include <string>

namespace {

using namespace carom;
using namespace carom::planar;

Vec<2> turned(const Vec<2>& vector, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  return {c * vector[0] - s * vector[1], s * vector[0] + c * vector[1]};
}

struct Motion {
  Vec<2> place;
  double angle;
  Vec<2> velocity;
  double spin;
};

/// A point of a body on a half-plane that nothing else touches.
void add_contact(System& system, BodyId body, const Motion& at, const Vec<2>& place, const Vec<2>& normal,
                 const Surface& surface, unsigned group) {
  const std::string name = std::to_string(group);
  const auto of_point = system.material("point " + name), of_plane = system.material("plane " + name);
  system.between(of_point, of_plane, surface);
  const ContactFilter filter{.groups = group, .touches = group};
  system.add(Point{
      .body = body, .position = turned(place - at.place, -at.angle), .material = of_point, .filter = filter});
  // A little in it, so that it takes part.
  const Vec<2> n = normal.normalized();
  system.add(HalfPlane{.point = place + 1e-13 * n, .normal = n, .material = of_plane, .filter = filter});
}

// Two discs that part, each on a plane that it leaves. The second slides at 4.5 m/s before its centre: an
// impulse of 1.2 N s would stop it and push the discs apart, by the law too. Pivoting finds that answer.
TEST(SeparatingContacts, NoImpulsesAreTakenBeforeOtherAnswers) {
  const Motion first{{0.0, 0.0}, -1.15449, {0.0229036, -0.0198678}, 1.44441};
  const Motion second{{-0.240516, -0.26111}, -2.53367, {-2.67265, -0.304575}, 4.5863};
  System system;
  const auto add = [&](double mass, double inertia, const Motion& at) {
    return system.add(RigidBody{.mass = {.mass = mass, .inertia = inertia},
                                .position = at.place,
                                .angle = at.angle,
                                .velocity = at.velocity,
                                .spin = at.spin});
  };
  const BodyId a = add(2.93505, 0.795934, first), b = add(0.375811, 0.0170944, second);
  const auto of_a = system.material("a"), of_b = system.material("b");
  system.between(
      of_a, of_b,
      Surface{.friction = 0.0, .normal_restitution = 0.664224, .impact_law = ImpactLaw::energetic});
  const Vec<2> centre_a(-0.136493, 0.0535122), centre_b(-0.011495, 0.0158978);
  const double apart =
      (first.place + turned(centre_a, first.angle) - second.place - turned(centre_b, second.angle)).norm();
  constexpr double radius = 0.297855;
  system.add(Disc{.body = a,
                  .radius = radius,
                  .centre = centre_a,
                  .material = of_a,
                  .filter = {.groups = 1, .touches = 1}});
  system.add(Disc{.body = b,
                  .radius = apart - radius + 1e-13,
                  .centre = centre_b,
                  .material = of_b,
                  .filter = {.groups = 1, .touches = 1}});
  add_contact(system, a, first, {0.33747, -0.444542}, {-0.0335921, 0.999436},
              {.friction = 0.176162, .normal_restitution = 0.369915, .impact_law = ImpactLaw::energetic}, 2);
  add_contact(system, b, second, {0.103343, 0.101347}, {0.216616, 0.976257},
              {.friction = 0.844735, .normal_restitution = 0.554891, .impact_law = ImpactLaw::energetic}, 4);
  for (const ForceRule rule : {ForceRule::trapezoidal, ForceRule::energy_momentum}) {
    Simulation simulation(system, TimeStepping{.step = 1e-9, .force_rule = rule});
    simulation.step();
    ASSERT_EQ(simulation.report().contacts.size(), 3u);
    for (const ContactRecord& contact : simulation.report().contacts) {
      EXPECT_GT(contact.velocity_before[0], 0.1);
      EXPECT_EQ(contact.impulse[0], 0.0);
      EXPECT_EQ(contact.impulse[1], 0.0);
    }
    EXPECT_EQ(simulation.state().velocity(b), second.velocity);
    EXPECT_EQ(simulation.state().spin(b), second.spin);
  }
}

}  // namespace
