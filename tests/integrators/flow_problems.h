#pragma once

// Problems for flows, from lambdas.

#include <carom/integrators/flow/flow.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <span>
#include <utility>
#include <vector>

namespace flow_problems {

using carom::Flow;
using Function = std::function<void(double, const double*, double*)>;
using Jacobian = std::function<void(double, const double*, std::vector<carom::RateDerivative>&)>;

// dy/dt = f(t, y) from a lambda.
class Problem : public carom::FlowProblem {
public:
  Problem(std::size_t size, double tolerance, Function rates)
      : tolerances_(size, tolerance), rates_(std::move(rates)) {}
  Problem(std::size_t size, double tolerance, Function rates, Jacobian jacobian)
      : tolerances_(size, tolerance), rates_(std::move(rates)), jacobian_(std::move(jacobian)) {}

  [[nodiscard]] std::size_t size() const override { return tolerances_.size(); }
  void rates(double time, const double* y, double* rates) override {
    ++evaluations;
    rates_(time, y, rates);
  }
  [[nodiscard]] std::span<const double> absolute_tolerances() const override { return tolerances_; }
  [[nodiscard]] bool has_jacobian() const override { return static_cast<bool>(jacobian_); }
  void jacobian(double time, const double* y, std::vector<carom::RateDerivative>& out) override {
    ++jacobians;
    jacobian_(time, y, out);
  }

  int evaluations = 0;
  int jacobians = 0;

private:
  std::vector<double> tolerances_;
  Function rates_;
  Jacobian jacobian_;
};

inline Problem oscillator(double tolerance) {
  return {2, tolerance, [](double, const double* y, double* rates) {
            rates[0] = y[1];
            rates[1] = -y[0];
          }};
}

// Where the oscillator is, a time t after y.
inline std::array<double, 2> turned(std::span<const double> y, double t) {
  return {std::cos(t) * y[0] + std::sin(t) * y[1], -std::sin(t) * y[0] + std::cos(t) * y[1]};
}

inline Problem pendulum(double tolerance) {
  return {2, tolerance, [](double, const double* y, double* rates) {
            rates[0] = y[1];
            rates[1] = -std::sin(y[0]);
          }};
}

inline double distance(std::span<const double> a, std::span<const double> b) {
  double largest = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) largest = std::max(largest, std::abs(a[i] - b[i]));
  return largest;
}

inline void go_to(Flow& flow, double time) {
  while (flow.end() < time) flow.advance(time - flow.end());
}

}  // namespace flow_problems
