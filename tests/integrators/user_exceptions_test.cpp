// A function of the user that throws once, at any of its calls: the exception comes out of the call,
// unchanged, the simulation stands at its last good state, and goes on from there as if nothing had happened.

#include "tests/integrators/same_run.h"
#include "tests/random.h"
#include "tests/shares.h"

#include <carom/carom.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <functional>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace {

using namespace carom;
using namespace carom::planar;
using carom_test::bits_of;
using carom_test::Random;

/// What a function throws. A SolverError is what a law throws that runs a simulation of its own.
enum class Thrown : std::uint8_t { standard, solver_error, model_error, number };

/// Counts the calls of one function, and throws at one of them.
struct Fuse {
  int calls = 0, throws_at = -1;
  Thrown sort = Thrown::standard;

  void call() {
    if (calls++ != throws_at) return;
    switch (sort) {
      case Thrown::standard:
        throw std::runtime_error("fuse");
      case Thrown::solver_error:
        throw SolverError("fuse", {});
      case Thrown::model_error:
        throw ModelError("fuse");
      case Thrown::number:
        throw 7;
    }
  }
};
using FuseOf = std::shared_ptr<Fuse>;

/// A spring of the user to the origin, with a guard.
struct Tether {
  static constexpr Role role = Role::force;
  static constexpr int dimension = 2;
  static constexpr int guard_size = 1;
  BodyId body;
  FuseOf of_loads, of_potential, of_guards;
  std::vector<BodyId> bodies() const { return {body}; }
  void loads(const ElementView<2>& at, ElementLoads<2>& out) const {
    of_loads->call();
    out.conservative(body, -3.0 * at.position(body));
  }
  double potential(const ElementView<2>& at) const {
    of_potential->call();
    return 1.5 * at.position(body).squaredNorm();
  }
  void guards(const ElementView<2>& at, double* out) const {
    of_guards->call();
    *out = at.position(body)[0] - 0.3;
  }
};

/// Two bodies and a wheel, with functions of the user of every sort, by turns.
struct Model {
  static constexpr std::size_t functions = 8;
  System system;
  std::array<FuseOf, functions> fuses;

  explicit Model(unsigned sort) {
    const bool on_floor = (sort & 1U) != 0, on_moving = (sort & 2U) != 0, touch = (sort & 4U) != 0;
    for (FuseOf& fuse : fuses) fuse = std::make_shared<Fuse>();
    system.add(Gravity{{0.0, -9.81}});
    system.set_default_law({.friction = 0.3, .normal_restitution = 0.4});
    if (on_floor) system.add(HalfPlane{.normal = {0.0, 1.0}});
    if (on_moving) add_moving_floor();
    const BodyId a = add_ball({0.0, 0.5}, {0.4, 0.0}, touch), b = add_ball({0.5, 0.5}, {-0.4, 0.0}, touch);
    system.add(Tether{a, fuses[0], fuses[1], fuses[2]});
    system.add(AppliedForce{.on = b, .force = [fuse = fuses[5]](double t) {
                              fuse->call();
                              return Vec<2>(std::sin(t), 0.0);
                            }});
    add_wheel((sort & 8U) != 0);
  }

private:
  BodyId add_ball(const Vec<2>& place, const Vec<2>& velocity, bool touches) {
    const BodyId ball =
        system.add(RigidBody{.mass = disc(1.0, 0.1), .position = place, .velocity = velocity});
    if (touches) system.add(Disc{.body = ball, .radius = 0.1});
    return ball;
  }
  void add_moving_floor() {
    PrescribedMotion motion;
    motion.displacement = [fuse = fuses[3]](double t) {
      fuse->call();
      return Vec<2>(0.0, 0.01 * std::sin(5.0 * t));
    };
    motion.velocity = [fuse = fuses[4]](double t) {
      fuse->call();
      return Vec<2>(0.0, 0.05 * std::cos(5.0 * t));
    };
    system.add(HalfPlane{.point = {0.0, -0.5}, .normal = {0.0, 1.0}, .motion = motion});
  }
  void add_wheel(bool driven) {
    const BodyId wheel = system.add(RigidBody{.mass = disc(1.0, 0.2), .position = {3.0, 3.0}});
    const JointId pin = system.add(Revolute{.from = {ground, {3.0, 3.0}}, .to = wheel});
    if (driven) {
      system.add(Driver{.joint = pin, .position = [fuse = fuses[6]](double t) {
                          fuse->call();
                          return t * t;
                        }});
    } else {
      system.add(Motor{.joint = pin, .torque = [fuse = fuses[7]](double, double, double rate) {
                         fuse->call();
                         return 1.0 - 0.1 * rate;
                       }});
    }
  }
};

Mode random_mode(Random& random) {
  constexpr std::array methods{FlowMethod::explicit_runge_kutta, FlowMethod::one_step, FlowMethod::adams,
                               FlowMethod::bdf};
  if (random.below(2) == 0) return EventDriven{.method = methods[random.below(4)]};
  TimeStepping options{.step = 5e-3};
  switch (random.below(7)) {
    case 1:
      options.iteration = Iteration::fixed_point;
      break;
    case 2:
      options.iteration = Iteration::anderson;
      break;
    case 3:
      options.control = StepControl{};
      break;
    case 4:
      options.impacts = ImpactTimes::located;
      break;
    case 5:
      options.force_rule = ForceRule::energy_momentum;
      break;
    case 6:
      options.overlaps.never_tunnel = true;
      break;
    default:
      break;
  }
  return options;
}

/// What came out of a call: nothing, the exception of the fuse, or another one.
std::string outcome_of(const std::function<void()>& call) {
  try {
    call();
  } catch (const SolverError& error) {
    return std::string("solver error: ") + error.what();
  } catch (const ModelError& error) {
    return std::string("model error: ") + error.what();
  } catch (const std::exception& error) {
    return error.what();
  } catch (int) {
    return "7";
  }
  return "nothing";
}
std::string outcome_of(Thrown sort) {
  constexpr std::array<const char*, 4> texts{"fuse", "solver error: fuse", "model error: fuse", "7"};
  return texts[static_cast<std::size_t>(sort)];
}

/// A run to 0.8 s in which one call of one function throws.
void run_with_fuse(std::uint64_t seed) {
  constexpr double end = 0.8;
  Random random(seed);
  Model model(random.below(16));
  const Mode mode = random_mode(random);
  Fuse& fuse = *model.fuses[random.below(Model::functions)];
  fuse.sort = static_cast<Thrown>(random.below(4));
  const bool seen = random.below(2) == 0;
  Simulation undisturbed(model.system, mode);
  const int at_start = fuse.calls;
  undisturbed.run_until(end);
  const int calls = fuse.calls - at_start;
  if (calls == 0) return;
  Simulation run(model.system, mode);
  if (seen) run.observe([](const Simulation&) {});
  fuse.throws_at = fuse.calls + static_cast<int>(random.below(static_cast<unsigned>(calls)));
  const std::string came = outcome_of([&] { run.run_until(end); });
  if (fuse.calls <= fuse.throws_at) return;  // who is looked at makes other calls
  EXPECT_EQ(came, outcome_of(fuse.sort));
  const bool by_events = std::holds_alternative<EventDriven>(mode);
  const double noise = by_events ? 1e-6 : 1e-12;  // a flow that starts anew has other errors
  EXPECT_NEAR(run.energy().residual(), 0.0, noise * run.energy().scale());
  run.run_until(end);
  EXPECT_NEAR(run.energy().residual(), 0.0, noise * run.energy().scale());
  for (std::size_t i = 0; i < run.state().q.size(); ++i) {
    if (by_events) {
      EXPECT_NEAR(run.state().q[i], undisturbed.state().q[i], 1e-6);
    } else {
      EXPECT_EQ(run.state().q[i], undisturbed.state().q[i]);
    }
  }
}

/// A call between steps, in which one call of one function throws: it changes nothing.
void call_with_fuse(std::uint64_t seed) {
  Random random(seed);
  const unsigned sort = random.below(16), call = random.below(5);
  const std::size_t function = random.below(Model::functions);
  const Mode mode = random_mode(random), other = random_mode(random);
  Model model(sort), twin(sort);
  Simulation run(model.system, mode), undisturbed(twin.system, mode);
  run.run_until(0.3);
  undisturbed.run_until(0.3);
  const auto make = [&](Simulation& now) {
    State state = now.state();
    state.v[0] += 0.01;
    switch (call) {
      case 0:
        return now.switch_to(other);
      case 1:
        return now.set_state(state);
      case 2:
        return now.edit([](System& system) { system.add(Particle{.mass = 1.0, .position = {50.0, 50.0}}); });
      case 3:
        return static_cast<void>(now.contact_forces());
      default:
        return static_cast<void>(now.step());
    }
  };
  const int before = twin.fuses[function]->calls;
  make(undisturbed);
  const int calls = twin.fuses[function]->calls - before;
  if (calls == 0) return;
  Fuse& fuse = *model.fuses[function];
  fuse.sort = static_cast<Thrown>(random.below(4));
  fuse.throws_at = fuse.calls + static_cast<int>(random.below(static_cast<unsigned>(calls)));
  const auto bits = bits_of(run);
  EXPECT_EQ(outcome_of([&] { make(run); }), outcome_of(fuse.sort)) << "call " << call;
  EXPECT_EQ(bits_of(run), bits) << "call " << call;
  EXPECT_EQ(run.mode().index(), mode.index());
  make(run);
  EXPECT_NEAR(run.energy().residual(), 0.0, 1e-6 * run.energy().scale());
}

TEST(UserExceptions, OneThatALawThrowsOnceEndsTheRun) {
  for (const Mode& mode : {Mode(EventDriven{.longest_step = 0.02}), Mode(TimeStepping{.step = 1e-2})}) {
    System system;
    const BodyId body = system.add(Particle{.mass = 1.0});
    auto thrown = std::make_shared<int>(0);
    system.add(AppliedForce{.on = body, .force = [thrown](double t) {
                              if (t > 0.5 && (*thrown)++ == 0) throw std::runtime_error("once");
                              return Vec<2>(1.0, 0.0);
                            }});
    Simulation simulation(system, mode);
    EXPECT_THROW(simulation.run_until(1.0), std::runtime_error);
    EXPECT_EQ(*thrown, 1);  // it is not asked again
    // The last step that ends before 0.5 s, or the interval within which a step of the flow went beyond.
    EXPECT_GT(simulation.time(), 0.47);
    EXPECT_LE(simulation.time(), 0.5);
    simulation.run_until(1.0);
    EXPECT_NEAR(simulation.state().position(body)[0], 0.5, 1e-9);
  }
}

TEST(UserExceptions, SoDoesARefusedEditWithinALaw) {
  System system;
  const BodyId body = system.add(Particle{.mass = 1.0});
  std::optional<Simulation> simulation;
  bool edited = false;
  system.add(AppliedForce{.on = body, .force = [&](double t) {
                            if (t > 0.5 && !std::exchange(edited, true)) simulation->edit([](System&) {});
                            return Vec<2>(1.0, 0.0);
                          }});
  simulation.emplace(system, EventDriven{});
  EXPECT_THROW(simulation->run_until(1.0), ModelError);
  EXPECT_TRUE(edited);
}

TEST(UserExceptions, AnyCallOfAnyFunctionMayThrow) {
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    SCOPED_TRACE(seed);
    run_with_fuse(seed);
    call_with_fuse(seed);
  }
}

TEST(UserExceptionsLong, AnyCallOfAnyFunctionMayThrow) {
  const carom_test::SeedRange seeds = carom_test::seeds_from(1000, 1200, 20000);
  for (std::uint64_t seed = seeds.first; seed < seeds.last; ++seed) {
    SCOPED_TRACE(seed);
    run_with_fuse(seed);
    call_with_fuse(seed);
  }
}

}  // namespace
