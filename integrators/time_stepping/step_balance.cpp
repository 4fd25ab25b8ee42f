// Problem: tell the ledger and the report what a step did, but for contacts (contact_balance.cpp).

#include <carom/integrators/time_stepping/step_balance.h>
#include <carom/integrators/time_stepping/step_commit.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace carom {

void StepBalance::begin(const StepInput& in) {
  result_.flows = {};
  result_.stored = {};
  jumps_ = {};
  result_.contact_modes.clear();
  result_.joint_friction_modes.clear();
  result_.tally = {};
  result_.contacts.start(in.step);
  result_.cut_sequences = result_.scaled_impacts = result_.plastic_jams = 0;
  StepReport& report = result_.report;
  static_cast<StepNumbers&>(report) = {};
  result_.recorded = 0;
  report.joint_impulses.clear();
  report.time = in.end_time;
  report.step = in.step;
  coupling_work_ = {};
  energy_position_projection_ = energy_velocity_projection_ = 0.0;
}

bool StepBalance::book_couplings(const StepInput& in, Index component, const StepTrial& trial) {
  const Component& all = assembly_->components()[component];
  StoredEnergies& stored = result_.stored;
  const BlockWorks works = trial.account.add_to(stored);
  double inside = 0.0;
  if (!all.z.empty()) {
    inside = trial.with_step(in, component,
                             [&](const StepContext& at) { return internal_loss(*assembly_, component, at); });
  }
  // Potentials enter the ledger unseen by any sweep.
  if (!std::isfinite(works.dissipative + works.external + inside + stored.total())) return false;
  coupling_work_.add(works.total - works.dissipative - works.external + inside);
  result_.flows[EnergyFlow::dashpot] += inside - works.dissipative;
  result_.flows[EnergyFlow::external] += works.external;
  return true;
}

bool StepBalance::book_loads(const BlockWorks& works, const StoredEnergies& potentials) {
  StoredEnergies& stored = result_.stored;
  stored[StoredEnergy::kinetic] += works.kinetic;
  for (std::size_t i = 0; i < stored_energy_count; ++i) stored.values[i] += potentials.values[i];
  if (!std::isfinite(stored.total())) return false;
  coupling_work_.add(works.total);
  return true;
}

void StepBalance::book_joints(const StepInput& in, Index component, JointStage& joints,
                              const IslandProblem* contact, StepTrial& trial) {
  const Assembly& assembly = *assembly_;
  const Range q = assembly.components()[component].q, v = assembly.components()[component].v;
  const JointAnswer& answer = joints.answer();
  const JointConstraints& end = joints.rows().at_end();
  const double* const total = joints.multipliers(contact);
  joints.finish(in, trial);
  // Reactions do no work on the constraints but that of drivers: the rest is an error of the step.
  coupling_work_.add(joints.iterate().work(trial));
  if (contact != nullptr) rates_.resize(end.size());
  if (joints.is_struck()) {
    // Along the rows at the start half of what rounding of the step before has left of the constraints.
    answer.errors(end, in.start.v.data(), rates_.data());
  } else if (contact != nullptr) {
    joints.rows().at_midpoint().residuals(JointLevel::change, trial.midpoint.v.data(), rates_.data());
  }
  for (std::size_t row = 0; row < end.size() && (contact != nullptr || end.depends_on_time()); ++row) {
    const double reaction = joints.iterate().impulse[row];
    double rate = 0.0;
    if (end.depends_on_time()) rate = 0.5 * (answer.rate_at_start(row) + end.rate(row));
    result_.flows[EnergyFlow::external] -= total[row] * rate;
    coupling_work_.add(reaction * rate);
    if (contact == nullptr) continue;
    coupling_work_.add((total[row] - reaction) *
                       (joints.is_struck() ? 0.5 * rates_[row] : rates_[row] + rate));
  }
  // Work of the conservative loads along the displacement, where that is not below the last digit of the
  // coordinates: at rest it would add up, although nothing moves.
  double taken = 0.0;
  for (Index i = v.begin; i < v.end; ++i) {
    double load = trial.loads_end.total[i];
    if (!trial.loads_end.dissipative.empty()) load -= trial.loads_end.dissipative[i];
    if (!trial.loads_end.external.empty()) load -= trial.loads_end.external[i];
    // Coordinates and velocities of the plane correspond one to one.
    const double at = trial.end.q[q.begin + (i - v.begin)];
    taken += load * (at - (at - joints.iterate().arrays->displacement[i]));
  }
  energy_position_projection_ += taken;

  const JointView halfway{trial.midpoint.view(), trial.at_midpoint.rotation.data()};
  Index row = 0;
  for (Index kind = 0; kind < assembly.joint_kinds().size(); ++kind) {
    const JointKind& of_kind = *assembly.joint_kinds()[kind];
    const Range range = assembly.joints(component, kind);
    for (Index joint = range.begin; joint < range.end; ++joint, row += of_kind.rows()) {
      if (of_kind.rows() == 0) continue;
      const JointReaction impulse = of_kind.reaction(halfway, joint, total + row);
      result_.report.joint_impulses.push_back({assembly.joint_id(kind, joint), impulse, in.end_time});
    }
  }
}

void StepBalance::add(const StepResult& impacts) {
  for (std::size_t i = 0; i < energy_flow_count; ++i) result_.flows.values[i] += impacts.flows.values[i];
  result_.tally.add(impacts.tally);
  result_.cut_sequences += impacts.cut_sequences;
  result_.scaled_impacts += impacts.scaled_impacts;
  result_.plastic_jams += impacts.plastic_jams;
  result_.report.energy_gain += impacts.report.energy_gain;
  result_.report.lasting_gain += impacts.report.lasting_gain;
  for (const ContactRecord& entry : impacts.records()) result_.next_record() = entry;
}

void StepBalance::book_turning(double work) {
  result_.flows[EnergyFlow::external] -= work;
  coupling_work_.add(work);
}

void StepBalance::book_projection(const Separation& result, const StoredEnergies& before,
                                  const StoredEnergies& after) {
  result_.report.projected = std::max(result_.report.projected, result.shift);
  energy_position_projection_ += before.potential() - after.potential();
  for (std::size_t i = 0; i < stored_energy_count; ++i) {
    result_.stored.values[i] += after.values[i] - before.values[i];
  }
}

void StepBalance::book_velocity_projection(double lost) {
  energy_velocity_projection_ += lost;
  result_.stored[StoredEnergy::kinetic] -= lost;
}

double StepBalance::unexplained_gain(const StepInput& in) const {
  // In steps too long for stiff springs loads may do some hundred times the work of their mean; an end with
  // more than this is none.
  constexpr double most = 1e4;
  constexpr double rounding = 1e-9;  // of the potential
  EnergyFlows others = result_.flows;
  const double gain = -std::exchange(others[EnergyFlow::coupling_discretisation], 0.0);
  const double kinetic = result_.stored[StoredEnergy::kinetic];
  if (!(gain > 0.5 * kinetic)) return 0.0;
  const double before = in.companion.ledger.potential(), after = result_.stored.potential();
  double explained = in.companion.ledger.kinetic() + std::abs(after - before);
  for (const double flow : others.values) explained += std::abs(flow);
  const bool absurd = kinetic > most * explained + rounding * (std::abs(before) + std::abs(after));
  return absurd ? gain : 0.0;
}

StepResult& StepBalance::finish(const StepInput& in) {
  EnergyFlows& flows = result_.flows;
  flows[EnergyFlow::projection] = energy_position_projection_ + energy_velocity_projection_;
  flows[EnergyFlow::coupling_discretisation] +=
      discretisation_loss(result_.stored.potential() + energy_position_projection_,
                          in.companion.ledger.potential(), coupling_work_.value());
  if (result_.recorded < result_.report.contacts.size()) result_.report.contacts.resize(result_.recorded);
  if (!result_.contacts.empty()) result_.contacts.contacts.finish();
  return result_;
}

}  // namespace carom
