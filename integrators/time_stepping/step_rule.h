#pragma once

/// \file
/// The rule of a step: by which loads velocities change, and by which velocities positions.
///
///   trapezoidal       v1 = v0 + M^-1 h (F0 + F1)/2 + dv,   q1 = q0 advanced by h (v0 + v1)/2
///   energy_momentum   v1 = v0 + M^-1 h Fm + dv,  Fm the mean loads of the elements over the step; angles
///   turn
///                     by 2 atan(h w/2), w the mean spin: a lever r then moves by h w x (r0 + r1)/2 exactly,
///                     so that a force at the mean lever does the work of its own displacement
///
/// dv is the change of velocities by impulses (Johansson 1999, section 4; docs/method.md, section 6).

#include <carom/core/body_kind.h>
#include <carom/core/export.h>
#include <carom/integrators/run/time_stepping.h>
#include <carom/integrators/time_stepping/step_input.h>
#include <carom/integrators/time_stepping/step_trial.h>

namespace carom {

/// Difference between an iterate and the next, angles times the radius of gyration [m].
struct SweepChange {
  double change = 0.0;  ///< largest change of positions and of h times velocities; NaN if any is
  double size = 0.0;    ///< largest of the numbers themselves

  /// Takes one number: its change and its size. A NaN is kept.
  void take(double difference, double number) {
    difference = difference < 0.0 ? -difference : difference;
    number = number < 0.0 ? -number : number;
    // Written so that a NaN is stored, and kept because no number compares greater.
    if (difference > change || difference != difference) change = difference;
    if (number > size || number != number) size = number;
  }
  /// Takes those of others.
  void take(const SweepChange& other) { take(other.change, other.size); }
};

/// Bodies of one kind that follow one another, as they stand in every array.
struct BodyPlace {
  const BodyKind* kind = nullptr;
  Range slots;  ///< within the kind
  Index q = 0;  ///< first coordinate
  Index v = 0;  ///< first velocity
};

/// One of the two rules of ForceRule.
class CAROM_API StepRule {
public:
  explicit StepRule(ForceRule rule) : rule_(rule) {}

  /// True if elements give mean loads.
  [[nodiscard]] bool is_mean() const { return rule_ == ForceRule::energy_momentum; }
  /// v_{j+1} changes by this times M^-1 times the change of the loads that are iterated [s].
  [[nodiscard]] double impulse_weight(double step) const { return is_mean() ? step : 0.5 * step; }
  /// Loads that stand for those at the start in the sum (F0 + F1)/2: mean loads count twice. Others
  /// with the correction for jumps at impacts.
  [[nodiscard]] const double* start_of_sum(const StepInput& in, const StepTrial& trial) const {
    if (is_mean()) return trial.loads_guess.data();
    return trial.jumps.on ? trial.jumps.start.data() : in.companion.loads.total.data();
  }
  /// Velocities, then positions of some bodies by the loads of the guess.
  /// \param with_impulses whether impulses have changed velocities there (StepTrial::dv_impulses)
  void move(const StepInput& in, Range bodies, bool with_impulses, StepTrial& trial) const {
    move(in, bodies, start_of_sum(in, trial), trial.loads_guess.data(), with_impulses, trial);
  }
  /// Velocities, then positions of some bodies by the loads at the start, which do not change.
  /// \param with_impulses whether impulses have changed velocities there (StepTrial::dv_impulses)
  void move_constant(const StepInput& in, Range bodies, bool with_impulses, StepTrial& trial) const {
    const double* const loads = in.companion.loads.total.data();
    move(in, bodies, loads, loads, with_impulses, trial);
  }
  /// Velocities, then positions by the loads at the start, of bodies whose place and masses are known.
  /// \param with_impulses whether impulses have changed velocities there (StepTrial::dv_impulses)
  void move_constant(const StepInput& in, const BodyPlace& bodies, const BodyMasses& masses,
                     bool with_impulses, StepTrial& trial) const {
    const double* const loads = in.companion.loads.total.data();
    move(in, bodies, masses, {loads, loads}, with_impulses, trial);
  }
  /// Change that another move would make, by the loads that the guess led to: velocities by M^-1 times their
  /// change, coordinates by h/2 times that, which is less than h times it.
  [[nodiscard]] SweepChange next_change(const StepInput& in, Range bodies, const StepTrial& trial) const;
  /// Work of some loads, given at both ends of the step, along the mean velocities `v` [J].
  [[nodiscard]] double work(const StepInput& in, const double* start, const double* end, Range v,
                            const StepTrial& trial) const;
  /// Works of the loads over a block: the total is that of the impulse that acted; its parts by cause are
  /// those of the loads that it led to, and what the iteration left open counts as conservative.
  [[nodiscard]] BlockWorks works(const StepInput& in, const Block& block, const StepTrial& trial) const;
  /// Works of loads that do not change over some bodies, whose velocities are `v`.
  void works_constant(const StepInput& in, Range bodies, Range v, const StepTrial& trial,
                      BlockWorks& out) const;
  /// Work of loads that do not change over some bodies, whose velocities are `v` [J].
  [[nodiscard]] double work_constant(const StepInput& in, Range v, const StepTrial& trial) const;

private:
  // Loads at both ends of a step, over all velocities.
  struct EndLoads {
    const double* start;
    const double* end;
  };
  void move(const StepInput& in, const BodyPlace& bodies, const BodyMasses& masses, const EndLoads& loads,
            bool with_impulses, StepTrial& trial) const;
  void move(const StepInput& in, Range bodies, const double* load0, const double* load1, bool with_impulses,
            StepTrial& trial) const;

  ForceRule rule_;
};

}  // namespace carom
