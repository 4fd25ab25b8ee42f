#pragma once

/// \file
/// How loads changed over the last steps, by which those at the end of the next are guessed.

#include <carom/core/export.h>
#include <carom/core/ids.h>

#include <array>
#include <cstddef>
#include <vector>

namespace carom {

/// Changes over the last steps, as floats: a guess needs no more digits. The last of them may be pending: it
/// is taken down when the next step begins with these bodies, whose loads are then at hand.
struct CAROM_API LoadHistory {
  static constexpr int most = 3;  ///< steps that are remembered
  int known = 0;                  ///< how many of the changes are known
  double step = 0.0;              ///< length of the last step, where nothing changes too; of the last
                                  ///< `known` if there are several [s]
  std::array<std::vector<float>, most> changes;  ///< over the last step, over the one before it, and so on
                                                 ///< [N, N m]; empty before the first step
  bool pending = false;  ///< the last change is that from `before` to the present loads, changes[0] is void
  std::vector<double> before;  ///< loads at the start of the last step if it is pending [N, N m]
  std::vector<int> sweeps;     ///< of the last step, by component; empty if there was none

  /// A step was made: its change is pending, and the oldest forgotten. \param next_step its length [s]
  /// \param size number of velocities
  void go_on(double next_step, std::size_t size);
  /// Takes the change from `then` to `now` down as the last one, over the velocities `v`.
  void record_change(Range v, const double* then, const double* now);
  /// Takes a pending change down, from `before` to the loads `now`: where an impact is about to change these.
  void settle(const std::vector<double>& now);
  /// Guesses loads over the velocities `v` after `next_step` [s] by the polynomial through those of the last
  /// steps; none of them may be pending there.
  void guess(Range v, double next_step, const double* now, double* guess) const;
};

}  // namespace carom
