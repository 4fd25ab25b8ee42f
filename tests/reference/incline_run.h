#pragma once

// One run of the bar or the pair over the inclined plane, in either mode, with what the reference files tell
// of it.

#include "examples/scenes/incline.h"
#include "tests/reference/reference_data.h"

#include <carom/carom.h>

#include <cmath>
#include <string>
#include <vector>

namespace carom_test {

struct InclineImpact {
  double time;          // [s]
  bool upper;           // of the end or particle that is above at the start
  std::string mode;     // "stick", "slip+", "slip-"
  double normal_speed;  // before, < 0 [m/s]
};

struct InclineRun {
  std::vector<InclineImpact> impacts;
  std::vector<double> q;  // at the end, in the order of the reference: bar x y angle, pair lower, upper
  double deepest_gap = 0.0;
  carom::Statistics statistics;
  double residual = 0.0, scale = 0.0;  // of the energy ledger
  double energy = 0.0;                 // total at the end
};

/// A number that some files hold as a text.
inline double number(const Json& value) {
  return value.is_string() ? std::stod(value.get<std::string>()) : value.get<double>();
}

inline scenes::Incline incline_of(const Json& p) {
  scenes::Incline incline;
  incline.slope = number(p.at("phi"));
  incline.angle = number(p.at("th0"));
  incline.speed = number(p.at("vx"));
  incline.friction = number(p.at("mu"));
  incline.normal_restitution = number(p.at("e_n"));
  incline.tangential_restitution = number(p.at("e_t"));
  return incline;
}

inline InclineRun run_incline(const scenes::Incline& incline, bool is_bar, double end,
                              const carom::Mode& mode) {
  carom::System system;
  scenes::add_plane(system, incline);
  carom::BodyId bar{};
  scenes::Pair pair{};
  if (is_bar) {
    bar = scenes::add_bar(system, incline);
  } else {
    pair = scenes::add_pair(system, incline);
  }
  carom::Simulation simulation(std::move(system), mode);
  InclineRun run;
  const auto add = [&](double time, const carom::ConstraintKey& key, const auto& at) {
    const bool upper = is_bar ? key.a.feature == 1 : at.body == pair.upper;
    run.impacts.push_back({time, upper, std::string(to_string(at.mode)), at.velocity_before[0]});
  };
  simulation.observe([&](const carom::Simulation& now) {
    if (!std::holds_alternative<carom::TimeStepping>(mode)) return;  // there are events
    for (const carom::ContactRecord& contact : now.report().contacts) {
      // A contact that is found again while it separates is no impact: its law answers with P = 0.
      if (contact.impact) add(contact.time, contact.key, contact);
    }
  });
  simulation.run_until(end);
  for (const carom::EventRecord& event : simulation.events()) {
    if (event.kind == carom::EventKind::impact) add(event.time, event.contact, event);
  }
  const carom::State& state = simulation.state();
  if (is_bar) {
    run.q = {state.position(bar)[0], state.position(bar)[1], state.angle(bar)};
  } else {
    run.q = {state.position(pair.lower)[0], state.position(pair.lower)[1], state.position(pair.upper)[0],
             state.position(pair.upper)[1]};
  }
  run.statistics = simulation.statistics();
  run.deepest_gap = run.statistics.deepest_gap;
  run.residual = simulation.energy().residual();
  run.scale = simulation.energy().scale();
  run.energy = simulation.energy().total();
  return run;
}

/// Coordinates at the end of the reference run, in the order of InclineRun::q.
inline std::vector<double> reference_end(const Json& end, bool is_bar) {
  if (!is_bar) return end.at("positions").get<std::vector<double>>();
  auto q = end.at("centre").get<std::vector<double>>();
  q.push_back(end.at("angle").get<double>());
  return q;
}

/// Euclidean distance of all coordinates (the angle counts with the half length of the bar, 1 m).
inline double distance(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
  return std::sqrt(sum);
}

/// Mode of a reference impact as the library names it: "slip+1" is slip+.
inline std::string reference_mode(const Json& impact) {
  const auto mode = impact.at("mode").get<std::string>();
  return mode.starts_with("slip") ? mode.substr(0, 5) : mode;
}

inline bool reference_upper(const Json& impact, bool is_bar) {
  return impact.at(is_bar ? "end" : "particle").get<std::string>() == "upper_at_start";
}

}  // namespace carom_test
