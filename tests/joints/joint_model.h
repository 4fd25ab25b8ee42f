#pragma once

// A system with joints at one state: rows, their differences, the forces that hold it.

#include <carom/core/assembly.h>
#include <carom/core/dynamics/joint_constraints.h>
#include <carom/core/joint_kind.h>
#include <carom/testing/loaded_model.h>

#include "tests/random.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace carom_test {

using carom::energy_test::LoadedModel;

/// An assembly with a state that can be moved. In the plane, q and v have the same places.
class JointModel : public LoadedModel {
public:
  explicit JointModel(carom::System system) : LoadedModel(std::move(system)) {}

  [[nodiscard]] carom::JointView view() const { return {state.view(), evaluation.rotation.data()}; }
  [[nodiscard]] const carom::JointKind& kind(carom::JointId joint) const {
    return *assembly.joint_kinds()[place(joint).kind];
  }
  [[nodiscard]] carom::Index slot(carom::JointId joint) const { return place(joint).slot; }

  /// Rows of a joint, and its coordinate as a last one.
  [[nodiscard]] std::vector<carom::JointRow> rows(carom::JointId joint) const {
    const carom::JointKind& joints = kind(joint);
    std::vector<carom::JointRow> rows(joints.rows());
    joints.evaluate(view(), slot(joint), rows.data());
    if (joints.has_coordinate()) {
      rows.emplace_back();
      joints.coordinate(view(), slot(joint), rows.back());
    }
    return rows;
  }
  /// Moves to q + s d, time + s.
  void move(const std::vector<double>& q, double time, const std::vector<double>& d, double s) {
    for (std::size_t i = 0; i < q.size(); ++i) state.q[i] = q[i] + s * d[i];
    state.time = time + s;
    update();
  }

  /// Accelerations of free bodies under the loads.
  [[nodiscard]] std::vector<double> free_acceleration() const {
    std::vector<double> force(conservative.size()), a(force.size());
    for (std::size_t i = 0; i < force.size(); ++i) force[i] = conservative[i] + dissipative[i] + external[i];
    for (carom::Index component = 0; component < assembly.components().size(); ++component) {
      assembly.for_bodies(
          component, [&](const carom::BodyKind& bodies, carom::Range slots, carom::Index, carom::Index v,
                         carom::Index) { bodies.apply_inverse_mass(slots, force.data() + v, a.data() + v); });
    }
    return a;
  }
  /// Accelerations under the loads and the joints of all components; keeps the reactions.
  std::vector<double> acceleration() {
    std::vector<double> a = free_acceleration();
    reactions_.clear();
    for (carom::Index component = 0; component < assembly.components().size(); ++component) {
      carom::JointConstraints joints(assembly, component);
      joints.update_and_factor(view());
      std::vector<double> multipliers(joints.size());
      joints.project(carom::JointLevel::acceleration, a.data(), multipliers.data());
      for (std::size_t i = 0; i < joints.pattern().size(); ++i) {
        const carom::Index row = joints.pattern().first_row(i);
        const carom::JointId id = joints.joint(row);
        reactions_.emplace_back(id, kind(id).reaction(view(), slot(id), multipliers.data() + row));
      }
    }
    return a;
  }
  /// Of the last acceleration().
  [[nodiscard]] carom::JointReaction reaction(carom::JointId joint) const {
    for (const auto& [id, reaction] : reactions_) {
      if (id == joint) return reaction;
    }
    ADD_FAILURE() << "no such joint";
    return {};
  }

private:
  [[nodiscard]] carom::JointTable::Place place(carom::JointId joint) const {
    return assembly.layout()->joints()->place(joint.serial);
  }
  std::vector<std::pair<carom::JointId, carom::JointReaction>> reactions_;
};

/// Derivatives by differences of fourth order along motions at constant velocity v = d: those of gaps are
/// G d + rate, those of G d + rate are drift. With the step, truncation is 5e-17 of the fifth derivative and
/// rounding about 1e-12 of the number.
inline void expect_rows_meet_differences(JointModel& model, carom::JointId joint, Random& random) {
  constexpr double step = 2e-4;
  const std::vector<double> q = model.state.q;
  const double time = model.state.time;
  const auto size = static_cast<carom::Index>(q.size());
  const auto differences = [&](const std::vector<double>& d, auto&& number) {
    std::vector<std::vector<double>> at;
    for (const double s : {-2.0, -1.0, 1.0, 2.0}) {
      model.move(q, time, d, s * step);
      at.emplace_back();
      for (const carom::JointRow& row : model.rows(joint)) at.back().push_back(number(row));
    }
    model.move(q, time, d, 0.0);
    std::vector<double> result(at[0].size());
    for (std::size_t i = 0; i < result.size(); ++i) {
      result[i] = (8.0 * (at[2][i] - at[1][i]) - (at[3][i] - at[0][i])) / (12.0 * step);
    }
    return result;
  };
  const auto gap = [](const carom::JointRow& row) { return row.gap; };
  // Every velocity, then all at once. Time goes on.
  for (carom::Index i = 0; i <= size; ++i) {
    std::vector<double> d(size, 0.0);
    if (i < size) {
      d[i] = 1.0;
    } else {
      for (double& number : d) number = random.uniform(-1.5, 1.5);
    }
    const std::vector<carom::JointRow> rows = model.rows(joint);
    const std::vector<double> found = differences(d, gap);
    for (std::size_t r = 0; r < rows.size(); ++r) {
      EXPECT_NEAR(rows[r].times(d.data()) + rows[r].rate, found[r], 2e-10)
          << model.kind(joint).label() << ", row " << r << ", velocity " << i;
    }
    model.state.v = d;
    const std::vector<carom::JointRow> moving = model.rows(joint);
    const std::vector<double> drifts =
        differences(d, [&](const carom::JointRow& row) { return row.times(d.data()) + row.rate; });
    for (std::size_t r = 0; r < rows.size(); ++r) {
      EXPECT_NEAR(moving[r].drift, drifts[r], 2e-9)
          << model.kind(joint).label() << ", row " << r << ", velocity " << i;
    }
  }
}

/// The pattern names the same velocities as the rows.
inline void expect_pattern_fits(const JointModel& model, carom::JointId joint) {
  const carom::JointKind& kind = model.kind(joint);
  std::vector<carom::JointRow> pattern(kind.rows());
  kind.pattern(model.slot(joint), pattern.data());
  if (kind.has_coordinate()) {
    pattern.emplace_back();
    kind.coordinate_pattern(model.slot(joint), pattern.back());
  }
  const std::vector<carom::JointRow> rows = model.rows(joint);
  ASSERT_EQ(rows.size(), pattern.size());
  for (std::size_t r = 0; r < rows.size(); ++r) {
    ASSERT_EQ(rows[r].bodies, pattern[r].bodies);
    EXPECT_GE(rows[r].bodies, 1);
    for (int b = 0; b < rows[r].bodies; ++b) {
      const auto i = static_cast<std::size_t>(b);
      EXPECT_EQ(rows[r].blocks[i].v, pattern[r].blocks[i].v);
      EXPECT_EQ(rows[r].blocks[i].columns, pattern[r].blocks[i].columns);
    }
  }
}

}  // namespace carom_test
