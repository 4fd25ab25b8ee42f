#pragma once

/// \file
/// Impulses and displacements of joints in the last steps, by which it is guessed for the next.

#include <carom/core/export.h>
#include <carom/core/ids.h>
#include <carom/core/numerics/extrapolation.h>

#include <array>
#include <cstddef>
#include <vector>

namespace carom {

/// Numbers of the last steps.
class CAROM_API StepCourse {
public:
  /// \param depth steps that are remembered, 1 to most_extrapolated
  explicit StepCourse(std::size_t depth) : depth_(depth) {}

  /// Makes room for the numbers of another step; the oldest are forgotten. \param size how many there are
  void go_on(std::size_t size);
  /// Takes the numbers of the last step over `range`.
  void record(Range range, const double* numbers);
  /// Guesses those of the next step over `range`. \param steps that it follows, if as many are remembered
  void guess(Range range, std::size_t steps, double* out) const;

  /// How many steps the guess should follow (carom::best_steps()). \param steps that are known \param weight
  /// of each number
  [[nodiscard]] std::size_t best_steps(Range range, std::size_t steps, const double* weight) const;
  /// Steps that are remembered.
  [[nodiscard]] std::size_t depth() const { return depth_; }
  /// Numbers of a step. \param ago 0 of the last one, 1 of the one before, and so on
  [[nodiscard]] const std::vector<double>& numbers(std::size_t ago) const;
  /// Numbers of a step, to be written. \param ago 0 of the last one, 1 of the one before, and so on
  [[nodiscard]] std::vector<double>& numbers(std::size_t ago);

private:
  [[nodiscard]] LastNumbers last() const;

  std::size_t depth_;
  std::array<std::vector<double>, most_extrapolated> steps_;
  std::size_t newest_ = 0;  // those before it follow, in a ring
};

/// Impulses of joints, what they did to velocities, and displacements back onto the joints, of steps of one
/// length. Part of the companion, so that a run that continues from a checkpoint guesses as the whole run
/// does.
struct CAROM_API JointHistory {
  static constexpr int most = static_cast<int>(most_extrapolated);  ///< steps that are remembered
  /// Steps whose displacements are remembered. These have the rounding of positions, which more steps would
  /// magnify.
  static constexpr int most_displacements = 5;

  double step = 0.0;            ///< length of the steps [s]
  std::vector<int> known;       ///< by component, how many of its steps are remembered; empty: none
  StepCourse impulses{most};    ///< of reactions, by row of all joints [N s, N m s]
  StepCourse velocities{most};  ///< their changes by these, over all velocities [m/s, rad/s]
  StepCourse displacements{most_displacements};  ///< back onto joints, over all velocities [m, rad]

  /// A step was made, which will be recorded component by component. \param next_step its length [s]
  /// \param components of the model \param rows of all its joints \param size of its velocities
  void go_on(double next_step, std::size_t components, std::size_t rows, std::size_t size);
  /// Steps of a component from which the next may be guessed; 0: none. \param rows of the joints up to and
  /// with those of the component \param next_step its length [s]
  [[nodiscard]] int usable(Index component, Index rows, double next_step) const {
    const bool fits = component < known.size() && rows <= impulses.numbers(0).size();
    return fits && step == next_step ? known[component] : 0;
  }
  /// Forgets all steps.
  void clear() { known.clear(); }
};

}  // namespace carom
