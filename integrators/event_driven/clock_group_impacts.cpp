// Problem: impacts at one instant, where they come from and where they lead to: accumulations, the ledger.

#include <carom/contact/impact_restitution.h>
#include <carom/core/dynamics/prescribed_joints.h>
#include <carom/integrators/event_driven/clock_group.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace carom {

namespace {

// Impacts of one instant: each takes energy out or hands it on, so that more than this do not happen but by
// e = 1 in a corner.
constexpr int most_impacts_at_once = 10000;

/// Line of the ledger for the work of an impact along a row of a contact.
EnergyFlow line_of(EventKind kind, int row) {
  if (kind == EventKind::accumulation) return EnergyFlow::accumulation;
  if (kind == EventKind::impact_without_collision) return EnergyFlow::impact_without_collision;
  return row == 0 ? EnergyFlow::impact_normal : EnergyFlow::impact_tangential;
}

}  // namespace

/// Which contact approaches fastest, for messages: "... approaches at 0.1 m/s, ...".
std::string ClockGroup::record_approach(const std::vector<Constraint>& contacts,
                                        const double* velocity) const {
  const auto slower = [&](const Constraint& a, const Constraint& b) {
    return a.normal_velocity(velocity) > b.normal_velocity(velocity);
  };
  const Constraint& fastest = *std::max_element(contacts.begin(), contacts.end(), slower);
  return detector_->name(fastest.key) + " approaches at " + to_text(-fastest.normal_velocity(velocity)) +
         " m/s; allowed: what impulses of all that touch can stop";
}

/// Impacts at this instant, group by group, until nothing that touches approaches. True if there was one.
bool ClockGroup::resolve_impacts(EventBalance& balance) {
  const auto& pairs = motion_.pairs();
  bool struck = false;
  for (int round = 0; round < most_impacts_at_once; ++round) {
    bool any = false;
    for (std::size_t first = 0; first < pairs.size();) {
      std::size_t last = first;
      double fastest = 0.0;
      const Index group = motion_.mechanism(pairs[first].body);
      for (; last < pairs.size() && motion_.mechanism(pairs[last].body) == group; ++last) {
        if (!touches(last)) continue;
        fastest = std::max(fastest, -work_->contacts[last].normal_velocity(work_->motion.trial.v.data()));
      }
      if (fastest > speed_noise()) {
        resolve_body(first, last, fastest, balance);
        any = struck = true;
      }
      first = last;
    }
    if (!any) return struck;
  }
  std::vector<std::string> names;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (touches(i)) names.push_back(detector_->name(work_->contacts[i].key));
  }
  fail("impacts at one instant do not come to an end, more than " + std::to_string(most_impacts_at_once) +
           " (restitution of 1, or unequal ones, where contacts hand on the motion)",
       std::move(names));
}

void ClockGroup::resolve_body(std::size_t first, std::size_t last, double fastest, EventBalance& balance) {
  double* const velocity = work_->motion.trial.v.data();
  std::vector<Constraint>& touching = work_->touching;
  touching.clear();
  for (std::size_t i = first; i < last; ++i) {
    if (!touches(i)) continue;
    // Friction in a joint that is bound by a constant has no impulse.
    if (work_->contacts[i].has_dry_friction() && !motion_.depends_on_joint_force(work_->contacts[i]))
      continue;
    Constraint& contact = touching.emplace_back(work_->contacts[i]);
    contact.friction_bound = 0.0;
    contact.friction = contact.law.friction_at(contact.sliding_speed(velocity));
    // Before the jump of a driver it did not approach: there is nothing to give back.
    if (jumped_ && is_active_[i] != 0) {
      contact.law.normal_restitution = contact.law.tangential_restitution = 0.0;
    }
  }
  share_impact_restitution(touching, velocity, 0.0);
  const bool captured = fastest <= options_.capture_speed;
  if (captured) take_captured(first, last);
  const double energy_before = motion_.kinetic_energy(touching.front().body());
  IslandProblem& cluster = work_->cluster;
  cluster.build(touching, velocity);
  motion_.respond(cluster);
  cluster.set_free_velocity(velocity);
  const bool solved = motion_.solve(cluster, touching, work_->chain);
  // Slower than the capture speed all that touches closes anyway.
  if (!solved && captured) cluster.forget_impulses();
  if (!solved && !captured) {
    std::vector<std::string> names;
    names.reserve(touching.size());
    for (const Constraint& contact : touching) names.push_back(detector_->name(contact.key));
    std::string what = "the contact problem of an impact is not solved (" +
                       std::string(to_string(cluster.report().outcome)) +
                       driven_by(*assembly_, motion_.component()) + ")";
    if (cluster.report().outcome == Outcome::no_solution) what += "; " + record_approach(touching, velocity);
    fail(what, std::move(names), &cluster);
  }
  cluster.map().add_velocities(velocity);
  const Range v = assembly_->components()[motion_.component()].v;
  std::copy(velocity + v.begin, velocity + v.end,
            y_.begin() + static_cast<std::ptrdiff_t>(motion_.v_begin()));
  book_impact(captured ? EventKind::accumulation : EventKind::impact, energy_before, balance);
  if (captured) close_captured(balance);
}

/// Adds contacts that are about to close too, and takes the restitution out of all.
void ClockGroup::take_captured(std::size_t first, std::size_t last) {
  const MotionWorkspace& work = work_->motion;
  const double limit = options_.capture_speed * options_.capture_speed;
  for (std::size_t i = first; i < last; ++i) {
    if (touches(i)) continue;
    const Constraint& contact = work_->contacts[i];
    // Almost without loads what is slow is far off all the same.
    if (contact.gap > options_.gap_tolerance) continue;
    const double speed = contact.normal_velocity(work.trial.v.data());
    const double fall = contact.normal_acceleration(work.acceleration.data());
    if (fall < 0.0 && speed * speed - 2.0 * contact.gap * fall <= limit) work_->touching.push_back(contact);
  }
  for (Constraint& contact : work_->touching) {
    contact.law.normal_restitution = contact.law.tangential_restitution = 0.0;
  }
}

/// Takes what is left of the normal velocities and gaps of captured contacts.
void ClockGroup::close_captured(EventBalance& balance) {
  MotionWorkspace& work = work_->motion;
  std::vector<ActiveContact>& list = capture_.list();
  const double* const velocity = work.trial.v.data();
  // A body that rocks and slides within the rounding of its gaps would do so for ever: what the projection
  // lifts it by, it falls again.
  double fall = 0.0;
  for (const Constraint& contact : work_->touching) {
    fall = std::max(fall, std::abs(contact.normal_acceleration(work.acceleration.data())));
  }
  const double rounding = std::sqrt(2.0 * 4.0 * gap_noise_ * fall);
  for (const bool stopping : {true, false}) {
    list.clear();
    for (const Constraint& contact : work_->touching) {
      if (contact.has_dry_friction() || contact.normal_velocity(velocity) > options_.capture_speed) continue;
      ActiveContact& closed = list.emplace_back();
      const bool stops = stopping && contact.rows > 1 && contact.sliding_speed(velocity) <= rounding;
      closed.mode = stops ? ContactMode::stick : ContactMode::slip_positive;
      closed.at = contact;
    }
    motion_.active().list().swap(list);
    bool changed = false;
    balance.flows[EnergyFlow::accumulation] += motion_.project(y_, changed, balance.shift);
    motion_.active().list().swap(list);
    if (!changed) return;
    motion_.evaluate(time_, y_.data(), false);
    locate_contacts();
    // To stop one may be to move another, in almost singular positions: then it may not be stopped.
    const bool closes = std::all_of(list.begin(), list.end(), [&](const ActiveContact& closed) {
      return std::abs(closed.at.normal_velocity(velocity)) <= speed_noise();
    });
    if (closes) return;
  }
}

void ClockGroup::book_impact(EventKind kind, double energy_before, EventBalance& balance) {
  const IslandProblem& cluster = work_->cluster;
  const MotionWorkspace& work = work_->motion;
  double gain = 0.0, scale = 0.0;
  const double energy_after = motion_.kinetic_energy(cluster.constraints().front().body());
  // Before those of this instant are remembered.
  const double pile_up =
      kind == EventKind::accumulation ? accumulation_time() : std::numeric_limits<double>::quiet_NaN();
  for (std::size_t c = 0; c < cluster.constraints().size(); ++c) {
    const Constraint& contact = cluster.constraints()[c];
    if (contact.has_dry_friction()) {
      const auto place = static_cast<std::size_t>(cluster.first_row(c));
      const double before = cluster.before()[place], after = contact.tangential_velocity(work.trial.v.data());
      const double gained = 0.5 * cluster.impulses()[place] * (before + after);
      gain += gained;
      scale += std::abs(cluster.impulses()[place]) * (std::abs(before) + std::abs(after));
      balance.flows[EnergyFlow::joint_friction] -= gained;
      continue;
    }
    EventRecord& event = record(kind, contact, balance);
    for (int row = 0; row < contact.rows; ++row) {
      const auto at = static_cast<std::size_t>(row);
      const auto place = static_cast<std::size_t>(cluster.first_row(c) + row);
      const double before = cluster.before()[place], after = contact.velocity(row, work.trial.v.data());
      const double impulse = cluster.impulses()[place];
      event.velocity_before[at] = before;
      event.velocity_after[at] = after;
      event.impulse[at] = impulse;
      const double gained = 0.5 * impulse * (before + after);
      gain += gained;
      scale += std::abs(impulse) * (std::abs(before) + std::abs(after));
      balance.flows[line_of(kind, row)] -= gained;
      balance.flows[EnergyFlow::external] += impulse * contact.surface_velocity[at];
    }
    event.energy_before = energy_before;
    event.energy_after = energy_after;
    event.mode = cluster.modes()[c];
    event.outcome = cluster.report().outcome;
    event.residual = cluster.report().residual;
    event.solver = cluster.report().solver;
    event.accumulation_time = pile_up;
    if (event.impulse[0] > 0.0) remember_impact(contact.key);
  }
  record_joints(balance);
  constexpr double rounding = 1e-13;  // of the sum of works
  if (!(gain > rounding * scale)) return;
  balance.energy_gain += gain;
  if (!options_.refuse_energy_gain) return;
  std::vector<std::string> names;
  names.reserve(cluster.constraints().size());
  for (const Constraint& contact : cluster.constraints()) names.push_back(detector_->name(contact.key));
  fail("an impact adds " + to_text(gain) + " J, which refuse_energy_gain forbids", std::move(names),
       &cluster);
}

/// What joints did in the impact just solved.
void ClockGroup::record_joints(EventBalance& balance) {
  JointConstraints& joints = motion_.joints();
  if (joints.empty()) return;
  MotionWorkspace& work = work_->motion;
  const Range v = joints.velocities();
  std::fill(work.of_velocity.begin() + v.begin, work.of_velocity.begin() + v.end, 0.0);
  work_->cluster.map().add_loads(1.0, work.of_velocity.data());
  joints.apply_inverse_mass(work.of_velocity.data());
  work.multipliers.resize(joints.size());
  joints.project(JointLevel::change, work.of_velocity.data(), work.multipliers.data());
  // What is prescribed moves on: G v = -rate before and after.
  for (std::size_t i = 0; i < joints.size(); ++i) {
    balance.flows[EnergyFlow::external] -= work.multipliers[i] * joints.rate(i);
  }
  list_impulses(balance);
  for (std::size_t c = 0; c < work_->cluster.constraints().size(); ++c) {
    const Constraint& contact = work_->cluster.constraints()[c];
    if (!contact.has_dry_friction()) continue;
    JointReaction reaction;
    reaction.moment = work_->cluster.impulses()[static_cast<std::size_t>(work_->cluster.first_row(c))];
    const JointId friction{contact.key.a.serial, assembly_->system().token()};
    balance.joint_impulses.push_back({friction, reaction, time_});
  }
}

/// Impulses of joints by the multipliers in the workspace.
void ClockGroup::list_impulses(EventBalance& balance) {
  const MotionWorkspace& work = work_->motion;
  const JointView at{work.trial.view(), work.evaluation.rotation.data()};
  std::size_t row = 0;
  for (Index k = 0; k < assembly_->joint_kinds().size(); ++k) {
    const JointKind& kind = *assembly_->joint_kinds()[k];
    const Range range = assembly_->joints(motion_.component(), k);
    for (Index joint = range.begin; joint < range.end; ++joint, row += kind.rows()) {
      const double* const of_joint = work.multipliers.data() + row;
      if (std::all_of(of_joint, of_joint + kind.rows(), [](double number) { return number == 0.0; }))
        continue;
      balance.joint_impulses.push_back(
          {assembly_->joint_id(k, joint), kind.reaction(at, joint, of_joint), time_});
    }
  }
}

void ClockGroup::remember_impact(const ConstraintKey& contact) {
  if (!last_impacts_.empty() && last_impacts_.back().time == time_ && last_impacts_.back().contact == contact)
    return;
  if (last_impacts_.size() == remembered) last_impacts_.erase(last_impacts_.begin());
  last_impacts_.push_back({time_, contact});
}

/// Where the pattern of contacts repeats (by one to four impacts) and its intervals shrink in a settled ratio
/// r, the sum of all that would follow the last interval D is D r/(1 - r).
double ClockGroup::accumulation_time() const {
  constexpr double settled = 1e-3;
  const std::size_t n = last_impacts_.size();
  for (std::size_t period = 1; period <= 4 && 3 * period + 1 <= n; ++period) {
    bool repeats = true;
    for (std::size_t i = 1; i <= 2 * period; ++i) {
      repeats = repeats && last_impacts_[n - i].contact == last_impacts_[n - i - period].contact;
    }
    if (!repeats) continue;
    const auto time = [&](std::size_t back) { return last_impacts_[n - 1 - back * period].time; };
    const double last = time(0) - time(1), before = time(1) - time(2), earlier = time(2) - time(3);
    const double ratio = last / before;
    if (!(ratio < 1.0) || !(std::abs(ratio - before / earlier) <= settled)) continue;
    // The impact at hand ends an interval that began with its like, a pattern ago.
    const double since = time_ - last_impacts_[n - period].time;
    return time_ + since * ratio / (1.0 - ratio);
  }
  return std::numeric_limits<double>::quiet_NaN();
}

}  // namespace carom
