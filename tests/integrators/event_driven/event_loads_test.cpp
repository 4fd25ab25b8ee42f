// Loads that are not finite end an event-driven run with an error that names the element and its bodies,
// whatever the flow, whether a contact is closed or not; the run stands at its last good state.

#include "tests/integrators/same_run.h"

#include <carom/carom.h>

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <string>

namespace {

using namespace carom;
using namespace carom::planar;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double at = 0.3;

enum class Place { flying, resting, jointed };

System scene(Place place) {
  System system;
  system.add(Gravity{{0.0, -9.81}});
  system.add(HalfPlane{.normal = {0.0, 1.0}}, Surface{.friction = 0.3, .normal_restitution = 0.5}, "floor");
  system.add(Particle{.mass = 1.0, .position = {5.0, 3.0}}, "bystander");
  if (place == Place::jointed) {
    const BodyId bar = system.add(RigidBody{.mass = rod(1.0, 1.0), .position = {0.5, 3.0}}, "victim");
    system.add(Revolute{.from = End<2>(ground, {0.0, 3.0}), .to = End<2>(bar, {-0.5, 0.0})});
  } else {
    system.add(Particle{.mass = 1.0, .position = {0.0, place == Place::resting ? 0.0 : 3.0}}, "victim");
  }
  const BodyId victim = system.body("victim");
  system.add(SpringDamper{.from = ground, .to = victim, .stiffness = 1.0}, "innocent");
  return system;
}

TEST(EventLoads, ThatAreNotFiniteAreNamed) {
  for (const Place place : {Place::flying, Place::resting, Place::jointed}) {
    for (const FlowMethod method :
         {FlowMethod::explicit_runge_kutta, FlowMethod::adams, FlowMethod::bdf, FlowMethod::one_step}) {
      for (const bool infinite : {false, true}) {
        System system = scene(place);
        const double bad = infinite ? std::numeric_limits<double>::infinity() : nan;
        system.add(AppliedForce{.on = system.body("victim"),
                                .force = [=](double t) { return Vec<2>(t > at ? bad : 0.0, 0.0); }},
                   "culprit");
        Simulation simulation(system, EventDriven{.method = method});
        try {
          simulation.run_until(1.0);
          ADD_FAILURE() << "nothing was thrown";
        } catch (const SolverError& error) {
          ASSERT_GE(error.failure().parts.size(), 2U) << error.what();
          EXPECT_EQ(error.failure().parts[0], "applied force 'culprit'") << error.what();
          EXPECT_NE(error.failure().parts[1].find("'victim'"), std::string::npos);
          EXPECT_NE(std::string(error.what()).find("not finite"), std::string::npos) << error.what();
        }
        EXPECT_LE(simulation.time(), at);
        for (const double number : simulation.state().q) EXPECT_TRUE(std::isfinite(number));
      }
    }
  }
}

TEST(EventLoads, APotentialThatIsNotFiniteIsNamed) {
  System system = scene(Place::flying);
  system.add(NonlinearSpring{.from = ground,
                             .to = system.body("victim"),
                             .force = [](double) { return 0.0; },
                             .potential_of = [](double length) { return length < 2.5 ? nan : 0.0; }},
             "culprit");
  Simulation simulation(system, EventDriven{});
  try {
    simulation.run_until(1.0);
    ADD_FAILURE() << "nothing was thrown";
  } catch (const SolverError& error) {
    ASSERT_FALSE(error.failure().parts.empty()) << error.what();
    EXPECT_EQ(error.failure().parts[0], "nonlinear spring 'culprit'");
  }
  EXPECT_TRUE(std::isfinite(simulation.energy().total()));
}

}  // namespace
