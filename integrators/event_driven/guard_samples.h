#pragma once

/// \file
/// Samples of guards within a step of a component, kept, so that all quantities that are asked for at one
/// time share one evaluation of the motion.

#include <carom/core/export.h>
#include <carom/core/guard_motion.h>
#include <carom/core/numerics/step_polynomial.h>

#include <cstddef>
#include <vector>

namespace carom {

/// Guards at one time, those of gaps aside.
struct GuardSample {
  double time = 0.0;                       ///< [s]
  std::vector<StepPolynomial::End> slips;  ///< sliding velocities and their rates, by closed contact
  /// Margins of features with their borders (FeatureRegions::border()), by closed contact; largest where
  /// there is but one feature.
  std::vector<StepPolynomial::End> features;
  std::vector<double> margins;      ///< of forces, by island that touches
  std::vector<GuardMotion> guards;  ///< of elements
};

/// Maker of samples within a step.
class CAROM_API GuardSampler {
public:
  virtual ~GuardSampler() = default;
  /// Writes the guards at a time within the step, times included.
  virtual void sample(double time, GuardSample& out) = 0;
};

/// The latest samples within one step.
class CAROM_API GuardSamples {
public:
  /// Forgets all: another step.
  void forget() { count_ = next_ = 0; }
  /// The sample at a time, an old one if there is one. Valid until the next call.
  [[nodiscard]] const GuardSample& at(double time, GuardSampler& sampler);

private:
  static constexpr std::size_t most = 64;
  std::vector<GuardSample> samples_;
  std::size_t count_ = 0, next_ = 0;
};

}  // namespace carom
