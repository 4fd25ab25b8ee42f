#include <carom/core/errors.h>
#include <carom/core/part_check.h>
#include <carom/core/text_table.h>
#include <carom/core/trace_comparison.h>
#include <carom/testing/refinement.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

namespace carom::energy_test {

namespace {

/// Differences below this part of the scale are rounding and say nothing of an order.
constexpr double rounding = 1e3 * std::numeric_limits<double>::epsilon();

void check_steps(const std::vector<RefinedTrace>& traces) {
  if (traces.size() < 2) {
    throw ModelError("order: number of steps is " + std::to_string(traces.size()) + "; allowed: at least 2");
  }
  double before = std::numeric_limits<double>::infinity();
  for (const RefinedTrace& refined : traces) {
    if (!(refined.step > 0.0 && refined.step < before)) {
      throw ModelError("order: step is " + to_text(refined.step) + " s; allowed: > 0 and less than " +
                       to_text(before) + " s");
    }
    before = refined.step;
  }
}

}  // namespace

std::vector<RefinedTrace> refine(const std::vector<double>& steps,
                                 const std::function<EnergyTrace(double step)>& run) {
  std::vector<RefinedTrace> traces;
  traces.reserve(steps.size());
  if (!run) throw ModelError("refinement: run is empty; allowed: a function that runs with a step");
  for (const double step : steps) traces.push_back({step, run(step)});
  return traces;
}

double fitted_order(std::span<const double> sizes, std::span<const double> differences) {
  assert(sizes.size() == differences.size() && sizes.size() >= 2);
  const auto count = static_cast<double>(sizes.size());
  double mean_x = 0.0, mean_y = 0.0;
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    mean_x += std::log(sizes[i]) / count;
    mean_y += std::log(differences[i]) / count;
  }
  double xy = 0.0, xx = 0.0;
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    const double x = std::log(sizes[i]) - mean_x;
    xy += x * (std::log(differences[i]) - mean_y);
    xx += x * x;
  }
  return xy / xx;
}

double largest_difference(const EnergyTrace& trace, const EnergyTrace& reference,
                          const std::vector<std::string>& terms) {
  const TraceComparison comparison = compare(trace, reference, {.relative = 1.0});
  double largest = 0.0;
  for (const std::string& name : terms) {
    const auto found = std::find_if(comparison.terms.begin(), comparison.terms.end(),
                                    [&](const TermComparison& term) { return term.term.name == name; });
    if (found == comparison.terms.end()) {
      throw ModelError("order: term is '" + name + "'; allowed: a term of traces, not time nor a scale");
    }
    largest = std::max(largest, found->worst.ratio());
  }
  return largest;
}

std::vector<std::string> compared_terms() {
  std::vector<std::string> terms;
  for (std::size_t i = 0; i < stored_energy_count; ++i) {
    terms.emplace_back(to_string(static_cast<StoredEnergy>(i)));
  }
  return terms;
}

Verdict check_order_at_least(const std::vector<RefinedTrace>& traces, double order,
                             const EnergyTrace& reference, const std::vector<std::string>& terms) {
  check_steps(traces);
  if (!std::isfinite(order)) throw ModelError("order: order is " + to_text(order) + "; allowed: finite");
  std::vector<double> steps, differences;
  TextTable table({"step [s]", "difference", "order from the step before"});
  for (const RefinedTrace& refined : traces) {
    const double difference = largest_difference(refined.trace, reference, terms);
    std::string local = "-";
    if (difference <= rounding) {
      local = "rounding, left out";
    } else {
      if (!steps.empty()) {
        local = cell(std::log(difference / differences.back()) / std::log(refined.step / steps.back()), 4);
      }
      steps.push_back(refined.step);
      differences.push_back(difference);
    }
    table.add({cell(refined.step), cell(difference, 6), local});
  }
  const std::string shown = "largest difference from the reference, in parts of the scale:\n" + table.text();
  if (steps.size() < 2) return {false, "no order can be seen: the differences are rounding\n" + shown};
  const double found = fitted_order(steps, differences);
  if (found >= order) return {true, "the order is " + cell(found, 5) + "\n"};
  return {false, "the order is " + cell(found, 5) + ", wanted is at least " + cell(order, 5) + "\n" + shown};
}

}  // namespace carom::energy_test
