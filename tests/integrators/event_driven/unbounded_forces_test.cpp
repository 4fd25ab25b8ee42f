// Contacts whose forces have outgrown the others.

#include <carom/integrators/event_driven/unbounded_forces.h>

#include <gtest/gtest.h>

#include <vector>

namespace {

using namespace carom;

TEST(UnboundedForces, FoundAgainstTheScale) {
  std::vector<ActiveContact> contacts(3);
  for (Index i = 0; i < contacts.size(); ++i) contacts[i].pair.body = i;
  contacts[0].normal = 5.0;
  contacts[1].normal = -2.0 * UnboundedForces::growth * 5.0;
  UnboundedForces unbounded;
  EXPECT_FALSE(unbounded.contains(contacts[1].pair));
  EXPECT_TRUE(unbounded.find(contacts, 5.0 * UnboundedForces::growth));
  EXPECT_FALSE(unbounded.contains(contacts[0].pair));
  EXPECT_TRUE(unbounded.contains(contacts[1].pair));
  EXPECT_FALSE(unbounded.find(contacts, 50.0 * UnboundedForces::growth));
  EXPECT_FALSE(unbounded.contains(contacts[1].pair));
  EXPECT_TRUE(unbounded.find(contacts, 5.0 * UnboundedForces::growth));
  unbounded.clear();
  EXPECT_FALSE(unbounded.contains(contacts[1].pair));
}

}  // namespace
