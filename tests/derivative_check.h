#pragma once

// Derivatives of loads as an element gives them, beside those by differences.

#include <carom/core/difference_derivatives.h>

#include <carom/testing/loaded_model.h>

#include <gtest/gtest.h>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <vector>

namespace carom_test {

using carom::energy_test::LoadedModel;

enum class By { element, differences };

/// Derivatives of all loads by position (left half) and velocity (right half).
inline Eigen::MatrixXd load_derivatives(const LoadedModel& model, By way) {
  const auto size = static_cast<Eigen::Index>(model.state.v.size());
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(size, 2 * size);
  std::vector<carom::LoadDerivative> entries;
  for (carom::Index component = 0; component < model.assembly.components().size(); ++component) {
    const carom::EvaluationContext at{model.assembly, model.state.view(), model.evaluation, component};
    for (carom::Index kind = 0; kind < model.assembly.force_kinds().size(); ++kind) {
      const carom::ForceKind& force = *model.assembly.force_kinds()[kind];
      const carom::Range elements = model.assembly.elements(component, kind);
      for (carom::Index element = elements.begin; element < elements.end; ++element) {
        if (way == By::element) {
          EXPECT_TRUE(force.has_derivatives()) << force.label();
          force.derivatives(at, element, entries);
        } else {
          difference_derivatives(force, at, element, entries);
        }
      }
    }
  }
  for (const carom::LoadDerivative& entry : entries) {
    result(entry.row, entry.column) += entry.by_position;
    result(entry.row, size + entry.column) += entry.by_velocity;
  }
  return result;
}

/// Both ways agree within what differences can do: with a step of 6e-6 the rounding of loads leaves 4e-11 of
/// them, truncation 6e-12 of their third derivative, which is of the size of loads and derivatives together.
inline void expect_derivatives_meet_differences(const LoadedModel& model) {
  const Eigen::MatrixXd own = load_derivatives(model, By::element);
  const Eigen::MatrixXd differences = load_derivatives(model, By::differences);
  double size = own.cwiseAbs().maxCoeff();
  for (const auto* loads : {&model.conservative, &model.dissipative, &model.external}) {
    for (const double load : *loads) size = std::max(size, std::abs(load));
  }
  EXPECT_LE((own - differences).cwiseAbs().maxCoeff(), 5e-10 * size) << own << "\n\n" << differences;
}

}  // namespace carom_test
