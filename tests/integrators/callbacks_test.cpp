// Every call of a simulation from within every function that it calls: refused by name, or it works.

#include "tests/integrators/pair_scene.h"
#include "tests/integrators/same_run.h"
#include "tests/integrators/throws.h"
#include "tests/model_error.h"
#include "tests/temporary_folder.h"

#include <carom/carom.h>
#include <carom/integrators/callbacks.h>
#include <carom/integrators/run/companion.h>

#include <gtest/gtest.h>

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace {

using namespace carom;
using namespace carom::planar;
using carom_test::bits_of;
using carom_test::pair_scene;

/// Runs a function wherever its body's loads are asked for, once.
struct Trap {
  static constexpr Role role = Role::force;
  static constexpr int dimension = 2;
  static constexpr std::string_view label = "trap";
  BodyId body;
  std::shared_ptr<std::function<void()>> function;
  std::vector<BodyId> bodies() const { return {body}; }
  void loads(const ElementView<2>&, ElementLoads<2>&) const {
    if (*function) (*function)();
  }
};

/// A driven wheel, a trap on a particle, a floor.
struct Model {
  System system;
  JointId pin;
  std::shared_ptr<std::function<void()>> law = std::make_shared<std::function<void()>>();
  std::shared_ptr<std::function<void()>> motion = std::make_shared<std::function<void()>>();
  std::shared_ptr<CallbackId> spare = std::make_shared<CallbackId>();  // of an observer that does nothing
  Model() {
    system = pair_scene();
    const BodyId wheel = system.add(RigidBody{.mass = disc(1.0, 0.5), .position = {50.0, 50.0}}, "wheel");
    pin = system.add(Revolute{.from = {ground, {50.0, 50.0}}, .to = wheel}, "pin");
    system.add(Driver{.joint = pin, .position = [call = motion](double t) {
                        if (*call) (*call)();
                        return t * t;
                      }});
    const BodyId trapped =
        system.add(Particle{.mass = 1.0, .position = {60.0, 50.0}, .contact = false}, "trapped");
    system.add(Trap{trapped, law});
  }
};

/// Calls that are allowed, by name as messages have it.
std::map<std::string, std::function<void(Simulation&)>> calls(const Model& model, const std::string& file) {
  const JointId pin = model.pin;
  return {
      {"step", [](Simulation& run) { run.step(); }},
      {"run_until", [](Simulation& run) { run.run_until(run.time() + 0.1); }},
      {"observe", [](Simulation& run) { run.observe([](const Simulation&) {}); }},
      {"every", [](Simulation& run) { run.every(0.013, [](Simulation&) {}); }},
      {"remove_callback", [spare = model.spare](Simulation& run) { run.remove_callback(*spare); }},
      {"stop_when", [](Simulation& run) { run.stop_when({}); }},
      {"edit", [](Simulation& run) { run.edit([](System& system) {
                                       system.add(Gravity{{0.0, -1.0}});
                                     }); }},
      {"set_state",
       [](Simulation& run) {
         State state = run.state();
         run.set_state(state);
       }},
      {"switch_to", [](Simulation& run) { run.switch_to(Mode(run.mode())); }},
      {"reaction", [pin](Simulation& run) { (void)run.reaction(pin); }},
      {"clear_events", [](Simulation& run) { run.clear_events(); }},
      {"save", [file](Simulation& run) { run.save(file); }},
      {"load", [file](Simulation& run) { run.load(file); }},
  };
}

const std::set<std::string> steps{"step", "run_until"};
const std::set<std::string> changes{"edit", "set_state", "switch_to", "load"};

enum class Place { law, motion, stop, sink, observer, action, change };

bool refused(const std::string& call, Place place) {
  switch (place) {
    case Place::law:
    case Place::motion:
    case Place::stop:
    case Place::sink:
      return true;
    case Place::observer:
    case Place::change:
      return steps.contains(call) || changes.contains(call);
    case Place::action:
      return steps.contains(call);
  }
  return true;
}

/// Makes one call from one place; what came out of it.
std::optional<std::string> call_from(Place place, const Model& model, const Mode& mode,
                                     const std::function<void(Simulation&)>& call, const std::string& file) {
  Simulation run(model.system, mode);
  run.step();
  run.save(file);
  *model.spare = run.observe([](const Simulation&) {});
  bool armed = true;
  bool reached = false;
  std::optional<std::string> error;
  const auto spring = [&] {
    if (!std::exchange(armed, false)) return;
    reached = true;
    try {
      call(run);
    } catch (const ModelError& refusal) {
      error = refusal.what();
    }
  };
  switch (place) {
    case Place::law:
      *model.law = spring;
      break;
    case Place::motion:
      *model.motion = spring;
      break;
    case Place::stop:
      run.stop_when([&] {
        spring();
        return false;
      });
      break;
    case Place::sink:
      // A restitution that adds energy writes a line; so do accumulations.
      run.log() = Log([&](LogLevel, std::string_view) { spring(); }, LogLevel::trace);
      break;
    case Place::observer:
      run.observe([&](const Simulation&) { spring(); });
      break;
    case Place::action:
      run.every(0.01, [&](Simulation&) { spring(); });
      run.save(file);
      break;
    case Place::change:
      run.edit([&](System&) { spring(); });
      break;
  }
  run.run_until(0.05);
  *model.law = {};
  *model.motion = {};
  armed = false;
  EXPECT_TRUE(reached || place == Place::sink);
  run.stop_when({});
  run.run_until(0.7);  // it goes on, through impacts
  EXPECT_EQ(run.time(), 0.7);
  if (!reached) return std::nullopt;
  return error ? error : std::optional<std::string>("");
}

TEST(Callbacks, EveryCallFromEveryPlaceIsRefusedByNameOrWorks) {
  const carom_test::TemporaryFolder folder;
  const std::string file = folder / "run";
  const std::vector<std::pair<Place, std::string>> places{{Place::law, "a law, an element"},
                                                          {Place::motion, "a law, an element"},
                                                          {Place::stop, "stop function"},
                                                          {Place::observer, "its own observer"},
                                                          {Place::action, "its own action (every)"},
                                                          {Place::change, "the function given to its edit"}};
  for (const Mode& mode : {Mode(TimeStepping{.step = 1e-3}), Mode(EventDriven{})}) {
    for (const auto& [place, text] : places) {
      const Model model;
      for (const auto& [name, call] : calls(model, file)) {
        const auto error = call_from(place, model, mode, call, file);
        ASSERT_TRUE(error) << name;
        if (refused(name, place)) {
          EXPECT_NE(error->find(name + " was called by"), std::string::npos) << name << ": " << *error;
          EXPECT_NE(error->find(text), std::string::npos) << name << ": " << *error;
          EXPECT_NE(error->find("allowed"), std::string::npos) << *error;
        } else {
          EXPECT_EQ(*error, "") << name << " from " << text;
        }
      }
    }
  }
}

TEST(Callbacks, TheSinkOfTheLogMayNotChangeTheRun) {
  // The paper's example with (e_n, e_t) = (1, 0) gains energy, which is told.
  System system;
  system.add(HalfPlane{.normal = {0.0, 1.0}}, Surface{.friction = 1.0, .normal_restitution = 1.0});
  const BodyId foot = system.add(
      RigidBody{.mass = {.mass = 1.0, .inertia = 1.0}, .position = {0.0, 1.1}, .velocity = {1.0, -2.0}});
  system.add(Point{.body = foot, .position = {-1.0, -1.0}});
  for (const Mode& mode : {Mode(TimeStepping{.step = 1e-3}), Mode(EventDriven{})}) {
    Simulation run(system, mode);
    std::vector<std::string> refusals;
    run.log() = Log(
        [&](LogLevel, std::string_view) {
          const std::vector<std::function<void()>> tries{[&] { run.step(); }, [&] { run.clear_events(); },
                                                         [&] { run.edit([](System&) {}); },
                                                         [&] { run.observe([](const Simulation&) {}); }};
          for (const auto& attempt : tries) {
            try {
              attempt();
            } catch (const ModelError& error) {
              refusals.emplace_back(error.what());
            }
          }
        },
        LogLevel::trace);
    run.run_until(0.1);
    ASSERT_GE(refusals.size(), 4u);
    for (const std::string& text : refusals) EXPECT_NE(text.find("the sink of its log"), std::string::npos);
    EXPECT_EQ(run.time(), 0.1);
  }
}

TEST(Callbacks, ObserversAreAddedAndRemovedWhileTheyAreCalled) {
  Simulation run(pair_scene(), TimeStepping{.step = 1e-3});
  std::vector<std::string> heard;
  std::vector<CallbackId> ids;
  ids.push_back(run.observe([&](const Simulation&) {
    heard.emplace_back("a");
    if (heard.size() > 1) return;
    // Itself and the next one go, a new one comes.
    run.remove_callback(ids[0]);
    run.remove_callback(ids[1]);
    run.observe([&](const Simulation&) { heard.emplace_back("new"); });
  }));
  ids.push_back(run.observe([&](const Simulation&) { heard.emplace_back("b"); }));
  ids.push_back(run.observe([&](const Simulation&) { heard.emplace_back("c"); }));
  run.step();
  EXPECT_EQ(heard, (std::vector<std::string>{"a", "c"}));
  run.step();
  EXPECT_EQ(heard, (std::vector<std::string>{"a", "c", "c", "new"}));
  EXPECT_MODEL_ERROR(run.remove_callback(ids[0]), "remove_callback", "allowed");
  EXPECT_MODEL_ERROR(run.remove_callback(CallbackId{}), "remove_callback", "allowed");
  Simulation other(pair_scene(), TimeStepping{.step = 1e-3});
  EXPECT_MODEL_ERROR(other.remove_callback(ids[2]), "remove_callback", "allowed");
  run.remove_callback(ids[2]);
}

TEST(Callbacks, ARemovedActionNoLongerEndsSteps) {
  Simulation run(pair_scene(), TimeStepping{.step = 1e-3});
  int fired = 0;
  std::vector<CallbackId> ids;
  ids.push_back(run.every(0.0004, [&](Simulation& now) {
    ++fired;
    now.remove_callback(ids[0]);
  }));
  ids.push_back(run.every(0.002, [&](Simulation&) { fired += 100; }));
  run.run_until(0.01);
  EXPECT_EQ(fired, 501);
  EXPECT_EQ(run.companion().rhythms.size(), 1u);
  Simulation same(pair_scene(), TimeStepping{.step = 1e-3});
  same.every(0.002, [](Simulation&) {});
  same.run_until(0.0004);
  same.run_until(0.01);
  EXPECT_EQ(run.state().q, same.state().q);
}

TEST(Callbacks, OneThatThrowsDoesNotKeepTheOthersFromTheirCall) {
  for (const Mode& mode : {Mode(TimeStepping{.step = 1e-3}), Mode(EventDriven{.interval = 1e-3})}) {
    Simulation run(pair_scene(), mode);
    std::vector<std::string> lines;
    run.log() = Log([&](LogLevel, std::string_view line) { lines.emplace_back(line); }, LogLevel::error);
    int seen = 0, acted = 0;
    bool armed = true;
    run.observe([&](const Simulation&) {
      if (armed) throw std::runtime_error("first");
    });
    run.observe([&](const Simulation&) {
      if (armed) throw std::logic_error("second");
    });
    run.observe([&](const Simulation&) { ++seen; });
    run.every(0.002, [&](Simulation&) { ++acted; });
    for (int i = 0; i < 4; ++i) EXPECT_THROWS(std::runtime_error, run.step(), "first");
    EXPECT_EQ(seen, 4);
    EXPECT_EQ(acted, 2);
    EXPECT_EQ(lines.size(), 4u);
    EXPECT_NE(lines.at(0).find("second"), std::string::npos);
    armed = false;
    run.run_until(0.1);
    EXPECT_EQ(acted, 50);
    Simulation plain(pair_scene(), mode);
    plain.observe([](const Simulation&) {});  // the same steps
    plain.every(0.002, [](Simulation&) {});
    plain.run_until(0.1);
    EXPECT_EQ(bits_of(run), bits_of(plain));
  }
}

TEST(Callbacks, AStateSavedByAnObserverGoesOnWithTheActionsThatWereDue) {
  const carom_test::TemporaryFolder folder;
  const std::string file = folder / "run";
  const auto prepared = [](int& acted) {
    Simulation run(pair_scene(), TimeStepping{.step = 1e-3});
    run.every(0.01, [&acted](Simulation& now) {
      ++acted;
      State state = now.state();
      state.v[0] += 0.01;
      now.set_state(state);
    });
    return run;
  };
  int acted = 0, again = 0;
  Simulation run = prepared(acted);
  run.observe([&](const Simulation& now) {
    if (now.time() == 0.02) now.save(file);
  });
  run.run_until(0.1);
  Simulation loaded = prepared(again);
  loaded.load(file);
  EXPECT_EQ(loaded.time(), 0.02);
  loaded.run_until(0.1);
  EXPECT_EQ(acted, 10);
  EXPECT_EQ(again, 9);
  EXPECT_EQ(bits_of(loaded), bits_of(run));
}

}  // namespace
