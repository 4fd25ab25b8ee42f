#pragma once

/// \file
/// A flow of our own for tiny components: an embedded Runge-Kutta pair without any overhead.

#include <carom/core/export.h>
#include <carom/integrators/flow/plain_flow.h>

#include <vector>

namespace carom {

/// The pair of orders 5 and 4 of Dormand and Prince (J. Comput. Appl. Math. 6, 1980, 19-26). Between the ends
/// of a step it is as accurate as at the ends: looking there is a step of its own.
class CAROM_API OneStepFlow final : public PlainFlow {
public:
  /// ModelError: as make_flow().
  OneStepFlow(FlowProblem& problem, double relative_tolerance);

  void advance(double longest) override;

private:
  void reach(double time, std::span<double> y) override;
  void carry_rates() override;
  void make_step(double time, double length, const std::vector<double>& from, double* slopes,
                 std::span<double> to);
  [[nodiscard]] double error(double length) const;
  [[nodiscard]] double first_guess() const;

  std::vector<double> trial_;    // y at the end of a step that may fail
  std::vector<double> landing_;  // stages of a step to a time within the last
};

}  // namespace carom
