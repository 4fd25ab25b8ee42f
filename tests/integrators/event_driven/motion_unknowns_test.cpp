// Unknowns of clock groups between the state of a model and the numbers of a flow.

#include <carom/carom.h>
#include <carom/core/assembly.h>
#include <carom/integrators/event_driven/motion_unknowns.h>

#include <gtest/gtest.h>

#include <numeric>
#include <vector>

namespace {

using namespace carom;
using namespace carom::planar;

TEST(MotionUnknowns, ComponentsTakeTheirPartOfTheState) {
  System system;
  const BodyId a = system.add(Particle{.mass = 1.0}), b = system.add(Particle{.mass = 1.0});
  system.add(MaxwellElement{.from = a, .to = b, .stiffness = 1.0, .damping = 1.0, .free_length = 0.0});
  system.add(RigidBody{.mass = disc(1.0, 1.0)});
  const Assembly assembly(system);
  ASSERT_EQ(assembly.components().size(), 2U);
  State state = assembly.initial_state();
  std::iota(state.q.begin(), state.q.end(), 100.0);
  std::iota(state.v.begin(), state.v.end(), 200.0);
  std::iota(state.z.begin(), state.z.end(), 300.0);
  State copy = assembly.initial_state();
  for (Index number = 0; number < assembly.components().size(); ++number) {
    const Component& component = assembly.components()[number];
    const MotionUnknowns unknowns(assembly, std::vector<Index>{number},
                                  static_cast<Index>(WorkLine::joint_friction));
    ASSERT_EQ(unknowns.size(), component.q.size() + component.v.size() + component.z.size() + 3U);
    EXPECT_EQ(unknowns.work_place(WorkLine::external), unknowns.size() - 1);
    std::vector<double> y(unknowns.size(), -1.0);
    unknowns.gather(state, y);
    for (Index v = component.v.begin; v < component.v.end; ++v) {
      EXPECT_EQ(y[unknowns.of_velocity(v)], state.v[v]);
    }
    for (std::size_t z = 0; z < unknowns.z_size(); ++z) {
      EXPECT_EQ(y[unknowns.z_begin() + z], state.z[component.z.begin + z]);
    }
    EXPECT_EQ(y[unknowns.work_place(WorkLine::dashpot)], 0.0);
    unknowns.scatter(y, copy);
  }
  EXPECT_EQ(copy.q, state.q);
  EXPECT_EQ(copy.v, state.v);
  EXPECT_EQ(copy.z, state.z);
}

TEST(MotionUnknowns, ComponentsOfOneGroupNeedNotBeNeighbours) {
  System system;
  const BodyId a = system.add(RigidBody{.mass = disc(1.0, 1.0)}),
               b = system.add(RigidBody{.mass = disc(1.0, 1.0)});
  system.add(MaxwellElement{.from = a, .to = b, .stiffness = 1.0, .damping = 1.0, .free_length = 0.0});
  system.add(RigidBody{.mass = disc(1.0, 1.0)});
  const BodyId c = system.add(RigidBody{.mass = disc(1.0, 1.0)}),
               d = system.add(RigidBody{.mass = disc(1.0, 1.0)});
  system.add(MaxwellElement{.from = c, .to = d, .stiffness = 1.0, .damping = 1.0, .free_length = 0.0});
  const Assembly assembly(system);
  ASSERT_EQ(assembly.components().size(), 3U);
  State state = assembly.initial_state();
  std::iota(state.q.begin(), state.q.end(), 100.0);
  std::iota(state.v.begin(), state.v.end(), 200.0);
  std::iota(state.z.begin(), state.z.end(), 300.0);
  const MotionUnknowns unknowns(assembly, std::vector<Index>{0, 2},
                                static_cast<Index>(WorkLine::joint_friction));
  ASSERT_EQ(unknowns.q_size(), 12U);
  ASSERT_EQ(unknowns.v_size(), 12U);
  ASSERT_EQ(unknowns.z_size(), state.z.size());
  std::vector<double> y(unknowns.size(), -1.0);
  unknowns.gather(state, y);
  State copy = assembly.initial_state();
  unknowns.scatter(y, copy);
  for (const Index number : {0U, 2U}) {
    const Component& component = assembly.components()[number];
    for (Index q = component.q.begin; q < component.q.end; ++q) EXPECT_EQ(copy.q[q], state.q[q]);
    for (Index v = component.v.begin; v < component.v.end; ++v) {
      EXPECT_EQ(copy.v[v], state.v[v]);
      EXPECT_EQ(y[unknowns.of_velocity(v)], state.v[v]);
      EXPECT_EQ(unknowns.velocity_at(unknowns.of_velocity(v)), v);
    }
  }
  // The component between them is another group's.
  const Component& between = assembly.components()[1];
  for (Index v = between.v.begin; v < between.v.end; ++v) EXPECT_NE(copy.v[v], state.v[v]);
}

}  // namespace
