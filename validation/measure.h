#pragma once

/// \file
/// Measuring: the worst of many comparisons, CPU time, orders, and rows made of them.

#include "tests/analytic/convergence.h"
#include "tests/reference/reference_data.h"
#include "validation/report.h"

#include <carom/carom.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace validation {

using namespace carom;
using namespace carom::planar;
using carom_test::Json;
using carom_test::reference_data;

inline constexpr double g = 9.81;  // [m/s^2], of all references
inline constexpr double pi = 3.14159265358979323846;

inline constexpr const char* stepping_name = "time stepping";
inline constexpr const char* events_name = "event-driven";
inline constexpr const char* solver_name = "contact solver";

/// Part of a reference file, by its keys: a value of its own, so that it can be looped over.
template <class... Keys>
Json reference(const std::string& file, const Keys&... keys) {
  Json part = reference_data(file);
  ((part = Json(part.at(keys))), ...);
  return part;
}

inline double of(const Json& data, const char* key) { return data.at(key).get<double>(); }

/// CPU time since its making [s].
class Clock {
public:
  [[nodiscard]] double seconds() const {
    return static_cast<double>(std::clock() - start_) / static_cast<double>(CLOCKS_PER_SEC);
  }

private:
  std::clock_t start_ = std::clock();
};

/// Many values beside their references: keeps the worst against its scale, and their number. Of those that
/// are equally bad but for rounding it keeps the first, so that rounding does not decide which is shown.
class Comparison {
public:
  void operator()(double obtained, double reference, double scale = 1.0) {
    const double found = std::abs(obtained - reference) / scale;
    constexpr double equally_bad = 1.0 + 1e-6;
    if (count_++ == 0 || !(found <= equally_bad * scaled_error_)) {
      scaled_error_ = found;
      obtained_ = obtained;
      reference_ = reference;
    }
  }
  [[nodiscard]] int count() const { return count_; }
  [[nodiscard]] double obtained() const { return obtained_; }
  [[nodiscard]] double reference() const { return reference_; }

private:
  double scaled_error_ = 0.0, obtained_ = unknown, reference_ = unknown;
  int count_ = 0;
};

/// The tolerances of the event-driven runs.
inline EventDriven tight() { return {.relative_tolerance = 1e-11, .absolute_tolerance = 1e-13}; }

inline std::string short_text(double value) {
  constexpr int longest = 40;
  char text[longest];
  std::snprintf(text, longest, "%.4g", value);
  return text;
}

/// How a run was made.
inline std::string setting(const EventDriven& options) {
  return "rtol " + short_text(options.relative_tolerance);
}
inline std::string setting(const TimeStepping& options) {
  const bool located = options.impacts == ImpactTimes::located;
  return "h = " + short_text(options.step) + (located ? " s, impacts located" : " s");
}

/// Depth at which a body starts in contact [m]: in time stepping a little inside, so that the contact is seen
/// at once.
inline double depth_for(const Mode& mode) { return std::holds_alternative<TimeStepping>(mode) ? 1e-9 : 0.0; }

/// Name and setting of a mode.
inline std::pair<std::string, std::string> described(const Mode& mode) {
  if (const auto* events = std::get_if<EventDriven>(&mode)) return {events_name, setting(*events)};
  return {stepping_name, setting(std::get<TimeStepping>(mode))};
}

/// A row of one value, or of the worst of many, which the quantity then says.
inline Row row(const Mode& mode, const std::string& quantity, const Comparison& compared, double cost,
               double order = unknown) {
  const auto [name, how] = described(mode);
  const std::string many =
      compared.count() > 1 ? ", worst of " + std::to_string(compared.count()) : std::string();
  return {name,
          how,
          quantity + many,
          number_text(compared.reference()),
          number_text(compared.obtained()),
          std::abs(compared.obtained() - compared.reference()),
          order,
          cost,
          {}};
}
inline Row row(const Mode& mode, const std::string& quantity, double obtained, double reference, double cost,
               double order = unknown) {
  Comparison one;
  one(obtained, reference);
  return row(mode, quantity, one, cost, order);
}

/// Rows of contact problems solved without a simulation.
inline Row solver_row(const std::string& solver, const std::string& quantity, const Comparison& compared,
                      double cost) {
  Row result = row(TimeStepping{}, quantity, compared, cost);
  result.mode = solver_name;
  result.setting = solver;
  return result;
}

/// A row of words.
inline Row statement(const Mode& mode, const std::string& quantity, const std::string& reference,
                     const std::string& obtained, double cost) {
  const auto [name, how] = described(mode);
  return {name, how, quantity, reference, obtained, unknown, unknown, cost, {}};
}

/// Errors of runs with steps h, h/2, h/4, ...
struct Halvings {
  std::vector<double> steps, errors;
  double cost = 0.0;  ///< of all runs [s]
  [[nodiscard]] double order() const { return analytic::slope(steps, errors); }
};
template <class F>
Halvings halve(double step, int runs, F&& error_at) {
  Halvings result;
  const Clock clock;
  for (int i = 0; i < runs; ++i, step *= 0.5) {
    result.steps.push_back(step);
    result.errors.push_back(error_at(step));
  }
  result.cost = clock.seconds();
  return result;
}

/// A mode with another step: keeps the other options of time stepping.
inline TimeStepping with_step(const Mode& mode, double step) {
  TimeStepping options = std::get<TimeStepping>(mode);
  options.step = step;
  return options;
}

/// True of time stepping with the options as they come: orders are measured with these alone.
inline bool has_order(const Mode& mode) {
  const auto* stepping = std::get_if<TimeStepping>(&mode);
  return stepping != nullptr && stepping->impacts == ImpactTimes::at_step_start &&
         stepping->force_rule == ForceRule::trapezoidal;
}

/// Adds rows of time stepping, with what comes out under each option (Row::with_option).
/// \param add called with a page and a mode: adds the rows of that mode, the same under each option
template <class F>
void add_with_options(Page& page, const TimeStepping& stepping, F&& add) {
  const std::size_t first = page.rows.size();
  add(page, Mode(stepping));
  constexpr std::array options{std::pair{ImpactTimes::located, ForceRule::trapezoidal},
                               std::pair{ImpactTimes::at_step_start, ForceRule::energy_momentum},
                               std::pair{ImpactTimes::located, ForceRule::energy_momentum}};
  static_assert(options.size() == option_count);
  for (std::size_t i = 0; i < option_count; ++i) {
    TimeStepping with = stepping;
    with.impacts = options[i].first;
    with.force_rule = options[i].second;
    Page other;
    add(other, Mode(with));
    if (other.rows.size() != page.rows.size() - first)
      throw std::runtime_error(page.name + ": an option changes the number of rows");
    for (std::size_t at = 0; at < other.rows.size(); ++at) {
      const Row& row = other.rows[at];
      page.rows[first + at].with_option.push_back(std::isnan(row.error) ? row.obtained
                                                                        : scientific_text(row.error));
    }
  }
}

/// Rows of both modes.
template <class F>
void add_in_both_modes(Page& page, const TimeStepping& stepping, const EventDriven& events, F&& add) {
  add_with_options(page, stepping, add);
  add(page, Mode(events));
}

/// The events of one kind, in time.
inline std::vector<EventRecord> events_of(const Simulation& simulation, EventKind kind) {
  std::vector<EventRecord> found;
  for (const EventRecord& event : simulation.events()) {
    if (event.kind == kind) found.push_back(event);
  }
  return found;
}

/// An impact, in either mode: of time stepping with the time at the end of its step, unless it is located.
/// Normal, tangential.
struct Impact {
  double time = 0.0;
  ConstraintKey contact{};
  BodyId body{};
  ObstacleId obstacle{};
  std::array<double, 3> before{}, after{}, impulse{};
  ContactMode mode = ContactMode::open;
};

/// Runs until `end`, once, and returns all impacts since the start.
inline std::vector<Impact> impacts_until(Simulation& simulation, double end) {
  const auto impacts =
      std::make_shared<std::vector<Impact>>();  // the observer lives as long as the simulation
  simulation.observe([impacts](const Simulation& now) {
    if (!std::holds_alternative<TimeStepping>(now.mode())) return;  // there are events
    for (const ContactRecord& at : now.report().contacts) {
      if (!at.impact) continue;
      impacts->push_back({at.time, at.key, at.body, at.obstacle, at.velocity_before, at.velocity_after,
                          at.impulse, at.mode});
    }
  });
  simulation.run_until(end);
  for (const EventRecord& at : events_of(simulation, EventKind::impact)) {
    impacts->push_back({at.time, at.contact, at.body, at.obstacle, at.velocity_before, at.velocity_after,
                        at.impulse, at.mode});
  }
  return *impacts;
}

}  // namespace validation
