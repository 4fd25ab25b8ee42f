#include <carom/joints/maxwell.h>

#include "tests/analytic/convergence.h"
#include "tests/energy/ledger_check.h"
#include "tests/integrators/same_run.h"
#include "tests/model_error.h"

#include <carom/carom.h>

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <limits>
#include <vector>

namespace {

using namespace carom;
using namespace carom::planar;
using carom_test::ledger_closes;

constexpr double eps = std::numeric_limits<double>::epsilon();
constexpr double k = 50.0;  // N/m
constexpr double c = 20.0;  // N s/m

/// A body so heavy that the element cannot move it.
struct Held {
  Held() {
    body = system.add(Particle{.mass = 1e15, .position = {1.5, 0.0}});
    element = system.add(
        MaxwellElement{.from = ground, .to = body, .stiffness = k, .damping = c, .free_length = 1.0});
  }
  System system;
  BodyId body;
  ElementId element;
};

TEST(Maxwell, TensionRelaxesExponentially) {
  // Stretched by 0.5 m and held: T = 25 N exp(-k t / c).
  const auto error = [](double step) {
    Held held;
    Simulation simulation(held.system, TimeStepping{.step = step});
    simulation.run_until(1.0);
    const double tension = k * (0.5 - simulation.state().internal(held.element)[0]);
    return std::abs(tension - k * 0.5 * std::exp(-k / c));
  };
  std::vector<double> steps, errors;
  for (const double step : {0.04, 0.02, 0.01, 0.005}) {
    steps.push_back(step);
    errors.push_back(error(step));
  }
  // The next term of the series is (h k/c)^2/20 = 5e-4 of the first at the largest step.
  EXPECT_NEAR(analytic::slope(steps, errors), 2.0, 1e-3);
  // Leading term of the trapezoidal rule: t (k/c)^3 h^2/12 of T.
  EXPECT_NEAR(errors.back(), k * 0.5 * std::exp(-k / c) * std::pow(k / c, 3.0) * 25e-6 / 12.0,
              1e-3 * errors.back());
}

TEST(Maxwell, AllOfTheSpringsEnergyIsLostInTheDashpot) {
  for (const double step : {1e-3, 0.1, 100.0}) {  // relaxation time 0.4 s: no limit to the step
    Held held;
    Simulation simulation(held.system, TimeStepping{.step = step});
    const double stored = simulation.energy().stored(StoredEnergy::elastic);
    EXPECT_DOUBLE_EQ(stored, 0.5 * k * 0.25);
    for (int i = 0; i < 200; ++i) simulation.step();
    const double now = simulation.energy().stored(StoredEnergy::elastic);
    EXPECT_NEAR(simulation.energy().flow(EnergyFlow::dashpot), stored - now, 1e-12 * stored) << step;
    EXPECT_LE(std::abs(simulation.energy().flow(EnergyFlow::coupling_discretisation)), 1e-12 * stored);
  }
}

TEST(Maxwell, CreepsUnderAConstantLoad) {
  // Hung by it, once the spring has stretched a load F lengthens the dashpot at F / c.
  System system;
  const BodyId body = system.add(Particle{.mass = 0.1, .position = {0.0, -1.0}});
  const ElementId element = system.add(
      MaxwellElement{.from = ground, .to = body, .stiffness = k, .damping = c, .free_length = 1.0});
  system.add(Gravity{{0.0, -10.0}});
  system.add(Drag{.on = body, .linear = 5.0});
  Simulation simulation(std::move(system), TimeStepping{.step = 1e-3});
  simulation.run_until(5.0);
  const double before = simulation.state().internal(element)[0];
  simulation.run_until(6.0);
  // The drag takes its part of the load: speed w, T = m g - d w, w = T / c, so w = m g / (c + d).
  EXPECT_NEAR(simulation.state().internal(element)[0] - before, 1.0 / 25.0, 1e-9);
  EXPECT_TRUE(ledger_closes(simulation.energy()));
}

System swinging(ElementId* element = nullptr) {
  System system;
  const BodyId plate = system.add(
      RigidBody{.mass = disc(1.0, 0.3), .position = {1.0, 0.2}, .velocity = {0.0, 3.0}, .spin = 2.0});
  const BodyId dot = system.add(Particle{.mass = 0.5, .position = {2.0, 0.0}, .velocity = {1.0, -2.0}});
  const ElementId id = system.add(MaxwellElement{.from = {plate, {0.1, 0.1}},
                                                 .to = dot,
                                                 .stiffness = 200.0,
                                                 .damping = 10.0,
                                                 .free_length = 0.7,
                                                 .lengthening = 0.05});
  system.add(SpringDamper{.from = ground, .to = plate, .stiffness = 40.0, .free_length = 0.5});
  if (element != nullptr) *element = id;
  return system;
}

TEST(Maxwell, LosesNothingButInItsDashpotUnderTheConservingRule) {
  Simulation simulation(
      swinging(), TimeStepping{.step = 5e-3, .tolerance = 0.0, .force_rule = ForceRule::energy_momentum});
  double last = 0.0;
  for (int i = 0; i < 2000; ++i) {
    simulation.step();
    const double lost = simulation.energy().flow(EnergyFlow::dashpot);
    EXPECT_GE(lost, last);
    last = lost;
  }
  EXPECT_LE(std::abs(simulation.energy().flow(EnergyFlow::coupling_discretisation)),
            1e3 * eps * simulation.energy().scale() * 10.0);
  EXPECT_TRUE(ledger_closes(simulation.energy()));
}

/// The same law through the user's door, by its rates alone.
struct PlainMaxwell {
  static constexpr Role role = Role::force;
  static constexpr int dimension = 2;
  static constexpr int internal_size = 1;
  End<2> from{}, to{};
  double stiffness = 0.0, damping = 0.0, free_length = 0.0, lengthening = 0.0;

  std::vector<BodyId> bodies() const { return {from.body, to.body}; }
  double tension(const ElementView<2>& at) const {
    return stiffness * ((at.position(to) - at.position(from)).norm() - free_length - *at.internal());
  }
  void loads(const ElementView<2>& at, ElementLoads<2>& out) const {
    const Vec<2> pull = tension(at) * (at.position(to) - at.position(from)).normalized();
    out.conservative(from, pull);
    out.conservative(to, -pull);
  }
  double potential(const ElementView<2>& at) const { return 0.5 * tension(at) * tension(at) / stiffness; }
  void initial_internal(double* z) const { z[0] = lengthening; }
  void internal_rates(const ElementView<2>& at, double* rates) const { rates[0] = tension(at) / damping; }
  double internal_loss_rate(const ElementView<2>& at) const { return tension(at) * tension(at) / damping; }
};

TEST(Maxwell, AUsersElementWithItsRatesAloneMovesAlike) {
  ElementId element;
  Simulation own(swinging(&element), TimeStepping{.step = 1e-3});
  System system = swinging();
  const auto& bodies = system.body_kinds();
  ASSERT_GE(bodies.next_serial(), 2U);
  const BodyId plate{0, system.token()}, dot{1, system.token()};
  system.remove(ElementId{element.serial, system.token()});
  const ElementId plain = system.add(PlainMaxwell{{plate, {0.1, 0.1}}, dot, 200.0, 10.0, 0.7, 0.05});
  Simulation users(std::move(system), TimeStepping{.step = 1e-3});
  own.run_until(1.0);
  users.run_until(1.0);
  for (std::size_t i = 0; i < own.state().q.size(); ++i) {
    EXPECT_NEAR(users.state().q[i], own.state().q[i], 1e-10);
  }
  EXPECT_NEAR(users.state().internal(plain)[0], own.state().internal(element)[0], 1e-10);
  // Its loss is taken halfway, not exactly: of second order, in the line of the coupling.
  EXPECT_NEAR(users.energy().flow(EnergyFlow::dashpot), own.energy().flow(EnergyFlow::dashpot), 1e-3);
  EXPECT_TRUE(ledger_closes(users.energy()));
}

TEST(Maxwell, CheckpointGoesOnBitForBit) {
  const std::string path = testing::TempDir() + "maxwell.checkpoint";
  for (const ForceRule force_rule : {ForceRule::trapezoidal, ForceRule::energy_momentum}) {
    const TimeStepping options{.step = 1e-3, .force_rule = force_rule};
    Simulation whole(swinging(), options);
    whole.run_until(0.3);
    whole.save(path);
    whole.run_until(0.6);
    // Loaded over a run that stood elsewhere.
    Simulation loaded(whole.system(), options);
    loaded.run_until(0.1);
    loaded.load(path);
    loaded.run_until(0.6);
    EXPECT_EQ(carom_test::bits_of(loaded), carom_test::bits_of(whole));
  }
  std::remove(path.c_str());
}

TEST(Maxwell, AnEditKeepsItsLengthening) {
  ElementId element;
  Simulation simulation(swinging(&element), TimeStepping{.step = 1e-3});
  const ElementId id{element.serial, simulation.system().token()};
  simulation.run_until(0.2);
  const double s = simulation.state().internal(id)[0];
  ElementId added;
  simulation.edit([&](System& system) {
    const BodyId body = system.add(Particle{.mass = 1.0, .position = {5.0, 5.0}});
    added = system.add(
        MaxwellElement{.from = ground, .to = body, .stiffness = k, .damping = c, .lengthening = 0.3});
  });
  EXPECT_EQ(simulation.state().internal(id)[0], s);
  EXPECT_EQ(simulation.state().internal(added)[0], 0.3);
  EXPECT_NO_THROW(simulation.run_until(0.3));
}

TEST(Maxwell, RefusesWhatCannotBe) {
  System system;
  const BodyId body = system.add(Particle{.mass = 1.0, .position = {1.0, 0.0}});
  const MaxwellElement good{.from = ground, .to = body, .stiffness = k, .damping = c};
  const auto with = [&](auto member, double value) {
    MaxwellElement part = good;
    part.*member = value;
    return part;
  };
  EXPECT_MODEL_ERROR(system.add(with(&MaxwellElement::stiffness, 0.0)), "Maxwell element", "stiffness is 0");
  EXPECT_MODEL_ERROR(system.add(with(&MaxwellElement::damping, -1.0)), "Maxwell element", "damping is -1");
  EXPECT_MODEL_ERROR(system.add(with(&MaxwellElement::free_length, -0.1)), "free_length is -0.1", ">= 0");
  EXPECT_MODEL_ERROR(system.add(with(&MaxwellElement::lengthening, std::nan(""))), "lengthening is nan",
                     "finite");
  Simulation simulation(system, TimeStepping{});
  EXPECT_MODEL_ERROR((void)simulation.state().internal(ElementId{}), "internal variables", "has none");
}

/// Rates that become infinite: dz/dt = z^2.
struct Exploding {
  static constexpr Role role = Role::force;
  static constexpr int dimension = 2;
  static constexpr int internal_size = 1;
  BodyId body;
  std::vector<BodyId> bodies() const { return {body}; }
  void loads(const ElementView<2>&, ElementLoads<2>&) const {}
  void initial_internal(double* z) const { z[0] = 1.0; }
  void internal_rates(const ElementView<2>& at, double* rates) const {
    rates[0] = *at.internal() * *at.internal();
  }
};

TEST(Maxwell, InternalVariablesThatCannotBeAdvancedEndTheStepByName) {
  System system;
  const BodyId body = system.add(Particle{.mass = 1.0});
  system.add(Exploding{body}, "bomb");
  Simulation simulation(std::move(system), TimeStepping{.step = 0.1});
  const auto run = [&] { simulation.run_until(2.0); };
  try {
    run();
    FAIL() << "z = 1/(1 - t) was integrated past t = 1";
  } catch (const SolverError& error) {
    EXPECT_NE(std::string(error.what()).find("bomb"), std::string::npos) << error.what();
    EXPECT_EQ(error.failure().time, simulation.time());
  }
}

}  // namespace
