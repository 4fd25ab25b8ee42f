// The broad phase against all pairs.

#include <carom/contact/detection/broad_phase.h>
#include <carom/core/errors.h>

#include "tests/allocation_counter.h"
#include "tests/contact/detection/random_boxes.h"
#include "tests/model_error.h"
#include "tests/random.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <span>
#include <string>
#include <vector>

namespace {

using carom::Box;
using carom::BoxPair;
using carom::BroadPhase;
using carom::Index;
using carom::none;
using carom::Vec;
using carom_test::all_pairs;
using carom_test::Random;
using carom_test::random_box;
using carom_test::random_boxes;

template <int D>
using Boxes = std::vector<Box<D>>;

std::vector<BoxPair> list(std::span<const BoxPair> pairs) { return {pairs.begin(), pairs.end()}; }

template <int D>
std::vector<BoxPair> fresh(const Boxes<D>& boxes, double margin, const std::vector<Index>& owners = {}) {
  BroadPhase<D> broad;
  if (owners.empty()) {
    broad.reset(static_cast<Index>(boxes.size()));
  } else {
    broad.reset(owners);
  }
  return list(broad.update(boxes, margin));
}

template <int D>
std::vector<BoxPair> brute(const Boxes<D>& boxes, double margin, const std::vector<Index>& owners = {}) {
  return all_pairs<D>(boxes, margin, owners);
}

template <int D>
void shift(Box<D>& box, const Vec<D>& by) {
  box.min += by, box.max += by;
}

template <class T>
class BroadPhaseIn : public testing::Test {};
struct Plane {
  static constexpr int dimension = 2;
};
struct InSpace {
  static constexpr int dimension = 3;
};
using Dimensions = testing::Types<Plane, InSpace>;
TYPED_TEST_SUITE(BroadPhaseIn, Dimensions);

TYPED_TEST(BroadPhaseIn, FindsThePairsOfRandomSets) {
  constexpr int D = TypeParam::dimension;
  Random random(1);
  for (const double most : {1.0, 3.0, 100.0, 1e6}) {
    for (const int count : {1, 2, 3, 10, 100, 1000}) {
      for (const double margin : {0.0, 0.3}) {
        const Boxes<D> boxes = random_boxes<D>(random, count, most);
        EXPECT_EQ(fresh(boxes, margin), brute(boxes, margin)) << count << " of 1 to " << most;
      }
    }
  }
}

TYPED_TEST(BroadPhaseIn, FindsPairsFarFromTheOriginAndAcrossIt) {
  constexpr int D = TypeParam::dimension;
  Random random(2);
  for (const double offset : {-20.0, 1e3, -1e8, 1e14, 1e17}) {
    Boxes<D> boxes = random_boxes<D>(random, 300, 10.0);
    for (Box<D>& box : boxes) shift<D>(box, Vec<D>::Constant(offset));
    EXPECT_EQ(fresh(boxes, 0.1), brute(boxes, 0.1)) << offset;
  }
}

TYPED_TEST(BroadPhaseIn, FindsPairsOfRowsAndDiagonals) {
  constexpr int D = TypeParam::dimension;
  Random random(3);
  for (int direction = 0; direction < 1 << D; ++direction) {
    Vec<D> along;
    for (int k = 0; k < D; ++k) along[k] = (direction >> k & 1) == 0 ? 0.0 : 0.8;
    Boxes<D> boxes;
    for (int i = 0; i < 400; ++i) {
      boxes.push_back(random_box<D>(random, 0.1, 1.0));
      shift<D>(boxes.back(), i * along);
    }
    EXPECT_EQ(fresh(boxes, 0.0), brute(boxes, 0.0)) << direction;
  }
}

TYPED_TEST(BroadPhaseIn, PairsThatJustMeetOverlapAndThoseThatJustMissDoNot) {
  constexpr int D = TypeParam::dimension;
  Random random(4);
  // Places in a lattice of boxes without size, whose distances are the margin as rounded, or just above. They
  // jump, so that none is kept in a larger box.
  for (const double margin : {0.1, 1.0 / 3.0, 1e-7}) {
    BroadPhase<D> broad;
    broad.reset(300);
    Boxes<D> boxes(300);
    for (int step = 0; step < 20; ++step) {
      for (Box<D>& box : boxes) {
        for (int k = 0; k < D; ++k) box.min[k] = (static_cast<double>(random.below(80)) - 40.0) * margin;
        if (D == 2 || random.below(4) != 0) box.min[D - 1] = box.min[0];  // close together
        box.max = box.min;
      }
      const double asked = step % 2 == 0 ? margin : std::nextafter(margin, 0.0);
      ASSERT_EQ(list(broad.update(boxes, asked)), brute(boxes, asked)) << margin << ", step " << step;
    }
  }
}

TYPED_TEST(BroadPhaseIn, AnswersAfterMotionAreThoseOfAFreshStart) {
  constexpr int D = TypeParam::dimension;
  // From hardly moving to jumping over each other.
  for (const double speed : {1e-4, 0.01, 0.1, 3.0}) {
    Random random(5);
    Boxes<D> boxes = random_boxes<D>(random, 300, 30.0);
    std::vector<Vec<D>> velocities;
    std::vector<Index> owners;
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      velocities.push_back(random.vec<D>(speed));
      owners.push_back(random.below(3) == 0 ? none : random.below(100));
    }
    BroadPhase<D> broad;
    broad.reset(owners);
    for (int step = 0; step < 100; ++step) {
      const double margin = step % 10 == 9 ? 0.5 : 0.05;
      const std::vector<BoxPair> found = list(broad.update(boxes, margin));
      ASSERT_EQ(found, brute(boxes, margin, owners)) << "speed " << speed << ", step " << step;
      for (std::size_t i = 0; i < boxes.size(); ++i) shift<D>(boxes[i], velocities[i]);
    }
  }
}

TYPED_TEST(BroadPhaseIn, AFewFastBoxesAmongManyAtRest) {
  constexpr int D = TypeParam::dimension;
  Random random(6);
  Boxes<D> boxes = random_boxes<D>(random, 500, 50.0);
  BroadPhase<D> broad;
  broad.reset(static_cast<Index>(boxes.size()));
  for (int step = 0; step < 200; ++step) {
    ASSERT_EQ(list(broad.update(boxes)), brute(boxes, 0.0)) << step;
    for (int i = 0; i < 3; ++i) shift<D>(boxes[random.below(500)], random.vec<D>(20.0));
    // Two that come to one place.
    const Index one = random.below(500), other = random.below(500);
    shift<D>(boxes[one], random.vec<D>(20.0));
    shift<D>(boxes[other], boxes[one].min - boxes[other].min);
  }
}

TYPED_TEST(BroadPhaseIn, ManySmallBoxesInAndAroundAFewLargeOnes) {
  constexpr int D = TypeParam::dimension;
  Random random(10);
  Boxes<D> boxes;
  for (int i = 0; i < 1500; ++i) boxes.push_back(random_box<D>(random, 150.0, i % 300 == 0 ? 100.0 : 1.0));
  EXPECT_EQ(fresh(boxes, 0.0), brute(boxes, 0.0));
  // One far away, so that the others are close together for the grid's sizes.
  shift<D>(boxes[0], Vec<D>::Constant(1e9));
  EXPECT_EQ(fresh(boxes, 0.0), brute(boxes, 0.0));
}

TYPED_TEST(BroadPhaseIn, QueryFindsAllAroundABox) {
  constexpr int D = TypeParam::dimension;
  Random random(7);
  Boxes<D> boxes = random_boxes<D>(random, 500, 100.0);
  BroadPhase<D> broad;
  broad.reset(static_cast<Index>(boxes.size()));
  std::vector<Index> found;
  for (int step = 0; step < 20; ++step) {
    broad.update(boxes, 0.2);
    for (const double size : {0.0, 1.0, 30.0, 1e4, 1e100}) {
      const Box<D> box = random_box<D>(random, 50.0, size);
      std::vector<Index> expected;
      for (Index i = 0; i < boxes.size(); ++i) {
        if (are_within(box, boxes[i], 0.2)) expected.push_back(i);
      }
      broad.query(boxes, box, 0.2, found);
      EXPECT_EQ(found, expected) << size;
    }
    for (int i = 0; i < 50; ++i) shift<D>(boxes[random.below(500)], random.vec<D>(1.0));
  }
}

TYPED_TEST(BroadPhaseIn, QueryOfMuchOfAField) {
  constexpr int D = TypeParam::dimension;
  Random random(11);
  const Boxes<D> boxes = random_boxes<D>(random, 2000, 1.0);
  BroadPhase<D> broad;
  broad.reset(static_cast<Index>(boxes.size()));
  broad.update(boxes);
  std::vector<Index> found;
  for (int trial = 0; trial < 50; ++trial) {
    const Box<D> box = random_box<D>(random, 10.0, trial);
    std::vector<Index> expected;
    for (Index i = 0; i < boxes.size(); ++i) {
      if (overlap(box, boxes[i])) expected.push_back(i);
    }
    broad.query(boxes, box, 0.0, found);
    EXPECT_EQ(found, expected) << trial;
  }
}

TYPED_TEST(BroadPhaseIn, AllAtOnePlace) {
  constexpr int D = TypeParam::dimension;
  Boxes<D> points(200);
  EXPECT_EQ(fresh(points, 0.0).size(), 200U * 199U / 2U);
  for (Box<D>& box : points) shift<D>(box, Vec<D>::Constant(-7.3));
  EXPECT_EQ(fresh(points, 0.0).size(), 200U * 199U / 2U);
  // Thousands that belong to one thing, none of which pairs.
  Boxes<D> many(4000);
  EXPECT_TRUE(fresh(many, 0.0, std::vector<Index>(many.size(), 5)).empty());
}

TYPED_TEST(BroadPhaseIn, NoBoxesNoPairs) {
  constexpr int D = TypeParam::dimension;
  BroadPhase<D> broad;
  EXPECT_TRUE(broad.update({}).empty());
  broad.reset(0);
  EXPECT_TRUE(broad.update({}).empty());
  std::vector<Index> found{3};
  broad.query({}, Box<D>{}, 0.0, found);
  EXPECT_TRUE(found.empty());
}

TYPED_TEST(BroadPhaseIn, ASteadyStateTakesNoMemory) {
  constexpr int D = TypeParam::dimension;
  Random random(8);
  const Boxes<D> begin = random_boxes<D>(random, 1000, 30.0);
  std::vector<Vec<D>> velocities;
  for (std::size_t i = 0; i < begin.size(); ++i)
    velocities.push_back(random.vec<D>(i % 10 == 0 ? 0.5 : 0.01));
  BroadPhase<D> broad;
  broad.reset(static_cast<Index>(begin.size()));
  std::vector<Index> around;
  const auto run = [&] {
    Boxes<D> boxes = begin;
    const std::int64_t before = carom_test::allocations();
    for (int step = 0; step < 100; ++step) {
      broad.update(boxes, 0.1);
      broad.query(boxes, boxes[7], 0.1, around);
      for (std::size_t i = 0; i < boxes.size(); ++i) shift<D>(boxes[i], velocities[i]);
    }
    return carom_test::allocations() - before;
  };
  EXPECT_GT(run(), 0);
  run();
  EXPECT_EQ(run(), 0);
}

TEST(BroadPhase, RefusesBoxesByTheirNumber) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  constexpr double inf = std::numeric_limits<double>::infinity();
  Boxes<2> boxes(5);
  BroadPhase<2> broad;
  broad.reset(5);
  const std::vector<BoxPair> before = list(broad.update(boxes));
  for (const double bad : {nan, inf, -inf, 1e151}) {
    Boxes<2> wrong = boxes;
    wrong[3].max[1] = bad;
    EXPECT_MODEL_ERROR(broad.update(wrong), "box 3");
    wrong[3] = boxes[3], wrong[4].min[0] = bad;
    EXPECT_MODEL_ERROR(broad.update(wrong), "box 4");
    EXPECT_EQ(list(broad.update(boxes)), before);
  }
  Boxes<2> wrong = boxes;
  wrong[2].min[0] = 1e-9;
  EXPECT_MODEL_ERROR(broad.update(wrong), "box 2", "min <= max");
  wrong.resize(4);
  EXPECT_MODEL_ERROR(broad.update(wrong), "4 boxes", "5");
  EXPECT_MODEL_ERROR(broad.update(boxes, -1.0), "margin");
  EXPECT_MODEL_ERROR(broad.update(boxes, nan), "margin");
  EXPECT_EQ(list(broad.update(boxes)), before);
}

TEST(BroadPhase, OtherBoxesAfterReset) {
  Random random(9);
  BroadPhase<2> broad;
  for (const int count : {50, 500, 20, 0, 100}) {
    const Boxes<2> boxes = random_boxes<2>(random, count, 5.0);
    broad.reset(static_cast<Index>(count));
    EXPECT_EQ(broad.size(), static_cast<Index>(count));
    EXPECT_EQ(list(broad.update(boxes)), brute(boxes, 0.0));
  }
}

}  // namespace
