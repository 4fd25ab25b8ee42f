// A light body between a heavy one and the floor, and on a heavy one: masses that differ by up to 1e13.

#include <carom/carom.h>

#include "tests/integrators/throws.h"
#include "tests/shares.h"

#include <gtest/gtest.h>

#include <cmath>

namespace {

using namespace carom;
using namespace carom::planar;

constexpr double gravity = 9.81, size = 0.2, gap = 0.1;

struct Tower {
  System system;
  BodyId low{}, high{};
};

/// Two discs or two boxes above each other; the upper one falls by `gap`. \param beside of the upper box [m]
Tower tower(double low_mass, double high_mass, bool boxes, double restitution = 0.0, double beside = 0.05) {
  Tower at;
  at.system.add(Gravity{{0.0, -gravity}});
  at.system.set_default_law(Surface{.friction = 0.5, .normal_restitution = restitution});
  at.system.add(HalfPlane{.normal = {0.0, 1.0}}, "floor");
  const auto add = [&](double mass, double x, double y) {
    const BodyId body = at.system.add(
        RigidBody{.mass = boxes ? box(mass, 2.0 * size, 2.0 * size) : disc(mass, size), .position = {x, y}});
    if (boxes) {
      at.system.add(
          Polygon{.body = body, .vertices = {{-size, -size}, {size, -size}, {size, size}, {-size, size}}});
    } else {
      at.system.add(Disc{.body = body, .radius = size});
    }
    return body;
  };
  at.low = add(low_mass, 0.0, size);
  at.high = add(high_mass, boxes ? beside : 0.0, 3.0 * size + gap);
  return at;
}

/// Both lie still, one on the other. \param depth as deep as steps may let a body sink, (3 - e)/2 h v
void expect_at_rest(const Simulation& simulation, const Tower& at, double depth, double speed) {
  const State& state = simulation.state();
  EXPECT_NEAR(state.position(at.low)[1], size, depth);
  EXPECT_NEAR(state.position(at.high)[1], 3.0 * size, depth);
  EXPECT_LE(state.velocity(at.low).norm(), speed);
  EXPECT_LE(state.velocity(at.high).norm(), speed);
}

constexpr double step = 1e-3;
const double step_depth = 1.5 * step * std::sqrt(2.0 * gravity * gap);

TEST(UnevenMasses, ALightBodyOnAHeavyOneIsStepped) {
  for (const bool boxes : {false, true}) {
    for (const double ratio : {1e6, 1e12, 1e13}) {
      const Tower at = tower(ratio, 1.0, boxes);
      Simulation simulation(at.system, TimeStepping{.step = step});
      ASSERT_NO_THROW(simulation.run_until(0.5)) << boxes << ' ' << ratio;
      expect_at_rest(simulation, at, step_depth, 1e-14);  // rounding of h g
    }
  }
}

TEST(UnevenMasses, ALightBodyOnAHeavyOneHasEvents) {
  for (const bool boxes : {false, true}) {
    for (const double ratio : carom_test::samples({1e6, 1e10, 1e12, 1e13})) {
      const Tower at = tower(ratio, 1.0, boxes);
      Simulation simulation(at.system, EventDriven{});
      ASSERT_NO_THROW(simulation.run_until(0.5)) << boxes << ' ' << ratio;
      expect_at_rest(simulation, at, 1e-9, 1e-9);  // tolerances of the integrator
    }
  }
}

TEST(UnevenMasses, ALightBodyUnderAHeavyOneIsStepped) {
  for (const bool boxes : {false, true}) {
    for (const double ratio : {1e6, 1e9}) {
      const Tower at = tower(1.0, ratio, boxes);
      Simulation simulation(at.system, TimeStepping{.step = step});
      ASSERT_NO_THROW(simulation.run_until(0.5)) << boxes << ' ' << ratio;
      // The certificate, 1e-12 of the impulses of the heavy body, over the mass of the light one.
      expect_at_rest(simulation, at, step_depth, 1e-12 * ratio * step * gravity);
    }
  }
}

// The answer of a heavy disc is lost in that of the light one that both contacts of the island have: it sank
// with an acceleration of up to the ratio of masses times rounding, into the light one.
TEST(UnevenMasses, AHeavyDiscDoesNotSinkIntoALightOne) {
  for (const double ratio : {1e5, 1e7, 1e9, 1e10}) {
    const Tower at = tower(1.0, ratio, false, 0.5);
    Simulation simulation(at.system, EventDriven{});
    ASSERT_NO_THROW(simulation.run_until(2.0)) << ratio;
    expect_at_rest(simulation, at, 1e-15, 1e-15);  // rounding of places of 0.6 m
  }
}

// The weight of the heavy box throws corners of the light one back so fast that a bounce at the capture speed
// is not higher than the rounding of gaps: each began a little deeper than the one before it, and was as
// fast. (Friction may make corners chatter too, some 1e6 times a second, which ends.)
TEST(UnevenMasses, ALightBodyBouncesToAnEndUnderAHeavyOne) {
  for (const double beside : {0.1, 0.1 + 1e-9, 0.1 + 2e-9}) {
    const Tower at = tower(1.0, 1e6, true, 0.5, beside);
    Simulation simulation(at.system, EventDriven{.event_limit = 1e8});
    ASSERT_NO_THROW(simulation.run_until(2.0)) << beside;
    expect_at_rest(simulation, at, 1e-9, 1e-9);  // tolerances of the integrator
  }
}

// Impacts of the heavy body are solved with five digits, and others follow from them.
TEST(UnevenMasses, FewDigitsAreNamedWhereverARunEnds) {
  for (const bool boxes : {false, true}) {
    const Tower at = tower(1.0, 1e11, boxes, 0.5);
    Simulation events(at.system, EventDriven{});
    EXPECT_THROWS(SolverError, events.run_until(1.0), "masses differ by a factor of 1", "digits");
  }
}

TEST(UnevenMasses, WithoutDigitsAreNamed) {
  for (const bool boxes : {false, true}) {
    const Tower at = tower(1.0, 1e14, boxes);
    Simulation steps(at.system, TimeStepping{.step = step});
    EXPECT_THROWS(SolverError, steps.run_until(0.5), "masses differ by a factor of 1", "1 digits");
    Simulation events(at.system, EventDriven{});
    EXPECT_THROWS(SolverError, events.run_until(0.5), "masses differ by a factor of 1", "1 digits");
  }
}

}  // namespace
