// Modes of contacts whose forces are not unique.

#include <carom/integrators/event_driven/modes_by_motion.h>

#include <carom/contact/detection/rolling_resistance.h>
#include <carom/core/constraint_set.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <vector>

namespace {

using namespace carom;

// A moment acts against rolling on the smoothest floor too: its coefficient is no friction of the contact.
TEST(ModesByMotion, RollingResistanceIsThereWhereItsContactHasNoFriction) {
  SingleConstraint contact;
  contact.law = {.friction = 0.0, .normal_restitution = 0.0, .rolling_resistance = 0.01};
  contact.add_body(0, 0, 3);
  contact.start_rows(2);
  const std::array<double, 6> rows{0.0, 1.0, 0.0, 1.0, 0.0, 0.5};
  std::copy(rows.begin(), rows.end(), contact.row(0));
  std::vector<Candidate> candidates(2);
  candidates[0].at = contact;
  write_rolling_resistance(contact, nullptr, candidates[1].at);
  take_modes(std::array{ContactMode::slip_positive, ContactMode::stick}, candidates);
  EXPECT_EQ(candidates[0].mode, ContactMode::slip_positive);
  EXPECT_TRUE(candidates[0].frictionless);
  EXPECT_EQ(candidates[1].mode, ContactMode::stick);
  EXPECT_FALSE(candidates[1].frictionless);
}

}  // namespace
