// Problem: tell the ledger and the report what the impulses of contacts, limits and friction in joints did.

#include <carom/contact/contact_point.h>
#include <carom/contact/contact_velocity.h>
#include <carom/contact/fetch_contact.h>
#include <carom/integrators/time_stepping/step_balance.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <vector>

namespace carom {

namespace {

constexpr std::size_t ahead = 8;  // contacts

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

/// Work of the contacts and limits of a problem so far, and whether one of them is an impact.
struct BookedWork {
  ImpulseWork sum;
  bool impact = false;
};

/// Books the contacts and limits of one problem: what they share is looked up once.
class ContactBooking {
public:
  /// \param after velocities at the end as contact sees them \param time when that is [s]
  ContactBooking(const Assembly& assembly, const IslandProblem& problem, const double* after, double time,
                 const StepInput& in, double capture_speed, StepResult& result)
      : bodies_(assembly.layout()->bodies()),
        token_(assembly.layout()->token()),
        token_of_system_(assembly.system().token()),
        problem_(problem),
        constraints_(problem.constraints()),
        modes_(problem.modes()),
        before_(problem.before().data()),
        impulses_(problem.impulses().data()),
        after_(after),
        q_(in.start.q.data()),
        time_(time),
        within_step_(time < in.end_time),
        is_swept_(problem.problem().is_factored()),
        capture_speed_(capture_speed),
        result_(result) {}

  /// \param contact number of its constraint \param first its first row
  void book(std::size_t contact, std::size_t first, BookedWork& work) const {
    const Constraint& at = constraints_[contact];
    const BodySlot body = bodies_[at.body()];
    if (is_swept_) fetch_contact_ahead(constraints_, contact + ahead);
    std::vector<ContactRecord>& records = result_.report.contacts;
    fetch_ahead(std::span(records.data(), records.capacity()), records.size() + ahead);
    ContactRecord& entry = records.emplace_back();
    name(at, contact, body.serial, entry);
    // Else an impact within the step, or contact up to it.
    if (!within_step_) result_.contact_modes.emplace_back(at.key, entry.mode);
    find_point_of_contact(at, q_ + body.q, entry.point, entry.normal);
    entry.impact = before_[first] < -capture_speed_;
    work.impact = work.impact || entry.impact;
    result_.tally.impacts += entry.impact ? 1 : 0;
    result_.tally.deepest_gap = std::min(result_.tally.deepest_gap, at.gap);
    book_rows(at, before_ + first, impulses_ + first, work.sum, entry);
  }

private:
  /// Which contact it is, and how its problem was solved. \param serial of its first body
  void name(const Constraint& at, std::size_t contact, Index serial, ContactRecord& entry) const {
    entry.key = at.key;
    entry.body = {serial, token_};
    if (at.type == ConstraintType::contact && at.bodies == 2) {
      entry.other = {bodies_[at.blocks[1].body].serial, token_};
    }
    if (at.key.b.owner == FeatureKey::Owner::obstacle) entry.obstacle = {at.key.b.serial, token_of_system_};
    entry.directions = at.rows;
    entry.gap = at.gap;
    entry.mode = modes_[contact];
    const ContactReport& report = problem_.report();
    entry.outcome = report.outcome;
    entry.residual = report.residual;
    entry.solver = report.solver;
    entry.restitution_factor = problem_.restitution_factor();
    entry.time = time_;
  }

  /// Works of its rows. \param before,impulses by row
  void book_rows(const Constraint& at, const double* before, const double* impulses, ImpulseWork& sum,
                 ContactRecord& entry) const {
    const std::array<double, 3> with = velocities_after(at, after_);
    ImpulseWork works = sum;
    double all = 0.0, on_surface = 0.0;
    const auto book_row = [&](std::size_t i) {  // a loop over two or three costs more than they do
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
    EnergyFlows& flows = result_.flows;
    flows[entry.impact ? EnergyFlow::impact_normal : EnergyFlow::contact_normal] -= book_row(0);
    double& tangential = flows[entry.impact ? EnergyFlow::impact_tangential : EnergyFlow::sliding];
    if (at.rows > 1) tangential -= book_row(1);
    if (at.rows > 2) tangential -= book_row(2);
    sum = works;
    entry.contact_work += all;
    if (on_surface != 0.0) flows[EnergyFlow::external] += on_surface;
  }

  const BodySlots& bodies_;
  Index token_, token_of_system_;
  const IslandProblem& problem_;
  std::span<const Constraint> constraints_;
  std::span<const ContactMode> modes_;
  const double *before_, *impulses_, *after_, *q_;
  double time_;
  bool within_step_, is_swept_;
  double capture_speed_;
  StepResult& result_;
};

/// Keeps the impulses of a constraint, from which the next step starts. \param impulses by row
void keep_impulses(const Constraint& at, const double* impulses, ContactHistory& out) {
  out.add(at.key, {impulses[0], at.rows > 1 ? impulses[1] : 0.0});
}

/// Marks where the residual of a problem is taken, unless that is at friction in a joint.
/// \param records of its contacts and limits
void mark_worst(const IslandProblem& problem, std::span<ContactRecord> records) {
  std::size_t record = 0;
  int group = 0;
  for (const Constraint& at : problem.constraints()) {
    if (at.type == ConstraintType::rolling) continue;  // of the group and the record of its contact
    const bool recorded = !at.has_dry_friction();
    if (group++ == problem.report().worst_group) {
      if (recorded) records[record].worst = true;
      return;
    }
    if (recorded) ++record;
  }
}

}  // namespace

void ContactTally::add(const ContactTally& other) {
  impacts += other.impacts;
  several_solutions += other.several_solutions;
  forces_not_unique += other.forces_not_unique;
  deepest_gap = std::min(deepest_gap, other.deepest_gap);
  worst_residual = std::max(worst_residual, other.worst_residual);
}

double StepBalance::book_contacts(const IslandProblem& problem, const double* after, double time,
                                  const StepInput& in, const StepTrial& trial) {
  BookedWork work;
  const std::size_t first = result_.report.contacts.size();
  const bool is_swept = problem.problem().is_factored();
  const ContactBooking booking(*assembly_, problem, after, time, in, capture_speed_, result_);
  const std::span<const Constraint> constraints = problem.constraints();
  for (std::size_t contact = 0; contact < constraints.size(); ++contact) {
    const Constraint& at = constraints[contact];
    const auto row = static_cast<std::size_t>(problem.first_row(contact));
    if (is_swept) keep_impulses(at, problem.impulses().data() + row, result_.contacts);
    if (at.type == ConstraintType::rolling) {
      book_rolling(problem, contact, after, work.sum);
    } else if (at.has_dry_friction()) {
      book_joint_friction(problem, contact, after, trial, work.sum);
    } else {
      booking.book(contact, row, work);
    }
  }
  tally(problem, static_cast<int>(result_.report.contacts.size() - first));
  if (problem.report().outcome == Outcome::accepted_at_cap) {
    mark_worst(problem, std::span(result_.report.contacts).subspan(first));
  }
  if (problem.restitution_factor() == 0.0) ++result_.plastic_jams;
  if (!(work.sum.gain > 0.0)) return 0.0;
  const double gain = book_gain(problem, work.sum, work.impact, trial);
  if (gain > 0.0) {
    for (std::size_t i = first; i < result_.report.contacts.size(); ++i)
      result_.report.contacts[i].energy_gain = gain;
  }
  return gain;
}

/// Counts what the contacts of a problem have in common. \param contacts how many
void StepBalance::tally(const IslandProblem& problem, int contacts) {
  if (contacts == 0) return;
  const ContactReport& report = problem.report();
  ContactTally& sum = result_.tally;
  if (report.outcome == Outcome::several_solutions) sum.several_solutions += contacts;
  if (report.outcome == Outcome::forces_not_unique) sum.forces_not_unique += contacts;
  sum.worst_residual = std::max(sum.worst_residual, report.residual);
}

double StepBalance::book_impact(const IslandProblem& problem, const double* after, const ImpactNote& note,
                                const StepInput& in, const StepTrial& trial) {
  const std::size_t first = result_.report.contacts.size();
  const double gain = book_contacts(problem, after, in.start.time, in, trial);
  if (note.cut_sequence) ++result_.cut_sequences;
  if (note.restitution_factor < problem.restitution_factor()) ++result_.scaled_impacts;
  for (std::size_t i = first; i < result_.report.contacts.size(); ++i) {
    ContactRecord& entry = result_.report.contacts[i];
    if (!entry.impact) ++result_.tally.impacts;
    entry.impact = true;
    entry.restitution_factor = note.restitution_factor;
    entry.cut_sequence = note.cut_sequence;
  }
  return gain;
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
    const std::span<const Constraint> contacts = problem.constraints();
    for (std::size_t c = 0; c < contacts.size(); ++c) {
      const Constraint& contact = contacts[c];
      fetch_contact_ahead(contacts, c + ahead);
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

}  // namespace carom
