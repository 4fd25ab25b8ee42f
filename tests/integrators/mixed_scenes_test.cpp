// Bodies of all shapes over ground of all kinds: every step is solved or says why not, accounts close,
// nothing sinks deeper than steps allow, and both modes tell the same.

#include "tests/integrators/mixed_scenes.h"

#include "tests/energy/ledger_check.h"
#include "tests/integrators/event_run.h"
#include "tests/shares.h"

#include <carom/carom.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

namespace {

using namespace carom;
using namespace carom::planar;
using carom_test::DepthWatch;
using carom_test::ledger_closes;
using carom_test::MixedScene;
using carom_test::tight;

struct Findings {
  int pressed = 0;              // scenes that end where moving ground presses a body
  int with_contact = 0;         // scenes in which anything touched
  std::int64_t jams = 0;        // plastic ones
  double worst_residual = 0.0;  // certificate
};

/// True if impulses within their sets move no body, W d = 0, and act against what approaches, b . d < 0.
/// Where there are none a contact problem has an answer (docs/method.md, section 3); and over ground at rest
/// there are none without restitution: b = H v, and W d = 0 means H^T d = 0, so b . d = 0. They are the limit
/// of the answers of (W + eps I) P + b, which grow along d as 1 / eps where W has none.
bool has_pressing_impulses(const ContactProblem& problem) {
  constexpr double eps = 1e-9, limit = 1e-5;
  double largest = 0.0;
  for (int row = 0; row < problem.rows(); ++row) largest = std::max(largest, problem.diagonal(row));
  ContactProblem near = problem;
  for (int row = 0; row < near.rows(); ++row) near.w(row, row) += eps * largest;
  std::vector<double> d(static_cast<std::size_t>(problem.rows())), xi(d.size());
  SolverChain chain;
  if (!chain.solve(near, d).usable()) return false;
  double size = 0.0;
  for (const double impulse : d) size = std::max(size, std::abs(impulse));
  if (size == 0.0) return false;
  for (double& impulse : d) impulse /= size;
  problem.velocities(d, xi);  // W d + b
  double work = 0.0, moved = 0.0;
  for (std::size_t row = 0; row < d.size(); ++row) {
    work += d[row] * problem.vector()[row];
    moved = std::max(moved, std::abs(xi[row] - problem.vector()[row]));
  }
  return moved <= limit * largest && work < 0.0;
}

/// True of an error that moving ground explains: it presses a body against other ground, which has no answer.
bool is_pressed(const MixedScene& scene, const SolverError& error) {
  return scene.moves() && error.has_problem() && error.failure().parts.size() > 1 &&
         has_pressing_impulses(error.problem());
}

/// True if the fastest velocity grows as 1 / sqrt(t* - t): two contacts come to a dead centre, where their
/// rows are dependent and pressing impulses exist, while moving ground drives them through it. With a
/// constant coefficient of friction forces grow without bound in no other way (docs/method.md, unbounded
/// forces).
bool is_driven_through_dead_centre(const MixedScene& scene, const SolverError& error) {
  constexpr double early = 1e-5, late = 1e-7;  // before the end [s]
  const double end = error.failure().time + error.failure().step;
  Simulation simulation(scene.system(), EventDriven{});
  const auto fastest = [&](double before) {
    simulation.run_until(end - before);
    double most = 0.0;
    for (const double v : simulation.state().v) most = std::max(most, std::abs(v));
    return most;
  };
  const double at_first = fastest(early), at_last = fastest(late);
  return scene.moves() && simulation.contact_forces().size() > 1 &&
         std::abs(at_last / at_first / std::sqrt(early / late) - 1.0) < 0.05;  // terms without growth
}

Findings run_scenes(const carom_test::SeedRange& seeds) {
  constexpr double step = 1e-3;
  Findings findings;
  for (std::uint64_t number = seeds.first; number < seeds.last; ++number) {
    SCOPED_TRACE("scene " + std::to_string(number));
    const MixedScene scene(number);
    Simulation simulation(scene.system(), TimeStepping{.step = step});
    const DepthWatch watch(simulation, scene);
    try {
      simulation.run_until(1.0);
    } catch (const SolverError& error) {
      EXPECT_TRUE(is_pressed(scene, error)) << error.what();
      EXPECT_NE(std::string(error.what()).find("pressed by the motion of"), std::string::npos);
      ++findings.pressed;
    }
    const Statistics& statistics = simulation.statistics();
    EXPECT_TRUE(ledger_closes(simulation.energy()));
    EXPECT_LE(-statistics.deepest_gap, watch.bound(step));
    if (statistics.contact_steps > 0) ++findings.with_contact;
    findings.jams += statistics.plastic_jams;
    findings.worst_residual = std::max(findings.worst_residual, statistics.worst_residual);
  }
  return findings;
}

void expect_sound(const Findings& findings, int count) {
  EXPECT_GE(findings.with_contact, count / 2);  // else nothing was tried
  EXPECT_LE(findings.pressed, 1 + count / 200);
  EXPECT_LE(findings.worst_residual, SweepBudget{}.accepted);
}

TEST(MixedScenes, AreSolvedAndKeepTheirAccountAndTheirDistance) { expect_sound(run_scenes({0, 60}), 60); }

TEST(MixedScenes, AnObstacleThatPressesIsNamed) {
  // A disc comes between a peg that moves down and one at rest.
  const MixedScene scene(2468);
  Simulation simulation(scene.system(), TimeStepping{.step = 1e-3});
  try {
    simulation.run_until(1.0);
    ADD_FAILURE() << "nothing presses";
  } catch (const SolverError& error) {
    EXPECT_TRUE(is_pressed(scene, error)) << error.what();
    EXPECT_NE(std::string(error.what()).find("motion of peg #0"), std::string::npos) << error.what();
  }
  EXPECT_TRUE(ledger_closes(simulation.energy()));
}

TEST(MixedScenesLong, AreSolvedAndKeepTheirAccountAndTheirDistance) {
  const carom_test::SeedRange seeds = carom_test::seeds_from(0, 1000, 10000, 1000);
  const Findings findings = run_scenes(seeds);
  expect_sound(findings, seeds.count());
  EXPECT_GT(findings.jams, 0);  // else no scene jams
  RecordProperty("plastic_jams", std::to_string(findings.jams));
  RecordProperty("pressed", std::to_string(findings.pressed));
}

struct EventFindings {
  int pressed = 0;          // scenes that end where moving ground presses a body, which names the contacts
  std::int64_t looked = 0;  // outputs with contacts that last
};

/// From event to event: accounts close, contacts push, and what ends a scene is named.
EventFindings run_scenes_by_events(const carom_test::SeedRange& seeds, double interval = 1e-2) {
  EventFindings findings;
  for (std::uint64_t number = seeds.first; number < seeds.last; ++number) {
    SCOPED_TRACE("scene " + std::to_string(number));
    const MixedScene scene(number);
    Simulation simulation(scene.system(), EventDriven{.interval = interval});
    simulation.observe([&](const Simulation& now) {
      const std::vector<LastingContact> lasting = now.contact_forces();
      findings.looked += lasting.empty() ? 0 : 1;
      for (const LastingContact& contact : lasting) {
        // Forces are up to some hundred newtons, and zero to 1e-11 of that; where bodies wedge each other
        // more.
        EXPECT_GE(contact.force[0], -1e-6) << now.name(contact.key) << ", t = " << now.time();
      }
    });
    try {
      simulation.run_until(1.0);
    } catch (const SolverError& error) {
      EXPECT_FALSE(error.failure().parts.empty()) << error.what();
      EXPECT_TRUE(is_pressed(scene, error) ||
                  (!error.has_problem() && is_driven_through_dead_centre(scene, error)))
          << error.what();
      ++findings.pressed;
    }
    // Tolerances of 1e-9 of some 1,000 steps.
    EXPECT_NEAR(simulation.energy().residual(), 0.0, 1e-7 * std::max(1.0, simulation.energy().scale()));
  }
  return findings;
}

void expect_sound(const EventFindings& findings, int count) {
  EXPECT_GE(findings.looked, count);  // else nothing was tried
  EXPECT_LE(findings.pressed, 1 + count / 500);
}

TEST(MixedScenes, AccountsCloseAndContactsPushFromEventToEvent) {
  expect_sound(run_scenes_by_events({0, 15}), 15);
}

TEST(MixedScenes, OnlyGroundThatMovesEndsARunFromEventToEvent) {
  // A body hits two pegs of which one moves: an impact without an answer. Another one, wedged between them,
  // is driven through a dead centre.
  for (const std::uint64_t number : {732u, 6613u}) {
    SCOPED_TRACE("scene " + std::to_string(number));
    const MixedScene scene(number);
    Simulation simulation(scene.system(), EventDriven{});
    try {
      simulation.run_until(1.0);
      ADD_FAILURE() << "nothing presses";
    } catch (const SolverError& error) {
      EXPECT_EQ(is_pressed(scene, error), number == 732) << error.what();
      EXPECT_EQ(is_driven_through_dead_centre(scene, error), number == 6613) << error.what();
    }
  }
  // A body between two walls without friction, whose velocities are b: it hits one of them, at rest or
  // slower.
  ContactProblem between;
  between.reset(2);
  between.w(0, 0) = between.w(1, 1) = 1.0;
  between.w(0, 1) = between.w(1, 0) = -1.0;
  between.group();
  for (const double other : {1.0, 0.5}) {
    between.vector()[0] = -1.0;
    between.vector()[1] = other;
    EXPECT_EQ(has_pressing_impulses(between), other < 1.0);
  }
}

TEST(MixedScenes, AnObstacleThatPressesIsNamedFromEventToEvent) {
  for (const std::uint64_t number : {732u, 2468u})
    EXPECT_EQ(run_scenes_by_events({number, number + 1}).pressed, 1);
}

TEST(MixedScenes, ForcesThatComeToTheirEndEndTheContact) {
  // 2216: within a step of 1 s a force falls below zero, comes back and falls again. 3471: of a body wedged
  // between two pegs a force falls below zero; no force of the wedge, however large, makes up for it.
  for (const std::uint64_t number : {2216u, 3471u}) {
    EXPECT_EQ(run_scenes_by_events({number, number + 1}, 1e-3).pressed, 0);
  }
}

TEST(MixedScenes, AGapThatHardlyMovesHidesNoClosing) {
  // A corner stays within 1e-12 m of where another one is closed, and is found touching at once in every
  // step; at last it closes a quarter of a step later than predicted, and behind the closing of another gap.
  for (const std::uint64_t number : {2u, 2754u}) {
    SCOPED_TRACE("scene " + std::to_string(number));
    Simulation simulation(MixedScene(number).system(), EventDriven{.interval = 1e-4});
    EXPECT_NO_THROW(simulation.run_until(1.0));
  }
}

TEST(MixedScenes, JamsAreSolvedWithoutRestitutionFromEventToEvent) {
  // Each of them has impacts that no impulses solve by the law: e differ, of contacts or along n and t.
  for (const std::uint64_t number :
       carom_test::samples({414u, 556u, 628u, 2002u, 2158u, 3371u, 3471u, 3515u, 3895u}, 3)) {
    SCOPED_TRACE("scene " + std::to_string(number));
    const MixedScene scene(number);
    Simulation simulation(scene.system(), EventDriven{});
    EXPECT_NO_THROW(simulation.run_until(1.0));
    EXPECT_GT(simulation.statistics().plastic_jams, 0);
    for (const EventRecord& event : simulation.events()) {
      if (event.restitution_factor != 0.0) continue;
      EXPECT_EQ(event.kind, EventKind::impact);
      EXPECT_EQ(event.energy_gain, 0.0);
      // But for rounding of sums; ground that moves does work.
      EXPECT_TRUE(scene.moves() || event.energy_after <= event.energy_before * (1.0 + 1e-12));
    }
    EXPECT_NEAR(simulation.energy().residual(), 0.0, 1e-7 * std::max(1.0, simulation.energy().scale()));
  }
}

TEST(MixedScenesLong, AccountsCloseAndContactsPushFromEventToEvent) {
  const carom_test::SeedRange seeds = carom_test::seeds_from(0, 300, 10000);
  const EventFindings findings = run_scenes_by_events(seeds);
  expect_sound(findings, seeds.count());
  RecordProperty("pressed", std::to_string(findings.pressed));
}

/// Whether impacts of one body follow each other within `apart` [s]: steps longer than that take them for
/// one, whose answer differs by more than the length of a step.
bool is_close(const std::vector<EventRecord>& events, double apart) {
  const auto shares = [](const EventRecord& a, const EventRecord& b) {
    const auto has = [&b](BodyId body) { return body.valid() && (body == b.body || body == b.other); };
    return has(a.body) || has(a.other);
  };
  for (std::size_t i = 0; i < events.size(); ++i) {
    if (events[i].kind != EventKind::impact) continue;
    for (std::size_t j = i + 1; j < events.size() && events[j].time - events[i].time <= apart; ++j) {
      if (events[j].kind != EventKind::impact || events[j].instant == events[i].instant) continue;
      if (shares(events[i], events[j])) return true;
    }
  }
  return false;
}

double distance(const State& a, const State& b) {
  double largest = 0.0;
  for (std::size_t i = 0; i < a.q.size(); ++i) largest = std::max(largest, std::abs(a.q[i] - b.q[i]));
  return largest;
}

/// A scene in both modes, looked at every 0.01 s while it is known what it does: as long as a change of the
/// start by 1e-9 (above what the tolerance of 1e-11 leaves) has grown by less than 1e5, and impacts of one
/// body are ten steps apart.
class TwoModes {
public:
  TwoModes(const MixedScene& scene, double step) : scene_(scene), step_(step) {}

  /// Largest difference against h V G: the length of a step, the fastest velocity, and how much a change of
  /// the start has grown. A step is of first order across impacts.
  double compare() {
    Simulation exact(scene_.system(), tight()), near = exact_from_changed_start();
    Simulation steps(scene_.system(), TimeStepping{.step = step_}), finer(scene_.system(), finer_steps());
    double fastest = 1.0, growth = 1.0, worst = 0.0;
    for (int look = 1; look <= 50; ++look) {
      for (Simulation* const each : {&exact, &near, &steps, &finer}) each->run_until(0.01 * look);
      if (is_close(exact.events(), 10.0 * step_)) break;
      growth = std::max(growth, distance(exact.state(), near.state()) / change);
      if (growth > 1e5) break;
      for (const double speed : exact.state().v) fastest = std::max(fastest, std::abs(speed));
      impacts_ = exact.statistics().events[static_cast<std::size_t>(EventKind::impact)];
      const double size = step_ * fastest * growth;
      // Where the constant of the error is large it still falls with the step.
      const double coarse = distance(exact.state(), steps.state());
      const double fine = distance(exact.state(), finer.state());
      worst = std::max(worst, fine <= 0.3 * coarse ? fine / size : coarse / size);
    }
    return worst;
  }
  /// Impacts in the part that was compared.
  std::int64_t impacts() const { return impacts_; }

private:
  static constexpr double change = 1e-9;

  Simulation exact_from_changed_start() const {
    Simulation simulation(scene_.system(), tight());
    State start = simulation.state();
    for (std::size_t i = 0; i < start.q.size(); ++i) start.q[i] += i % 2 == 0 ? change : -change;
    simulation.set_state(start);
    return simulation;
  }
  TimeStepping finer_steps() const { return {.step = 0.1 * step_}; }

  const MixedScene& scene_;
  double step_;
  std::int64_t impacts_ = 0;
};

/// Numbers of scenes and of impacts that were compared.
void compare_modes(const carom_test::SeedRange& seeds) {
  std::int64_t impacts = 0;
  for (std::uint64_t number = seeds.first; number < seeds.last; ++number) {
    SCOPED_TRACE("scene " + std::to_string(number));
    const MixedScene scene(number, 3);
    TwoModes modes(scene, 1e-4);
    try {
      // Of 600 scenes two came above 10 by their steps alone (10.4, 19.2), and converge. A missed impact
      // leaves the time since over the step: a hundred after one look.
      EXPECT_LE(modes.compare(), 10.0);
    } catch (const SolverError& error) {
      // From event to event contacts may jam, or bounce without end; then it says so.
      const std::string text = error.what();
      EXPECT_TRUE(text.find("no solution") != std::string::npos ||
                  text.find("approaches") != std::string::npos ||
                  text.find("do not come to an end") != std::string::npos)
          << text;
    }
    impacts += modes.impacts();
  }
  EXPECT_GE(impacts, seeds.count() / 2);  // else nothing was compared
}

TEST(MixedScenes, BothModesTellTheSame) { compare_modes({0, 3}); }

TEST(MixedScenesLong, BothModesTellTheSame) {
  compare_modes({3, 7});
  compare_modes(carom_test::seeds_from(100, 150));
}

}  // namespace
