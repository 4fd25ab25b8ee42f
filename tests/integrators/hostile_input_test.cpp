// Input that no sane program gives, against every door of the library that takes some: each is refused by an
// error that names the place and what is allowed. No crash, no hang, no result.

#include "tests/model_error.h"
#include "tests/temporary_folder.h"

#include <carom/carom.h>
#include <carom/core/assembly.h>

#include <gtest/gtest.h>

#include <filesystem>
#include <functional>
#include <limits>
#include <sstream>
#include <string>
#include <vector>

#include <sys/stat.h>

namespace {

using namespace carom;
using namespace carom::planar;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();
const Surface rough{.friction = 0.3, .normal_restitution = 0.5};

/// Two rigid bodies, two particles, and a joint.
struct Bench {
  Bench() {
    a = system.add(RigidBody{.mass = disc(1.0, 1.0)}, "a");
    b = system.add(RigidBody{.mass = disc(1.0, 1.0), .position = {1.0, 0.0}}, "b");
    p = system.add(Particle{.mass = 1.0, .position = {0.0, 2.0}}, "p");
    pin = system.add(Revolute{.from = ground, .to = a}, "pin");
  }
  System system;
  BodyId a, b, p;
  JointId pin;
};

/// A number of a part or option, and how it enters.
struct NumberDoor {
  const char* name;
  std::function<void(Bench&, double)> enter;
  bool infinite_allowed = false;
};

const std::vector<NumberDoor>& number_doors() {
  static const std::vector<NumberDoor> doors{
      {"particle mass", [](Bench& t, double x) { t.system.add(Particle{.mass = x}); }},
      {"particle position",
       [](Bench& t, double x) {
         t.system.add(Particle{.mass = 1.0, .position = {0.0, x}});
       }},
      {"particle velocity",
       [](Bench& t, double x) {
         t.system.add(Particle{.mass = 1.0, .velocity = {x, 0.0}});
       }},
      {"rigid mass",
       [](Bench& t, double x) { t.system.add(RigidBody{.mass = {.mass = x, .inertia = 1.0}}); }},
      {"rigid inertia",
       [](Bench& t, double x) { t.system.add(RigidBody{.mass = {.mass = 1.0, .inertia = x}}); }},
      {"rigid position",
       [](Bench& t, double x) {
         t.system.add(RigidBody{.mass = disc(1.0, 1.0), .position = {x, 0.0}});
       }},
      {"rigid angle",
       [](Bench& t, double x) { t.system.add(RigidBody{.mass = disc(1.0, 1.0), .angle = x}); }},
      {"rigid velocity",
       [](Bench& t, double x) {
         t.system.add(RigidBody{.mass = disc(1.0, 1.0), .velocity = {0.0, x}});
       }},
      {"rigid spin", [](Bench& t, double x) { t.system.add(RigidBody{.mass = disc(1.0, 1.0), .spin = x}); }},
      {"disc mass", [](Bench&, double x) { (void)disc(x, 1.0); }},
      {"disc()", [](Bench&, double x) { (void)disc(1.0, x); }},
      {"rod()", [](Bench&, double x) { (void)planar::rod(1.0, x); }},
      {"box()", [](Bench&, double x) { (void)box(1.0, 1.0, x); }},
      {"polygon()",
       [](Bench&, double x) {
         (void)polygon(1.0, {{0.0, 0.0}, {x, 0.0}, {0.0, 1.0}});
       }},
      {"shifted()",
       [](Bench&, double x) {
         (void)shifted(disc(1.0, 1.0), {x, 0.0});
       }},
      {"disc radius", [](Bench& t, double x) { t.system.add(Disc{.body = t.a, .radius = x}); }},
      {"disc centre",
       [](Bench& t, double x) {
         t.system.add(Disc{.body = t.a, .radius = 1.0, .centre = {x, 0.0}});
       }},
      {"point",
       [](Bench& t, double x) {
         t.system.add(Point{.body = t.a, .position = {0.0, x}});
       }},
      {"segment",
       [](Bench& t, double x) {
         t.system.add(Segment{.body = t.a, .from = {0.0, 0.0}, .to = {x, 0.0}});
       }},
      {"polygon",
       [](Bench& t, double x) {
         t.system.add(Polygon{.body = t.a, .vertices = {{0.0, 0.0}, {1.0, 0.0}, {0.0, x}}});
       }},
      {"gravity",
       [](Bench& t, double x) {
         t.system.add(Gravity{{0.0, x}});
       }},
      {"spring stiffness",
       [](Bench& t, double x) { t.system.add(SpringDamper{.from = t.a, .to = t.p, .stiffness = x}); }},
      {"spring damping",
       [](Bench& t, double x) { t.system.add(SpringDamper{.from = t.a, .to = t.p, .damping = x}); }},
      {"spring length",
       [](Bench& t, double x) {
         t.system.add(SpringDamper{.from = t.a, .to = t.p, .stiffness = 1.0, .free_length = x});
       }},
      {"spring end",
       [](Bench& t, double x) {
         t.system.add(SpringDamper{.from = End<2>(t.a, {x, 0.0}), .to = t.p, .stiffness = 1.0});
       }},
      {"cable stiffness",
       [](Bench& t, double x) {
         t.system.add(Cable{.from = t.a, .to = t.p, .stiffness = x, .free_length = 1.0});
       }},
      {"torsion",
       [](Bench& t, double x) { t.system.add(TorsionalSpring{.from = t.a, .to = t.b, .stiffness = x}); }},
      {"drag", [](Bench& t, double x) { t.system.add(Drag{.on = t.p, .linear = x}); }},
      {"half-plane point",
       [](Bench& t, double x) {
         t.system.add(HalfPlane{.point = {x, 0.0}, .normal = {0.0, 1.0}}, rough);
       }},
      {"friction",
       [](Bench& t, double x) {
         t.system.add(HalfPlane{.normal = {0.0, 1.0}}, Surface{.friction = x, .normal_restitution = 0.0});
       }},
      {"restitution",
       [](Bench& t, double x) {
         t.system.between(t.system.material("a"), t.system.material("b"),
                          {.friction = 0.0, .normal_restitution = x});
       }},
      {"joint end",
       [](Bench& t, double x) {
         t.system.add(Revolute{.from = End<2>(ground, {x, 0.0}), .to = t.b});
       }},
      {"rod length", [](Bench& t, double x) { t.system.add(Rod{.from = t.b, .to = t.p, .length = x}); },
       false},
      {"stop", [](Bench& t, double x) { t.system.add(Stop{.joint = t.pin, .lower = -1.0, .upper = x}); },
       true},
      {"joint friction", [](Bench& t, double x) { t.system.add(JointFriction{.joint = t.pin, .bound = x}); }},
      {"static factor",
       [](Bench& t, double x) {
         t.system.add(JointFriction{.joint = t.pin, .bound = 1.0, .static_factor = x});
       }},
      {"break",
       [](Bench& t, double x) {
         t.system.add(
             AppliedForce{.on = t.p, .force = [](double) { return Vec<2>(0.0, 0.0); }, .breaks = {x}});
       }},
      {"state position",
       [](Bench& t, double x) {
         Simulation run(t.system, TimeStepping{});
         State state = run.state();
         state.position(t.p)[0] = x;
         run.set_state(state);
       }},
      {"state velocity",
       [](Bench& t, double x) {
         Simulation run(t.system, EventDriven{});
         State state = run.state();
         state.spin(t.b) = x;
         run.set_state(state);
       }},
      {"step", [](Bench& t, double x) { Simulation(t.system, TimeStepping{.step = x}); }},
      {"tolerance", [](Bench& t, double x) { Simulation(t.system, TimeStepping{.tolerance = x}); }},
      {"capture speed", [](Bench& t, double x) { Simulation(t.system, TimeStepping{.capture_speed = x}); }},
      {"largest step",
       [](Bench& t, double x) { Simulation(t.system, TimeStepping{.control = StepControl{.largest = x}}); }},
      {"interval", [](Bench& t, double x) { Simulation(t.system, EventDriven{.interval = x}); }},
      {"gap tolerance", [](Bench& t, double x) { Simulation(t.system, EventDriven{.gap_tolerance = x}); }},
      {"event limit", [](Bench& t, double x) { Simulation(t.system, EventDriven{.event_limit = x}); }},
  };
  return doors;
}

TEST(HostileInput, NumbersThatAreNoneOrTooLarge) {
  for (const NumberDoor& door : number_doors()) {
    for (const double bad : {infinity, 1e151, 1e200, std::numeric_limits<double>::max()}) {
      if (door.infinite_allowed && bad == infinity) continue;
      Bench bench;
      EXPECT_MODEL_ERROR(door.enter(bench, bad), "allowed") << door.name << " " << bad;
    }
    for (const double bad : {nan, -infinity, -1e151}) {
      // NaN stands for "not given" where that is possible.
      if (std::string(door.name) == "rod length" && bad != bad) continue;
      Bench bench;
      EXPECT_MODEL_ERROR(door.enter(bench, bad), "allowed") << door.name << " " << bad;
    }
    Bench bench;
    const std::uint64_t before = bench.system.fingerprint();
    try {
      door.enter(bench, 1e151);
    } catch (const ModelError& error) {
      EXPECT_NE(std::string(error.what()).find("1e+151"), std::string::npos) << error.what();
    }
    if (std::string(door.name) != "restitution") {
      EXPECT_EQ(bench.system.fingerprint(), before) << door.name;
    }
  }
}

TEST(HostileInput, EnumeratorsThatAreNone) {
  const Bench bench;
  for (const int bad : {20, 77, 255}) {
    EXPECT_MODEL_ERROR(Simulation(bench.system, TimeStepping{.force_rule = static_cast<ForceRule>(bad)}),
                       "force_rule", "allowed");
    EXPECT_MODEL_ERROR(Simulation(bench.system, TimeStepping{.iteration = static_cast<Iteration>(bad)}),
                       "iteration", "allowed");
    EXPECT_MODEL_ERROR(Simulation(bench.system, EventDriven{.method = static_cast<FlowMethod>(bad)}),
                       "method", "allowed");
    EXPECT_MODEL_ERROR(Log([](LogLevel, std::string_view) {}, static_cast<LogLevel>(bad)), "level",
                       "allowed");
    const EnergyLedger ledger;
    EXPECT_MODEL_ERROR((void)ledger.flow(static_cast<EnergyFlow>(bad)), "term", "allowed");
    EXPECT_MODEL_ERROR((void)ledger.stored(static_cast<StoredEnergy>(bad)), "term", "allowed");
    for (const std::string_view name :
         {to_string(static_cast<EventKind>(bad)), to_string(static_cast<EnergyFlow>(bad)),
          to_string(static_cast<StoredEnergy>(bad)), to_string(static_cast<LogLevel>(bad)),
          to_string(static_cast<SolverId>(bad)), to_string(static_cast<ForceRule>(bad)),
          to_string(static_cast<Iteration>(bad)), to_string(static_cast<FindingKind>(bad)),
          unit(static_cast<Quantity>(bad))}) {
      EXPECT_EQ(name, "unknown");
    }
    EXPECT_EQ(to_string(static_cast<Outcome>(bad)), "unknown outcome");
    EXPECT_EQ(to_string(static_cast<ContactMode>(bad)), "unknown mode");
  }
}

TEST(HostileInput, FunctionsThatAreEmpty) {
  Bench t;
  Simulation run(t.system, TimeStepping{});
  EXPECT_MODEL_ERROR(run.observe({}), "observe", "empty", "allowed");
  EXPECT_MODEL_ERROR(run.every(1.0, {}), "every", "empty", "allowed");
  EXPECT_MODEL_ERROR(run.edit({}), "edit", "empty", "allowed");
  EXPECT_MODEL_ERROR(run.edit([](System& system) { system = Bench().system; }), "edit", "another one",
                     "allowed");
  run.step();  // it still runs
  EXPECT_MODEL_ERROR(t.system.add(AppliedForce{.on = t.p}), "force", "allowed");
  EXPECT_MODEL_ERROR(t.system.add(AppliedTorque{.on = t.a}), "torque", "allowed");
  EXPECT_MODEL_ERROR(t.system.add(FollowerLoad{.on = t.a}), "force", "allowed");
  EXPECT_MODEL_ERROR(t.system.add(LinearActuator{.from = t.a, .to = t.p}), "force", "allowed");
  EXPECT_MODEL_ERROR(t.system.add(RotaryActuator{.from = t.a, .to = t.b}), "torque", "allowed");
  EXPECT_MODEL_ERROR(t.system.add(Motor{.joint = t.pin}), "torque", "allowed");
  EXPECT_MODEL_ERROR(t.system.add(Driver{.joint = t.pin}), "position", "allowed");
  EXPECT_MODEL_ERROR(t.system.add(NonlinearSpring{.from = t.a, .to = t.p}), "force", "allowed");
  EXPECT_MODEL_ERROR(
      t.system.add(NonlinearSpring{.from = t.a, .to = t.p, .force = [](double) { return 0.0; }}), "potential",
      "allowed");
  EXPECT_MODEL_ERROR(t.system.add(HalfPlane{.normal = {0.0, 1.0},
                                            .motion = {.velocity = [](double) { return Vec<2>(0.0, 0.0); }}}),
                     "motion", "allowed");
  std::ostringstream out;
  EXPECT_MODEL_ERROR(write_events(out, {EventRecord{}}, {}), "events", "empty", "allowed");
  Log quiet{LogSink()};  // documented: a quiet log
  EXPECT_FALSE(quiet.enabled(LogLevel::error));
}

TEST(HostileInput, PolygonsWithoutAnArea) {
  Bench t;
  const auto refused = [&](const std::vector<Vec<2>>& vertices) {
    EXPECT_MODEL_ERROR(t.system.add(Polygon{.body = t.a, .vertices = vertices}), "polygon", "vert",
                       "allowed");
    EXPECT_MODEL_ERROR((void)polygon(1.0, vertices), "polygon", "allowed");
  };
  refused({});
  refused({{0.0, 0.0}, {1.0, 0.0}});
  refused({{0.5, 0.25}, {0.5, 0.25}, {0.5, 0.25}});
  refused({{0.0, 0.0}, {0.0, 0.0}, {0.0, 0.0}, {0.0, 0.0}});
  refused({{0.0, 0.0}, {1.0, 1.0}, {2.0, 2.0}});
  refused({{0.1, 0.3}, {0.2, 0.6}, {0.3, 0.9}, {0.1, 0.3}});
  refused({{1.0, 1.0}, {2.0, 2.0}, {1.0, 1.0}});
  refused({{nan, 0.0}, {1.0, 0.0}, {0.0, 1.0}});
  refused({{0.0, 0.0}, {infinity, 0.0}, {0.0, 1.0}});
  // One vertex given twice does no harm, nor is a thin one a line.
  EXPECT_NO_THROW(t.system.add(
      Polygon{.body = t.a, .vertices = {{0.0, 0.0}, {1.0, 0.0}, {1.0, 0.0}, {0.0, 1.0}, {0.0, 0.0}}}));
  EXPECT_NO_THROW(t.system.add(Polygon{.body = t.a, .vertices = {{0.0, 0.0}, {1.0, 0.0}, {0.5, 1e-9}}}));
}

TEST(HostileInput, MassWithoutInertia) {
  System system;
  EXPECT_MODEL_ERROR(system.add(RigidBody{.mass = {1.0}}, "plate"),
                     "rigid body 'plate': moment of inertia is nan kg m^2, it is missing",
                     "disc(), rod(), box()");
}

TEST(HostileInput, FilesThatAreNone) {
  const carom_test::TemporaryFolder folder;
  const Bench t;
  Simulation run(t.system, EventDriven{});
  run.run_until(0.1);
  const std::string pipe = folder / "pipe", directory = folder / "directory";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  std::filesystem::create_directory(directory);
  const auto refused = [](const auto& call, const std::string& path) {
    try {
      call();
      ADD_FAILURE() << path;
    } catch (const FileError& error) {
      EXPECT_NE(std::string(error.what()).find(path), std::string::npos) << error.what();
    }
  };
  for (const std::string& path : {std::string("/dev/null"), std::string("/dev/zero"), pipe, directory,
                                  std::string(), folder / "nowhere/file"}) {
    refused([&] { run.load(path); }, path);
    refused([&] { (void)EnergyTrace::load(path); }, path);
    refused([&] { run.save(path); }, path);
    refused([&] { run.write_events(path); }, path);
  }
  EXPECT_TRUE(std::filesystem::is_character_file("/dev/null"));
  EXPECT_TRUE(std::filesystem::is_fifo(pipe));
  EXPECT_TRUE(std::filesystem::is_directory(directory));
  run.step();
}

TEST(HostileInput, StatesOfNoModel) {
  const Bench t;
  Simulation run(t.system, TimeStepping{}), other(Bench().system, TimeStepping{});
  for (const State& bad : {State(), other.state()}) {
    EXPECT_MODEL_ERROR((void)total_momentum(run.assembly(), bad), "state", "allowed");
    EXPECT_MODEL_ERROR((void)mobility(run.assembly(), bad), "state", "allowed");
    EXPECT_MODEL_ERROR(run.set_state(bad), "state", "allowed");
    EXPECT_MODEL_ERROR((void)find_equilibrium(run.assembly(), bad), "state", "allowed");
    EXPECT_MODEL_ERROR((void)driver_forces(run.assembly(), bad), "state", "allowed");
    State copy = bad;
    EXPECT_MODEL_ERROR(close_joints(run.assembly(), copy), "state", "allowed");
  }
  State cut = run.state();
  cut.v.pop_back();
  EXPECT_MODEL_ERROR((void)total_momentum(run.assembly(), cut), "state", "allowed");
  EXPECT_NO_THROW((void)total_momentum(run.assembly(), run.state()));
}

}  // namespace
