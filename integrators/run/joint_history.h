#pragma once

/// \file
/// What joints did in the last steps, by which it is guessed for the next.

#include <carom/core/export.h>
#include <carom/core/ids.h>

#include <array>
#include <vector>

namespace carom {

/// Numbers of a step and how they changed over the steps before it.
struct CAROM_API StepCourse {
  static constexpr int most = 3;  ///< changes that are remembered

  std::vector<double> last;                      ///< numbers of the last step
  std::array<std::vector<float>, most> changes;  ///< to them, to those before, and so on

  /// Makes room for the numbers of another step. \param size how many there are
  void go_on(std::size_t size);
  /// Takes the numbers of the last step over `range`.
  void record(Range range, const double* numbers);
  /// Guesses those of the next step over `range`. \param known steps that are remembered, 1 or more
  void guess(Range range, int known, double* out) const;
};

/// Impulses of joints, what they did to velocities, and displacements back onto the joints, of steps of one
/// length. Part of the companion, so that a run that continues from a checkpoint guesses as the whole run
/// does.
struct CAROM_API JointHistory {
  double step = 0.0;         ///< length of the steps [s]
  std::vector<int> known;    ///< by component, how many of its steps are remembered; empty: none
  StepCourse impulses;       ///< of reactions, by row of all joints [N s, N m s]
  StepCourse velocities;     ///< their changes by these, over all velocities [m/s, rad/s]
  StepCourse displacements;  ///< back onto joints, over all velocities [m, rad]

  /// A step was made, which will be recorded component by component. \param next_step its length [s]
  void go_on(double next_step, std::size_t components, std::size_t rows, std::size_t size);
  /// Steps of a component from which the next may be guessed; 0: none. \param next_step its length [s]
  [[nodiscard]] int usable(Index component, double next_step) const {
    return component < known.size() && step == next_step ? known[component] : 0;
  }
  /// Forgets all steps.
  void clear() { known.clear(); }
};

}  // namespace carom
