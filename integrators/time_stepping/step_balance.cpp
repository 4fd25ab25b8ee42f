// Problem: tell the ledger, the report and the statistics what a step did, and make the step's end the state.

#include <carom/contact/contact_point.h>
#include <carom/contact/contact_velocity.h>
#include <carom/integrators/time_stepping/step_balance.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace carom {

namespace {

/// Velocities along the rows of a constraint at the end. \param after of all bodies
std::array<double, 3> velocities_after(const Constraint& at, const double* after) {
  if (at.rows == 2) {
    const std::array<double, 2> both = times_both_rows(at, after);
    return {both[0] - at.surface_velocity_after[0], both[1] - at.surface_velocity_after[1], 0.0};
  }
  std::array<double, 3> all{};
  for (int row = 0; row < at.rows; ++row) {
    all[static_cast<std::size_t>(row)] = at.velocity_after(row, after);
  }
  return all;
}

/// Constraint::speed() of the rows of a constraint.
std::array<double, 3> speeds_of_rows(const Constraint& at, const double* velocities) {
  if (at.rows == 2) {
    const std::array<double, 2> both = speeds_of_both_rows(at, velocities);
    return {both[0], both[1], 0.0};
  }
  std::array<double, 3> all{};
  for (int row = 0; row < at.rows; ++row) all[static_cast<std::size_t>(row)] = at.speed(row, velocities);
  return all;
}

/// Asks for the memory of a record that is soon to be written: of many contacts it is in no cache near by.
void fetch_ahead(const std::vector<ContactRecord>& records) {
  constexpr std::size_t ahead = 4, line = 64;
  if (records.capacity() - records.size() <= ahead) return;
  const auto* const memory = reinterpret_cast<const std::byte*>(records.data() + records.size() + ahead);
  for (std::size_t i = 0; i < sizeof(ContactRecord); i += line) __builtin_prefetch(memory + i, 1);
}

}  // namespace

void StepBalance::begin(const StepInput& in) {
  result_.flows = {};
  result_.stored = {};
  result_.joint_friction_modes.clear();
  result_.contacts.start(in.step);
  result_.cut_sequences = result_.scaled_impacts = result_.plastic_jams = 0;
  StepReport& report = result_.report;
  static_cast<StepNumbers&>(report) = {};
  report.contacts.clear();
  report.joint_impulses.clear();
  report.time = in.end_time;
  report.step = in.step;
  coupling_work_ = {};
  energy_position_projection_ = energy_velocity_projection_ = 0.0;
}

bool StepBalance::book_couplings(const StepInput& in, Index component, const StepTrial& trial) {
  const Component& all = assembly_->components()[component];
  StoredEnergies& stored = result_.stored;
  double total = 0.0, dissipative = 0.0, external = 0.0;
  for (const BlockWorks& works : trial.account.works) {
    stored[StoredEnergy::kinetic] += works.kinetic;
    total += works.total;
    dissipative += works.dissipative;
    external += works.external;
  }
  // Last: they are written just before, one by one, and are not at hand at once.
  for (std::size_t i = 0; i < stored_energy_count; ++i)
    stored.values[i] += trial.account.potentials.values[i];
  double inside = 0.0;
  if (!all.z.empty()) {
    inside = trial.with_step(in, component,
                             [&](const StepContext& at) { return internal_loss(*assembly_, component, at); });
  }
  // Potentials enter the ledger unseen by any sweep.
  if (!std::isfinite(dissipative + external + inside + stored.total())) return false;
  coupling_work_.add(total - dissipative - external + inside);
  result_.flows[EnergyFlow::dashpot] += inside - dissipative;
  result_.flows[EnergyFlow::external] += external;
  return true;
}

void StepBalance::book_joints(const StepInput& in, Index component, JointStage& joints,
                              const IslandProblem* contact, StepTrial& trial) {
  const Assembly& assembly = *assembly_;
  const Range q = assembly.components()[component].q, v = assembly.components()[component].v;
  const JointConstraints &start = joints.rows().at_start(), &end = joints.rows().at_end();
  const double* const total = joints.multipliers(contact);
  joints.finish(in, trial);
  // Reactions do no work on the constraints but that of drivers: the rest is an error of the step. Answers
  // along the rows at the start have none.
  coupling_work_.add(joints.iterate().work(trial));
  if (contact != nullptr) rates_.resize(end.size());
  if (joints.is_struck()) {
    // Half of what rounding of the step before has left of the constraints, which the answers meet.
    start.residuals(JointLevel::velocity, in.start.v.data(), rates_.data());
  } else if (contact != nullptr) {
    joints.rows().at_midpoint().residuals(JointLevel::change, trial.midpoint.v.data(), rates_.data());
  }
  for (std::size_t row = 0; row < end.size() && (contact != nullptr || start.depends_on_time()); ++row) {
    const double reaction = joints.iterate().impulse[row];
    double rate = 0.0;
    if (start.depends_on_time()) rate = 0.5 * (start.rate(row) + end.rate(row));
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

double StepBalance::book_contacts(const IslandProblem& problem, const double* after, double time,
                                  const StepInput& in, const StepTrial& trial) {
  ImpulseWork work;
  bool impact = false;
  const std::size_t first = result_.report.contacts.size();
  for (std::size_t contact = 0; contact < problem.constraints().size(); ++contact) {
    if (problem.constraints()[contact].type == ConstraintType::rolling) {
      book_rolling(problem, contact, after, work);
    } else if (problem.constraints()[contact].has_dry_friction()) {
      book_joint_friction(problem, contact, after, trial, work);
    } else {
      book_contact(problem, contact, after, time, in, work, impact);
    }
  }
  if (problem.problem().is_factored()) keep_impulses(problem);
  if (problem.restitution_factor() == 0.0) ++result_.plastic_jams;
  if (!(work.gain > 0.0)) return 0.0;
  const double gain = book_gain(problem, work, impact, trial);
  if (gain > 0.0) {
    for (std::size_t i = first; i < result_.report.contacts.size(); ++i)
      result_.report.contacts[i].energy_gain = gain;
  }
  return gain;
}

double StepBalance::book_impact(const IslandProblem& problem, const double* after, const ImpactNote& note,
                                const StepInput& in, const StepTrial& trial) {
  const std::size_t first = result_.report.contacts.size();
  const double gain = book_contacts(problem, after, in.start.time, in, trial);
  if (note.cut_sequence) ++result_.cut_sequences;
  if (note.restitution_factor < problem.restitution_factor()) ++result_.scaled_impacts;
  for (std::size_t i = first; i < result_.report.contacts.size(); ++i) {
    ContactRecord& entry = result_.report.contacts[i];
    entry.impact = true;
    entry.restitution_factor = note.restitution_factor;
    entry.cut_sequence = note.cut_sequence;
  }
  return gain;
}

void StepBalance::add(const StepResult& impacts) {
  for (std::size_t i = 0; i < energy_flow_count; ++i) result_.flows.values[i] += impacts.flows.values[i];
  result_.cut_sequences += impacts.cut_sequences;
  result_.scaled_impacts += impacts.scaled_impacts;
  result_.plastic_jams += impacts.plastic_jams;
  result_.report.energy_gain += impacts.report.energy_gain;
  result_.report.lasting_gain += impacts.report.lasting_gain;
  result_.report.contacts.insert(result_.report.contacts.end(), impacts.report.contacts.begin(),
                                 impacts.report.contacts.end());
}

void StepBalance::book_contact(const IslandProblem& problem, std::size_t contact, const double* after,
                               double time, const StepInput& in, ImpulseWork& sum, bool& impact) {
  const Constraint& at = problem.constraints()[contact];
  const auto first = static_cast<std::size_t>(problem.first_row(contact));
  const double *const before = problem.before().data() + first, *const impulses =
                                                                    problem.impulses().data() + first;
  const BodySlot body = assembly_->layout()->bodies()[at.body()];
  ContactRecord& entry = record(problem, contact, body.serial);
  entry.time = time;
  find_point_of_contact(at, in.start.q.data() + body.q, entry.point, entry.normal);
  entry.impact = before[0] < -capture_speed_;
  impact = impact || entry.impact;
  const std::array<double, 3> with = velocities_after(at, after);
  ImpulseWork works = sum;
  double all = 0.0, on_surface = 0.0;
  const auto book_row = [&](std::size_t i) {  // row by row: a loop over two or three costs more than they do
    const double impulse = impulses[i], gamma = before[i];
    const double work = works.add(impulse, gamma, with[i]);
    all += work;
    on_surface += impulse_work(impulse, at.surface_velocity[i], at.surface_velocity_after[i]);
    entry.velocity_before[i] = gamma;
    entry.velocity_after[i] = with[i];
    entry.impulse[i] = impulse;
    entry.work[i] = work;
    return work;
  };
  result_.flows[entry.impact ? EnergyFlow::impact_normal : EnergyFlow::contact_normal] -= book_row(0);
  double& tangential = result_.flows[entry.impact ? EnergyFlow::impact_tangential : EnergyFlow::sliding];
  if (at.rows > 1) tangential -= book_row(1);
  if (at.rows > 2) tangential -= book_row(2);
  sum = works;
  entry.contact_work += all;
  if (on_surface != 0.0) result_.flows[EnergyFlow::external] += on_surface;
}

/// Rolling resistance, in the record of the contact before it.
void StepBalance::book_rolling(const IslandProblem& problem, std::size_t contact, const double* after,
                               ImpulseWork& sum) {
  const Constraint& at = problem.constraints()[contact];
  const auto row = static_cast<std::size_t>(problem.first_row(contact));
  const double moment = problem.impulses()[row];
  const double work = sum.add(moment, problem.before()[row], at.velocity_after(0, after));
  ContactRecord& entry = result_.report.contacts.back();
  entry.rolling_moment = moment;
  entry.contact_work += work;
  result_.flows[EnergyFlow::rolling] -= work;
  result_.flows[EnergyFlow::external] +=
      impulse_work(moment, at.surface_velocity[0], at.surface_velocity_after[0]);
}

/// In an impact a gain is one of the law. In lasting contact the loads of the step take part, and a gain is
/// an error of the step: the law holds the velocity along the row at its start, which turns meanwhile.
/// Returns what an impact gained.
double StepBalance::book_gain(const IslandProblem& problem, const ImpulseWork& work, bool impact,
                              const StepTrial& trial) {
  ImpulseWork sum = work;
  if (!sum.is_gain()) return 0.0;
  if (!impact) {
    // Velocities of what lasts are small differences: of those that loads alone would lead to, of the
    // velocities of the bodies, of those of the surfaces.
    const double *b = problem.problem().vector().data(), *impulse = problem.impulses().data();
    for (const Constraint& contact : problem.constraints()) {
      const std::array<double, 3> speeds = speeds_of_rows(contact, trial.end.v.data());
      for (std::size_t i = 0; i < static_cast<std::size_t>(contact.rows); ++i) {
        sum.scale += std::abs(*impulse++) * (std::abs(*b++) + speeds[i]);
      }
      if (!sum.is_gain()) return 0.0;  // the scale only grows
    }
  }
  result_.report.energy_gain += sum.gain;
  if (impact) return sum.gain;
  result_.report.lasting_gain += sum.gain;
  return 0.0;
}

/// Friction in a joint, along its row at the start or halfway, where the trial has the mean velocities.
void StepBalance::book_joint_friction(const IslandProblem& problem, std::size_t contact, const double* after,
                                      const StepTrial& trial, ImpulseWork& sum) {
  const Constraint& at = problem.constraints()[contact];
  const double moment = problem.map().impulse(contact, 0), before = problem.map().before(contact, 0);
  const double mean_rate = after == trial.end.v.data() ? at.times(0, trial.midpoint.v.data())
                                                       : 0.5 * (before + at.velocity_after(0, after));
  JointReaction reaction;
  reaction.moment = moment;
  result_.flows[EnergyFlow::joint_friction] -= moment * mean_rate;
  sum.gain += moment * mean_rate;
  sum.scale += 2.0 * std::abs(moment) * std::max(std::abs(before), std::abs(mean_rate));
  result_.report.joint_impulses.push_back(
      {JointId{at.key.a.serial, assembly_->system().token()}, reaction, result_.report.time});
  const ContactMode mode = problem.modes()[contact];
  result_.joint_friction_modes.emplace_back(at.key, mode == ContactMode::open ? ContactMode::stick : mode);
}

/// Names a contact, and how its problem was solved. \param serial of its first body
ContactRecord& StepBalance::record(const IslandProblem& problem, std::size_t contact, Index serial) {
  const Constraint& at = problem.constraints()[contact];
  const ContactReport& report = problem.report();
  fetch_ahead(result_.report.contacts);
  ContactRecord& entry = result_.report.contacts.emplace_back();
  entry.key = at.key;
  const Layout& layout = *assembly_->layout();
  entry.body = {serial, layout.token()};
  if (at.type == ConstraintType::contact && at.bodies == 2) entry.other = layout.id(at.blocks[1].body);
  if (at.key.b.owner == FeatureKey::Owner::obstacle) {
    entry.obstacle = {at.key.b.serial, assembly_->system().token()};
  }
  entry.directions = at.rows;
  entry.gap = at.gap;
  entry.mode = problem.modes()[contact];
  entry.outcome = report.outcome;
  entry.residual = report.residual;
  entry.solver = report.solver;
  entry.restitution_factor = problem.restitution_factor();
  return entry;
}

/// Impulses from which the next step starts.
void StepBalance::keep_impulses(const IslandProblem& problem) {
  for (std::size_t c = 0; c < problem.constraints().size(); ++c) {
    const auto row = static_cast<std::size_t>(problem.first_row(c));
    std::array<double, 2> impulse{problem.impulses()[row], 0.0};
    if (problem.constraints()[c].rows > 1) impulse[1] = problem.impulses()[row + 1];
    result_.contacts.add(problem.constraints()[c].key, impulse);
  }
}

void StepBalance::book_turning(double work) {
  result_.flows[EnergyFlow::external] -= work;
  coupling_work_.add(work);
}

void StepBalance::book_projection(const GapProjection::Result& result, const StoredEnergies& before,
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

StepResult& StepBalance::finish(const StepInput& in) {
  EnergyFlows& flows = result_.flows;
  flows[EnergyFlow::projection] = energy_position_projection_ + energy_velocity_projection_;
  flows[EnergyFlow::coupling_discretisation] -= (result_.stored.potential() + energy_position_projection_ -
                                                 in.companion.ledger.potential() + coupling_work_.value());
  if (!result_.contacts.empty()) result_.contacts.contacts.finish();
  return result_;
}

}  // namespace carom
