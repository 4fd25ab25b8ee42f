#pragma once

/// \file
/// Impulses of the contacts of the last step, by key, but for contacts that were solved one by one: where
/// solvers start in the next step. At rest they are its answer as they are (contact/solvers/warm_start.h).

#include <carom/core/constraint_table.h>

#include <algorithm>
#include <array>
#include <vector>

namespace carom {

/// Where solvers start at a contact.
struct SweepStart {
  std::array<double, 2> impulse{};  ///< along its rows [N s]
  int kept = 0;                     ///< steps in a row whose answer it was as it is, up to `most_kept`

  /// As good as any more: an int would end after some hours of rest.
  static constexpr int most_kept = 1'000'000;

  friend bool operator==(const SweepStart&, const SweepStart&) = default;
};

/// Where sweeps over a contact start after a step that started from `last` and found an impulse. Impulses
/// that miss those of rest by a little change the velocities by the same amount in each step. If they are
/// good enough for m steps, those of the step that corrects them undo m + 1 such changes at once, and one of
/// these alone is missing for rest: the next step starts from there, or it would have to undo m of them
/// again.
[[nodiscard]] inline SweepStart next_start(const SweepStart& last, const std::array<double, 2>& found) {
  constexpr std::array<double, 2> nothing{};
  if (found == nothing) return {found, 0};  // open: when it closes, its impulse is a new one
  if (last.impulse == found) return {found, std::min(last.kept + 1, SweepStart::most_kept)};
  if (last.kept == 0) return {found, 0};
  const auto between = [part = 1.0 / (1.0 + last.kept)](double from, double to) {
    return from + part * (to - from);
  };
  return {{between(last.impulse[0], found[0]), between(last.impulse[1], found[1])}, 0};
}

/// Contacts and their impulses.
struct ContactHistory {
  double step = 0.0;               ///< length of their step [s]
  ConstraintTable contacts;        ///< by key
  std::vector<SweepStart> starts;  ///< in the same order

  /// Forgets all contacts. \param length of the step whose impulses are to be added [s]
  void start(double length) {
    step = length;
    if (empty()) return;
    contacts.clear();
    starts.clear();
  }
  /// True if there are no contacts.
  [[nodiscard]] bool empty() const { return starts.empty(); }
  /// Adds a contact of that step.
  void add(const ConstraintKey& key, const SweepStart& start) {
    contacts.add(key);
    starts.push_back(start);
  }
};

}  // namespace carom
