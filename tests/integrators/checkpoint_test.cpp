// Saved and loaded, a run continues bit for bit; files that cannot be are refused by name.

#include "examples/scenes/discs.h"
#include "examples/scenes/incline.h"
#include "tests/integrators/event_runs.h"
#include "tests/integrators/same_run.h"
#include "tests/integrators/throws.h"

#include <carom/carom.h>

#include <gtest/gtest.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

namespace {

using namespace carom;
using namespace carom::planar;
using carom_test::bits_of;

/// The pair close above the plane, with a bar of its own: impacts with friction, unequal coefficients.
System scene(const std::function<void(System&)>& change = {}) {
  scenes::Incline incline;
  incline.height = 2.0;
  incline.angle = 0.3;
  incline.friction = 0.5;
  incline.normal_restitution = 0.9;
  incline.tangential_restitution = 0.2;
  System system;
  scenes::add_plane(system, incline);
  scenes::add_pair(system, incline);
  incline.height = 1.7;
  scenes::add_bar(system, incline);
  if (change) change(system);
  return system;
}

class Checkpoint : public testing::Test {
protected:
  Checkpoint() {
    const auto* info = testing::UnitTest::GetInstance()->current_test_info();
    path_ =
        (std::filesystem::path(testing::TempDir()) / (std::string("carom_") + info->name() + ".checkpoint"))
            .string();
    std::filesystem::remove(path_);
  }
  ~Checkpoint() override {
    std::filesystem::remove(path_);
    std::filesystem::remove_all(path_ + ".unfinished");
  }

  [[nodiscard]] std::vector<char> bytes() const {
    std::ifstream file(path_, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }
  void write(const std::vector<char>& content) const {
    std::ofstream file(path_, std::ios::binary | std::ios::trunc);
    file.write(content.data(), static_cast<std::streamsize>(content.size()));
  }

  std::string path_;
};

TEST_F(Checkpoint, ContinuesBitForBit) {
  // Saved in free flight, in the middle of contact, and after a step that was cut short.
  for (const double time : {0.1, 0.5, 0.73219, 1.5}) {
    Simulation whole(scene(), TimeStepping{.step = 1e-3});
    whole.run_until(time);
    whole.save(path_);
    const auto saved = bits_of(whole);
    whole.run_until(3.0);

    Simulation fresh(scene(), TimeStepping{.step = 1e-3});
    fresh.load(path_);
    EXPECT_EQ(bits_of(fresh), saved) << time;
    fresh.run_until(3.0);
    EXPECT_EQ(bits_of(fresh), bits_of(whole)) << time;
    EXPECT_GT(whole.statistics().impacts, 5);
  }
}

// Without a file: the same bytes; a copy of a simulation goes on as the first one, and has none of its
// callbacks.
TEST_F(Checkpoint, BytesAndCopiesContinueBitForBit) {
  for (const Mode& mode : {Mode(TimeStepping{.step = 1e-3}), Mode(EventDriven{})}) {
    for (const double time : {0.0, 0.1, 0.73219, 1.5}) {
      Simulation whole(scene(), mode);
      int calls = 0;
      whole.observe([&](const Simulation&) { ++calls; });
      whole.every(0.25, [](Simulation&) {});
      whole.run_until(time);
      Simulation copy = whole.copy();
      const int before = calls;
      whole.save(path_);
      const std::string made = whole.checkpoint();
      EXPECT_EQ(std::vector<char>(made.begin(), made.end()), bytes());
      Simulation fresh(scene(), mode);
      fresh.observe([](const Simulation&) {});  // an event-driven run that is observed ends its intervals
      fresh.every(0.25, [](Simulation&) {});
      fresh.restore(made);
      for (Simulation* const other : {&copy, &fresh}) other->run_until(time);
      EXPECT_EQ(bits_of(copy), bits_of(whole)) << time;
      copy.run_until(2.0);
      EXPECT_EQ(calls, before);
      fresh.run_until(2.0);
      whole.run_until(2.0);
      EXPECT_EQ(bits_of(fresh), bits_of(whole)) << time;
    }
  }
}

TEST_F(Checkpoint, WrongBytesChangeNothing) {
  Simulation whole(scene(), TimeStepping{.step = 1e-3});
  whole.run_until(0.5);
  const auto before = bits_of(whole);
  std::string made = whole.checkpoint();
  made[made.size() / 2] = static_cast<char>(made[made.size() / 2] + 1);
  for (const std::string& wrong : {std::string(), std::string("nothing"), made, made.substr(0, 20)}) {
    EXPECT_THROWS(FileError, whole.restore(wrong), "in memory");
  }
  EXPECT_EQ(bits_of(whole), before);
}

TEST_F(Checkpoint, AStateFitsEverySimulationOfItsModel) {
  const System system = scene();
  Simulation one(system, TimeStepping{.step = 1e-3}), two(system, EventDriven{}),
      other(scene(), TimeStepping{});
  one.run_until(0.4);
  two.set_state(one.state());
  EXPECT_EQ(two.state().q, one.state().q);
  EXPECT_THROWS(ModelError, other.set_state(one.state()), "state", "another one");
  // Behind an edit the numbers of a state have other places.
  two.edit([](System& edited) { edited.add(Particle{.mass = 1.0, .position = {9.0, 9.0}}); });
  EXPECT_THROWS(ModelError, two.set_state(one.state()), "state");
}

// Discs that meet, and fall on the plane, by every method: of the steps ahead of the state nothing is left.
TEST_F(Checkpoint, ContinuesBitForBitFromEventToEvent) {
  const auto discs = [](System& system) {
    for (int i = 0; i < 3; ++i) {
      const BodyId body =
          system.add(RigidBody{.mass = disc(1.0 + i, 0.2), .position = {3.0 + 0.05 * i, 1.0 + 0.6 * i}});
      system.add(Disc{.body = body, .radius = 0.2});
    }
    system.set_default_law({.friction = 0.3, .normal_restitution = 0.5});
  };
  for (const FlowMethod method : carom_test::flow_methods) {
    for (const double time : {0.1, 0.5, 0.73219}) {
      Simulation whole(scene(discs), EventDriven{.method = method});
      whole.run_until(time);
      whole.save(path_);
      Simulation fresh(scene(discs), EventDriven{.method = method});
      fresh.load(path_);
      EXPECT_EQ(bits_of(fresh), bits_of(whole)) << time;
      for (const double end : {time + 0.2, 1.5}) {
        whole.run_until(end);
        fresh.run_until(end);
        EXPECT_EQ(bits_of(fresh), bits_of(whole)) << time;
        EXPECT_EQ(fresh.statistics().events, whole.statistics().events) << time;
      }
      EXPECT_GT(whole.statistics().impacts, 5);
    }
  }
}

// Impacts at the start of a step change the loads of dashpots, by which those of the next step are guessed.
TEST_F(Checkpoint, ContinuesBitForBitWithImpactsAtTheStartOfSteps) {
  const auto two_boxes = [] {
    System system;
    system.add(Gravity{{0.0, -9.81}});
    system.add(HalfPlane{.normal = {0.0, 1.0}}, Surface{.friction = 0.4, .normal_restitution = 0.2});
    std::vector<BodyId> boxes;
    for (const double x : {-0.2, 0.2}) {
      boxes.push_back(
          system.add(RigidBody{.mass = box(1.0, 0.2, 0.1), .position = {x, 0.2}, .angle = 0.5 + x}));
      system.add(Polygon{.body = boxes.back(),
                         .vertices = {{-0.1, -0.05}, {0.1, -0.05}, {0.1, 0.05}, {-0.1, 0.05}}});
    }
    system.add(SpringDamper{.from = boxes[0],
                            .to = {boxes[1], {0.05, 0.0}},
                            .stiffness = 200.0,
                            .damping = 1.0,
                            .free_length = 0.4});
    return system;
  };
  using Rules = ImpactRules;
  for (const TimeStepping& options :
       {TimeStepping{.step = 1e-3, .impact_rules = Rules{.order = ImpactOrder::sequential}},
        TimeStepping{.step = 1e-3, .impact_rules = Rules{.energy_gain = EnergyGain::limit}},
        TimeStepping{.step = 1e-3, .overlaps = OverlapRules{.never_tunnel = true}}}) {
    Simulation whole(two_boxes(), options);
    int struck = 0;
    for (int step = 0; step < 400; ++step) {  // saved before every step: before some there are impacts
      whole.save(path_);
      Simulation fresh(two_boxes(), options);
      fresh.load(path_);
      const std::int64_t before = whole.statistics().impacts;
      whole.step();
      fresh.step();
      ASSERT_EQ(bits_of(fresh), bits_of(whole)) << whole.time();
      if (whole.statistics().impacts != before) ++struck;
    }
    EXPECT_GT(struck, 5);
  }
}

// Where sweeps over the contacts of a pile start depends on how many steps their impulses were good enough
// for.
TEST_F(Checkpoint, ContinuesBitForBitInAPileAtRest) {
  System pile;
  scenes::add_discs(pile, {.count = 60, .width = 0.8});
  TimeStepping options{.step = 1e-3};
  options.contact_budget.residual = 1e-8;
  Simulation whole(pile, options);
  whole.run_until(2.5);
  whole.save(path_);
  Simulation fresh(pile, options);
  fresh.load(path_);
  for (int step = 0; step < 100; ++step) {
    whole.step();
    fresh.step();
    ASSERT_EQ(bits_of(fresh), bits_of(whole)) << whole.time();
  }
}

TEST_F(Checkpoint, ContinuesInASimulationThatHasRunElsewhere) {
  Simulation whole(scene(), TimeStepping{.step = 1e-3});
  whole.run_until(0.6);
  whole.save(path_);
  whole.run_until(1.2);
  Simulation other(scene(), TimeStepping{.step = 1e-3});
  other.run_until(2.0);
  other.load(path_);
  other.run_until(1.2);
  EXPECT_EQ(bits_of(other), bits_of(whole));
}

// Times on the way of the one are none of the other: the next step begins where the checkpoint ends.
TEST_F(Checkpoint, ContinuesWithAnotherStepOrInterval) {
  const auto mode = [](bool events, double length) {
    return events ? Mode(EventDriven{.interval = length}) : Mode(TimeStepping{.step = length});
  };
  for (const bool events : {false, true}) {
    for (const auto& [first, second] :
         {std::pair(1e-3, 1e-4), std::pair(1e-4, 1e-3), std::pair(1e-3, 3e-4)}) {
      Simulation whole(scene(), mode(events, first));
      for (int i = 0; i < 3; ++i) whole.step();
      whole.save(path_);
      Simulation other(scene(), mode(events, second));
      other.load(path_);
      other.step();
      EXPECT_NEAR(other.time(), whole.time() + second, 1e-15);  // rounding of times
      // Free fall: 1 - cos is of second order, both modes are exact.
      const double height = whole.state().q[1] + second * whole.state().v[1] - 0.5 * 9.81 * second * second;
      EXPECT_NEAR(other.state().q[1], height, 1e-12) << first << " " << second;
    }
  }
}

TEST_F(Checkpoint, KeepsTheRhythmOfPeriodicEvents) {
  const auto make = [](std::vector<double>& times) {
    Simulation simulation(scene(), TimeStepping{.step = 1e-3});
    simulation.every(0.0307, [&times](Simulation& now) { times.push_back(now.time()); });
    return simulation;
  };
  std::vector<double> whole_times, fresh_times;
  Simulation whole = make(whole_times);
  whole.run_until(0.4);
  whole.save(path_);
  whole_times.clear();
  whole.run_until(1.0);
  Simulation fresh = make(fresh_times);
  fresh.load(path_);
  fresh.run_until(1.0);
  EXPECT_EQ(fresh_times, whole_times);
  EXPECT_EQ(bits_of(fresh), bits_of(whole));
  // Another number of periodic events is another program.
  Simulation without(scene(), TimeStepping{.step = 1e-3});
  EXPECT_THROWS(FileError, without.load(path_), path_, "1 periodic events", "0");
  // So is another interval.
  Simulation slower(scene(), TimeStepping{.step = 1e-3});
  slower.every(0.5, [](Simulation&) {});
  EXPECT_THROWS(FileError, slower.load(path_), path_, "periodic event 0", "0.5");
}

TEST_F(Checkpoint, IsRefusedOnAnotherModel) {
  Simulation simulation(scene(), TimeStepping{.step = 1e-3});
  simulation.run_until(0.5);
  simulation.save(path_);
  const std::vector<std::function<void(System&)>> changes{
      [](System& system) { system.add(Particle{.mass = 1.0}); },
      [](System& system) { system.remove(system.element("spring")); },
      [](System& system) {
        system.add(HalfPlane{.normal = {1.0, 0.0}}, Surface{.friction = 0.0, .normal_restitution = 0.0});
      },
      [](System& system) {
        const BodyId lower = system.body("lower"), upper = system.body("upper");
        system.remove(system.element("spring"));
        system.add(SpringDamper{.from = lower, .to = upper, .stiffness = 1000.0000001, .free_length = 2.0},
                   "spring");
      },
  };
  for (const auto& change : changes) {
    Simulation other(scene(change), TimeStepping{.step = 1e-3});
    other.run_until(0.1);
    const auto before = bits_of(other);
    EXPECT_THROWS(FileError, other.load(path_), path_, "another model");
    EXPECT_EQ(bits_of(other), before);
  }
}

TEST_F(Checkpoint, IsRefusedForAnotherMass) {
  const auto model = [](double mass) {
    System system;
    system.add(Particle{.mass = mass});
    return system;
  };
  Simulation one(model(1.0), TimeStepping{});
  one.save(path_);
  Simulation other(model(1.5), TimeStepping{});
  EXPECT_THROWS(FileError, other.load(path_), path_, "another model");
  // Names, initial positions and velocities do not count: they are not the model's but the state's.
  System named;
  named.add(Particle{.mass = 1.0, .position = {3.0, 4.0}}, "ball");
  Simulation same(std::move(named), TimeStepping{});
  EXPECT_NO_THROW(same.load(path_));
  EXPECT_EQ(same.state().q, one.state().q);
}

TEST_F(Checkpoint, DamagedFilesAreRefusedAndChangeNothing) {
  Simulation simulation(scene(), TimeStepping{.step = 1e-3});
  simulation.run_until(0.5);
  simulation.save(path_);
  const std::vector<char> good = bytes();
  simulation.run_until(0.7);
  const auto before = bits_of(simulation);
  ASSERT_GT(good.size(), 500u);

  // Cut at every length.
  for (std::size_t size = 0; size < good.size(); size += size < 64 ? 1 : 7) {
    write({good.begin(), good.begin() + static_cast<std::ptrdiff_t>(size)});
    EXPECT_THROWS(FileError, simulation.load(path_), path_) << size;
  }
  // Any byte changed.
  for (std::size_t at = 0; at < good.size(); at += at < 64 ? 1 : 13) {
    std::vector<char> bad = good;
    bad[at] = static_cast<char>(bad[at] ^ 0x10);
    write(bad);
    EXPECT_THROWS(FileError, simulation.load(path_), path_) << at;
  }
  // More than there should be.
  std::vector<char> longer = good;
  longer.insert(longer.end(), 16, '\0');
  write(longer);
  EXPECT_THROWS(FileError, simulation.load(path_), path_, "damaged");
  // Something else.
  write({'h', 'e', 'l', 'l', 'o'});
  EXPECT_THROWS(FileError, simulation.load(path_), path_, "not a checkpoint");
  EXPECT_EQ(bits_of(simulation), before);

  write(good);
  EXPECT_NO_THROW(simulation.load(path_));
  EXPECT_EQ(simulation.time(), 0.5);
}

TEST_F(Checkpoint, MissingFilesAndPlacesAreNamed) {
  Simulation simulation(scene(), TimeStepping{});
  EXPECT_THROWS(FileError, simulation.load(path_), path_, "cannot be read");
  const std::string nowhere = path_ + "/no/such/place";
  EXPECT_THROWS(FileError, simulation.save(nowhere), nowhere, "cannot be written");
}

TEST_F(Checkpoint, AFailedSaveLeavesTheOldFile) {
  Simulation simulation(scene(), TimeStepping{.step = 1e-3});
  simulation.save(path_);
  const std::vector<char> old = bytes();
  simulation.run_until(0.1);
  // A directory stands where the unfinished file would go.
  std::filesystem::create_directory(path_ + ".unfinished");
  EXPECT_THROWS(FileError, simulation.save(path_), path_);
  EXPECT_EQ(bytes(), old);
  std::filesystem::remove_all(path_ + ".unfinished");
  simulation.save(path_);
  EXPECT_NE(bytes(), old);
  EXPECT_FALSE(std::filesystem::exists(path_ + ".unfinished"));
}

TEST_F(Checkpoint, WorksAfterAnEdit) {
  const auto make = [] {
    Simulation simulation(scene(), TimeStepping{.step = 1e-3});
    simulation.run_until(0.2);
    simulation.edit([](System& system) { system.remove(system.element("spring")); });
    return simulation;
  };
  Simulation whole = make();
  whole.run_until(0.7);
  whole.save(path_);
  whole.run_until(1.5);
  Simulation fresh = make();
  fresh.load(path_);
  fresh.run_until(1.5);
  EXPECT_EQ(bits_of(fresh), bits_of(whole));
}

}  // namespace
