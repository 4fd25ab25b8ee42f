// Problem: every impulse does its work on a line of the ledger, and is recorded.

#include <carom/contact/contact_parties.h>
#include <carom/contact/frame_of_contact.h>
#include <carom/contact/impulse_map.h>
#include <carom/integrators/event_driven/event_balance.h>

#include <algorithm>

namespace carom {

namespace {

/// Line of the ledger for the work of an impact along a row of a contact.
EnergyFlow line_of(EventKind kind, int row) {
  if (kind == EventKind::accumulation) return EnergyFlow::accumulation;
  if (kind == EventKind::impact_without_collision) return EnergyFlow::impact_without_collision;
  return row == 0 ? EnergyFlow::impact_normal : EnergyFlow::impact_tangential;
}

EnergyFlow line_of_rolling(EventKind kind) {
  return kind == EventKind::impact ? EnergyFlow::rolling : line_of(kind, 0);
}

/// True of a contact that was closed in an impact without taking part in it.
bool took_no_impulse(const EventRecord& event) {
  return is_impulsive(event.kind) && event.impulse == std::array<double, 3>{};
}

}  // namespace

/// Records are large: the first few come without moving those before.
EventBalance::EventBalance(const EventKeeping& kept) : keeping(kept) {
  constexpr std::size_t of_an_instant = 8;
  fresh.reserve(of_an_instant);
}

void EventBalance::clear() {
  flows = {};
  fresh.clear();
  events.clear();
  counts = {};
  tally = {};
  instant_ = 0;
  joint_impulses.clear();
  energy_gain = shift = 0.0;
}

void EventBalance::add(const GroupBooks& books) {
  for (std::size_t term = 0; term < flows.values.size(); ++term) {
    flows.values[term] += books.flows.values[term];
  }
  energy_gain += books.energy_gain;
}

void EventBalance::copy_totals(const EventBalance& from) {
  flows = from.flows;
  counts = from.counts;
  tally = from.tally;
  joint_impulses.assign(from.joint_impulses.begin(), from.joint_impulses.end());
  energy_gain = from.energy_gain;
  shift = from.shift;
}

void EventBalance::return_to(const EventBalance& earlier, double time) {
  copy_totals(earlier);
  fresh.clear();
  order_events();
  std::size_t kept = events.size();
  while (kept > 0 && events.time(kept - 1) > time) --kept;
  events.drop_last(events.size() - kept);
}

void EventBalance::settle() {
  for (const EventRecord& event : fresh) {
    if (event.kind == EventKind::impact && event.impulse[0] > 0.0) ++tally.impacts;
    if (event.outcome == Outcome::several_solutions) ++tally.several_solutions;
    if (event.outcome == Outcome::forces_not_unique) ++tally.forces_not_unique;
    tally.worst_residual = std::max(tally.worst_residual, event.residual);
    if (keeping.records && (keeping.zero_impulses || !took_no_impulse(event))) events.append(event);
  }
  fresh.clear();
  ++instant_;
  if (!keeping.records) joint_impulses.clear();
  // Now and then, so that what is kept is put in order a few times at most.
  if (keeping.limit > 0 && events.size() >= 2 * keeping.limit) keep_latest();
}

/// Groups that come later may have earlier events: the latest are those by time.
void EventBalance::keep_latest() {
  if (keeping.limit == 0 || events.size() <= keeping.limit) return;
  order_events();
  events.drop_first(events.size() - keeping.limit);
}

void EventBalance::finish() {
  settle();
  order_events();
  keep_latest();
  const auto earlier = [](const JointImpulse& a, const JointImpulse& b) { return a.time < b.time; };
  if (!std::is_sorted(joint_impulses.begin(), joint_impulses.end(), earlier)) {
    std::stable_sort(joint_impulses.begin(), joint_impulses.end(), earlier);
  }
  std::int64_t last = 0, number = -1;
  for (std::size_t i = 0; i < events.size(); ++i) {
    const std::int64_t instant = events.instant(i);
    if (number < 0 || instant != last) ++number;
    last = instant;
    events.set_instant(i, number);
  }
}

void EventBalance::order_events() { events.order(order_); }

EventRecord& EventBalance::record(EventKind kind, double time, const ConstraintHead& contact,
                                  const Assembly& assembly) {
  ++counts[static_cast<std::size_t>(kind)];
  EventRecord& event = fresh.emplace_back();
  event.time = time;
  event.kind = kind;
  event.instant = instant_;
  if (contact.bodies == 0) return event;
  event.contact = contact.key;
  set_parties(contact, assembly, event);
  return event;
}

void EventBalance::note_before(const IslandProblem& problem, const StateView& state,
                               const Assembly& assembly) {
  motions_.clear();
  if (!keeping.records) return;
  for (const Constraint& contact : problem.constraints()) {
    motions_.push_back(motions_of(contact, state, assembly));
  }
}

double EventBalance::book(const SolvedImpact& impact, const Assembly& assembly) {
  const IslandProblem& problem = impact.problem;
  ImpulseWork work;
  const std::size_t first = fresh.size();
  for (std::size_t c = 0; c < problem.constraints().size(); ++c) {
    const Constraint& contact = problem.constraints()[c];
    if (contact.normals == 0) {
      book_without_normal(impact, c, work);
      continue;
    }
    EventRecord& event = record(impact.kind, impact.time, contact, assembly);
    static_cast<ImpactNote&>(event) = impact.note;
    for (int row = 0; row < contact.rows; ++row) {
      const auto at = static_cast<std::size_t>(row);
      const auto place = static_cast<std::size_t>(problem.first_row(c) + row);
      const double before = problem.before()[place], after = contact.velocity(row, impact.velocity);
      const double impulse = problem.impulses()[place];
      event.velocity_before[at] = before / contact.of_joint.length;
      event.velocity_after[at] = after / contact.of_joint.length;
      event.impulse[at] = contact.of_joint.length * impulse;
      const double of_row = work.add(impulse, before, after);
      event.contact_work += of_row;
      flows[line_of(impact.kind, row)] -= of_row;
      flows[EnergyFlow::external] += impulse * contact.surface_velocity[at];
    }
    if (keeping.records) {
      event.motions = motions_[c];
      read_contact_frame(contact, event.motions[0].position.data(), event);
      event.gap = contact.gap / contact.of_joint.length;
      set_after(contact, impact.velocity, assembly, event.motions);
    }
    event.energy_before = impact.energy_before;
    event.energy_after = impact.energy_after;
    event.mode = problem.modes()[c];
    event.outcome = problem.report().outcome;
    event.residual = problem.report().residual;
    event.solver = problem.report().solver;
    event.accumulation_time = impact.accumulation_time;
  }
  if (impact.note.cut_sequence) ++tally.cut_sequences;
  if (impact.note.restitution_factor < problem.restitution_factor()) ++tally.scaled_impacts;
  if (problem.restitution_factor() == 0.0) ++tally.plastic_jams;
  if (!work.is_gain()) return 0.0;
  for (std::size_t i = first; i < fresh.size(); ++i) fresh[i].energy_gain = work.gain;
  energy_gain += work.gain;
  return work.gain;
}

/// Friction in a joint, or rolling resistance, which is in the record of the contact before it.
void EventBalance::book_without_normal(const SolvedImpact& impact, std::size_t c, ImpulseWork& sum) {
  const Constraint& at = impact.problem.constraints()[c];
  const ImpulseMap map = impact.problem.map();
  const double impulse = map.impulse(c, 0);
  const double work = sum.add(impulse, map.before(c, 0), at.tangential_velocity(impact.velocity));
  if (!at.attached) {
    sum.allow_for_joint_friction(impulse, map.before(c, 0));
    flows[EnergyFlow::joint_friction] -= work;
    return;
  }
  EventRecord& event = fresh.back();
  event.rolling_moment = at.of_joint.length * impulse;
  event.contact_work += work;
  flows[line_of_rolling(impact.kind)] -= work;
  flows[EnergyFlow::external] += impulse * at.surface_velocity[0];
}

void EventBalance::book_joints(const SolvedImpact& impact, const GroupModel& model, JointReactions& joints,
                               const MotionSample& at) {
  if (joints.rows().empty()) return;
  const std::span<const double> multipliers = joints.impulses(impact.problem);
  // Prescribed coordinates move on: G v = -rate before and after.
  for (std::size_t i = 0; i < multipliers.size(); ++i) {
    flows[EnergyFlow::external] -= multipliers[i] * joints.rows().rate(i);
  }
  list_joint_impulses(multipliers, impact.time, model, at);
  const IslandProblem& problem = impact.problem;
  for (std::size_t c = 0; c < problem.constraints().size(); ++c) {
    const Constraint& contact = problem.constraints()[c];
    if (!contact.has_given_bound()) continue;
    JointReaction reaction;
    reaction.moment = contact.of_joint.length * problem.map().impulse(c, 0);
    const JointId friction{contact.key.a.serial, model.assembly->system().token()};
    joint_impulses.push_back({friction, reaction, impact.time});
  }
}

void EventBalance::list_joint_impulses(std::span<const double> multipliers, double time,
                                       const GroupModel& model, const MotionSample& at) {
  const Assembly& assembly = *model.assembly;
  std::size_t row = 0;
  const auto list = [&](Index k, Range range) {
    const JointKind& kind = *assembly.joint_kinds()[k];
    for (Index joint = range.begin; joint < range.end; ++joint, row += kind.rows()) {
      const double* const of_joint = multipliers.data() + row;
      if (std::all_of(of_joint, of_joint + kind.rows(), [](double number) { return number == 0.0; }))
        continue;
      joint_impulses.push_back(
          {assembly.joint_id(k, joint), kind.reaction(at.joint_view(), joint, of_joint), time});
    }
  };
  for (const auto& part : model.parts()) {
    for (Index k = 0; k < assembly.joint_kinds().size(); ++k) list(k, assembly.joints(part.component, k));
  }
}

}  // namespace carom
