// One impact by the rules, without a simulation: law, order, what ends a sequence, limited gains.

#include "tests/contact/touching_body.h"

#include <carom/contact/strike.h>
#include <carom/core/constraint_set.h>

#include <gtest/gtest.h>

#include <array>
#include <vector>

namespace {

using namespace carom;
using carom_test::Touch;
using carom_test::TouchingBody;

/// Strikes contacts of a body, and takes what they do into its velocity.
struct Blow {
  Blow(const std::vector<Touch>& touches, const std::array<double, 3>& before)
      : body(touches), velocity(before), touching(body.contacts()) {}

  Struck strike(const ImpactRules& rules, int struck = 0, bool plastic = false) {
    const StrikeInput in{.rules = rules,
                         .velocity = velocity.data(),
                         .speed_noise = 1e-12,
                         .struck = struck,
                         .plastic = plastic};
    const std::array<double, 3> before = velocity;
    const auto by = [&](ImpactLaw law) {
      IslandProblem& problem = problems.by(law);
      return StrikeAnswer{problem, body.solve(problem, touching, before)};
    };
    const Struck out = carom::strike(touching, in, by);
    if (out.problem != nullptr) {
      gain = body.gain(*out.problem, before);
      out.problem->map().add_velocities(velocity.data());
    }
    return out;
  }

  TouchingBody body;
  std::array<double, 3> velocity;  ///< (v_x, v_y, omega)
  ConstraintSet touching;
  ImpactProblems problems{IslandOptions{.plastic_jams = true}};
  double gain = 0.0;  ///< of kinetic energy by the last one [J]
};

constexpr double rounding = 1e-14;  // of velocities of about 1 m/s

Surface smooth(double restitution, ImpactLaw law = ImpactLaw::newton) {
  return {.friction = 0.0, .normal_restitution = restitution, .impact_law = law};
}

// A floor and a wall through the centre of mass: each turns its own component.
std::vector<Touch> corner(const Surface& floor, const Surface& wall) {
  return {{{0.0, 0.0}, {0.0, 1.0}, floor}, {{0.0, 0.0}, {1.0, 0.0}, wall}};
}

TEST(Strike, AllContactsTakePartTogether) {
  Blow blow(corner(smooth(0.5), smooth(0.25)), {-1.0, -2.0, 0.0});
  const Struck struck = blow.strike({});
  ASSERT_EQ(struck.outcome, Struck::Outcome::solved);
  EXPECT_FALSE(struck.cut_sequence);
  EXPECT_EQ(struck.restitution_factor, 1.0);
  EXPECT_NEAR(blow.velocity[0], 0.25, rounding);
  EXPECT_NEAR(blow.velocity[1], 1.0, rounding);
}

TEST(Strike, SequentialTheFastestComesFirst) {
  const ImpactRules rules{.order = ImpactOrder::sequential, .sequence_limit = 2};
  Blow blow(corner(smooth(0.5), smooth(0.25)), {-1.0, -2.0, 0.0});
  ASSERT_EQ(blow.strike(rules).outcome, Struck::Outcome::solved);
  EXPECT_EQ(blow.touching.size(), 1u);
  EXPECT_EQ(blow.velocity[0], -1.0);
  EXPECT_NEAR(blow.velocity[1], 1.0, rounding);
}

TEST(Strike, ASequenceEndsWithoutRestitution) {
  const ImpactRules rules{.order = ImpactOrder::sequential, .sequence_limit = 2};
  Blow blow(corner(smooth(0.5), smooth(0.25)), {-1.0, -2.0, 0.0});
  const Struck last = blow.strike(rules, 2);
  ASSERT_EQ(last.outcome, Struck::Outcome::solved);
  EXPECT_TRUE(last.cut_sequence);
  EXPECT_EQ(blow.touching.size(), 2u);
  EXPECT_NEAR(blow.velocity[0], 0.0, rounding);
  EXPECT_NEAR(blow.velocity[1], 0.0, rounding);
}

TEST(Strike, PlasticOnesTakeAllContactsWhateverTheRulesAndLaws) {
  const ImpactRules rules{.order = ImpactOrder::sequential};
  Blow blow(corner(smooth(0.5), smooth(0.25, ImpactLaw::poisson)), {-1.0, -2.0, 0.0});
  const Struck struck = blow.strike(rules, 0, true);
  ASSERT_EQ(struck.outcome, Struck::Outcome::solved);
  EXPECT_FALSE(struck.cut_sequence);
  EXPECT_EQ(struck.problem, &blow.problems.by(ImpactLaw::newton));
  EXPECT_NEAR(blow.velocity[0], 0.0, rounding);
  EXPECT_NEAR(blow.velocity[1], 0.0, rounding);
}

TEST(Strike, ContactsOfDifferentLawsHaveNoneInCommon) {
  Blow blow(corner(smooth(0.5), smooth(0.25, ImpactLaw::poisson)), {-1.0, -2.0, 0.0});
  const Struck struck = blow.strike({});
  EXPECT_EQ(struck.outcome, Struck::Outcome::laws_differ);
  EXPECT_EQ(struck.problem, nullptr);
  // One after the other each has its own.
  EXPECT_EQ(blow.strike({.order = ImpactOrder::sequential}).outcome, Struck::Outcome::solved);
}

TEST(Strike, OtherLawsHaveTheirSolver) {
  const Surface poisson{.friction = 0.0, .normal_restitution = 0.5, .impact_law = ImpactLaw::poisson};
  Blow blow(corner(poisson, poisson), {-1.0, -2.0, 0.0});
  const Struck struck = blow.strike({});
  ASSERT_EQ(struck.outcome, Struck::Outcome::solved);
  EXPECT_NE(struck.problem, &blow.problems.by(ImpactLaw::newton));
  EXPECT_NEAR(blow.velocity[0], 0.5, rounding);
  EXPECT_NEAR(blow.velocity[1], 1.0, rounding);
}

// Friction that stops what turns makes the normal rebound faster than it came, with e_n alone.
std::vector<Touch> that_gains() {
  return {{{0.7, -0.9},
           {0.0, 1.0},
           {.friction = 2.75, .normal_restitution = 1.0, .tangential_restitution = 0.0}}};
}

TEST(Strike, GainsAreLimitedWhereTheRulesSaySo) {
  constexpr std::array<double, 3> before{-1.8, -1.3, -3.5};
  Blow free(that_gains(), before);
  ASSERT_EQ(free.strike({}).outcome, Struck::Outcome::solved);
  ASSERT_GT(free.gain, 1e-3);  // else nothing is limited
  Blow limited(that_gains(), before);
  const Struck struck = limited.strike({.energy_gain = EnergyGain::limit});
  ASSERT_EQ(struck.outcome, Struck::Outcome::solved);
  EXPECT_LT(struck.restitution_factor, 1.0);
  EXPECT_GT(struck.restitution_factor, 0.0);
  EXPECT_LE(limited.gain, 1e-12);  // rounding of an energy of 3 J
}

TEST(Strike, WhatJamsIsNotSolvedWhereJamsAreRefused) {
  const std::vector<Touch> corridor{{{0.0, 0.0}, {0.0, 1.0}, smooth(0.5)},
                                    {{0.0, 0.0}, {0.0, -1.0}, smooth(0.2)}};
  Blow refused(corridor, {1.0, -1.0, 0.0});
  refused.problems = ImpactProblems(IslandOptions{.plastic_jams = false});
  EXPECT_EQ(refused.strike({}).outcome, Struck::Outcome::not_solved);
  Blow jammed(corridor, {1.0, -1.0, 0.0});
  const Struck struck = jammed.strike({});
  EXPECT_EQ(struck.outcome, Struck::Outcome::solved);
  EXPECT_EQ(struck.restitution_factor, 0.0);
  EXPECT_NEAR(jammed.velocity[1], 0.0, rounding);
  EXPECT_EQ(hint_at_jams({}, 2), "");
  EXPECT_EQ(hint_at_jams({.refuse_jams = true}, 1), "");
  EXPECT_NE(hint_at_jams({.refuse_jams = true}, 2), "");
}

TEST(Strike, StepsLeaveSlowContactsAndEventsCloseThem) {
  constexpr double noise = 1e-12, capture = 1e-3;
  for (const ImpactsOfMode& mode : {impacts_of_steps, impacts_of_events}) {
    EXPECT_EQ(onset_of(noise, noise, capture, 0, mode), ImpactOnset::nothing);
    EXPECT_EQ(onset_of(2.0 * capture, noise, capture, 0, mode), ImpactOnset::impact);
    EXPECT_EQ(onset_of(capture, noise, capture, 1, mode), ImpactOnset::impact) << "a sequence has begun";
    EXPECT_EQ(onset_of(capture, noise, 0.0, 0, mode), ImpactOnset::impact) << "none is slow";
  }
  EXPECT_EQ(onset_of(capture, noise, capture, 0, impacts_of_steps), ImpactOnset::nothing);
  EXPECT_EQ(onset_of(capture, noise, capture, 0, impacts_of_events), ImpactOnset::closing);
}

TEST(Strike, FrictionInJointsTakesPartInEventsWhereItFollowsForces) {
  SingleConstraint contact, friction, rolling;
  friction.normals = rolling.normals = 0;
  rolling.attached = 1;
  for (const ImpactsOfMode& mode : {impacts_of_steps, impacts_of_events}) {
    EXPECT_TRUE(takes_part(contact, mode, false));
    EXPECT_TRUE(takes_part(rolling, mode, false));
    EXPECT_FALSE(takes_part(friction, mode, false));
  }
  EXPECT_FALSE(takes_part(friction, impacts_of_steps, true));
  EXPECT_TRUE(takes_part(friction, impacts_of_events, true));
}

}  // namespace
