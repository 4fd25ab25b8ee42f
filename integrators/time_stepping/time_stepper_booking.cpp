// Problem: tell the ledger, the report and the statistics what a step did, and make the step's end the
// state.

#include <carom/core/numerics/pair.h>
#include <carom/integrators/time_stepping/time_stepper.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace carom {

namespace {

/// Work of the impulse of loads a and b at the ends of a step: impulse times mean velocity, exact for the
/// kinetic energy [J].
double work(const double* a, const double* b, const State& start, const State& end, Range v, double step) {
  Pair pairs = both(0.0);
  Index i = v.begin;
  for (; i + 1 < v.end; i += 2) {
    pairs +=
        (load_pair(start.v.data() + i) + load_pair(end.v.data() + i)) * (load_pair(a + i) + load_pair(b + i));
  }
  double sum = pairs[0] + pairs[1];
  if (i < v.end) sum += (start.v[i] + end.v[i]) * (a[i] + b[i]);
  return 0.25 * step * sum;
}

}  // namespace

/// The total is that of the impulse that acted; its parts by cause are those of the loads that it led to,
/// what the iteration left open counts as conservative.
TimeStepper::Works TimeStepper::works(Index component, const Block& block, const State& state,
                                      const Companion& companion, double step) const {
  const auto of_cause = [&](const std::vector<double>& at_start, const std::vector<double>& at_end) {
    if (at_end.empty()) return 0.0;
    const double* const first = mean_rule() ? at_end.data() : at_start.data();
    return work(first, at_end.data(), state, trial_, block.v, step);
  };
  Works sums{};
  sums.total = work(start_of_sum(companion), evaluation_.force.data(), state, trial_, block.v, step);
  sums.dissipative = of_cause(companion.loads.dissipative, dissipative_);
  sums.external = of_cause(companion.loads.external, external_);
  assembly_->for_bodies(component, block.bodies,
                        [&](const BodyKind& kind, Range slots, Index, Index v, Index) {
                          sums.kinetic += kind.kinetic_energy(slots, trial_.v.data() + v);
                        });
  return sums;
}

void TimeStepper::book_couplings(Index component, const State& state, double step) {
  const Assembly& assembly = *assembly_;
  for (std::size_t i = 0; i < stored_energy_count; ++i) stored_.values[i] += evaluated_energies_.values[i];
  double total = 0.0, dissipative = 0.0, external = 0.0;
  for (Index part = 0; part < assembly.components()[component].blocks.size(); ++part) {
    stored_[StoredEnergy::kinetic] += works_[part].kinetic;
    total += works_[part].total;
    dissipative += works_[part].dissipative;
    external += works_[part].external;
  }
  double inside = 0.0;
  if (!assembly.components()[component].z.empty()) {
    inside = with_step(component, state, step,
                       [&](const StepContext& at) { return internal_loss(assembly, component, at); });
  }
  // Potentials enter the ledger unseen by any sweep.
  if (!std::isfinite(dissipative + external + inside + stored_.total())) fail_account(component, state, step);
  coupling_work_.add(total - dissipative - external + inside);
  flows_[EnergyFlow::dashpot] += inside - dissipative;
  flows_[EnergyFlow::external] += external;
}

void TimeStepper::project(Index component, const State& state, const Companion& companion, double step) {
  if (contacts_.empty()) return;
  const Assembly& assembly = *assembly_;
  evaluate_positions(assembly, component, trial_.view(), evaluation_);
  JointConstraints none_there;
  JointConstraints& joints = jointed(component) ? joints_[component].end : none_there;
  const GapProjection::Result result =
      projection_.project(assembly, component, detector_, places_after_, {contacts_}, chains_.front(), trial_,
                          evaluation_, joints);
  if (result.left != nullptr) fail_projection(*result.left, state, step);
  if (!result.moved) return;
  report_.projected = std::max(report_.projected, result.shift);
  if (jointed(component)) hold_velocities(component);
  const StoredEnergies before = evaluated_energies_;
  if (mean_rule()) {
    // The mean loads are those that acted.
    evaluated_energies_ = {};
    add_potentials(assembly, component, trial_.view(), evaluation_, evaluated_energies_);
  } else {
    evaluate_iterate(component, state, companion, step, LoadsAsked::by_cause, false);
  }
  energy_position_projection_ += before.potential() - evaluated_energies_.potential();
  for (std::size_t i = 0; i < stored_energy_count; ++i) {
    stored_.values[i] += evaluated_energies_.values[i] - before.values[i];
  }
}

/// Velocities that the joints allow where bodies have been moved to.
void TimeStepper::hold_velocities(Index component) {
  const Assembly& assembly = *assembly_;
  const auto kinetic = [&] {
    double sum = 0.0;
    assembly.for_bodies(component, [&](const BodyKind& kind, Range slots, Index, Index v, Index) {
      sum += kind.kinetic_energy(slots, trial_.v.data() + v);
    });
    return sum;
  };
  JointConstraints& joints = joints_[component].end;
  const double before = kinetic();
  joints.update_and_factor({trial_.view(), evaluation_.rotation.data()});
  joints.project(JointLevel::velocity, trial_.v.data());
  joints.project(JointLevel::velocity, trial_.v.data());  // what rounding left
  const double after = kinetic();
  energy_velocity_projection_ += before - after;
  stored_[StoredEnergy::kinetic] += after - before;
}

void TimeStepper::book_contacts(Index component, const State& state, double step) {
  after_ = trial_.v.data();
  if (jointed(component) && joints_[component].struck) {
    const Range v = assembly_->components()[component].v;
    std::copy(trial_.v.begin() + v.begin, trial_.v.begin() + v.end, allowed_.begin() + v.begin);
    allow_at_start(joints_[component], allowed_.data());
    after_ = allowed_.data();
  }
  for (std::size_t i = 0; i < clusters_in_use_; ++i) {
    const IslandProblem& cluster = clusters_[i];
    ContactWork work;
    for (std::size_t contact = 0; contact < cluster.constraints().size(); ++contact) {
      if (cluster.constraints()[contact].has_dry_friction()) {
        book_joint_friction(cluster, contact, work);
      } else {
        book_contact(cluster, contact, work);
      }
    }
    if (work.gain > 0.0) book_gain(cluster, work, state, step);
  }
}

void TimeStepper::book_contact(const IslandProblem& cluster, std::size_t contact, ContactWork& sum) {
  record(cluster, contact);
  if (detector_.has_moving_obstacles()) flows_[EnergyFlow::external] += cluster.map().surface_work(contact);
  const ContactRecord& entry = report_.contacts.back();
  sum.impact = sum.impact || entry.impact;
  for (int direction = 0; direction < entry.directions; ++direction) {
    const auto at = static_cast<std::size_t>(direction);
    sum.gain += entry.work[at];
    sum.scale += std::abs(entry.impulse[at]) *
                 (std::abs(entry.velocity_before[at]) + std::abs(entry.velocity_after[at]));
    const EnergyFlow line = entry.impact
                                ? (direction == 0 ? EnergyFlow::impact_normal : EnergyFlow::impact_tangential)
                                : (direction == 0 ? EnergyFlow::contact_normal : EnergyFlow::sliding);
    flows_[line] -= entry.work[at];
  }
}

/// In an impact a gain is one of the law. In lasting contact the loads of the step take part, and a gain is
/// an error of the step: the law holds the velocity along the row at its start, which turns meanwhile.
void TimeStepper::book_gain(const IslandProblem& cluster, const ContactWork& work, const State& state,
                            double step) {
  // Rounding of the sum of works; a gain above it is real.
  constexpr double rounding = 1e-13;
  double scale = work.scale;
  const auto is_rounding = [&] { return !(work.gain > rounding * scale); };
  if (is_rounding()) return;
  if (!work.impact) {
    // Velocities of what lasts are small differences: of those that loads alone would lead to, of the
    // velocities of the bodies, of those of the obstacles.
    for (std::size_t c = 0; c < cluster.constraints().size(); ++c) {
      const Constraint& contact = cluster.constraints()[c];
      for (int i = 0; i < contact.rows; ++i) {
        const auto row = static_cast<std::size_t>(cluster.first_row(c) + i);
        const double size = std::abs(cluster.problem().vector()[row]) + contact.speed(i, trial_.v.data());
        scale += std::abs(cluster.impulses()[row]) * size;
        if (is_rounding()) return;  // the scale only grows
      }
    }
  }
  report_.energy_gain += work.gain;
  if (!work.impact) {
    report_.lasting_gain += work.gain;
  } else if (options_.refuse_energy_gain) {
    refuse_gain(cluster, work.gain, state, step);
  }
}

/// Friction in a joint, along its row at the start or halfway; the velocities halfway are at hand.
void TimeStepper::book_joint_friction(const IslandProblem& cluster, std::size_t contact, ContactWork& sum) {
  const Constraint& at = cluster.constraints()[contact];
  const auto place = static_cast<std::size_t>(cluster.first_row(contact));
  JointReaction reaction;
  const double moment = cluster.impulses()[place];
  const double mean_rate = after_ == trial_.v.data()
                               ? at.times(0, midpoint_.v.data())
                               : 0.5 * (cluster.before()[place] + at.velocity_after(0, after_));
  reaction.moment = moment;
  flows_[EnergyFlow::joint_friction] -= moment * mean_rate;
  sum.gain += moment * mean_rate;
  sum.scale += 2.0 * std::abs(moment) * std::max(std::abs(cluster.before()[place]), std::abs(mean_rate));
  report_.joint_impulses.push_back(
      {JointId{at.key.a.serial, assembly_->system().token()}, reaction, trial_.time});
  const ContactMode mode = cluster.modes()[contact];
  joint_friction_modes_.emplace_back(at.key, mode == ContactMode::open ? ContactMode::stick : mode);
}

void TimeStepper::record(const IslandProblem& cluster, std::size_t contact) {
  const Constraint& at = cluster.constraints()[contact];
  ContactRecord& entry = report_.contacts.emplace_back();
  entry.key = at.key;
  entry.body = assembly_->layout()->id(at.body());
  if (at.key.b.owner == FeatureKey::Owner::obstacle) {
    entry.obstacle = {at.key.b.serial, assembly_->system().token()};
  }
  entry.directions = at.rows;
  entry.gap = at.gap;
  for (int row = 0; row < at.rows; ++row) {
    const auto direction = static_cast<std::size_t>(row);
    const auto place = static_cast<std::size_t>(cluster.first_row(contact) + row);
    entry.velocity_before[direction] = cluster.before()[place];
    entry.velocity_after[direction] = at.velocity_after(row, after_);
    entry.impulse[direction] = cluster.impulses()[place];
    entry.work[direction] =
        0.5 * entry.impulse[direction] * (entry.velocity_before[direction] + entry.velocity_after[direction]);
  }
  entry.mode = cluster.modes()[contact];
  entry.impact = entry.velocity_before[0] < -options_.capture_speed;
  entry.outcome = cluster.report().outcome;
  entry.residual = cluster.report().residual;
  entry.solver = cluster.report().solver;
}

void TimeStepper::commit(State& state, Companion& companion, double end_time, StepReport& report) {
  flows_[EnergyFlow::projection] = energy_position_projection_ + energy_velocity_projection_;
  flows_[EnergyFlow::coupling_discretisation] = -(stored_.potential() + energy_position_projection_ -
                                                  companion.ledger.potential() + coupling_work_.value());
  std::swap(state.q, trial_.q);
  std::swap(state.v, trial_.v);
  std::swap(state.z, trial_.z);
  remember_loads(companion);
  companion.loads.dissipative.swap(dissipative_);
  companion.loads.external.swap(external_);
  companion.loads.valid = true;
  companion.loads.mean = mean_rule();
  std::swap(companion.rounding, rounding_);
  state.time = end_time;
  companion.ledger.book(flows_, stored_);

  companion.modes = joint_friction_modes_;
  Statistics& statistics = companion.statistics;
  ++statistics.steps;
  statistics.sweeps += report_.sweeps;
  companion.iterations.swap(iterations_);
  ++statistics.steps_by_iteration[static_cast<std::size_t>(report_.iteration)];
  statistics.fallbacks += report_.fallbacks;
  statistics.most_sweeps = std::max(statistics.most_sweeps, report_.sweeps);
  statistics.largest_contraction = std::max(statistics.largest_contraction, report_.contraction);
  for (const ContactRecord& contact : report_.contacts) {
    companion.modes.emplace_back(contact.key, contact.mode);
    ++statistics.contact_steps;
    if (contact.impact) ++statistics.impacts;
    if (contact.outcome == Outcome::several_solutions) ++statistics.several_solutions;
    if (contact.outcome == Outcome::forces_not_unique) ++statistics.forces_not_unique;
    statistics.deepest_gap = std::min(statistics.deepest_gap, contact.gap);
    statistics.worst_residual = std::max(statistics.worst_residual, contact.residual);
  }
  for (SolverChain& chain : chains_) {
    if (chain.statistics().problems == 0) continue;
    companion.contact_statistics += chain.statistics();
    chain.reset_statistics();
  }
  if (report_.energy_gain > report_.lasting_gain) {
    ++statistics.energy_gains;
    statistics.energy_gained += report_.energy_gain - report_.lasting_gain;
  }
  if (report_.lasting_gain > 0.0) {
    ++statistics.lasting_gains;
    statistics.lasting_gained += report_.lasting_gain;
  }
  report_.findings.swap(report.findings);
  std::swap(report, report_);
}

}  // namespace carom
