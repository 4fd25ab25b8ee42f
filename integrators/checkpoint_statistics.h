#pragma once

/// \file
/// Which numbers of the statistics of a run a checkpoint has.

#include <carom/contact/solvers/chain_statistics.h>
#include <carom/integrators/run/step_report.h>

#include <cstddef>

namespace carom {

/// Version of the checkpoints that are written.
inline constexpr int checkpoint_version = 15;
/// Oldest version that is read. Those before version 7 know nothing of joints and of large contact problems:
/// a run goes on from one without guesses.
inline constexpr int oldest_checkpoint = 6;

/// The numbers of Statistics, in the order in which they are saved. \param version of the checkpoint
template <class S, class F>
void for_statistics(S& s, int version, F&& f) {
  f(s.steps);
  f(s.sweeps);
  f(s.most_sweeps);
  f(s.largest_contraction);
  for (auto& count : s.steps_by_iteration) f(count);
  f(s.fallbacks);
  f(s.impacts);
  f(s.contact_steps);
  f(s.several_solutions);
  f(s.forces_not_unique);
  f(s.rejected_steps);
  f(s.steps_across_impacts);
  f(s.energy_gains);
  f(s.energy_gained);
  f(s.lasting_gains);
  f(s.lasting_gained);
  if (version >= 8) {
    f(s.cut_sequences);
    f(s.scaled_impacts);
    f(s.plastic_jams);
  }
  f(s.deepest_gap);
  f(s.worst_residual);
  if (version >= 10) {
    for (auto& count : s.certified_steps) f(count);
  }
  constexpr std::size_t without_rolling = 11;  // kinds of events
  for (std::size_t kind = 0; kind < (version >= 9 ? s.events.size() : without_rolling); ++kind)
    f(s.events[kind]);
  f(s.flow_steps);
  f(s.flow_evaluations);
  f(s.flow_restarts);
}

/// The numbers of the statistics of the contact solvers, in the order in which they are saved. \param version
/// of the checkpoint; version 6 has none of large problems, whose solver is the last
template <class S, class F>
void for_contact_statistics(S& s, int version, F&& f) {
  const bool large = version >= 7;
  const std::size_t solvers = large ? solver_count : solver_count - 1;
  f(s.problems);
  for (std::size_t i = 0; i < solvers; ++i) f(s.accepted[i]);
  for (std::size_t i = 0; i < solvers; ++i) f(s.tried[i]);
  f(s.fall_backs);
  f(s.tolerated);
  f(s.several_solutions);
  f(s.forces_not_unique);
  f(s.degenerate);
  f(s.no_solution);
  f(s.not_solved);
  if (large) {
    f(s.accepted_at_cap);
    for (auto& count : s.certified) f(count);
  }
  f(s.worst_residual);
}

}  // namespace carom
