#include <carom/integrators/time_stepper.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace carom {

void check_options(const TimeStepping& options) {
  const auto refuse = [](const char* option, double value, const char* allowed) {
    throw ModelError(std::string("time stepping: ") + option + " is " + to_text(value) + "; allowed: " + allowed);
  };
  if (!(std::isfinite(options.step) && options.step > 0.0)) refuse("step", options.step, "finite and > 0 s");
  if (!(std::isfinite(options.tolerance) && options.tolerance >= 0.0)) {
    refuse("tolerance", options.tolerance, "finite and >= 0 m");
  }
  if (options.max_sweeps < 2) refuse("max_sweeps", options.max_sweeps, "at least 2");
  if (!(std::isfinite(options.capture_speed) && options.capture_speed >= 0.0)) {
    refuse("capture_speed", options.capture_speed, "finite and >= 0 m/s");
  }
}

void TimeStepper::SplitLoads::resize(std::size_t size) {
  conservative.resize(size);
  dissipative.resize(size);
  external.resize(size);
}

TimeStepper::TimeStepper(const Assembly& assembly, const TimeStepping& options)
    : assembly_(&assembly), options_(options), finder_(assembly), trial_(assembly.layout()),
      evaluation_(make_evaluation(assembly)) {
  check_options(options);
  const std::size_t q_size = assembly.layout()->q_size();
  const std::size_t v_size = assembly.layout()->v_size();
  used_q_.resize(q_size);
  used_v_.resize(v_size);
  start_.resize(v_size);
  end_.resize(v_size);
  start_force_.resize(v_size);
  load_.resize(v_size);
  delta_.resize(v_size);
  change_.resize(v_size);
  rounding_.resize(v_size);
  ratings_.resize(assembly.islands().size());
  rated_contraction_.assign(assembly.islands().size(), -1.0);
}

void TimeStepper::step(State& state, Companion& companion, double step, double end_time, StepReport& report) {
  trial_.time = end_time;
  flows_ = {};
  stored_ = {};
  report_.contacts.clear();
  report_.time = end_time;
  report_.step = step;
  report_.sweeps = 0;
  report_.contraction = 0.0;
  report_.worst_coupling = {};
  report_.worst_coupling_rate = 0.0;
  report_.energy_gain = 0.0;
  for (Index island = 0; island < assembly_->islands().size(); ++island) {
    advance_island(island, state, companion, step);
  }
  commit(state, companion, end_time, report);
}

void TimeStepper::advance_island(Index island, const State& state, const Companion& companion, double step) {
  const Assembly& assembly = *assembly_;
  const Range v = assembly.islands()[island].v;
  const Range q = assembly.islands()[island].q;

  evaluate_positions(assembly, island, state.view(), evaluation_);
  evaluate_loads(assembly, island, state.view(), evaluation_, start_.view());
  find_contacts(island, state);
  for (Index i = v.begin; i < v.end; ++i) {
    start_force_[i] = start_.conservative[i] + start_.dissipative[i] + start_.external[i];
    evaluation_.force[i] = start_force_[i];
  }
  std::copy(state.q.begin() + q.begin, state.q.begin() + q.end, used_q_.begin() + q.begin);
  std::copy(state.v.begin() + v.begin, state.v.begin() + v.end, used_v_.begin() + v.begin);

  FixedPointJudge judge(options_.tolerance, options_.max_sweeps);
  for (;;) {
    solve_velocities(island, state, companion, step);
    advance_positions(island, state, step);
    const auto verdict = compare(island, step, judge);
    if (verdict == FixedPointJudge::Verdict::failed) fail_contraction(island, state, step, judge);
    // The first sweep's forces were those of t_j: its end is not yet a fixed point, however small the change.
    if (verdict == FixedPointJudge::Verdict::converged && judge.sweeps() > 1) break;
    std::copy(trial_.q.begin() + q.begin, trial_.q.begin() + q.end, used_q_.begin() + q.begin);
    std::copy(trial_.v.begin() + v.begin, trial_.v.begin() + v.end, used_v_.begin() + v.begin);
    evaluate(assembly, island, trial_.view(), evaluation_);
  }

  book_couplings(island, state, step);
  book_contacts();
  rate(island, state, step, judge.contraction());
  report_.sweeps = std::max(report_.sweeps, judge.sweeps());
  report_.contraction = std::max(report_.contraction, judge.contraction());
}

void TimeStepper::find_contacts(Index island, const State& state) {
  contacts_.clear();
  clusters_in_use_ = 0;
  finder_.find(island, state.view(), evaluation_, 0.0, contacts_);
  // Obstacles are fixed, so contacts share a problem where they share a body; they come ordered by body.
  for (std::size_t first = 0; first < contacts_.size();) {
    std::size_t last = first + 1;
    while (last < contacts_.size() && contacts_[last].body == contacts_[first].body) ++last;
    if (clusters_in_use_ == clusters_.size()) clusters_.emplace_back();
    clusters_[clusters_in_use_++].build(*assembly_, {contacts_.data() + first, last - first}, state.v.data());
    first = last;
  }
}

void TimeStepper::solve_velocities(Index island, const State& state, const Companion& companion, double step) {
  const Range v = assembly_->islands()[island].v;
  const double half = 0.5 * step;
  for (Index i = v.begin; i < v.end; ++i) load_[i] = half * (start_force_[i] + evaluation_.force[i]);
  assembly_->for_bodies(island, [this](const BodyKind& kind, Range slots, Index, Index offset, Index) {
    kind.apply_inverse_mass(slots, load_.data() + offset, change_.data() + offset);
  });
  if (clusters_in_use_ > 0) {
    for (Index i = v.begin; i < v.end; ++i) trial_.v[i] = state.v[i] + change_[i];
    for (std::size_t i = 0; i < clusters_in_use_; ++i) clusters_[i].set_free_velocity(trial_.v.data());
    for (std::size_t i = 0; i < clusters_in_use_; ++i) {
      if (!clusters_[i].solve(chain_).usable()) fail_contact(clusters_[i], state, step);
      clusters_[i].apply(change_.data());
    }
  }
  // Equal small changes over many steps would round the same way each time, and the error would add up.
  for (Index i = v.begin; i < v.end; ++i) {
    const double change = change_[i] + companion.rounding[i];
    trial_.v[i] = state.v[i] + change;
    rounding_[i] = change - (trial_.v[i] - state.v[i]);
  }
}

void TimeStepper::advance_positions(Index island, const State& state, double step) {
  const Range v = assembly_->islands()[island].v;
  const double half = 0.5 * step;
  for (Index i = v.begin; i < v.end; ++i) delta_[i] = half * (state.v[i] + trial_.v[i]);
  assembly_->for_bodies(island, [&](const BodyKind& kind, Range slots, Index q, Index offset, Index) {
    kind.advance(slots, state.q.data() + q, delta_.data() + offset, trial_.q.data() + q);
  });
}

FixedPointJudge::Verdict TimeStepper::compare(Index island, double step, FixedPointJudge& judge) const {
  double change = 0.0;
  double size = 0.0;
  // Maxima that let NaN through: a comparison with NaN is false, so it is taken.
  const auto take = [](double& largest, double candidate) {
    if (!(candidate <= largest)) largest = candidate;
  };
  const auto& lengths = assembly_->length_scales();
  const Range bodies = assembly_->islands()[island].bodies;
  for (Index body = bodies.begin; body < bodies.end; ++body) {
    const BodySlot& slot = assembly_->layout()->bodies()[body];
    for (Index i = 0; i < slot.v_size; ++i) {
      const Index at = slot.v + i;
      take(change, std::abs(trial_.v[at] - used_v_[at]) * step * lengths[at]);
      take(size, std::abs(trial_.v[at]) * step * lengths[at]);
    }
    for (Index i = 0; i < slot.q_size; ++i) {
      // Orientations are weighed as the velocity coordinates they belong to.
      const double length = lengths[slot.v + std::min(i, slot.v_size - 1)];
      take(change, std::abs(trial_.q[slot.q + i] - used_q_[slot.q + i]) * length);
      take(size, std::abs(trial_.q[slot.q + i]) * length);
    }
  }
  return judge.judge(change, size);
}

void TimeStepper::book_couplings(Index island, const State& state, double step) {
  const Assembly& assembly = *assembly_;
  const Range v = assembly.islands()[island].v;
  const StateView used{trial_.time, used_q_.data(), used_v_.data(), trial_.z.data()};

  StoredEnergies before, after;
  evaluate_positions(assembly, island, state.view(), evaluation_);
  add_stored_energies(assembly, island, state.view(), evaluation_, before);
  evaluate_positions(assembly, island, used, evaluation_);
  evaluate_loads(assembly, island, used, evaluation_, end_.view());
  evaluate_positions(assembly, island, trial_.view(), evaluation_);
  add_stored_energies(assembly, island, trial_.view(), evaluation_, after);

  // Work of an impulse over the step: impulse times mean velocity, exact for the kinetic energy.
  const auto work = [&](const std::vector<double>& at_start, const std::vector<double>& at_end) {
    double sum = 0.0;
    for (Index i = v.begin; i < v.end; ++i) {
      sum += 0.25 * step * (at_start[i] + at_end[i]) * (state.v[i] + trial_.v[i]);
    }
    return sum;
  };
  const double stored_change = after.potential() - before.potential();
  flows_[EnergyFlow::coupling_discretisation] -= stored_change + work(start_.conservative, end_.conservative);
  flows_[EnergyFlow::dashpot] -= work(start_.dissipative, end_.dissipative);
  flows_[EnergyFlow::external] += work(start_.external, end_.external);
  for (std::size_t i = 0; i < stored_energy_count; ++i) stored_.values[i] += after.values[i];
}

void TimeStepper::book_contacts() {
  for (std::size_t i = 0; i < clusters_in_use_; ++i) {
    const ContactCluster& cluster = clusters_[i];
    bool impact = false;
    double gain = 0.0;
    double scale = 0.0;
    for (std::size_t contact = 0; contact < cluster.contacts().size(); ++contact) {
      record(cluster, contact);
      const ContactRecord& entry = report_.contacts.back();
      impact = impact || entry.impact;
      for (int direction = 0; direction < entry.directions; ++direction) {
        const auto at = static_cast<std::size_t>(direction);
        gain += entry.work[at];
        scale += std::abs(entry.impulse[at]) * (std::abs(entry.velocity_before[at]) + std::abs(entry.velocity_after[at]));
        const EnergyFlow line = entry.impact ? (direction == 0 ? EnergyFlow::impact_normal : EnergyFlow::impact_tangential)
                                             : (direction == 0 ? EnergyFlow::contact_normal : EnergyFlow::sliding);
        flows_[line] -= entry.work[at];
      }
    }
    // Rounding of the sum of works; a gain above it is real. In lasting contact the loads of the step take
    // part, and the sign of the contact's share says nothing about the law.
    constexpr double rounding = 1e-13;
    if (!impact || !(gain > rounding * scale)) continue;
    report_.energy_gain += gain;
    if (!options_.refuse_energy_gain) continue;
    SolverFailure failure{report_.time - report_.step, report_.step, 0.0, cluster.report().residual, {}, nullptr};
    for (const Contact& contact : cluster.contacts()) failure.parts.push_back(finder_.name(contact.key));
    failure.problem = std::make_shared<const ContactProblem>(cluster.problem());
    const std::string first = failure.parts.front();
    throw SolverError("time stepping at t = " + to_text(failure.time) + " s: contact of " + first + " adds " +
                          to_text(gain) + " J; allowed: no gain (refuse_energy_gain is set; use e_n = e_t)",
                      std::move(failure));
  }
}

void TimeStepper::record(const ContactCluster& cluster, std::size_t contact) {
  const Contact& at = cluster.contacts()[contact];
  ContactRecord& entry = report_.contacts.emplace_back();
  entry.key = at.key;
  entry.body = assembly_->layout()->id(at.body);
  entry.obstacle = {at.key.against.serial, assembly_->system().token()};
  entry.directions = at.rows;
  entry.gap = at.gap;
  for (int row = 0; row < at.rows; ++row) {
    const auto direction = static_cast<std::size_t>(row);
    const auto place = static_cast<std::size_t>(cluster.first_row(contact) + row);
    entry.velocity_before[direction] = cluster.before()[place];
    entry.velocity_after[direction] = at.velocity(row, trial_.v.data());
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

void TimeStepper::rate(Index island, const State& state, double step, double contraction) {
  // Rated once, and again when the iteration has come to contract twice as badly.
  constexpr double worsening = 2.0;
  if (rated_contraction_[island] < 0.0 || contraction > worsening * rated_contraction_[island]) {
    evaluate_positions(*assembly_, island, state.view(), evaluation_);
    ratings_[island] = rate_couplings(*assembly_, island, state.view(), evaluation_, step);
    rated_contraction_[island] = contraction;
  }
  if (ratings_[island].rate > report_.worst_coupling_rate) {
    report_.worst_coupling = ratings_[island].worst;
    report_.worst_coupling_rate = ratings_[island].rate;
  }
}

void TimeStepper::fail_contraction(Index island, const State& state, double step, const FixedPointJudge& judge) {
  // The bound of the rating is pessimistic by itself; the rest is room for forces that stiffen on the way.
  constexpr double caution = 0.9;
  const System& system = assembly_->system();
  SolverFailure failure;
  failure.time = state.time;
  failure.step = step;
  failure.residual = judge.change();
  const std::string where = "time stepping at t = " + to_text(state.time) + " s, step " + to_text(step) + " s: ";

  const StateView used{trial_.time, used_q_.data(), used_v_.data(), trial_.z.data()};
  for (const StateView& view : {state.view(), used}) {
    evaluate_positions(*assembly_, island, view, evaluation_);
    const ElementId culprit = find_non_finite(*assembly_, island, view, evaluation_);
    if (!culprit.valid()) continue;
    // Forces may overflow only because the iteration diverged; then the coupling is named by its rate below.
    const Range q = assembly_->islands()[island].q;
    const Range v = assembly_->islands()[island].v;
    const auto finite = [](const double* numbers, Range range) {
      return std::all_of(numbers + range.begin, numbers + range.end, [](double x) { return std::isfinite(x); });
    };
    if (!finite(view.q, q) || !finite(view.v, v)) break;
    failure.parts.push_back(system.name(culprit));
    throw SolverError(where + "the loads of " + failure.parts.front() + " are not finite", std::move(failure));
  }

  evaluate_positions(*assembly_, island, state.view(), evaluation_);
  const CouplingRating rating = rate_couplings(*assembly_, island, state.view(), evaluation_, step);
  std::string message = where + "the fixed-point iteration does not contract after " +
                        std::to_string(judge.sweeps()) + " sweeps (last change " + to_text(judge.change()) + " m)";
  if (rating.worst.valid()) {
    failure.parts.push_back(system.name(rating.worst));
    failure.suggested_step = std::min(caution * rating.contracting_step, 0.5 * step);
    message += "; limited most by " + failure.parts.front() + " (rate " + to_text(rating.rate) +
               "); a step of " + to_text(failure.suggested_step) + " s would contract";
  }
  throw SolverError(message, std::move(failure));
}

void TimeStepper::fail_contact(const ContactCluster& cluster, const State& state, double step) const {
  SolverFailure failure{state.time, step, 0.0, cluster.report().residual, {}, nullptr};
  for (const Contact& contact : cluster.contacts()) failure.parts.push_back(finder_.name(contact.key));
  failure.problem = std::make_shared<const ContactProblem>(cluster.problem());
  std::string message = "time stepping at t = " + to_text(state.time) + " s: contact problem of ";
  for (std::size_t i = 0; i < failure.parts.size(); ++i) message += (i == 0 ? "" : ", ") + failure.parts[i];
  message.append(": ").append(to_string(cluster.report().outcome));
  if (!cluster.report().reason.empty()) message.append(" (").append(cluster.report().reason).append(")");
  message += ", residual " + to_text(cluster.report().residual);
  throw SolverError(message, std::move(failure));
}

void TimeStepper::commit(State& state, Companion& companion, double end_time, StepReport& report) {
  std::swap(state.q, trial_.q);
  std::swap(state.v, trial_.v);
  std::swap(companion.rounding, rounding_);
  state.time = end_time;
  companion.ledger.book(flows_, stored_);

  companion.modes.clear();
  Statistics& statistics = companion.statistics;
  ++statistics.steps;
  statistics.sweeps += report_.sweeps;
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
  if (report_.energy_gain > 0.0) {
    ++statistics.energy_gains;
    statistics.energy_gained += report_.energy_gain;
  }
  std::swap(report, report_);
}

}  // namespace carom
