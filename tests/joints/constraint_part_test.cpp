#include <carom/joints/constraint_part_table.h>
#include <carom/joints/driver.h>
#include <carom/joints/prismatic.h>
#include <carom/joints/revolute.h>
#include <carom/joints/rod.h>

#include "tests/joints/element_pairs.h"
#include "tests/joints/joint_model.h"
#include "tests/model_error.h"

#include <limits>
#include <string>

namespace {

using namespace carom;
using namespace carom::planar;
using namespace carom_test;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

/// A joint of every kind between two ends, where it can be.
std::vector<JointId> add_joints(System& system, const End<2>& from, const End<2>& to, Random& random) {
  const auto turns = [&](BodyId body) { return body == ground || system.has_orientation(body); };
  std::vector<JointId> joints{
      system.add(Revolute{.from = from, .to = to, .zero_angle = random.uniform(-1.0, 1.0)}),
      system.add(Rod{.from = from, .to = to, .length = random.uniform(0.2, 4.0)})};
  if (!turns(from.body)) return joints;
  joints.push_back(system.add(PointOnLine{.from = from, .to = to, .axis = random.vec<2>(5.0)}));
  joints.push_back(
      system.add(PointOnLine{.from = from, .to = to, .axis = {3.0, -4.0}, .zero_distance = 0.3}));
  if (!turns(to.body)) return joints;
  joints.push_back(system.add(Weld{.from = from, .to = to}));
  joints.push_back(system.add(Weld{.from = from, .to = to, .angle = 0.7}));
  joints.push_back(system.add(
      Prismatic{.from = from, .to = to, .axis = random.vec<2>(5.0), .angle = random.uniform(-1.0, 1.0)}));
  if (to.body == ground) return joints;
  joints.push_back(system.add(Rolling{.from = from, .to = to, .normal = random.vec<2>(5.0), .radius = 0.4}));
  return joints;
}

template <class F>
void for_random_joints(std::uint64_t seed, F&& f) {
  Random random(seed);
  for (int repeat = 0; repeat < 5; ++repeat) {
    const Bodies bodies(random);
    for (const auto& [from, to] : pairs_of_ends(bodies, random)) {
      System system = bodies.system;
      const std::vector<JointId> joints = add_joints(system, from, to, random);
      JointModel model(system);
      for (const JointId joint : joints) f(model, joint, from, to, random);
    }
  }
}

TEST(ConstraintPart, RowsMeetDifferences) {
  for_random_joints(301, [](JointModel& model, JointId joint, const End<2>&, const End<2>&, Random& random) {
    expect_pattern_fits(model, joint);
    expect_rows_meet_differences(model, joint, random);
  });
}

TEST(ConstraintPart, ReactionsAreWhatTheRowsDo) {
  // G^T l is the reaction on `to` at its end, and its opposite at the same place on `from`. Where a pin or a
  // weld is open, the places are two.
  for_random_joints(
      302, [](const JointModel& model, JointId joint, const End<2>& from, const End<2>& to, Random& random) {
        const JointKind& kind = model.kind(joint);
        std::vector<double> multipliers(kind.rows()), load(model.state.v.size()), expected(load.size());
        for (double& multiplier : multipliers) multiplier = random.uniform(-2.0, 2.0);
        const std::vector<JointRow> rows = model.rows(joint);
        for (std::size_t r = 0; r < multipliers.size(); ++r)
          rows[r].add_transposed(multipliers[r], load.data());
        const JointReaction reaction = kind.reaction(model.view(), model.slot(joint), multipliers.data());
        const Vec<2> force(reaction.force[0], reaction.force[1]);
        const bool two_places = kind.label() == Revolute::label || kind.label() == Weld::label;
        const auto place_of = [&](const End<2>& end) {
          const Attachment<2> located(end, *model.assembly.layout());
          return located.position(model.state.view(), located.lever(model.evaluation));
        };
        for (const auto& [body, sign] : {std::pair(from.body, -1.0), std::pair(to.body, 1.0)}) {
          if (body == ground) continue;
          const BodySlot& slot = model.assembly.layout()->slot(body);
          const Vec<2> place = place_of(two_places && body == from.body ? from : to);
          const Vec<2> lever = place - model.state.position(body);
          expected[slot.v] = sign * force[0];
          expected[slot.v + 1] = sign * force[1];
          if (slot.rotation == none) continue;
          expected[slot.v + 2] = sign * (reaction.moment + lever[0] * force[1] - lever[1] * force[0]);
        }
        SCOPED_TRACE(std::string(kind.label()));
        expect_near(load, expected, 1e-13 * (1.0 + largest(expected)));
        EXPECT_EQ(reaction.force[2], 0.0);
      });
}

TEST(ConstraintPart, RowsDoNotDependOnTimeOrNeighbours) {
  for_random_joints(303, [](JointModel& model, JointId joint, const End<2>& from, const End<2>& to, Random&) {
    EXPECT_FALSE(model.kind(joint).depends_on_time());
    std::vector<BodyId> ends;
    model.kind(joint).ends(model.slot(joint), ends);
    EXPECT_EQ(ends, (std::vector{from.body, to.body}));
    for (const JointRow& row : model.rows(joint)) {
      EXPECT_EQ(row.rate, 0.0);
      for (int b = 0; b < row.bodies; ++b) {
        const Index v = row.blocks[static_cast<std::size_t>(b)].v;
        bool found = false;
        for (const BodyId body : {from.body, to.body}) {
          found = found || (body != ground && model.assembly.layout()->slot(body).v == v);
        }
        EXPECT_TRUE(found);
      }
    }
  });
}

TEST(ConstraintPart, RowsDoNotDependOnTheOrderOfOtherJoints) {
  Random random(304);
  const Bodies bodies(random);
  const auto joint = [&](System& system, double angle) {
    return system.add(Weld{.from = bodies.plates[0], .to = bodies.plates[1], .angle = angle});
  };
  System first = bodies.system, second = bodies.system;
  const JointId a = joint(first, 0.25), b = joint(first, 0.5);
  const JointId gone = joint(second, 1.0), d = joint(second, 0.5), c = joint(second, 0.25);
  second.remove(gone);
  const JointModel one(first), two(second);
  EXPECT_EQ(one.rows(a)[2].gap, two.rows(c)[2].gap);
  EXPECT_EQ(one.rows(b)[2].gap, two.rows(d)[2].gap);
  EXPECT_NEAR(one.rows(a)[2].gap - one.rows(b)[2].gap, 0.25, 1e-15);
}

/// Ends that no joint takes; `joint` makes one between two ends.
template <class F>
void expect_bad_ends_are_refused(const std::string& label, F&& joint) {
  System system;
  const BodyId plate = system.add(RigidBody{.mass = disc(1.0, 1.0), .position = {1, 0}}, "plate");
  const BodyId other = system.add(RigidBody{.mass = disc(1.0, 1.0), .position = {2, 0}});
  const BodyId dot = system.add(Particle{.mass = 1.0, .position = {3, 0}});
  const BodyId gone = system.add(RigidBody{.mass = disc(1.0, 1.0)});
  system.remove(gone);
  System elsewhere;
  elsewhere.add(Particle{.mass = 1.0});
  const BodyId foreign = elsewhere.add(RigidBody{.mass = disc(1.0, 1.0)});
  const auto add = [&](const End<2>& from, const End<2>& to) { return system.add(joint(from, to)); };
  EXPECT_MODEL_ERROR(add({}, plate), label + " #0", "from is not given", "allowed: a body of this system");
  EXPECT_MODEL_ERROR(add(plate, {}), label + " #0", "to is not given", "allowed: a body of this system");
  EXPECT_MODEL_ERROR(add(gone, plate), label, "from is a body that was removed", "allowed");
  EXPECT_MODEL_ERROR(add(plate, foreign), label, "to is a body of another system", "allowed");
  EXPECT_MODEL_ERROR(add(plate, plate), label, "to is rigid body 'plate', as from",
                     "allowed: another body than from");
  EXPECT_MODEL_ERROR(add({plate, {1, 0}}, {plate, {0, 1}}), label, "to is rigid body 'plate', as from");
  EXPECT_MODEL_ERROR(add(ground, {ground, {1, 0}}), label, "to is ground", "allowed: a");
  EXPECT_MODEL_ERROR(add({plate, {nan, 0}}, other), label, "from", "nan", "finite");
  EXPECT_MODEL_ERROR(add(plate, {other, {0, infinity}}), label, "to", "inf", "finite");
  EXPECT_MODEL_ERROR(add({dot, {1, 0}}, plate), label, "particle #2", "allowed");
  EXPECT_MODEL_ERROR(add(plate, {dot, {1, 0}}), label, "particle #2", "allowed");
  EXPECT_TRUE(system.joints().empty());
  // And what was refused left nothing behind.
  add(plate, other);
  EXPECT_EQ(system.joints().size(), 1u);
}

TEST(ConstraintPart, EndsThatCannotBeAreRefusedByName) {
  using Ends = const End<2>&;
  expect_bad_ends_are_refused("revolute joint", [](Ends a, Ends b) { return Revolute{.from = a, .to = b}; });
  expect_bad_ends_are_refused("weld", [](Ends a, Ends b) { return Weld{.from = a, .to = b}; });
  expect_bad_ends_are_refused("prismatic joint", [](Ends a, Ends b) {
    return Prismatic{.from = a, .to = b, .axis = {1, 0}};
  });
  expect_bad_ends_are_refused("point-on-line joint", [](Ends a, Ends b) {
    return PointOnLine{.from = a, .to = b, .axis = {1, 0}};
  });
  expect_bad_ends_are_refused("rolling joint", [](Ends a, Ends b) {
    return Rolling{.from = a, .to = b, .normal = {1, 0}, .radius = 1.0};
  });
  expect_bad_ends_are_refused("rod", [](Ends a, Ends b) { return Rod{.from = a, .to = b}; });
}

TEST(ConstraintPart, RowsOfAllJointsAreThoseOfEach) {
  Random random(305);
  const Bodies bodies(random);
  System system = bodies.system;
  std::vector<JointId> joints;
  for (const auto& [from, to] : pairs_of_ends(bodies, random)) {
    for (const JointId joint : add_joints(system, from, to, random)) joints.push_back(joint);
  }
  JointModel model(system);
  for (double& number : model.state.v) number = random.uniform(-2.0, 2.0);
  std::size_t compared = 0;
  for (const auto& kind : model.assembly.joint_kinds()) {
    struct Numbers {
      std::vector<double> jacobian, gap, rate, drift;
      explicit Numbers(std::size_t rows) : jacobian(9 * rows, 7.0), gap(rows), rate(rows, 7.0), drift(rows) {}
      JointNumbers out() { return {jacobian.data(), gap.data(), rate.data(), drift.data()}; }
    };
    Numbers found(kind->size() * kind->rows()), expected = found, gaps = found;
    kind->evaluate_all(model.view(), {0, kind->size()}, found.out());
    kind->JointKind::evaluate_all(model.view(), {0, kind->size()}, expected.out());
    kind->evaluate_all(model.view(), {0, kind->size()}, {.gap = gaps.gap.data()});
    EXPECT_EQ(found.jacobian, expected.jacobian) << kind->label();
    EXPECT_EQ(found.gap, expected.gap) << kind->label();
    EXPECT_EQ(found.rate, expected.rate) << kind->label();
    EXPECT_EQ(found.drift, expected.drift) << kind->label();
    EXPECT_EQ(gaps.gap, expected.gap) << kind->label();
    compared += kind->size();
  }
  EXPECT_EQ(compared, joints.size());
}

/// Two pins in one joint.
struct TwoPins {
  static constexpr Role role = Role::joint;
  static constexpr std::string_view label = "two pins";
  static constexpr Index row_count = 4;
  BodyId from, to;
  Vec<2> other;
  int pins = 2;

  [[nodiscard]] std::vector<ConstraintPart> constraints(const PartCheck&) const {
    std::vector<ConstraintPart> all = point_constraints(from, to);
    if (pins == 2) {
      for (const ConstraintPart& constraint : point_constraints(from, {to, other})) all.push_back(constraint);
    }
    return all;
  }
};

TEST(ConstraintPart, AllOfAJointAreBetweenTheSameEnds) {
  System system;
  const BodyId plate = system.add(RigidBody{.mass = disc(1.0, 1.0)});
  EXPECT_MODEL_ERROR(system.add(TwoPins{ground, plate, {1.0, 0.0}}), "two pins #0",
                     "constraint parts is between different ends", "allowed: all between the same two ends");
  EXPECT_MODEL_ERROR(system.add(TwoPins{ground, plate, {0.0, 0.0}, 1}), "number of constraint parts is 2",
                     "allowed: 4");
  system.add(TwoPins{ground, plate, {0.0, 0.0}});  // redundant, but that does no harm
  EXPECT_EQ(system.joints().size(), 1u);
}

TEST(ConstraintPart, AParticleCannotBeHeldAtAnAngle) {
  System system;
  const BodyId plate = system.add(RigidBody{.mass = disc(1.0, 1.0), .position = {1, 0}}, "plate");
  const BodyId dot = system.add(Particle{.mass = 1.0}, "dot");
  const std::string is_dot = "is particle 'dot'";
  EXPECT_MODEL_ERROR(system.add(Weld{.from = plate, .to = dot}), "weld #0", "to " + is_dot,
                     "allowed: a rigid body");
  EXPECT_MODEL_ERROR(system.add(Weld{.from = dot, .to = ground}, "w"), "weld 'w'", "from " + is_dot);
  EXPECT_MODEL_ERROR(system.add(Prismatic{.from = dot, .to = plate, .axis = {1, 0}}), "from " + is_dot);
  EXPECT_MODEL_ERROR(system.add(Prismatic{.from = ground, .to = dot, .axis = {1, 0}}), "to " + is_dot);
  EXPECT_MODEL_ERROR(system.add(PointOnLine{.from = dot, .to = plate, .axis = {1, 0}}), "from " + is_dot,
                     "allowed: a rigid body");
  EXPECT_MODEL_ERROR(system.add(Rolling{.from = dot, .to = plate, .normal = {1, 0}, .radius = 1.0}),
                     "from " + is_dot);
  EXPECT_MODEL_ERROR(system.add(Rolling{.from = plate, .to = dot, .normal = {1, 0}, .radius = 1.0}),
                     "to " + is_dot);
  EXPECT_MODEL_ERROR(system.add(Rolling{.from = plate, .to = ground, .normal = {1, 0}, .radius = 1.0}),
                     "to is ground", "allowed: a body of this system");
  EXPECT_TRUE(system.joints().empty());
}

TEST(ConstraintPart, PlanarJointsAreOfThePlane) {
  System system;
  const BodyId dot = system.add(spatial::Particle{.mass = 1.0});
  EXPECT_MODEL_ERROR(system.add(Revolute{.from = ground, .to = dot}), "revolute joint", "dimension is 2",
                     "allowed: 3");
}

}  // namespace
