#pragma once

/// \file
/// Events of guards: which side of its switching point each guard is on, and which one passes it first within
/// a step.

#include <carom/core/export.h>
#include <carom/integrators/event_driven/group_guards.h>
#include <carom/integrators/event_driven/guard_samples.h>

#include <cstddef>
#include <limits>
#include <vector>

namespace carom {

/// Follows the guards of one component. A guard that is nearer to zero than `noise` is on the side that it
/// was on before: what stays there makes no events, and only what comes out on the other side has passed.
class CAROM_API GuardSearch {
public:
  /// A guard that passes zero.
  struct Passage {
    double time = std::numeric_limits<double>::infinity();  ///< about [s]; infinity: none
    std::size_t guard = 0;
    double sign = 1.0;  ///< of the guard before
  };

  /// Forgets all sides: a new motion.
  void forget(std::size_t count) { sides_.assign(count, 0.0); }
  /// Takes the sides of guards that are far enough from zero.
  void update(const std::vector<GuardMotion>& guards, double noise);
  /// A guard is on the other side from now on.
  void pass(const Passage& passage) { sides_[passage.guard] = -passage.sign; }
  /// True if the guard stands at zero at the start of a step and leaves it for the other side at once. \param
  /// rounding of guards
  [[nodiscard]] bool passes_at_once(const Passage& passage, const GuardMotion& start, double rounding) const;
  /// The first passage in a step. \param start, end samples at its ends \param until of no interest
  /// behind
  [[nodiscard]] Passage first(const GroupGuards& guards, const GuardSample& start, const GuardSample& end,
                              GuardSamples& samples, GuardSampler& sampler, double noise, double until) const;

private:
  std::vector<double> sides_;  // 1 or -1; 0: not known yet
};

}  // namespace carom
