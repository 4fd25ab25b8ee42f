#pragma once

/// \file
/// GoogleTest matchers for traces of runs and for force elements (CMake target carom::testing):
///
///     EXPECT_THAT(recorder.trace(), ledger_closes_within(1e-12));
///
/// On failure a matcher prints the terms concerned, the time, and the nearest event.
/// Invalid input, such as a negative tolerance, is refused with the ModelError of the check that it calls.

#include <carom/core/text_table.h>
#include <carom/testing/conservative_loads.h>
#include <carom/testing/refinement.h>
#include <carom/testing/stored_trace.h>
#include <carom/testing/trace_checks.h>

#include <gmock/gmock.h>

#include <iostream>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

namespace carom::energy_test {

/// A matcher made of a check; for internal use by the functions below.
template <class Check>
class VerdictMatcher {
public:
  VerdictMatcher(std::string demand, Check check) : demand_(std::move(demand)), check_(std::move(check)) {}

  /// Members that GoogleTest needs of a matcher.
  template <class T>
  bool MatchAndExplain(const T& value, ::testing::MatchResultListener* listener) const {
    const Verdict verdict = check_(value);
    // On lines of their own, so that tables line up.
    if (!verdict.text.empty()) *listener << "\n" << verdict.text;
    return verdict.holds;
  }
  void DescribeTo(std::ostream* out) const { *out << demand_; }
  void DescribeNegationTo(std::ostream* out) const { *out << "not: " << demand_; }

private:
  std::string demand_;
  Check check_;
};

/// A matcher of GoogleTest made of a check.
template <class Check>
[[nodiscard]] auto matcher(std::string demand, Check check) {
  return ::testing::MakePolymorphicMatcher(VerdictMatcher<Check>(std::move(demand), std::move(check)));
}

/// The ledger of a trace, or a given ledger, closes within `relative` times its largest term:
/// check_ledger_closes().
[[nodiscard]] inline auto ledger_closes_within(double relative) {
  return matcher("the ledger closes within " + cell(relative, 3) + " of its largest term",
                 [=](const auto& account) { return check_ledger_closes(account, relative); });
}

/// T + V - W_external - intervention rises by no more than `tolerance` [J]: check_energy_never_rises().
[[nodiscard]] inline auto energy_never_rises(double tolerance) {
  return matcher("the energy never rises by more than " + cell(tolerance, 3) + " J",
                 [=](const EnergyTrace& trace) { return check_energy_never_rises(trace, tolerance); });
}

/// The momentum along a direction is conserved: check_momentum_in().
[[nodiscard]] inline auto momentum_is_conserved_in(const Coordinates& direction, double relative) {
  return matcher("momentum is conserved within " + cell(relative, 3) + " of its scale",
                 [=](const EnergyTrace& trace) { return check_momentum_in(trace, direction, relative); });
}

/// The angular momentum about a point is conserved: check_angular_momentum_about().
[[nodiscard]] inline auto angular_momentum_is_conserved_about(const Coordinates& point, double relative) {
  return matcher(
      "angular momentum is conserved within " + cell(relative, 3) + " of its scale",
      [=](const EnergyTrace& trace) { return check_angular_momentum_about(trace, point, relative); });
}

/// No contact penetrates and no joint opens by more than `metres` [m]: check_constraints_within().
[[nodiscard]] inline auto constraints_hold_within(double metres) {
  return matcher("constraints hold within " + cell(metres, 3) + " m",
                 [=](const EnergyTrace& trace) { return check_constraints_within(trace, metres); });
}

/// The trace is the one stored at `path`: check_against_stored(). A trace that is not is written beside the
/// stored one. With CAROM_REWRITE_TRACES=1 in the environment the trace is stored instead, nothing is
/// compared, and the test says so.
[[nodiscard]] inline auto matches_stored_trace(const std::string& path, const TraceTolerances& tolerances) {
  return matcher("a trace as stored in '" + path + "'", [=](const EnergyTrace& trace) {
    if (rewrite_requested()) {
      const Verdict verdict = rewrite_stored(trace, path);
      if (verdict.holds) std::cout << verdict.text;  // an explanation would be shown on failure only
      return verdict;
    }
    const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
    const std::string name = test ? std::string(test->test_suite_name()) + "." + test->name() : "";
    return check_against_stored(trace, path, tolerances, name);
  });
}

/// Traces at decreasing steps (refine()) approach a reference, e.g. the trace of another mode or of a much
/// smaller step, with at least the given order: check_order_at_least().
[[nodiscard]] inline auto modes_agree_with_order_at_least(
    double order, const EnergyTrace& reference, const std::vector<std::string>& terms = compared_terms()) {
  return matcher("agreement with the reference of order at least " + cell(order, 4),
                 [=](const std::vector<RefinedTrace>& traces) {
                   return check_order_at_least(traces, order, reference, terms);
                 });
}

/// The conservative loads of a system are minus the gradient of its potential: check_conservative_loads().
[[nodiscard]] inline auto conservative_loads_follow_the_potential(double tolerance) {
  return matcher("conservative loads are minus the gradient of the potential within " + cell(tolerance, 3),
                 [=](const System& system) { return check_conservative_loads(system, tolerance); });
}

/// How GoogleTest shows these in messages (else it would print bytes).
inline void PrintTo(const std::vector<RefinedTrace>& traces, std::ostream* out) {
  *out << traces.size() << " traces";
}

}  // namespace carom::energy_test

namespace carom {

/// How GoogleTest shows a system in messages.
inline void PrintTo(const System& system, std::ostream* out) {
  *out << "system of " << system.bodies().size() << " bodies";
}

}  // namespace carom
