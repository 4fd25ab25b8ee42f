// Problem: tell the ledger and the report what the impulses of contacts, limits and friction in joints did.

#include <carom/contact/contact_parties.h>
#include <carom/contact/contact_velocity.h>
#include <carom/contact/fetch_contact.h>
#include <carom/integrators/time_stepping/mode_after.h>
#include <carom/integrators/time_stepping/start_keeper.h>
#include <carom/integrators/time_stepping/step_balance.h>

#include <algorithm>
#include <array>
#include <span>
#include <string_view>
#include <vector>

namespace carom {

namespace {

constexpr std::size_t ahead = 8;  // contacts

/// Work of the contacts and limits of a problem so far, and whether one of them is an impact.
struct BookedWork {
  ImpulseWork sum;
  bool impact = false;
};

/// Answer of a contact or limit, as its problem gives it. Numbers by row.
struct ContactAnswer {
  const double* before;
  const double* impulses;
  ContactMode mode;
  double residual;
};

/// Common to all contacts and limits that are booked together.
struct CommonAnswer {
  double time;                        // [s]
  std::span<const GroundJump> jumps;  // of velocities of ground shapes, before the impulses
  Outcome outcome;
  std::string_view solver;
  double restitution_factor;
};

/// Books contacts and limits. Most problems have one: nothing is made ready for others.
class ContactBooking {
public:
  /// \param after velocities at the end as contact sees them
  ContactBooking(const Assembly& assembly, const double* after, const CommonAnswer& common,
                 const StepInput& in, StepResult& result)
      : assembly_(assembly), after_(after), common_(common), in_(in), result_(result) {}

  void book(const Constraint& at, const ContactAnswer& answer, double capture_speed, BookedWork& work) const {
    result_.fetch_records(ahead);
    const std::array<double, 3> jump = jump_of(at);
    const double* const before = answer.before;
    const bool impact = before[0] - jump[0] < -capture_speed;
    work.impact = work.impact || impact;
    ContactTally& tally = result_.tally;
    tally.impacts += impact ? 1 : 0;
    tally.deepest_gap = std::min(tally.deepest_gap, at.gap);
    ContactRecord& entry = result_.next_record();
    entry.mode = answer.mode;
    entry.impact = impact;
    write_place(at, assembly_, in_.start.q.data(), entry);
    write_answer(answer, entry);
    book_rows(at, {before, jump.data()}, answer.impulses, work.sum, entry);
    const bool is_last = !(common_.time < in_.end_time);  // else an impact, or contact up to it
    if (is_last) result_.contact_modes.emplace_back(at.key, mode_after(at, entry, after_));
    if (at.of_joint.length != 1.0) tell_in_coordinate(at, entry);
  }

private:
  /// Numbers of a row with an arm, in the unit of its coordinate.
  static void tell_in_coordinate(const Constraint& at, ContactRecord& entry) {
    entry.gap /= at.of_joint.length;
    entry.velocity_before[0] /= at.of_joint.length;
    entry.velocity_after[0] /= at.of_joint.length;
    entry.impulse[0] *= at.of_joint.length;
  }

  /// When it acted, and how its problem was solved. The rest of the note is of whole impacts, and of rows
  /// that come behind.
  void write_answer(const ContactAnswer& answer, ContactRecord& entry) const {
    entry.time = common_.time;
    entry.outcome = common_.outcome;
    entry.residual = answer.residual;
    entry.solver = common_.solver;
    entry.restitution_factor = common_.restitution_factor;
    entry.energy_gain = entry.rolling_moment = 0.0;
    entry.cut_sequence = entry.worst = false;
  }

  /// Velocities along rows before an impulse, and by how much the ground has jumped behind these.
  struct Before {
    const double* velocity;
    const double* jump;
  };

  [[nodiscard]] std::array<double, 3> jump_of(const Constraint& at) const {
    if (common_.jumps.empty()) return {};
    const BodySlot body = assembly_.layout()->bodies()[at.body()];
    return jump_along_rows(common_.jumps, at, in_.start.q.data() + body.q);
  }

  /// Works of its rows. \param impulses by row
  void book_rows(const Constraint& at, const Before& before, const double* impulses, ImpulseWork& sum,
                 ContactRecord& entry) const {
    const std::array<double, 3> with = velocities_after(at, after_);
    ImpulseWork works = sum;
    double all = 0.0, on_surface = 0.0;
    const auto book_row = [&](std::size_t i) {  // a loop over two or three costs more than they do
      const double impulse = impulses[i], gamma = before.velocity[i] - before.jump[i];
      const double work = works.add(impulse, gamma, with[i]);
      all += work;
      on_surface +=
          impulse_work(impulse, at.surface_velocity[i] + before.jump[i], at.surface_velocity_after[i]);
      entry.velocity_before[i] = gamma;
      entry.velocity_after[i] = with[i];
      entry.impulse[i] = impulse;
      entry.work[i] = work;
      return work;
    };
    const auto leave_out = [&](std::size_t i) {
      entry.velocity_before[i] = entry.velocity_after[i] = entry.impulse[i] = entry.work[i] = 0.0;
    };
    EnergyFlows& flows = result_.flows;
    flows[entry.impact ? EnergyFlow::impact_normal : EnergyFlow::contact_normal] -= book_row(0);
    double& tangential = flows[entry.impact ? EnergyFlow::impact_tangential : EnergyFlow::sliding];
    if (at.rows > 1) {
      tangential -= book_row(1);
    } else {
      leave_out(1);
    }
    if (at.rows > 2) {
      tangential -= book_row(2);
    } else {
      leave_out(2);
    }
    sum = works;
    entry.contact_work = all;
    if (on_surface != 0.0) flows[EnergyFlow::external] += on_surface;
  }

  const Assembly& assembly_;
  const double* after_;
  CommonAnswer common_;
  const StepInput& in_;
  StepResult& result_;
};

/// Marks where the residual of a problem is taken, unless that is at friction in a joint.
/// \param records of its contacts and limits
void mark_worst(const IslandProblem& problem, std::span<ContactRecord> records) {
  std::size_t record = 0;
  int group = 0;
  for (const Constraint& at : problem.constraints()) {
    if (at.attached) continue;  // in the group and the record of the one before it
    const bool recorded = at.normals > 0;
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
  const std::size_t first = result_.recorded;
  const bool is_swept = problem.problem().is_factored();
  const ContactReport& report = problem.report();
  const ContactBooking booking(*assembly_, after,
                               {time, jumps_, report.outcome, report.solver, problem.restitution_factor()},
                               in, result_);
  const std::span<const Constraint> constraints = problem.constraints();
  const std::span<const ContactMode> modes = problem.modes();
  const double *const before = problem.before().data(), *const impulses = problem.impulses().data();
  StartKeeper starts(in.companion.contacts, problem, result_.contacts);
  for (std::size_t contact = 0; contact < constraints.size(); ++contact) {
    const Constraint& at = constraints[contact];
    const auto row = static_cast<std::size_t>(problem.first_row(contact));
    if (starts.are_kept()) starts.keep(at, impulses + row);
    if (at.attached) {
      book_rolling(problem, contact, after, in, work.sum);
    } else if (at.normals == 0) {
      book_joint_friction(problem, contact, after, trial, work.sum);
    } else {
      if (is_swept) fetch_contact_ahead(constraints, contact + ahead);
      booking.book(at, {before + row, impulses + row, modes[contact], report.residual}, capture_speed_, work);
    }
  }
  tally(problem, static_cast<int>(result_.recorded - first));
  if (problem.report().outcome == Outcome::accepted_at_cap) {
    mark_worst(problem, result_.records().subspan(first));
  }
  if (problem.restitution_factor() == 0.0) ++result_.plastic_jams;
  if (!(work.sum.gain > 0.0)) return 0.0;
  const double gain = book_gain(constraints, problem.problem().vector().data(), problem.impulses().data(),
                                work.sum, work.impact, trial);
  if (gain > 0.0) {
    for (ContactRecord& entry : result_.records().subspan(first)) entry.energy_gain = gain;
  }
  return gain;
}

void StepBalance::book_lone(const LoneContacts& contacts, const double* after, const StepInput& in,
                            const StepTrial& trial, FunctionRef<bool(Index body)> leaves_out) {
  constexpr std::string_view solver = solver_names[static_cast<std::size_t>(SolverId::single_contact)];
  const ContactBooking booking(*assembly_, after, {in.end_time, jumps_, Outcome::solved, solver, 1.0}, in,
                               result_);
  const std::span<const Constraint> constraints = contacts.constraints();
  double worst = result_.tally.worst_residual;
  for (std::size_t i = 0; i < constraints.size(); ++i) {
    if (leaves_out && leaves_out(constraints[i].body())) continue;
    const LoneAnswer& answer = contacts.answers()[i];
    BookedWork work;
    booking.book(constraints[i], {answer.before.data(), answer.impulse.data(), answer.mode, answer.residual},
                 capture_speed_, work);
    worst = std::max(worst, answer.residual);
    if (!(work.sum.gain > 0.0)) continue;
    const double gain = book_gain(constraints.subspan(i, 1), answer.b.data(), answer.impulse.data(), work.sum,
                                  work.impact, trial);
    if (gain > 0.0) result_.records().back().energy_gain = gain;
  }
  result_.tally.worst_residual = worst;
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
  const std::size_t first = result_.recorded;
  const double gain = book_contacts(problem, after, in.start.time, in, trial);
  if (note.cut_sequence) ++result_.cut_sequences;
  if (note.restitution_factor < problem.restitution_factor()) ++result_.scaled_impacts;
  for (ContactRecord& entry : result_.records().subspan(first)) {
    if (!entry.impact) ++result_.tally.impacts;
    entry.impact = true;
    entry.restitution_factor = note.restitution_factor;
    entry.cut_sequence = note.cut_sequence;
  }
  return gain;
}

void StepBalance::tell_cut(std::size_t records) {
  ++result_.cut_sequences;
  for (ContactRecord& entry : result_.records().last(records)) entry.cut_sequence = true;
}

/// Rolling resistance, in the record of the contact before it.
void StepBalance::book_rolling(const IslandProblem& problem, std::size_t contact, const double* after,
                               const StepInput& in, ImpulseWork& sum) {
  const Constraint& at = problem.constraints()[contact];
  const auto row = static_cast<std::size_t>(problem.first_row(contact));
  const double moment = problem.impulses()[row];
  double jump = 0.0;
  if (!jumps_.empty()) {
    const BodySlot body = assembly_->layout()->bodies()[at.body()];
    jump = jump_along_rows(jumps_, at, in.start.q.data() + body.q)[0];
  }
  const double work = sum.add(moment, problem.before()[row] - jump, at.velocity_after(0, after));
  ContactRecord& entry = result_.records().back();
  entry.rolling_moment = at.of_joint.length * moment;
  entry.contact_work += work;
  result_.flows[EnergyFlow::rolling] -= work;
  result_.flows[EnergyFlow::external] +=
      impulse_work(moment, at.surface_velocity[0] + jump, at.surface_velocity_after[0]);
}

/// In an impact a gain is one of the law. In lasting contact the loads of the step take part, and a gain is
/// an error of the step: the law holds the velocity along the row at its start, which turns meanwhile.
/// Returns what an impact gained. \param b,impulse of the problem, by row
double StepBalance::book_gain(std::span<const Constraint> contacts, const double* b, const double* impulse,
                              const ImpulseWork& work, bool impact, const StepTrial& trial) {
  ImpulseWork sum = work;
  if (!sum.is_gain()) return 0.0;
  if (!impact) {
    // Velocities of what lasts are small differences: of those that loads alone would lead to, of the
    // velocities of the bodies, of those of the surfaces.
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

/// Friction in a joint, along its row at the start or halfway, where the trial has the mean velocities. What
/// a row that turns makes of the velocities at both ends is work of the friction too.
void StepBalance::book_joint_friction(const IslandProblem& problem, std::size_t contact, const double* after,
                                      const StepTrial& trial, ImpulseWork& sum) {
  const Constraint& at = problem.constraints()[contact];
  const double moment = problem.map().impulse(contact, 0), before = problem.map().before(contact, 0);
  const double made_up = at.surface_velocity[0] + at.surface_velocity_after[0];
  const double mean_rate = after == trial.end.v.data()
                               ? at.times(0, trial.midpoint.v.data())
                               : 0.5 * (before + at.velocity_after(0, after) + made_up);
  JointReaction reaction;
  reaction.moment = at.of_joint.length * moment;
  result_.flows[EnergyFlow::joint_friction] -= moment * mean_rate;
  sum.gain += moment * mean_rate;
  sum.scale += 2.0 * std::abs(moment) * std::max(std::abs(before), std::abs(mean_rate));
  sum.allow_for_joint_friction(moment, before);
  result_.report.joint_impulses.push_back(
      {JointId{at.key.a.serial, assembly_->system().token()}, reaction, result_.report.time});
  const ContactMode mode = problem.modes()[contact];
  result_.joint_friction_modes.emplace_back(at.key, mode == ContactMode::open ? ContactMode::stick : mode);
}

}  // namespace carom
