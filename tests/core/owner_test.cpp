// An owner has one object at most, and each object one owner.

#include <carom/core/owner.h>

#include <gtest/gtest.h>

#include <type_traits>
#include <utility>

namespace {

using carom::Owner;

struct Counted {
  explicit Counted(int& there) : there_(&there) { ++there; }
  Counted(const Counted&) = delete;
  Counted& operator=(const Counted&) = delete;
  ~Counted() { --*there_; }
  int* there_;
};

static_assert(!std::is_copy_constructible_v<Owner<Counted>> && !std::is_copy_assignable_v<Owner<Counted>>);
static_assert(std::is_nothrow_move_constructible_v<Owner<Counted>>);
static_assert(std::is_nothrow_move_assignable_v<Owner<Counted>>);

TEST(Owner, HandsItsObjectOn) {
  int there = 0;
  {
    Owner<Counted> first(new Counted(there));
    Counted* const object = first.get();
    Owner<Counted> second(std::move(first));
    EXPECT_EQ(first.get(), nullptr);  // NOLINT(bugprone-use-after-move): that is what is asked
    EXPECT_EQ(second.get(), object);
    EXPECT_EQ(&*second, object);
    EXPECT_EQ(second->there_, &there);
    EXPECT_EQ(there, 1);
  }
  EXPECT_EQ(there, 0);
}

TEST(Owner, WhatIsReplacedEndsAtOnce) {
  int there = 0;
  Owner<Counted> kept(new Counted(there)), given(new Counted(there));
  Counted* const object = given.get();
  kept = std::move(given);
  EXPECT_EQ(there, 1);
  EXPECT_EQ(kept.get(), object);
  EXPECT_EQ(given.get(), nullptr);  // NOLINT(bugprone-use-after-move): that is what is asked
  Owner<Counted>& same = kept;
  kept = std::move(same);
  EXPECT_EQ(kept.get(), object);
  EXPECT_EQ(there, 1);
  kept = Owner<Counted>();
  EXPECT_EQ(there, 0);
}

}  // namespace
