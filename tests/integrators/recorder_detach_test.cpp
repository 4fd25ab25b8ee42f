// Recorders of bodies that are removed, of runs that they are taken off, and beside observers that fail.

#include "tests/integrators/pair_scene.h"
#include "tests/integrators/same_run.h"
#include "tests/integrators/throws.h"
#include "tests/temporary_folder.h"

#include <carom/carom.h>
#include <carom/integrators/run/companion.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace {

using namespace carom;
using namespace carom::planar;
using carom_test::bits_of;
using carom_test::pair_scene;

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

System with_visitor() {
  System system = pair_scene();
  system.add(RigidBody{.mass = disc(1.0, 0.1), .position = {5.0, 9.0}, .spin = 2.0}, "visitor");
  return system;
}

TEST(RecorderOfARemovedBody, LeavesItsFieldsEmpty) {
  const carom_test::TemporaryFolder folder;
  for (const Mode& mode : {Mode(TimeStepping{.step = 1e-3}), Mode(EventDriven{.interval = 1e-3})}) {
    Simulation run(with_visitor(), mode);
    const BodyId visitor = run.system().body("visitor");
    CsvRecorder all(run, folder / "all.csv");
    CsvRecorder one(run, folder / "one.csv", {.bodies = {visitor}, .energies = false});
    EnergyRecorder energies(run);
    run.run_until(0.003);
    run.edit([&](System& system) { system.remove(visitor); });
    run.run_until(0.005);
    run.edit([&](System& system) {
      system.add(RigidBody{.mass = disc(1.0, 0.1), .position = {5.0, 9.0}}, "visitor");
    });
    run.run_until(0.006);  // another one of that name is another body
    all.flush();
    one.flush();
    const std::vector<std::string> lines = lines_of(folder.text_of("one.csv"));
    ASSERT_EQ(lines.size(), 8u);
    for (const std::size_t with : {1u, 4u}) EXPECT_EQ(lines[with].find(",,"), std::string::npos);
    for (const std::size_t without : {5u, 6u, 7u}) {
      EXPECT_NE(lines[without].find(",,,,,,"), std::string::npos) << lines[without];
    }
    for (const std::string file : {"one.csv", "all.csv"}) {
      const std::vector<std::string> rows = lines_of(folder.text_of(file));
      for (const std::string& row : rows) {
        EXPECT_EQ(std::count(row.begin(), row.end(), ','), std::count(rows[0].begin(), rows[0].end(), ','));
      }
    }
    EXPECT_EQ(energies.trace().rows().size(), 7u);
  }
}

TEST(RecorderDetached, RecordsNoMoreAndLeavesTheRunAlone) {
  const carom_test::TemporaryFolder folder;
  Simulation run(pair_scene(), TimeStepping{.step = 1e-3});
  CsvRecorder table(run, folder / "run.csv");
  EnergyRecorder every_step(run);
  EnergyRecorder now_and_then(run, {.interval = 0.0025});
  run.run_until(0.01);
  Simulation other(pair_scene(), TimeStepping{.step = 1e-3});
  EXPECT_THROWS(ModelError, table.detach(other), "remove_callback", "allowed");
  table.detach(run);
  every_step.detach(run);
  now_and_then.detach(run);
  EXPECT_THROWS(ModelError, table.detach(run), "remove_callback", "allowed");
  EXPECT_TRUE(run.companion().rhythms.empty());
  run.run_until(0.1);
  EXPECT_EQ(table.rows(), 13);  // steps of 1 ms, and two that end between
  EXPECT_EQ(lines_of(folder.text_of("run.csv")).size(), 14u);
  EXPECT_EQ(every_step.trace().rows().size(), 13u);
  EXPECT_EQ(now_and_then.trace().rows().size(), 5u);
  // Attached or not, the same run but for where steps end.
  Simulation plain(pair_scene(), TimeStepping{.step = 1e-3});
  const CallbackId rhythm = plain.every(0.0025, [](Simulation&) {});
  plain.run_until(0.01);
  plain.remove_callback(rhythm);
  plain.run_until(0.1);
  EXPECT_EQ(bits_of(run), bits_of(plain));
}

TEST(RecorderDetached, AnObserverThatFailsPoisonsNoRecorder) {
  const carom_test::TemporaryFolder folder;
  Simulation run(pair_scene(), TimeStepping{.step = 1e-3});
  const CallbackId failing = run.observe([](const Simulation&) { throw std::runtime_error("broken"); });
  CsvRecorder table(run, folder / "run.csv");
  for (int i = 0; i < 3; ++i) EXPECT_THROWS(std::runtime_error, run.step(), "broken");
  EXPECT_EQ(table.rows(), 4);
  run.remove_callback(failing);
  run.run_until(0.01);
  EXPECT_EQ(table.rows(), 11);
  Simulation plain(pair_scene(), TimeStepping{.step = 1e-3});
  plain.run_until(0.01);
  EXPECT_EQ(bits_of(run), bits_of(plain));
}

}  // namespace
