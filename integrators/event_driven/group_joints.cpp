// Problem: the joints of components that share one time, in one list of rows.

#include <carom/integrators/event_driven/group_joints.h>

#include <algorithm>

namespace carom {

GroupJoints::GroupJoints(const Assembly& assembly, std::span<const Index> components) : response_(assembly) {
  joints_.reserve(components.size());
  for (const Index component : components) {
    if (!append_constraints(assembly, component, joints_)) continue;
    joints_.back().factors().reveal_rank(true);
    parts_.push_back({component, rows_, nullptr});
    rows_ += joints_.back().size();
  }
  joints_.shrink_to_fit();
  for (std::size_t i = 0; i < parts_.size(); ++i) parts_[i].joints = &joints_[i];
  list_ = addresses_of(joints_);
  response_.bind(list_);
}

bool GroupJoints::depends_on_time() const {
  return std::any_of(joints_.begin(), joints_.end(),
                     [](const JointConstraints& joints) { return joints.depends_on_time(); });
}

void GroupJoints::update_and_factor(const JointView& at) {
  for (JointConstraints& joints : joints_) joints.update_and_factor(at);
}

void GroupJoints::project(JointLevel level, double* x, double* multipliers) {
  for (const Part& part : parts_) {
    part.joints->project(level, x, multipliers == nullptr ? nullptr : multipliers + part.first_row);
  }
}

void GroupJoints::apply_inverse_mass(double* x) const {
  for (const JointConstraints& joints : joints_) joints.apply_inverse_mass(x);
}

const GroupJoints::Part& GroupJoints::part_of(std::size_t row) const {
  const auto behind = std::upper_bound(parts_.begin(), parts_.end(), row,
                                       [](std::size_t at, const Part& part) { return at < part.first_row; });
  return *(behind - 1);
}

double GroupJoints::rate(std::size_t row) const {
  const Part& part = part_of(row);
  return part.joints->rate(row - part.first_row);
}

JointId GroupJoints::joint(std::size_t row) const {
  const Part& part = part_of(row);
  return part.joints->joint(row - part.first_row);
}

BoundComponents::BoundComponents(const Assembly& assembly, std::span<const Index> of)
    : components(of.begin(), of.end()), rows(assembly, of) {
  for (const GroupJoints::Part& part : rows.parts()) bounds.add(assembly, part.component, *part.joints);
}

}  // namespace carom
