// Laws and orders of impact in both modes: Newton's cradle, contact that gains energy, options that exclude
// each other.

#include "tests/integrators/event_driven/body_scenes.h"
#include "tests/integrators/throws.h"
#include "tests/random.h"
#include "tests/reference/reference_data.h"
#include "tests/temporary_folder.h"

#include <carom/carom.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace {

using namespace body_scenes;
using namespace carom_test;

/// Newton's cradle: the first of equal discs in touch arrives at 1 m/s.
struct Cradle {
  System system;
  std::vector<BodyId> discs;

  /// \param gap of the first disc at the start [m]
  Cradle(int count, double e, double gap, ImpactLaw law = ImpactLaw::newton) {
    system.set_default_law({.friction = 0.0, .normal_restitution = e, .impact_law = law});
    for (int i = 0; i < count; ++i) {
      const double x = i == 0 ? -gap : 0.25 * i;
      discs.push_back(add_disc(system, 1.0, 0.125, {x, 0.0}, {i == 0 ? 1.0 : 0.0, 0.0}));
    }
  }
};

/// Modes, with steps short enough that nothing has moved on when the impact is over.
template <class Mode>
Mode mode(ImpactOrder order) {
  Mode options;
  options.impact_rules.order = order;
  return options;
}

TEST(ImpactLaws, NewtonsCradleInBothOrdersAndModes) {
  const Json data = reference_data("contacts_planar.json").at("newton_cradle");
  int cases = 0;
  for (const Json& at : data.at("cases")) {
    ++cases;
    const int count = at.at("N").get<int>();
    const double e = at.at("e").get<double>();
    for (const ImpactOrder order : {ImpactOrder::simultaneous, ImpactOrder::sequential}) {
      const bool sequential = order == ImpactOrder::sequential;
      const Json& expected =
          sequential ? at.at("sequential_velocities") : at.at("simultaneous_velocities").at(0);
      const auto check = [&](const Simulation& simulation, const Cradle& cradle, const char* name) {
        for (std::size_t i = 0; i < cradle.discs.size(); ++i) {
          // The approach that a sequence leaves is below 1e-12 of the speed.
          EXPECT_NEAR(simulation.state().velocity(cradle.discs[i])[0], expected.at(i).get<double>(), 1e-12)
              << name << ", " << count << " discs, e = " << e << ", " << to_string(order) << ", disc " << i;
        }
        EXPECT_LE(std::abs(simulation.energy().residual()), 1e-14) << name;
      };
      const Cradle far(count, e, 0.5);
      EventDriven events = mode<EventDriven>(order);
      events.absolute_tolerance = 1e-13;
      Simulation simulation(far.system, events);
      simulation.run_until(0.6);
      check(simulation, far, "events");
      const Cradle near(count, e, 0.0);
      TimeStepping steps = mode<TimeStepping>(order);
      steps.step = 1e-6;
      Simulation stepping(near.system, steps);
      stepping.step();
      if (e == 1.0 || sequential) check(stepping, near, "steps");
    }
  }
  EXPECT_EQ(cases, 8);
}

TEST(ImpactLaws, LawsOfACradleAgreeWithoutFriction) {
  for (const double e : {0.0, 0.5, 1.0}) {
    std::vector<double> newton;
    for (const ImpactLaw law : {ImpactLaw::newton, ImpactLaw::poisson, ImpactLaw::energetic}) {
      const Cradle cradle(4, e, 0.5, law);
      Simulation simulation(cradle.system, EventDriven{});
      simulation.run_until(0.6);
      const Cradle near(4, e, 0.0, law);
      Simulation stepping(near.system, TimeStepping{.step = 1e-6});
      stepping.step();
      for (std::size_t i = 0; i < cradle.discs.size(); ++i) {
        const double v = simulation.state().velocity(cradle.discs[i])[0];
        if (law == ImpactLaw::newton) newton.push_back(v);
        EXPECT_NEAR(v, newton[i], 1e-13) << e << to_string(law) << i;
        EXPECT_NEAR(stepping.state().velocity(near.discs[i])[0], newton[i], 1e-13)
            << e << to_string(law) << i;
      }
    }
  }
}

TEST(ImpactLaws, SequenceEndsAtItsLimit) {
  // e = 0 hands on half of each approach for ever; the limit ends it with all discs at one speed.
  const Cradle cradle(5, 0.0, 0.5);
  Simulation simulation(cradle.system,
                        EventDriven{.impact_rules = {.order = ImpactOrder::sequential, .sequence_limit = 7}});
  simulation.run_until(0.6);
  for (const BodyId disc : cradle.discs) EXPECT_NEAR(simulation.state().velocity(disc)[0], 0.2, 1e-13);
  EXPECT_EQ(simulation.statistics().cut_sequences, 1);
  EXPECT_GT(simulation.energy().flow(EnergyFlow::accumulation), 0.0);
  EXPECT_TRUE(std::any_of(simulation.events().begin(), simulation.events().end(),
                          [](const EventRecord& event) { return event.cut_sequence; }));
  EXPECT_LE(std::abs(simulation.energy().residual()), 1e-14);
  const Cradle near(5, 0.0, 0.0);
  Simulation stepping(
      near.system,
      TimeStepping{.step = 1e-6, .impact_rules = {.order = ImpactOrder::sequential, .sequence_limit = 7}});
  stepping.step();
  for (const BodyId disc : near.discs) EXPECT_NEAR(stepping.state().velocity(disc)[0], 0.2, 1e-13);
  EXPECT_EQ(stepping.statistics().cut_sequences, 1);
  const TemporaryFolder folder;
  stepping.save(folder / "checkpoint");
  Simulation again(near.system, TimeStepping{});
  again.load(folder / "checkpoint");
  EXPECT_EQ(again.statistics().cut_sequences, 1);
}

/// A box in a box, which strikes walls with its corners: with e_n > e_t some impacts gain energy.
System falling_box(Random& random, ImpactLaw law) {
  System system;
  const double friction = random.uniform(0.8, 1.5);
  const double e_n = random.uniform(0.8, 1.0);
  const double e_t = random.uniform(0.0, 0.2);
  const Surface floor{.friction = friction,
                      .normal_restitution = e_n,
                      .tangential_restitution = law == ImpactLaw::energetic ? 0.0 : e_t,
                      .impact_law = law};
  system.add(Gravity{{0.0, -g}});
  add_walls(system, 1.0, floor);
  const double w = random.uniform(0.3, 0.9), h = random.uniform(0.3, 0.9);
  const Vec<2> place{0.0, 0.0};
  const Vec<2> velocity = random.vec<2>(4.0);
  const double angle = random.uniform(-3.0, 3.0);
  const double spin = random.uniform(-5.0, 5.0);
  add_box(system, 1.0, w, h, place, angle, velocity, spin);
  return system;
}

TEST(ImpactLaws, GainsAreReportedWithTheirContactsAndCanBeLimited) {
  int gains = 0, limited = 0;
  for (int i = 0; i < 60; ++i) {
    Random random(100 + static_cast<unsigned>(i));
    const System system = falling_box(random, ImpactLaw::newton);
    Simulation simulation(system, EventDriven{});
    simulation.run_until(0.7);
    double sum = 0.0;
    for (const EventRecord& event : simulation.events()) {
      if (event.kind != EventKind::impact || !(event.energy_gain > 0.0)) continue;
      EXPECT_NEAR(event.energy_after - event.energy_before, event.energy_gain, 1e-12 * event.energy_before);
      if (event.contact_work > 0.0) sum += event.energy_gain;
      ++gains;
    }
    EXPECT_EQ(sum > 0.0, simulation.statistics().energy_gains > 0) << i;
    Simulation limit(system, EventDriven{.impact_rules = {.energy_gain = EnergyGain::limit}});
    limit.run_until(0.7);
    EXPECT_EQ(limit.statistics().energy_gains, 0) << i;
    for (const EventRecord& event : limit.events()) {
      if (event.kind != EventKind::impact || event.restitution_factor == 1.0) continue;
      ++limited;
      // The largest factor without a gain leaves none, unless the gain jumps there.
      EXPECT_LE(event.energy_after, event.energy_before * (1.0 + 1e-12)) << i;
      EXPECT_GE(event.energy_after, event.energy_before * (1.0 - 1e-9))
          << i << " " << event.restitution_factor;
    }
    // Energies of 10 J, and the relative tolerance of the flow.
    EXPECT_LE(std::abs(limit.energy().residual()), 1e-9) << i;
    Simulation steps(system, TimeStepping{.impact_rules = {.energy_gain = EnergyGain::limit}});
    steps.run_until(0.7);
    EXPECT_EQ(steps.statistics().energy_gains, 0) << i;
    EXPECT_LE(std::abs(steps.energy().residual()), 1e-11) << i;
  }
  EXPECT_GT(gains, 5);
  EXPECT_GT(limited, 5);
}

TEST(ImpactLaws, EnergeticLawOfOneContactNeverGains) {
  int impacts = 0;
  for (int i = 0; i < 60; ++i) {
    Random random(200 + static_cast<unsigned>(i));
    const System system = falling_box(random, ImpactLaw::energetic);
    Simulation simulation(system, EventDriven{});
    simulation.run_until(0.7);
    EXPECT_EQ(simulation.statistics().energy_gains, 0) << i;
    impacts += static_cast<int>(simulation.statistics().impacts);
    EXPECT_LE(std::abs(simulation.energy().residual()), 1e-9) << i;
  }
  EXPECT_GT(impacts, 100);
}

TEST(ImpactLaws, ModesConvergeToEachOther) {
  // First order in the step: an impact is noticed up to one step late.
  for (const ImpactLaw law : {ImpactLaw::poisson, ImpactLaw::energetic}) {
    Random random(7);
    const System system = falling_box(random, law);
    Simulation events(system, EventDriven{});
    events.run_until(0.5);
    double last = 0.0;
    for (const double step : {1e-3, 1e-4, 1e-5}) {
      Simulation steps(system, TimeStepping{.step = step});
      steps.run_until(0.5);
      const Vec<2> off =
          steps.state().position(system.bodies().front()) - events.state().position(system.bodies().front());
      last = off.norm();
      EXPECT_LT(last, 100.0 * step) << to_string(law) << step;
    }
  }
}

TEST(ImpactLaws, BadInputIsNamed) {
  System system;
  const auto add = [&](Surface law) { system.add(HalfPlane{.normal = {0.0, 1.0}}, law); };
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROWS(ModelError,
                add({.friction = 0.1, .normal_restitution = 1.5, .impact_law = ImpactLaw::poisson}),
                "normal_restitution", "1.5");
  EXPECT_THROWS(ModelError,
                add({.friction = 0.1,
                     .normal_restitution = 0.5,
                     .tangential_restitution = 0.5,
                     .impact_law = ImpactLaw::energetic}),
                "tangential_restitution", "energetic");
  EXPECT_THROWS(ModelError,
                add({.friction = 0.1, .normal_restitution = 0.5, .impact_law = static_cast<ImpactLaw>(7)}),
                "impact_law", "7");
  EXPECT_THROWS(ModelError, add({.friction = 0.1, .normal_restitution = 0.5, .rolling_resistance = -0.1}),
                "rolling_resistance", "-0.1");
  EXPECT_THROWS(ModelError, add({.friction = 0.1, .normal_restitution = 0.5, .rolling_resistance = nan}),
                "rolling_resistance", "nan");
  EXPECT_THROWS(ModelError,
                add({.friction = 0.1,
                     .normal_restitution = 0.5,
                     .impact_law = ImpactLaw::energetic,
                     .rolling_resistance = 0.1,
                     .rolling_restitution = 0.5}),
                "rolling_restitution is 0.5", "0 where impact_law is energetic");
  const Cradle cradle(3, 0.5, 0.1);
  EXPECT_THROWS(ModelError, Simulation(cradle.system, EventDriven{.impact_rules = {.sequence_limit = 0}}),
                "sequence_limit", "0");
  EXPECT_THROWS(ModelError, Simulation(cradle.system, TimeStepping{.impact_rules = {.sequence_limit = -1}}),
                "sequence_limit");
  EXPECT_THROWS(
      ModelError,
      Simulation(cradle.system, EventDriven{.impact_rules = {.energy_gain = static_cast<EnergyGain>(7)}}),
      "energy_gain", "7");
}

/// Two boxes with round corners, turned, that meet with these; or discs in the place of the corners that
/// meet.
System corners_that_meet(bool discs, double slope, ImpactLaw law) {
  constexpr double round = 0.05;
  System system;
  system.set_default_law({.friction = 0.6, .normal_restitution = 0.7, .impact_law = law});
  const Vec<2> corner(0.2, 0.1);
  // The corner of each box looks at the other one.
  const auto add = [&](const Vec<2>& place, double angle, const Vec<2>& velocity, double spin) {
    const BodyId body = system.add(RigidBody{
        .mass = box(1.0, 0.4, 0.2), .position = place, .angle = angle, .velocity = velocity, .spin = spin});
    if (discs) {
      system.add(Disc{.body = body, .radius = round, .centre = corner});
    } else {
      system.add(Polygon{.body = body, .vertices = corners_of(0.4, 0.2), .radius = round});
    }
  };
  const auto turned = [&](double angle) -> Vec<2> {
    const double c = std::cos(angle), s = std::sin(angle);
    return {c * corner[0] - s * corner[1], s * corner[0] + c * corner[1]};
  };
  const double other = slope + 3.0;
  add({0.0, 0.0}, slope, {1.0, 0.3}, 0.4);
  add(turned(slope) + Vec<2>(0.4, 0.19) - turned(other), other, {-1.0, -0.5}, -0.3);
  return system;
}

TEST(ImpactLaws, RoundCornersThatMeetAreOneContact) {
  // Each corner stands against the outline of the other body; by the energetic law one contact is followed
  // exactly, where two in one place would share the energy.
  for (const ImpactLaw law : {ImpactLaw::newton, ImpactLaw::poisson, ImpactLaw::energetic}) {
    for (const double slope : {-0.1, 0.0, 0.1, 0.2}) {
      EventDriven options{.relative_tolerance = 1e-12, .absolute_tolerance = 1e-14};
      Simulation boxes(corners_that_meet(false, slope, law), options);
      Simulation discs(corners_that_meet(true, slope, law), options);
      boxes.run_until(0.3);
      discs.run_until(0.3);
      ASSERT_EQ(discs.events().size(), 1U) << slope;
      EXPECT_EQ(boxes.events().size(), 1U) << slope;
      // Velocities are of order 1, levers of 0.2 m.
      for (std::size_t i = 0; i < 6; ++i) {
        EXPECT_NEAR(boxes.state().v[i], discs.state().v[i], 1e-11) << to_string(law) << " " << slope;
      }
    }
  }
}

}  // namespace
