#pragma once

// Event-driven runs of mechanisms, watched: joints at every output, the energy ledger.

#include "tests/integrators/event_run.h"
#include "tests/integrators/joint_scenes.h"

#include <carom/carom.h>

#include <gtest/gtest.h>

namespace joint_scenes {

inline constexpr double gap_limit = 1e-10, speed_limit = 1e-9;  // [m, rad], [m/s, rad/s]

/// Of the event-driven runs with joints.
inline EventDriven fine() { return {.relative_tolerance = 1e-12, .absolute_tolerance = 1e-12}; }

/// A run that is watched: joints at every output, the energy ledger.
struct WatchedRun {
  Simulation simulation;
  JointCheck joints;
  carom_test::LedgerWatch ledger;

  explicit WatchedRun(const Scene& scene, const EventDriven& options = fine())
      : simulation(scene.system, options), joints(simulation), ledger(simulation) {}
  ~WatchedRun() {
    EXPECT_LE(joints.gap, gap_limit);
    EXPECT_LE(joints.speed, speed_limit);
    EXPECT_TRUE(ledger.closes());
    carom_test::note("gap", joints.gap);
    carom_test::note("speed", joints.speed);
    carom_test::note("ledger", ledger.worst());
  }
  WatchedRun(const WatchedRun&) = delete;
  WatchedRun& operator=(const WatchedRun&) = delete;
};

}  // namespace joint_scenes
