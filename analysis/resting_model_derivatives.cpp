// Problem: how the equations of rest change with positions and velocities, and the masses they are set
// against.

#include <carom/analysis/resting_model.h>
#include <carom/core/difference_derivatives.h>

#include <algorithm>
#include <array>
#include <limits>
#include <optional>
#include <utility>

namespace carom {

namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// df/dh at 0 of a vector: central differences with halved steps, extrapolated (Ridders' table). The entry
/// that differs least from its neighbours is taken: near 1e-13 of the size of f wherever f is smooth over
/// some step of the table.
template <class F>
void extrapolated_derivative(F&& f, VectorXd& out) {
  constexpr int levels = 9;
  constexpr double widest = 0.05;  // rad, or m at a length scale of 1 m
  std::array<VectorXd, levels> above, row;
  double best = std::numeric_limits<double>::infinity();
  double step = widest;
  for (int i = 0; i < levels; ++i, step *= 0.5) {
    VectorXd ahead, behind;
    f(step, ahead);
    f(-step, behind);
    row[0] = (ahead - behind) / (2.0 * step);
    double weight = 1.0;
    for (int k = 1; k <= i; ++k) {
      weight *= 4.0;
      const auto j = static_cast<std::size_t>(k);
      row[j] = row[j - 1] + (row[j - 1] - above[j - 1]) / (weight - 1.0);
      const double error = std::max((row[j] - row[j - 1]).lpNorm<Eigen::Infinity>(),
                                    (row[j] - above[j - 1]).lpNorm<Eigen::Infinity>());
      if (error < best) {
        best = error;
        out = row[j];
      }
    }
    std::swap(above, row);
  }
}

}  // namespace

void RestingModel::differentiate(MatrixXd& by_position, MatrixXd& by_velocity) const {
  const Eigen::Index size = lengths_.size();
  by_position.setZero(size, size);
  by_velocity.setZero(size, size);
  add_load_derivatives(by_position, by_velocity);
  add_constraint_derivatives(by_position);
  const VectorXd inverse = lengths_.cwiseInverse();
  by_position = inverse.asDiagonal() * by_position * inverse.asDiagonal();
  by_velocity = inverse.asDiagonal() * by_velocity * inverse.asDiagonal();
}

void RestingModel::add_load_derivatives(MatrixXd& by_position, MatrixXd& by_velocity) const {
  std::vector<LoadDerivative> entries;
  for (Index component = 0; component < assembly_->components().size(); ++component) {
    const EvaluationContext here{*assembly_, state_.view(), evaluation_, component};
    std::optional<DifferenceDerivatives> differences;
    for (Index index = 0; index < assembly_->force_kinds().size(); ++index) {
      const ForceKind& kind = *assembly_->force_kinds()[index];
      const Range elements = assembly_->elements(component, index);
      for (Index element = elements.begin; element < elements.end; ++element) {
        if (kind.has_derivatives()) {
          kind.derivatives(here, element, entries);
        } else {
          if (!differences) differences.emplace(here);
          differences->append(kind, element, entries);
        }
      }
    }
  }
  for (const LoadDerivative& entry : entries) {
    by_position(eigen_index(entry.row), eigen_index(entry.column)) += entry.by_position;
    by_velocity(eigen_index(entry.row), eigen_index(entry.column)) += entry.by_velocity;
  }
}

/// G^T l: the rows of one body at a time, moved along one of its coordinates.
void RestingModel::add_constraint_derivatives(MatrixXd& by_position) const {
  State moved = state_;
  Evaluation evaluation = evaluation_;
  const JointView view{moved.view(), evaluation.rotation.data()};
  const VectorXd multipliers = l_.cwiseQuotient(constraints_.norms());
  VectorXd column;
  const Layout& layout = *assembly_->layout();
  for (Index body = 0; body < layout.bodies().size(); ++body) {
    if (!constraints_.acts_on(body)) continue;
    const BodySlot slot = layout.bodies()[body];
    const BodyKind& kind = *assembly_->body_kinds()[slot.kind];
    const Range own{slot.slot, slot.slot + 1};
    std::vector<double> delta(slot.v_size, 0.0);
    const auto stand = [&] {
      kind.advance(own, state_.q.data() + slot.q, delta.data(), moved.q.data() + slot.q);
      if (slot.rotation != none) {
        kind.rotations(own, moved.q.data() + slot.q, evaluation.rotation.data() + slot.rotation);
      }
    };
    for (Index i = 0; i < slot.v_size; ++i) {
      extrapolated_derivative(
          [&](double step, VectorXd& forces) {
            // Turned by an angle, moved by a part of the body's own length.
            delta[i] = step;
            stand();
            forces.setZero(lengths_.size());
            constraints_.add_forces(body, view, evaluation, multipliers, forces.data());
          },
          column);
      delta[i] = 0.0;
      by_position.col(eigen_index(slot.v + i)) += column;
    }
    stand();
  }
}

MatrixXd RestingModel::mass() const {
  const Eigen::Index size = lengths_.size();
  MatrixXd mass = MatrixXd::Zero(size, size);
  for (const BodySlot slot : assembly_->layout()->bodies()) {
    const BodyKind& kind = *assembly_->body_kinds()[slot.kind];
    std::vector<double> unit(slot.v_size, 0.0), image(slot.v_size);
    for (Index column = 0; column < slot.v_size; ++column) {
      unit[column] = 1.0;
      kind.apply_mass({slot.slot, slot.slot + 1}, unit.data(), image.data());
      unit[column] = 0.0;
      for (Index row = 0; row < slot.v_size; ++row) {
        const Eigen::Index r = eigen_index(slot.v + row), c = eigen_index(slot.v + column);
        mass(r, c) = image[row] / (lengths_[r] * lengths_[c]);
      }
    }
  }
  return mass;
}

}  // namespace carom
