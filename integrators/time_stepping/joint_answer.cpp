// Problem: joints answer contact by the same convention by which contact acts.

#include <carom/integrators/time_stepping/joint_answer.h>

#include <cmath>

namespace carom {

JointAnswer::JointAnswer(Index component, const JointConstraints& like)
    : component_(component),
      rows_(like),
      constant_(like.size()),
      rate_at_start_(like.size()),
      sizes_(like.size()) {}

void JointAnswer::place(const StepInput& in, StepTrial& trial) {
  if (halfway_) return;
  evaluate_positions(in.assembly, component_, in.start.view(), trial.at_start);
  rows_.update({in.start.view(), trial.at_start.rotation.data()});
}

bool JointAnswer::follow_path(const StepInput& in, const State& middle, StepJointRows& joints,
                              StepTrial& trial) {
  constexpr double rounding = 1e-14;  // of the velocities that a row is made of
  const double* const v = trial.end.v.data();
  const JointConstraints& end = joints.at_end();
  halfway_ = false;
  place(in, trial);
  for (std::size_t row = 0; row < end.size(); ++row) rate_at_start_[row] = rows_.rate(row);
  halfway_ = true;
  evaluate_positions(in.assembly, component_, middle.view(), trial.at_midpoint);
  rows_.update({middle.view(), trial.at_midpoint.rotation.data()});
  joints.place_end(in, trial);
  end.residuals_and_sizes(v, constant_.data(), sizes_.data());
  bool turns = false;
  for (std::size_t row = 0; row < end.size(); ++row) {
    constant_[row] -= rows_.row(row).times(v);
    turns = turns || std::abs(constant_[row] - end.rate(row)) > rounding * sizes_[row];
  }
  return turns;
}

void JointAnswer::allow(const JointConstraints& end, double* velocity, std::vector<double>& left) {
  rows_.residuals(JointLevel::change, velocity, left.data());
  for (std::size_t row = 0; row < left.size(); ++row) left[row] += halfway_ ? constant_[row] : end.rate(row);
  rows_.solve(left.data());
  rows_.add_response(left.data(), velocity);
}

void JointAnswer::errors(const JointConstraints& end, const double* velocity_before, double* out) const {
  rows_.residuals(JointLevel::change, velocity_before, out);
  for (std::size_t row = 0; row < end.size(); ++row) {
    out[row] += rate_at_start(row);
    if (halfway_) out[row] += end.rate(row) - constant_[row];
  }
}

}  // namespace carom
