// Problem: rows of the joints and closed contacts of a whole model.

#include <carom/analysis/resting_constraints.h>

#include <algorithm>

namespace carom {

namespace {

using Eigen::VectorXd;

}  // namespace

RestingConstraints::RestingConstraints(const Assembly& assembly, const State& state,
                                       const Evaluation& evaluation, double contact_tolerance)
    : assembly_(&assembly), detector_(assembly) {
  detector_.place(state.time, places_);
  list_joints();
  find_supports(state.view(), evaluation, contact_tolerance);
  list_bodies();
  const Index row = supports_.empty() ? static_cast<Index>(joint_rows_.size())
                                      : supports_.back().row + static_cast<Index>(supports_.back().rows);
  rows_.resize(eigen_index(row), eigen_index(static_cast<Index>(state.v.size())));
  gaps_.resize(eigen_index(row));
  norms_.resize(eigen_index(row));
}

void RestingConstraints::list_joints() {
  for (Index component = 0; component < assembly_->components().size(); ++component) {
    for (Index kind = 0; kind < assembly_->joint_kinds().size(); ++kind) {
      const JointKind& joints = *assembly_->joint_kinds()[kind];
      const Range range = assembly_->joints(component, kind);
      for (Index slot = range.begin; slot < range.end && joints.rows() > 0; ++slot) {
        const auto row = static_cast<Index>(joint_rows_.size());
        joint_rows_.resize(row + joints.rows());
        joints.pattern(slot, joint_rows_.data() + row);
        joints_.push_back({kind, slot, row, assembly_->joint_id(kind, slot)});
      }
    }
  }
}

void RestingConstraints::find_supports(const StateView& state, const Evaluation& evaluation,
                                       double tolerance) {
  auto row = static_cast<Index>(joint_rows_.size());
  for (Index component = 0; component < assembly_->components().size(); ++component) {
    for (const ContactPair& pair : detector_.pairs(component)) {
      Support support;
      support.pair = pair;
      detector_.contact(pair, state, evaluation, places_, support.at);
      if (!(support.at.gap <= tolerance)) continue;
      const bool sticks = support.at.rows > 1 && support.at.law.sticking_friction() > 0.0;
      support.rows = sticks ? support.at.rows : 1;
      support.row = row;
      row += static_cast<Index>(support.rows);
      supports_.push_back(support);
    }
  }
}

void RestingConstraints::list_bodies() {
  const Layout& layout = *assembly_->layout();
  joints_of_body_.resize(layout.bodies().size());
  supports_of_body_.resize(joints_of_body_.size());
  std::vector<Index> body_at(layout.v_size());
  for (Index body = 0; body < layout.bodies().size(); ++body) {
    const BodySlot slot = layout.bodies()[body];
    std::fill_n(body_at.begin() + slot.v, slot.v_size, body);
  }
  const auto touches = [&](std::vector<std::vector<std::size_t>>& lists, Index v, std::size_t part) {
    std::vector<std::size_t>& list = lists[body_at[v]];
    if (list.empty() || list.back() != part) list.push_back(part);
  };
  for (std::size_t joint = 0; joint < joints_.size(); ++joint) {
    const Index rows = assembly_->joint_kinds()[joints_[joint].kind]->rows();
    for (Index i = joints_[joint].row; i < joints_[joint].row + rows; ++i) {
      for (int b = 0; b < joint_rows_[i].bodies; ++b) {
        touches(joints_of_body_, joint_rows_[i].blocks[static_cast<std::size_t>(b)].v, joint);
      }
    }
  }
  for (std::size_t i = 0; i < supports_.size(); ++i) {
    for (int b = 0; b < supports_[i].at.bodies; ++b) {
      touches(supports_of_body_, supports_[i].at.blocks[static_cast<std::size_t>(b)].v, i);
    }
  }
}

std::string RestingConstraints::row_name(Eigen::Index row) const {
  std::string name;
  for (const Joint& joint : joints_) {
    if (eigen_index(joint.row) <= row) name = assembly_->system().name(joint.id);
  }
  for (const Support& support : supports_) {
    if (eigen_index(support.row) <= row) name = this->name(support);
  }
  return name;
}

void RestingConstraints::update(const StateView& state, const Evaluation& evaluation,
                                const VectorXd& lengths) {
  rows_.setZero();
  VectorXd row(lengths.size());
  const auto take = [&](Eigen::Index place, double gap) {
    rows_.row(place) = row.cwiseQuotient(lengths).transpose();
    // A row that moves nothing is left as it is: one that follows from others.
    const double norm = rows_.row(place).norm();
    norms_[place] = norm > 0.0 ? norm : 1.0;
    rows_.row(place) /= norms_[place];
    gaps_[place] = gap / norms_[place];
  };
  for (const Joint& joint : joints_) {
    const JointKind& kind = *assembly_->joint_kinds()[joint.kind];
    kind.evaluate({state, evaluation.rotation.data()}, joint.slot, joint_rows_.data() + joint.row);
    for (Index i = 0; i < kind.rows(); ++i) {
      row.setZero();
      joint_rows_[joint.row + i].add_transposed(1.0, row.data());
      take(eigen_index(joint.row + i), joint_rows_[joint.row + i].gap);
    }
  }
  for (Support& support : supports_) {
    detector_.contact(support.pair, state, evaluation, places_, support.at);
    for (int i = 0; i < support.rows; ++i) {
      row.setZero();
      support.at.add_transposed(i, 1.0, row.data());
      take(eigen_index(support.row) + i,
           i == 0 ? support.at.gap : support.slid[static_cast<std::size_t>(i - 1)]);
    }
  }
}

std::vector<std::array<double, 2>> RestingConstraints::slid() const {
  std::vector<std::array<double, 2>> slid;
  for (const Support& support : supports_) slid.push_back(support.slid);
  return slid;
}

void RestingConstraints::set_slid(const std::vector<std::array<double, 2>>& slid) {
  for (std::size_t i = 0; i < supports_.size(); ++i) supports_[i].slid = slid[i];
}

bool RestingConstraints::sticks() const {
  return std::any_of(supports_.begin(), supports_.end(),
                     [](const Support& support) { return support.rows > 1; });
}

void RestingConstraints::slide(const StateView& state, const Evaluation& evaluation, double part,
                               const VectorXd& change) {
  SingleConstraint contact;
  for (Support& support : supports_) {
    if (support.rows == 1) continue;
    detector_.contact(support.pair, state, evaluation, places_, contact);
    for (int row = 1; row < support.rows; ++row) {
      support.slid[static_cast<std::size_t>(row - 1)] += part * contact.times(row, change.data());
    }
  }
}

void RestingConstraints::add_forces(Index body, const JointView& view, const Evaluation& evaluation,
                                    const VectorXd& multipliers, double* forces) const {
  std::array<JointRow, std::size_t{JointKind::most_rows}> rows;
  for (const std::size_t j : joints_of_body_[body]) {
    const Joint& joint = joints_[j];
    const JointKind& kind = *assembly_->joint_kinds()[joint.kind];
    std::copy_n(joint_rows_.begin() + joint.row, kind.rows(), rows.begin());
    kind.evaluate(view, joint.slot, rows.data());
    for (Index row = 0; row < kind.rows(); ++row) {
      rows[row].add_transposed(multipliers[eigen_index(joint.row + row)], forces);
    }
  }
  SingleConstraint contact;
  for (const std::size_t j : supports_of_body_[body]) {
    const Support& support = supports_[j];
    detector_.contact(support.pair, view.state, evaluation, places_, contact);
    for (int row = 0; row < support.rows; ++row) {
      contact.add_transposed(row, multipliers[eigen_index(support.row) + row], forces);
    }
  }
}

std::optional<RestingConstraints::Entered> RestingConstraints::find_entered(const StateView& state,
                                                                            const Evaluation& evaluation,
                                                                            double tolerance) const {
  SingleConstraint contact;
  for (Index component = 0; component < assembly_->components().size(); ++component) {
    for (const ContactPair& pair : detector_.pairs(component)) {
      if (std::any_of(supports_.begin(), supports_.end(),
                      [&](const Support& support) { return support.pair == pair; })) {
        continue;
      }
      detector_.contact(pair, state, evaluation, places_, contact);
      if (!(contact.gap >= -tolerance)) return Entered{detector_.name(contact.key), contact.gap};
    }
  }
  return std::nullopt;
}

}  // namespace carom
