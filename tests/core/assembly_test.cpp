#include <carom/bodies/particle.h>
#include <carom/bodies/rigid_body.h>
#include <carom/contact/detection/half_space.h>
#include <carom/core/assembly.h>
#include <carom/joints/gravity.h>
#include <carom/joints/spring_damper.h>

#include "tests/model_error.h"
#include "tests/random.h"
#include <carom/testing/loaded_model.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace {

using namespace carom;
using namespace carom::planar;
using carom::energy_test::LoadedModel;

constexpr double epsilon = std::numeric_limits<double>::epsilon();
constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

BodyId add_particle(System& system, double x = 0.0) {
  return system.add(Particle{.mass = 1.0, .position = {x, -x}});
}
BodyId add_plate(System& system, double x = 0.0) {
  return system.add(RigidBody{.mass = disc(1.0, 1.0), .position = {x, -x}, .angle = x});
}

std::set<std::set<BodyId>> components_of(const Assembly& assembly) {
  std::set<std::set<BodyId>> result;
  for (const Component& component : assembly.components()) {
    std::set<BodyId> ids;
    for (Index body = component.bodies.begin; body < component.bodies.end; ++body)
      ids.insert(assembly.layout()->id(body));
    result.insert(ids);
  }
  return result;
}

TEST(Assembly, NeedsABody) {
  System system;
  EXPECT_MODEL_ERROR(Assembly(system), "system: number of bodies is 0", "at least one body");
  system.add(HalfPlane{.normal = {0, 1}});
  EXPECT_MODEL_ERROR(Assembly(system), "number of bodies is 0");
}

TEST(Assembly, CouplingsJoinGroundAndGravityDoNot) {
  System system;
  const BodyId a = add_particle(system), b = add_particle(system), c = add_plate(system),
               d = add_plate(system);
  system.add(Gravity{{0.0, -9.81}});
  system.add(SpringDamper{.from = ground, .to = a});
  system.add(SpringDamper{.from = b, .to = ground});
  system.add(HalfPlane{.normal = {0, 1}}, Surface{.friction = 0.0, .normal_restitution = 0.0});
  EXPECT_EQ(components_of(Assembly(system)), (std::set<std::set<BodyId>>{{a}, {b}, {c}, {d}}));
  system.add(SpringDamper{.from = d, .to = a});
  EXPECT_EQ(components_of(Assembly(system)), (std::set<std::set<BodyId>>{{a, d}, {b}, {c}}));
  const ElementId last = system.add(SpringDamper{.from = b, .to = d});
  EXPECT_EQ(components_of(Assembly(system)), (std::set<std::set<BodyId>>{{a, b, d}, {c}}));
  system.remove(last);
  EXPECT_EQ(components_of(Assembly(system)), (std::set<std::set<BodyId>>{{a, d}, {b}, {c}}));
}

// A random graph, with parts removed here and there, and its connected components found another way.
struct RandomGraph {
  explicit RandomGraph(std::uint64_t seed) {
    carom_test::Random random(seed);
    const unsigned count = 1 + random.below(40);
    std::vector<BodyId> all;
    for (unsigned i = 0; i < count; ++i) {
      all.push_back(random.below(2) == 0 ? add_particle(system, i) : add_plate(system, i));
    }
    for (std::size_t i = all.size(); i-- > 1;) {
      if (random.below(5) != 0) continue;
      system.remove(all[i]);
      all.erase(all.begin() + static_cast<std::ptrdiff_t>(i));
    }
    for (const BodyId id : all) component[id] = id;
    if (random.below(2) == 0) system.add(Gravity{{0.0, -1.0}});
    for (unsigned i = random.below(count); i > 0; --i) {
      const BodyId from = all[random.below(static_cast<unsigned>(all.size()))];
      const BodyId to = random.below(6) == 0 ? ground : all[random.below(static_cast<unsigned>(all.size()))];
      if (from == to) continue;
      springs[system.add(SpringDamper{
          .from = from, .to = to, .stiffness = 1.0, .free_length = random.uniform(0, 1)})] = {from, to};
      if (to == ground) continue;
      const BodyId old = component[from], merged = component[to];
      for (auto& entry : component) {
        if (entry.second == old) entry.second = merged;
      }
    }
  }

  System system;
  std::map<BodyId, BodyId> component;
  std::map<ElementId, std::pair<BodyId, BodyId>> springs;
};

TEST(Assembly, ComponentsAreTheConnectedComponents) {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    const RandomGraph graph(seed);
    std::map<BodyId, std::set<BodyId>> components;
    for (const auto& [body, component] : graph.component) components[component].insert(body);
    std::set<std::set<BodyId>> expected;
    for (const auto& entry : components) expected.insert(entry.second);
    EXPECT_EQ(components_of(Assembly(graph.system)), expected) << "seed " << seed;
  }
}

TEST(Assembly, ComponentsAreRangesThatTileEveryArray) {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    const RandomGraph graph(seed);
    const Assembly assembly(graph.system);
    const Layout& layout = *assembly.layout();
    Index body = 0, q = 0, v = 0, rotation = 0;
    std::vector<Index> slot(assembly.body_kinds().size(), 0);
    for (Index component = 0; component < assembly.components().size(); ++component) {
      const Component& range = assembly.components()[component];
      EXPECT_EQ(range.bodies.begin, body);
      EXPECT_EQ(range.q.begin, q);
      EXPECT_EQ(range.v.begin, v);
      EXPECT_FALSE(range.bodies.empty());
      for (; body < range.bodies.end; ++body) {
        const BodySlot& at = layout.bodies()[body];
        EXPECT_EQ(at.q, q);
        EXPECT_EQ(at.v, v);
        EXPECT_EQ(at.slot, slot[at.kind]++);
        EXPECT_EQ(assembly.component_of(body), component);
        q += at.q_size;
        v += at.v_size;
        if (graph.system.has_orientation(layout.id(body))) {
          EXPECT_EQ(at.rotation, rotation);
          rotation += 2;
        } else {
          EXPECT_EQ(at.rotation, none);
        }
      }
      EXPECT_EQ(range.q.end, q);
      EXPECT_EQ(range.v.end, v);
    }
    EXPECT_EQ(body, graph.component.size());
    EXPECT_EQ(layout.q_size(), q);
    EXPECT_EQ(layout.v_size(), v);
    EXPECT_EQ(layout.rotation_size(), rotation);
    EXPECT_EQ(assembly.length_scales().size(), v);
  }
}

TEST(Assembly, BodiesOfAComponentComeKindByKind) {
  System system;
  const BodyId a = add_particle(system, 1), b = add_plate(system, 2), c = add_particle(system, 3);
  const BodyId d = add_plate(system, 4), e = add_particle(system, 5);
  system.add(SpringDamper{.from = a, .to = b});
  system.add(SpringDamper{.from = b, .to = e});
  const Assembly assembly(system);
  std::vector<BodyId> order;
  for (Index body = 0; body < 5; ++body) order.push_back(assembly.layout()->id(body));
  EXPECT_EQ(order, (std::vector<BodyId>{a, e, b, c, d}));
  std::vector<std::string> calls;
  for (Index component = 0; component < assembly.components().size(); ++component) {
    assembly.for_bodies(component, [&](const BodyKind& kind, Range slots, Index q, Index v, Index rotation) {
      calls.push_back(std::string(kind.label()) + " " + std::to_string(slots.begin) + "-" +
                      std::to_string(slots.end) + " q" + std::to_string(q) + " v" + std::to_string(v) +
                      (rotation == none ? "" : " r" + std::to_string(rotation)));
    });
  }
  EXPECT_EQ(calls, (std::vector<std::string>{"particle 0-2 q0 v0", "rigid body 0-1 q4 v4 r0",
                                             "particle 2-3 q7 v7", "rigid body 1-2 q9 v9 r2"}));
}

TEST(Assembly, EveryElementActsInTheComponentOfItsBodiesAndKeepsItsIdentity) {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    const RandomGraph graph(seed);
    const Assembly assembly(graph.system);
    std::map<ElementId, int> seen;
    for (Index component = 0; component < assembly.components().size(); ++component) {
      const Range bodies = assembly.components()[component].bodies;
      for (Index kind = 0; kind < assembly.force_kinds().size(); ++kind) {
        const Range elements = assembly.elements(component, kind);
        if (assembly.force_kinds()[kind]->is_field()) {
          EXPECT_EQ(elements.size(), 1U) << "a field acts in every component";
          continue;
        }
        for (Index element = elements.begin; element < elements.end; ++element) {
          const ElementId id = assembly.element_id(kind, element);
          ++seen[id];
          std::vector<BodyId> ends;
          assembly.force_kinds()[kind]->ends(element, ends);
          const auto& spring = graph.springs.at(id);
          EXPECT_EQ(ends, (std::vector<BodyId>{spring.first, spring.second}));
          for (const BodyId end : ends) {
            if (end == ground) continue;
            const Index body = assembly.layout()->index(end);
            EXPECT_TRUE(body >= bodies.begin && body < bodies.end);
          }
        }
      }
    }
    EXPECT_EQ(seen.size(), graph.springs.size());
    for (const auto& entry : seen) EXPECT_EQ(entry.second, 1);
  }
}

TEST(Assembly, LoadsAreTheSameAsOfEachSpringByItself) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const RandomGraph graph(seed);
    const LoadedModel model(graph.system);
    const Layout& layout = *model.assembly.layout();
    std::vector<double> expected(layout.v_size(), 0.0);
    for (const ElementId id : graph.system.elements()) {
      System single = graph.system;
      for (const ElementId other : single.elements()) {
        if (other != id) single.remove(other);
      }
      const LoadedModel alone(single);
      for (const BodySlot& slot : layout.bodies()) {
        const BodyId body{slot.serial, single.token()};
        for (Index i = 0; i < slot.v_size; ++i) {
          expected[slot.v + i] += alone.conservative[alone.assembly.layout()->slot(body).v + i];
        }
      }
    }
    for (Index i = 0; i < layout.v_size(); ++i)
      EXPECT_NEAR(model.conservative[i], expected[i], 1e3 * epsilon * 100.0);
  }
}

TEST(Assembly, EvaluatingAComponentTouchesNoOther) {
  System system;
  add_plate(system, 1);
  add_plate(system, 2);
  add_plate(system, 3);
  system.add(Gravity{{0.0, -2.0}});
  const Assembly assembly(system);
  const State state = assembly.initial_state();
  Evaluation evaluation = make_evaluation(assembly);
  std::fill(evaluation.force.begin(), evaluation.force.end(), 9.0);
  std::fill(evaluation.rotation.begin(), evaluation.rotation.end(), 9.0);
  evaluate(assembly, 1, state.view(), evaluation);
  EXPECT_EQ(evaluation.force, (std::vector<double>{9, 9, 9, 0, -2, 0, 9, 9, 9}));
  EXPECT_EQ(evaluation.rotation, (std::vector<double>{9, 9, std::cos(2.0), std::sin(2.0), 9, 9}));
}

TEST(Assembly, LoadsMayBeBookedTogetherOrByCause) {
  System system;
  const BodyId a = add_particle(system, 1), b = add_plate(system, 3);
  system.add(Gravity{{0.5, -2.0}});
  system.add(
      SpringDamper{.from = a, .to = {b, {0.5, 0.5}}, .stiffness = 3.0, .damping = 0.5, .free_length = 1.0});
  LoadedModel model(system);
  model.state.velocity(a) << 1, 2;
  model.state.spin(b) = 3.0;
  model.update();
  evaluate(model.assembly, 0, model.state.view(), model.evaluation);
  for (std::size_t i = 0; i < 5; ++i) {
    EXPECT_NEAR(model.evaluation.force[i], model.conservative[i] + model.dissipative[i] + model.external[i],
                32 * epsilon);
  }
}

TEST(Assembly, InitialStateIsTheDescribedOneWhateverTheOrder) {
  const RandomGraph graph(7);
  const State state = Assembly(graph.system).initial_state();
  for (const BodyId id : graph.system.bodies()) {
    EXPECT_EQ(state.position(id)[0], id.serial);
    EXPECT_EQ(state.position(id)[1], -state.position(id)[0]);
    if (graph.system.has_orientation(id)) {
      EXPECT_EQ(state.angle(id), id.serial);
    }
  }
}

TEST(Assembly, EnergiesGoByForm) {
  System system;
  const BodyId a = system.add(Particle{.mass = 2.0, .position = {0, 3}, .velocity = {3, 4}});
  const BodyId b = system.add(
      RigidBody{.mass = {.mass = 1.0, .inertia = 0.5}, .position = {0, 7}, .velocity = {1, 0}, .spin = 2.0});
  system.add(Gravity{{0.0, -10.0}});
  system.add(SpringDamper{.from = a, .to = b, .stiffness = 8.0, .free_length = 3.5});
  LoadedModel model(system);
  const StoredEnergies energies = model.energies();
  EXPECT_EQ(energies[StoredEnergy::kinetic], 25.0 + 0.5 + 1.0);
  EXPECT_EQ(energies[StoredEnergy::gravity], 60.0 + 70.0);
  EXPECT_EQ(energies[StoredEnergy::elastic], 1.0);
  EXPECT_EQ(energies[StoredEnergy::potential], 0.0);
}

TEST(Assembly, KeepsItsOwnCopyOfTheSystem) {
  System system;
  const BodyId a = add_particle(system);
  const Assembly assembly(system);
  system.remove(a);
  EXPECT_TRUE(assembly.system().contains(a));
  EXPECT_EQ(assembly.components().size(), 1U);
}

TEST(CheckState, AcceptsTheInitialStateAndNamesWhatIsWrong) {
  System system;
  const BodyId dot = system.add(Particle{.mass = 1.0}, "dot");
  const BodyId plate = system.add(RigidBody{.mass = disc(1.0, 1.0)}, "plate");
  const Assembly assembly(system);
  const State good = assembly.initial_state();
  EXPECT_NO_THROW(check_state(assembly, good));
  for (const double bad : {nan, infinity, -infinity}) {
    State state = good;
    state.time = bad;
    EXPECT_MODEL_ERROR(check_state(assembly, state), "state: time is " + to_text(bad) + " s", "finite");
    state = good;
    state.position(dot)[1] = bad;
    EXPECT_MODEL_ERROR(check_state(assembly, state), "state of particle 'dot'",
                       "coordinate is " + to_text(bad));
    state = good;
    state.angle(plate) = bad;
    EXPECT_MODEL_ERROR(check_state(assembly, state), "state of rigid body 'plate'",
                       "coordinate is " + to_text(bad));
    state = good;
    state.spin(plate) = bad;
    EXPECT_MODEL_ERROR(check_state(assembly, state), "state of rigid body 'plate'",
                       "velocity is " + to_text(bad));
  }
  State state = good;
  state.q.pop_back();
  EXPECT_MODEL_ERROR(check_state(assembly, state),
                     "state: number of coordinates, velocities and internal variables is 4 + 5 + 0",
                     "5 + 5 + 0");
  EXPECT_MODEL_ERROR(check_state(assembly, State()), "is 0 + 0 + 0");
}

TEST(Assembly, InSpaceParticlesSpringsGravityAndObstaclesWork) {
  System system;
  const BodyId a = system.add(spatial::Particle{.mass = 2.0, .position = {1, 2, 3}, .velocity = {0, 0, 1}});
  const BodyId b = system.add(spatial::Particle{.mass = 1.0, .position = {1, 2, 8}}, "upper");
  system.add(spatial::Gravity{{0, 0, -10}});
  system.add(spatial::SpringDamper{.from = a, .to = b, .stiffness = 4.0, .damping = 0.5, .free_length = 3.0});
  system.add(spatial::SpringDamper{.from = {ground, {0, 0, 3}}, .to = a, .stiffness = 2.0});
  const ObstacleId floor = system.add(spatial::HalfSpace{.normal = {0, 0, 2}},
                                      Surface{.friction = 0.1, .normal_restitution = 0.5});
  LoadedModel model(system);
  ASSERT_EQ(model.assembly.components().size(), 1U);
  EXPECT_EQ(model.assembly.layout()->dimension(), 3);
  const std::vector<double> conservative{-2, -4, -20 + 8, 0, 0, -10 - 8};
  const std::vector<double> dissipative{0, 0, -0.5, 0, 0, 0.5};
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_NEAR(model.conservative[i], conservative[i], 32 * epsilon);
    EXPECT_NEAR(model.dissipative[i], dissipative[i], 4 * epsilon);
    EXPECT_NEAR(model.minus_gradient()[i], conservative[i], 1e-9);
  }
  EXPECT_NEAR(model.energies()[StoredEnergy::elastic], 8.0 + 5.0, 64 * epsilon);
  EXPECT_EQ(model.energies()[StoredEnergy::gravity], 140.0);
  EXPECT_EQ(model.energies()[StoredEnergy::kinetic], 1.0);
  EXPECT_EQ(Vec<3>(model.state.position(b)), Vec<3>(1, 2, 8));
  const Gap gap = system.ground_shape_kinds().kind_of(floor.serial).gap(0, model.state.position(b).data());
  EXPECT_EQ(gap.distance, 8.0);
  EXPECT_EQ(gap.normal, (std::array<double, 3>{0, 0, 1}));
}

}  // namespace
