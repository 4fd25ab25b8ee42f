// The reference problems in both modes, every number with all its bits: a line each, "name number number
// ...". reference_runs.py runs the same models from Python; test_same_bits.py compares the lines.

#include "examples/scenes/incline.h"
#include "tests/analytic/rotating_spring_pair.h"
#include "tests/reference/incline_run.h"
#include "tests/reference/reference_data.h"
#include "validation/scenes.h"

#include <carom/carom.h>

#include <cstdio>
#include <cstdlib>
#include <exception>
#include <functional>
#include <iostream>
#include <numbers>
#include <string>

namespace {

using namespace carom;
using namespace carom::planar;
using carom_test::Json;
using carom_test::reference_data;

double number(const Json& of, const char* key) { return of.at(key).get<double>(); }

/// Time, state, ledger and counts of a run.
void print(const std::string& name, const Simulation& simulation) {
  std::fputs(name.c_str(), stdout);
  const auto put = [](double value) { std::printf(" %a", value); };
  const State& state = simulation.state();
  put(state.time);
  for (const std::vector<double>* numbers : {&state.q, &state.v, &state.z}) {
    for (const double value : *numbers) put(value);
  }
  const EnergyLedger& energy = simulation.energy();
  for (std::size_t i = 0; i < stored_energy_count; ++i) put(energy.stored(static_cast<StoredEnergy>(i)));
  for (std::size_t i = 0; i < energy_flow_count; ++i) put(energy.flow(static_cast<EnergyFlow>(i)));
  put(energy.initial());
  put(energy.residual());
  const Statistics& counts = simulation.statistics();
  for (const long count : {counts.steps, counts.sweeps, counts.impacts, counts.flow_steps}) {
    put(static_cast<double>(count));
  }
  put(static_cast<double>(simulation.events().size()));
  std::puts("");
}

/// Runs a model in both modes. \param make makes it, for time stepping or not
void run(const std::string& name, double end, const std::function<System(bool)>& make) {
  Simulation steps(make(true), TimeStepping{.step = 1e-3});
  steps.run_until(end);
  print(name + "/time-stepping", steps);
  Simulation events(make(false), EventDriven{});
  events.run_until(end);
  print(name + "/event-driven", events);
}

// Depth at which bodies in contact start: time stepping then sees the contact in the first step.
double depth(bool stepping) { return stepping ? 1e-9 : 0.0; }

void run_contacts() {
  const auto plain = [](const std::string& name, double end, auto make) {
    run(name, end, [=](bool stepping) { return make(depth(stepping)).system; });
  };
  plain("bouncing_ball", 2.0, [](double) { return scenes::ball_above_floor(1.0, 0.8); });
  plain("coulomb_oscillator", 3.0, [](double at) { return scenes::coulomb_oscillator(at); });
  plain("ladder", 0.5, [](double at) { return scenes::ladder(0.5, 1.0, at); });
  plain("painleve_rod", 0.2, [](double at) {
    return scenes::painleve_rod({.theta = 1.0, .friction = 0.3, .tip_speed = 2.0, .depth = at});
  });
  plain("rocking_block", 3.0, [](double at) { return scenes::rocking_block(0.2, 0.8, 0.1, at); });
  plain("impact_oscillator", 5.0, [](double) {
    return scenes::impact_oscillator(
        {.force = 1.0, .frequency = 2.8, .wall = 0.1, .restitution = 0.8, .position = -0.1, .speed = 0.5});
  });
  plain("vibrating_table", 1.0, [](double) {
    return scenes::vibrating_table({.amplitude = 0.01,
                                    .frequency = 10.0 * std::numbers::pi,
                                    .phase = 0.3,
                                    .restitution = 0.5,
                                    .height = 0.05,
                                    .speed = 0.1});
  });
}

void run_rolling(const Json& data) {
  int i = 0;
  for (const Json& at : data.at("body_on_incline").at("cases")) {
    run("body_on_incline" + std::to_string(i++), 1.0, [&](bool stepping) {
      return scenes::downhill({.slope = number(at, "slope"),
                               .friction = number(at, "mu"),
                               .inertia = number(at, "inertia_over_m_r2") * 0.1 * 0.1,
                               .radius = 0.1,
                               .depth = depth(stepping)})
          .system;
    });
  }
  i = 0;
  for (const Json& at : data.at("slide_to_roll").at("cases")) {
    run("slide_to_roll" + std::to_string(i++), 2.0, [&](bool stepping) {
      return scenes::downhill({.friction = 0.3,
                               .inertia = number(at, "I_over_m_r2") * 0.1 * 0.1,
                               .radius = 0.1,
                               .speed = number(at, "v0"),
                               .forward_spin = number(at, "spin0"),
                               .depth = depth(stepping)})
          .system;
    });
  }
}

// One impact without gravity.
void strike(const std::string& name, const MassProperties<2>& mass, double radius, const Surface& surface,
            const Vec<2>& velocity, double spin) {
  run(name, 1e-3,
      [&](bool) { return scenes::round_body(mass, radius, surface, 0.0, velocity, spin).system; });
}

void run_impacts(const Json& data) {
  int i = 0;
  for (const auto& [name, impacts] : data.at("johansson_tables").at("runs").items()) {
    const double e_t = std::stod(name.substr(2, name.find('_') - 2));
    for (const Json& at : impacts) {
      if (at.at("table") != "low") continue;
      strike("johansson_tables" + std::to_string(i++), solid_sphere(0.00859, 0.0131), 0.0131,
             {.friction = 1.13, .normal_restitution = 0.91, .tangential_restitution = e_t},
             {number(at, "vx_minus"), number(at, "vy_minus")}, number(at, "spin_minus"));
    }
  }
  i = 0;
  for (const auto& [name, result] : data.at("horak").at("results").items()) {
    for (const Json& row : result.at("rows")) {
      strike("horak" + std::to_string(i++), thin_shell(0.1134, 0.0359), 0.0359,
             {.friction = number(result, "mu"),
              .normal_restitution = number(result, "e_n"),
              .tangential_restitution = number(result, "e_t")},
             {0.0, -number(data.at("horak"), "impact_speed")}, number(row, "spin_before"));
    }
  }
  i = 0;
  for (const Json& curve : data.at("walton_curves").at("cases")) {
    for (const Json& point : curve.at("curve_psi1_psi2_mode")) {
      const double r = 1.59e-3, m = 4.0e-5;
      strike("walton" + std::to_string(i++), {.mass = m, .inertia = number(curve, "I_over_m_r2") * m * r * r},
             r,
             {.friction = number(curve, "mu"),
              .normal_restitution = number(curve, "e_n"),
              .tangential_restitution = number(curve, "beta0")},
             {point[0].get<double>(), -1.0}, 0.0);
    }
  }
  i = 0;
  for (const Json& value : data.at("energy_inconsistency").at("values")) {
    run("energy_inconsistency" + std::to_string(i++), 1e-3, [&](bool) {
      return scenes::struck_point({.mass = 1.0, .inertia = 1.0}, {-1.0, -1.0},
                                  {.friction = 1.0,
                                   .normal_restitution = number(value, "e_n"),
                                   .tangential_restitution = number(value, "e_t")},
                                  {1.0, -2.0})
          .system;
    });
  }
}

void run_incline_bodies() {
  const Json all = reference_data("incline_bodies.json");
  for (const char* kind : {"bar", "pair"}) {
    for (const auto& [name, data] : all.at(kind).items()) {
      const scenes::Incline incline = carom_test::incline_of(data.at("parameters"));
      run(std::string(kind) + "_" + name, 3.5, [&](bool) {
        System system;
        scenes::add_plane(system, incline);
        if (kind == std::string("bar")) {
          scenes::add_bar(system, incline);
        } else {
          scenes::add_pair(system, incline);
        }
        return system;
      });
    }
  }
}

void run_smooth() {
  run("two_mass_spring_dashpot", 1.0, [](bool) {
    System system;
    system.add(Gravity{{0.0, -9.81}});
    const BodyId lower = system.add(Particle{.mass = 1.0, .position = {0.0, 10.0}, .velocity = {0.0, 2.0}});
    const BodyId upper = system.add(Particle{.mass = 2.0, .position = {0.0, 11.0}, .velocity = {0.0, -1.0}});
    system.add(
        SpringDamper{.from = lower, .to = upper, .stiffness = 100.0, .damping = 3.0, .free_length = 0.5});
    return system;
  });
  int i = 0;
  const Json variants = reference_data("open_variants.json").at("spring_pendulum");
  for (const Json& variant : variants) {
    run("spring_pendulum" + std::to_string(i++), 1.0, [&](bool) {
      const auto start = variant.at("start").get<std::vector<double>>();
      System system;
      system.add(Gravity{{0.0, -9.81}});
      const BodyId bob = system.add(Particle{
          .mass = number(variant, "m"), .position = {start[0], start[1]}, .velocity = {start[2], start[3]}});
      system.add(SpringDamper{.from = ground,
                              .to = bob,
                              .stiffness = number(variant, "k"),
                              .free_length = number(variant, "l0")});
      return system;
    });
  }
  run("rotating_spring_pair", 1.0, [](bool) {
    const analytic::RotatingSpringPair exact{1.0, 1000.0, 2.0, 10.0};
    System system;
    const BodyId first =
        system.add(Particle{.mass = 1.0, .position = exact.position(0.0), .velocity = exact.velocity(0.0)});
    const BodyId second =
        system.add(Particle{.mass = 1.0, .position = -exact.position(0.0), .velocity = -exact.velocity(0.0)});
    system.add(SpringDamper{.from = first, .to = second, .stiffness = 1000.0, .free_length = 2.0});
    return system;
  });
}

}  // namespace

int main() try {
  const Json data = reference_data("impacts_planar.json");
  run_contacts();
  run_rolling(data);
  run_impacts(data);
  run_incline_bodies();
  run_smooth();
  return EXIT_SUCCESS;
} catch (const std::exception& error) {
  std::cerr << "reference_runs: " << error.what() << "\n";
  return EXIT_FAILURE;
}
