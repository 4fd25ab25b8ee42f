#include <carom/core/errors.h>
#include <carom/testing/matchers.h>

#include "tests/integrators/throws.h"
#include "tests/temporary_folder.h"
#include "tests/testing/verdict_of.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <string>

namespace {

using namespace carom;
using namespace carom::energy_test;
using carom_test::TemporaryFolder;

EnergyTrace trace_with(double last_energy) {
  EnergyTrace trace;
  trace.add(TraceEvent{0.5, "ball on floor, stick"});
  for (const double time : {0.0, 1.0}) {
    TraceRow row;
    row.time = time;
    row.stored[StoredEnergy::elastic] = time == 0.0 ? 2.0 : last_energy;
    row.energy_scale = 2.0;
    trace.add(row);
  }
  return trace;
}

/// Sets the variable while it lives.
class Environment {
public:
  explicit Environment(const char* value) { setenv(rewrite_variable, value, 1); }
  ~Environment() { unsetenv(rewrite_variable); }
  Environment(const Environment&) = delete;
  Environment& operator=(const Environment&) = delete;
};

class MatchesStoredTrace : public testing::Test {
protected:
  // Whoever rewrites the stored traces of this project runs these tests, too.
  void SetUp() override { unsetenv(rewrite_variable); }
};

TEST_F(MatchesStoredTrace, WhatIsStoredWithinTolerances) {
  const TemporaryFolder folder;
  trace_with(1.0).save(folder / "run.csv");
  EXPECT_THAT(trace_with(1.0), matches_stored_trace(folder / "run.csv", {}));
  EXPECT_THAT(trace_with(1.0 + 1e-6), matches_stored_trace(folder / "run.csv", {.energy = 1.1e-6}));
  EXPECT_THAT(trace_with(1.0 + 1e-6), matches_stored_trace(folder / "run.csv", {.relative = 0.6e-6}));
  EXPECT_FALSE(folder.has("run.produced.csv"));
}

TEST_F(MatchesStoredTrace, OtherwiseReportsAndKeepsTheProducedTrace) {
  const TemporaryFolder folder;
  trace_with(1.0).save(folder / "run.csv");
  const std::string stored = folder.text_of("run.csv");
  EXPECT_REFUSES(matches_stored_trace(folder / "run.csv", {.energy = 1e-3}), trace_with(1.5),
                 "'elastic' departs first: at t = 1 s by 0.5 J, allowed 0.001 J",
                 "nearest event: t = 0.5 s (0.5 s before): ball on floor, stick", folder / "run.produced.csv",
                 "CAROM_REWRITE_TRACES=1 ctest -R "
                 "'MatchesStoredTrace.OtherwiseReportsAndKeepsTheProducedTrace'");
  EXPECT_EQ(folder.text_of("run.csv"), stored);
  EXPECT_EQ(EnergyTrace::load(folder / "run.produced.csv").values("elastic"), (std::vector{2.0, 1.5}));
}

TEST_F(MatchesStoredTrace, AMissingOneIsAFailureThatSaysHowToMakeIt) {
  const TemporaryFolder folder;
  EXPECT_REFUSES(matches_stored_trace(folder / "run.csv", {}), trace_with(1.0), "there is no stored trace",
                 folder / "run.csv", "the produced trace is in",
                 "CAROM_REWRITE_TRACES=1 ctest -R 'MatchesStored");
  EXPECT_TRUE(folder.has("run.produced.csv"));
  EXPECT_FALSE(folder.has("run.csv"));
}

TEST_F(MatchesStoredTrace, ABrokenOneOrOtherTimesFailWithTheReason) {
  const TemporaryFolder folder;
  folder.write("run.csv", "nonsense\n");
  EXPECT_REFUSES(matches_stored_trace(folder / "run.csv", {}), trace_with(1.0), "line 1",
                 "column 'time [s]' is missing", "the produced trace is in");
  EnergyTrace later = trace_with(1.0);
  TraceRow row;
  row.time = 3.0;
  later.add(row);
  later.save(folder / "run.csv");
  EXPECT_REFUSES(matches_stored_trace(folder / "run.csv", {}), trace_with(1.0), "2 rows", "same times");
}

TEST_F(MatchesStoredTrace, SaysWhereItCannotWriteTheProducedTrace) {
  const TemporaryFolder folder;
  EXPECT_REFUSES(matches_stored_trace(folder / "no/such/place.csv", {}), trace_with(1.0),
                 "place.produced.csv' cannot be written");
}

TEST_F(MatchesStoredTrace, TheEnvironmentRewritesOnPurpose) {
  const TemporaryFolder folder;
  trace_with(1.0).save(folder / "run.csv");
  {
    const Environment rewrite("1");
    testing::internal::CaptureStdout();
    EXPECT_THAT(trace_with(1.5), matches_stored_trace(folder / "run.csv", {}));
    const std::string said = testing::internal::GetCapturedStdout();
    EXPECT_NE(said.find("run.csv' was rewritten, nothing was compared"), std::string::npos) << said;
    EXPECT_REFUSES(matches_stored_trace(folder / "no/such/place.csv", {}), trace_with(1.0),
                   "place.csv' cannot be written");
    EXPECT_REFUSES(matches_stored_trace(folder / "empty.csv", {}), EnergyTrace(), "no rows");
  }
  EXPECT_THAT(trace_with(1.5), matches_stored_trace(folder / "run.csv", {}));
  EXPECT_THAT(trace_with(1.0), testing::Not(matches_stored_trace(folder / "run.csv", {})));
}

TEST_F(MatchesStoredTrace, OnlyOneRewrites) {
  EXPECT_FALSE(rewrite_requested());
  for (const char* value : {"", "0"}) {
    const Environment rewrite(value);
    EXPECT_FALSE(rewrite_requested());
  }
  const Environment unclear("yes");
  EXPECT_THROWS(ModelError, rewrite_requested(), "CAROM_REWRITE_TRACES is 'yes'", "1 (rewrite");
}

TEST_F(MatchesStoredTrace, ProducedTracesStandBesideStoredOnes) {
  EXPECT_EQ(produced_path("traces/pair.csv"), "traces/pair.produced.csv");
  EXPECT_EQ(produced_path("pair"), "pair.produced");
}

}  // namespace
