// First events of steps of a flow.

#include <carom/carom.h>
#include <carom/core/assembly.h>
#include <carom/integrators/event_driven/event_detector.h>
#include <carom/integrators/flow/flow.h>

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <vector>

namespace {

using namespace carom;
using namespace carom::planar;

/// The one component of a model with its detector, without contacts that are closed.
struct Flight {
  explicit Flight(const System& system)
      : assembly(system),
        detector(assembly),
        memory(assembly),
        sample(assembly),
        detection(sample),
        motion(assembly, detector, {{0}, {}}, options, memory),
        failure(motion.model(), clock),
        events(motion, failure, unbounded, detection),
        flow(make_flow(options.method, motion, options.relative_tolerance)),
        y(motion.size()) {
    motion.model().unknowns.gather(assembly.initial_state(), y);
    events.start();
    events.begin_phase(0.0, y.data(),
                       {.force = 10.0, .gap_noise = 1e-13, .speed_noise = 1e-12, .guard_noise = 1e-11});
    flow->start(0.0, y, 0.0);
  }
  /// Goes on up to the first event.
  Event first() {
    for (;;) {
      const Event event = events.step(*flow, flow->end(), y, 1.0);
      if (event.guard != Guard::nothing) return event;
      y.assign(flow->state().begin(), flow->state().end());
      events.accept();
    }
  }

  Assembly assembly;
  Detector detector;
  EventDriven options;
  MotionMemory memory;
  MotionSample sample;
  DetectionMemory detection;
  SmoothMotion motion;
  GroupClock clock;
  GroupFailure failure;
  UnboundedForces unbounded;
  EventDetector events;
  std::unique_ptr<Flow> flow;
  std::vector<double> y;
};

TEST(EventDetector, AGapThatCloses) {
  System system;
  system.add(Gravity{{0.0, -10.0}});
  system.add(Particle{.mass = 1.0, .position = {0.0, 0.2}, .velocity = {0.3, 0.0}});
  system.add(HalfPlane{.point = {0, 0}, .normal = {0, 1}},
             Surface{.friction = 0.0, .normal_restitution = 0.0});
  Flight ball(system);
  const Event event = ball.first();
  EXPECT_EQ(event.guard, Guard::gap);
  EXPECT_EQ(event.which, 0U);
  EXPECT_NEAR(event.time, 0.2, 1e-12);
  ball.events.land(*ball.flow, event, ball.y);
  EXPECT_NEAR(ball.y[0], 0.06, 1e-12);
  EXPECT_NEAR(ball.y[1], 0.0, 1e-12);
  EXPECT_NEAR(ball.y[3], -2.0, 1e-11);
}

TEST(EventDetector, TheSwitchingPointOfACableAndItsSide) {
  System system;
  const BodyId ball = system.add(Particle{.mass = 1.0, .position = {0.5, 0.0}, .velocity = {2.0, 0.0}});
  system.add(Cable{.from = {ground, {0, 0}}, .to = ball, .stiffness = 100.0, .free_length = 1.0});
  Flight flight(system);
  Event event = flight.first();
  EXPECT_EQ(event.guard, Guard::switching_point);
  EXPECT_NEAR(event.time, 0.25, 1e-9);
  // Behind it the guard is on the other side, and the next passage is the way back.
  flight.events.land(*flight.flow, event, flight.y);
  flight.events.pass(event);
  flight.events.begin_phase(event.time, flight.y.data(),
                            {.force = 10.0, .gap_noise = 1e-13, .speed_noise = 1e-12, .guard_noise = 1e-11});
  flight.flow->start(event.time, flight.y, 0.0);
  event = flight.first();
  EXPECT_EQ(event.guard, Guard::switching_point);
  const double half_period = std::acos(-1.0) / 10.0;
  EXPECT_NEAR(event.time, 0.25 + half_period, 1e-8);
}

TEST(EventDetector, ADiscontinuityEndsTheStep) {
  System system;
  const BodyId ball = system.add(Particle{.mass = 1.0});
  system.add(AppliedForce{
      .on = ball, .force = [](double t) { return Vec<2>(t < 0.3 ? 1.0 : -1.0, 0.0); }, .breaks = {0.3}});
  Flight flight(system);
  const Event event = flight.first();
  EXPECT_EQ(event.guard, Guard::discontinuity);
  EXPECT_EQ(event.time, 0.3);
}

}  // namespace
