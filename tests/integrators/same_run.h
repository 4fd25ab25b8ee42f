#pragma once

// Is it bit for bit the same? State, energy ledger, statistics, and all else that a later step depends on.

#include <carom/carom.h>
#include <carom/integrators/run/companion.h>

#include <gtest/gtest.h>

#include <bit>
#include <cstdint>
#include <string>
#include <vector>

namespace carom_test {

inline void append_bits(std::vector<std::uint64_t>& bits, double number) {
  bits.push_back(std::bit_cast<std::uint64_t>(number));
}
template <class Real>
void append_bits(std::vector<std::uint64_t>& bits, const std::vector<Real>& numbers) {
  for (const Real number : numbers) append_bits(bits, static_cast<double>(number));
}

/// All numbers of a run, as bits (so that -0 differs from 0 and NaN equals itself).
inline std::vector<std::uint64_t> bits_of(const carom::Simulation& simulation) {
  std::vector<std::uint64_t> bits;
  const carom::State& state = simulation.state();
  append_bits(bits, state.time);
  append_bits(bits, state.q);
  append_bits(bits, state.v);
  append_bits(bits, state.z);
  for (const double number : simulation.energy().save()) append_bits(bits, number);
  const carom::Statistics& s = simulation.statistics();
  for (const std::int64_t count :
       {s.steps, s.sweeps, std::int64_t{s.most_sweeps}, s.impacts, s.contact_steps, s.several_solutions,
        s.forces_not_unique, s.energy_gains, s.lasting_gains}) {
    bits.push_back(static_cast<std::uint64_t>(count));
  }
  for (const double number :
       {s.largest_contraction, s.energy_gained, s.lasting_gained, s.deepest_gap, s.worst_residual})
    append_bits(bits, number);
  const carom::ChainStatistics& c = simulation.contact_statistics();
  for (const std::int64_t count : {c.problems, c.fall_backs, c.tolerated, c.several_solutions,
                                   c.forces_not_unique, c.degenerate, c.no_solution, c.not_solved}) {
    bits.push_back(static_cast<std::uint64_t>(count));
  }
  for (std::size_t i = 0; i < carom::solver_count; ++i) {
    bits.push_back(static_cast<std::uint64_t>(c.accepted[i]));
    bits.push_back(static_cast<std::uint64_t>(c.tried[i]));
  }
  append_bits(bits, c.worst_residual);
  const carom::Companion& companion = simulation.companion();
  append_bits(bits, companion.rounding);
  append_bits(bits, companion.grid_start);
  bits.push_back(static_cast<std::uint64_t>(companion.grid_steps));
  for (const auto& [key, mode] : companion.modes) {
    bits.insert(bits.end(), {key.a.serial, key.a.feature, key.b.serial, static_cast<std::uint64_t>(mode)});
  }
  return bits;
}

/// Coordinates and velocities only, as bits.
inline std::vector<std::uint64_t> motion_bits(const carom::State& state) {
  std::vector<std::uint64_t> bits;
  append_bits(bits, state.q);
  append_bits(bits, state.v);
  return bits;
}

}  // namespace carom_test
