#pragma once

/// \file
/// Looks into a step of a component: whatever is watched there, seen at one time and kept, so that all
/// quantities that ask for a time share one evaluation of the motion.

#include <carom/core/export.h>
#include <carom/core/guard_motion.h>
#include <carom/core/numerics/step_polynomial.h>

#include <cstddef>
#include <vector>

namespace carom {

/// Watched quantities at one time.
struct StepLook {
  double time = 0.0;                       ///< [s]
  std::vector<StepPolynomial::End> slips;  ///< sliding velocities and their rates, by closed contact
  std::vector<double> margins;             ///< of forces, by body that touches
  std::vector<GuardMotion> guards;         ///< of elements
};

/// Who can look.
class CAROM_API StepLooker {
public:
  virtual ~StepLooker() = default;
  /// Writes what is seen at a time within the step, times included.
  virtual void look(double time, StepLook& out) = 0;
};

/// The latest looks into one step.
class CAROM_API StepLooks {
public:
  /// Forgets the looks: another step.
  void forget() { count_ = next_ = 0; }
  /// A look at a time, an old one if there is one. Valid until the next call.
  [[nodiscard]] const StepLook& at(double time, StepLooker& looker);

private:
  static constexpr std::size_t most = 64;
  std::vector<StepLook> looks_;
  std::size_t count_ = 0, next_ = 0;
};

}  // namespace carom
