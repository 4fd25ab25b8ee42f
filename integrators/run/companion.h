#pragma once

/// \file
/// Everything beside the state that can influence a later step or is accumulated along a run.

#include <carom/contact/solvers/chain_statistics.h>
#include <carom/contact/solvers/contact_solver.h>
#include <carom/core/constraint.h>
#include <carom/core/energy_ledger.h>
#include <carom/integrators/run/contact_history.h>
#include <carom/integrators/run/iteration_memory.h>
#include <carom/integrators/run/joint_history.h>
#include <carom/integrators/run/load_history.h>
#include <carom/integrators/run/step_report.h>

#include <cstdint>
#include <utility>
#include <vector>

namespace carom {

/// Modes of contacts, limits and friction in joints, by key.
using ContactModes = std::vector<std::pair<ConstraintKey, ContactMode>>;

/// Loads at the present state, by cause; arrays over all velocities. A function of the state, kept so that
/// the end of one step need not be evaluated again as the start of the next. Under the rule
/// `energy_momentum` the mean loads of the last step instead, from which those of the next are guessed.
struct PresentLoads {
  bool valid = false;               ///< false: to be evaluated
  bool mean = false;                ///< mean loads of the last step
  std::vector<double> total;        ///< [N, N m]
  std::vector<double> dissipative;  ///< part of the total; empty if no element books any
  std::vector<double> external;     ///< part of the total; empty if no element books any
};

/// When a periodic event is due: at start + k interval, k = 1, 2, ..., so that rounding does not add up.
struct Rhythm {
  double start = 0.0;      ///< [s]
  double interval = 0.0;   ///< [s]
  std::int64_t fired = 0;  ///< how often it has fired

  /// When it is due next [s].
  [[nodiscard]] double due() const { return start + static_cast<double>(fired + 1) * interval; }
};

/// Contacts that close where the next step begins, of those that are slower than the capture speed, or are
/// more than a step may have (TimeStepping::impacts, closing_counts.h).
struct ClosingNotes {
  /// Nothing is known of the way here: all that approach rebound.
  bool all_free = true;
  std::vector<ConstraintKey> free;  ///< slow ones that nothing presses: they rebound
  std::vector<ConstraintKey> cut;   ///< beyond TimeStepping::most_impacts: they do not
};

/// With the state, all that a checkpoint holds (but `loads` where they follow from the state).
struct Companion {
  EnergyLedger ledger;                 ///< the energy ledger
  Statistics statistics;               ///< counts since the start
  ChainStatistics contact_statistics;  ///< of the contact solvers in accepted steps
  std::vector<float>
      rounding;         ///< what rounding cut off the velocities: carried on, so that it does not add up
  LoadHistory history;  ///< for the guess at the loads of the next step
  JointHistory joints;  ///< for that at reactions of joints
  IterationMemory iterations;   ///< with which the next step begins
  double grid_start = 0.0;      ///< times of steps are grid_start + n h, so that rounding does not add up [s]
  std::int64_t grid_steps = 0;  ///< n
  double next_step = 0.0;       ///< of step control; 0: as described [s]
  ClosingNotes closings;        ///< contacts that close now
  PresentLoads loads;           ///< at the state
  ContactModes modes;           ///< contacts of the last step, by key
  ContactHistory contacts;      ///< impulses of the last step in large islands
  std::vector<Rhythm> rhythms;  ///< of the periodic events, in the order of every()
};

}  // namespace carom
