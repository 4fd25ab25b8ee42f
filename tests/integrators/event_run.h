#pragma once

// Event-driven runs as the reference tests make them: tight tolerances, the energy ledger watched all along.

#include <carom/carom.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <string>
#include <vector>

namespace carom_test {

/// The tolerances of the reference tests.
inline carom::EventDriven tight(carom::FlowMethod method = carom::FlowMethod::explicit_runge_kutta) {
  return {.relative_tolerance = 1e-11, .absolute_tolerance = 1e-13, .method = method};
}

/// Watches the energy ledger from its making on: the terms of the event-driven mode are quadratures, so that
/// the residual may be 100 tolerances per 1,000 steps of the integrator, of the largest of |dV|, T and the
/// sum of what flowed, or of the absolute tolerance of works (mass times 1 m^2/s^2) where these are smaller;
/// besides there is the rounding of the terms. Must live as long as the simulation runs.
class LedgerWatch {
public:
  explicit LedgerWatch(carom::Simulation& simulation, double mass = 1.0)
      : tolerance_(std::get<carom::EventDriven>(simulation.mode()).relative_tolerance),
        floor_(std::get<carom::EventDriven>(simulation.mode()).absolute_tolerance * mass),
        potential_(simulation.energy().potential()) {
    simulation.observe([this](const carom::Simulation& now) { look(now); });
  }
  LedgerWatch(const LedgerWatch&) = delete;
  LedgerWatch& operator=(const LedgerWatch&) = delete;

  /// The largest residual against what is allowed.
  [[nodiscard]] double worst() const { return worst_; }
  /// The largest residual against the scale.
  [[nodiscard]] double largest() const { return largest_; }
  /// Whether none was too large.
  [[nodiscard]] testing::AssertionResult closes() const {
    if (seen_ > 0 && worst_ <= 1.0) return testing::AssertionSuccess();
    return testing::AssertionFailure()
           << "the residual is " << worst_ << " times what is allowed, at t = " << when_ << " s";
  }

private:
  void look(const carom::Simulation& now) {
    const carom::EnergyLedger& energy = now.energy();
    double flowed = 0.0;
    for (std::size_t i = 0; i < carom::energy_flow_count; ++i)
      flowed += std::abs(energy.flow(static_cast<carom::EnergyFlow>(i)));
    scale_ = std::max({scale_, energy.kinetic(), std::abs(energy.potential() - potential_), flowed});
    const double thousands = std::max(1.0, 1e-3 * static_cast<double>(now.statistics().flow_steps));
    const double residual = std::abs(energy.residual());
    ++seen_;
    if (residual == 0.0) return;
    largest_ = std::max(largest_, residual / scale_);
    constexpr double rounding = 1e3 * std::numeric_limits<double>::epsilon();
    const double found =
        residual / (100.0 * thousands * (tolerance_ * scale_ + floor_) + rounding * energy.scale());
    if (found <= worst_) return;
    worst_ = found;
    when_ = now.time();
  }

  double tolerance_, floor_, potential_;
  double scale_ = 0.0, worst_ = 0.0, largest_ = 0.0, when_ = 0.0;
  int seen_ = 0;
};

/// The events of one kind, in time.
inline std::vector<carom::EventRecord> events_of(const carom::Simulation& simulation, carom::EventKind kind) {
  std::vector<carom::EventRecord> found;
  for (const carom::EventRecord& event : simulation.events()) {
    if (event.kind == kind) found.push_back(event);
  }
  return found;
}

/// "stick", "slip" or "open", whatever the direction.
inline std::string kind_of(carom::ContactMode mode) {
  return std::string(to_string(mode)).substr(0, mode == carom::ContactMode::stick ? 5 : 4);
}

/// Notes the largest error for the report of the test.
inline void note(const std::string& name, double error) {
  testing::Test::RecordProperty(name, std::to_string(error));
  if (std::getenv("CAROM_NOTES") != nullptr) std::printf("    %s: %.2e\n", name.c_str(), error);
}

/// The largest error of many numbers.
class Worst {
public:
  void operator()(double found, double expected, double scale = 1.0) {
    const double error = std::abs(found - expected) / scale;
    if (!(error <= value_)) value_ = error;
  }
  [[nodiscard]] double value() const { return value_; }

private:
  double value_ = 0.0;
};

}  // namespace carom_test
