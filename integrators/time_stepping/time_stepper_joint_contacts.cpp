// Problem: contact of bodies that joints make answer together, and friction in their joints.
//
// Contact acts along its rows H at the start of the step, and so does the answer of the joints to it, along
// their rows G0 there: both are one impact,
//
//   K = M^-1 - M^-1 G0^T S^-1 G0 M^-1,   S = G0 M^-1 G0^T,   W = H K H^T,
//
// the same in all sweeps. The law sees velocities that the joints allow there,
//
//   gamma^+ = H (v - M^-1 G0^T S^-1 (G0 v + rate)),   v = v_{j+1}, rate at the end,
//
// which differ from H v_{j+1} by how far the joints turn within the step. With that, of contacts at one pin
// (the ends of two bars that it joins) one follows from the other; with H v_{j+1} they would contradict each
// other by that little, and large impulses would change from sweep to sweep. Impulses and answers do the work
// P . (gamma^- + gamma^+)/2, and on drivers the multipliers times the mean of their rates, nothing else.

#include <carom/integrators/time_stepping/time_stepper.h>

#include <algorithm>

namespace carom {

/// Whether anything but friction in joints takes part.
bool TimeStepper::strikes() const {
  return std::any_of(contacts_.begin(), contacts_.end(),
                     [](const Constraint& contact) { return !contact.has_dry_friction(); });
}

void TimeStepper::solve_joint_contacts(Index component, const State& state, double step) {
  IslandProblem& cluster = clusters_.front();
  JointWork& work = joints_[component];
  if (work.struck) {
    // The guess of Newton's method couples bodies by more than their joints.
    if (iteration_ == Iteration::linearly_implicit) {
      JointResponse response(work.start);
      cluster.respond(response);
    }
    for (std::size_t c = 0; c < contacts_.size(); ++c) {
      if (contacts_[c].has_dry_friction()) cluster.update_bound(c);
    }
  } else {
    update_friction_rows(component);
    JointResponse response(work.mean);
    cluster.respond(response);
  }
  const Range v = assembly_->components()[component].v;
  for (Index i = v.begin; i < v.end; ++i) scratch_[i] = free_[i] + reaction_[i];
  if (work.struck) allow_at_start(work, scratch_.data());
  cluster.set_free_velocity(scratch_.data());
  const FrictionBoundProblem pressed{.cluster = cluster,
                                     .contacts = contacts_,
                                     .pressure = work.pressure,
                                     .at = {midpoint_.view(), middle_evaluation_.rotation.data()},
                                     .duration = step,
                                     .multipliers = [this, component] {
                                       add_contacts_to_joints(component);
                                       return joints_[component].total.data();
                                     }};
  if (!work.friction_bound.solve(pressed, chains_.front())) fail_contact(component, cluster, state, step);
  std::fill(dv_contact_.begin() + v.begin, dv_contact_.begin() + v.end, 0.0);
  cluster.map().add_velocities(dv_contact_.data());
}

/// Makes velocities obey the joints with the rows at the start and the rates at the end.
void TimeStepper::allow_at_start(JointWork& work, double* velocity) {
  work.start.residuals(JointLevel::change, velocity, work.left.data());
  for (std::size_t row = 0; row < work.left.size(); ++row) work.left[row] += work.end.rate(row);
  work.start.solve(work.left.data());
  work.start.add_response(work.left.data(), velocity);
}

/// Friction in joints alone acts halfway, against the rates that coordinates have at the end.
void TimeStepper::update_friction_rows(Index component) {
  const Range v = assembly_->components()[component].v;
  for (Index i = v.begin; i < v.end; ++i) scratch_[i] = free_[i] + reaction_[i] + dv_contact_[i];
  for (std::size_t c = 0; c < contacts_.size(); ++c) {
    Constraint& contact = contacts_[c];
    const JointView halfway{midpoint_.view(), middle_evaluation_.rotation.data()};
    detector_.update_friction_rows({trial_.view(), evaluation_.rotation.data()}, contact);
    const double at_end = contact.times(0, scratch_.data());
    detector_.update_friction_rows(halfway, contact);
    contact.surface_velocity_after[0] = contact.times(0, scratch_.data()) - at_end;
    clusters_.front().update_bound(c);
  }
}

/// Impulses of the joints, with those by which they answer to contact.
void TimeStepper::add_contacts_to_joints(Index component) {
  JointWork& work = joints_[component];
  JointConstraints& answering = work.struck ? work.start : work.mean;
  const Range v = assembly_->components()[component].v;
  work.total = work.impulse;
  std::fill(scratch_.begin() + v.begin, scratch_.begin() + v.end, 0.0);
  clusters_.front().map().add_loads(1.0, scratch_.data());
  answering.apply_inverse_mass(scratch_.data());
  answering.project(JointLevel::change, scratch_.data(), work.left.data());
  for (std::size_t row = 0; row < work.total.size(); ++row) work.total[row] += work.left[row];
}

}  // namespace carom
