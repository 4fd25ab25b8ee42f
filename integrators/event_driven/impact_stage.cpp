// Problem: impacts at one instant, where they come from and where they lead to.

#include <carom/contact/pressed_bodies.h>
#include <carom/core/dynamics/answering_bodies.h>
#include <carom/integrators/event_driven/impact_stage.h>

#include <algorithm>
#include <cmath>

namespace carom {

namespace {

// Closings of slow contacts at one instant. Each stops contacts that part slowly too; where contacts jam that
// makes others approach, and so on. After these only what approaches is stopped, which ends.
constexpr int most_closings_at_once = 16;

/// True of two contacts of the same two outlines that are one: where two round corners meet, each of them
/// stands against the outline of the other.
/// \param gap_noise rounding of places, and so of levers [m]
bool is_repeated(const Constraint& contact, const Constraint& other, double gap_noise) {
  constexpr double of_directions = 1e-12, roundings = 16.0;
  const auto same_owner = [](const FeatureKey& one, const FeatureKey& two) {
    return one.owner == two.owner && one.serial == two.serial;
  };
  if (contact.rows != other.rows || contact.columns() != other.columns() ||
      !same_owner(contact.key.a, other.key.a) || !same_owner(contact.key.b, other.key.b)) {
    return false;
  }
  // Directions and levers both follow from the places of the same two corners.
  const double allowed = std::max(of_directions, roundings * gap_noise);
  return std::equal(contact.row(0), contact.row(contact.rows), other.row(0), other.row(other.rows),
                    [=](double one, double two) { return std::abs(one - two) <= allowed; });
}

const ImpactRules& rules_of(const EventInstant& at) { return at.motion.model().options->impact_rules; }

/// True of what is slow, but approaches or is about to close: it closes with what touches.
bool closes_soon(const Constraint& contact, double capture, const EventInstant& at) {
  const double speed = contact.normal_velocity(at.velocities());
  const double fall = contact.normal_acceleration(at.now.acceleration.data());
  return speed < -at.scales.speed_noise ||
         (fall < 0.0 && speed * speed - 2.0 * contact.gap * fall <= capture * capture);
}

}  // namespace

bool ImpactStage::resolve(EventInstant& at) {
  bool struck = false;
  // An island that has begun a sequence goes on with it, however slow.
  std::vector<ImpactCounts>& counts = memory_->counts;
  counts.assign(at.islands.size(), {});
  for (int round = 0; round < most_impacts_at_once; ++round) {
    bool any = false;
    for (std::size_t island = 0; island < at.islands.size(); ++island) {
      const std::span<const Index> pairs = at.islands.pairs(island);
      const double fastest = fastest_approach(pairs, at);
      if (!(fastest > at.scales.speed_noise)) continue;  // mostly: nobody asks what is slow then
      const ImpactOnset onset = onset_of(fastest, at.scales.speed_noise, capture_speed(pairs, at),
                                         counts[island].sequence, impacts_of_events);
      resolve_island(pairs, onset, counts[island], at);
      any = struck = true;
    }
    if (!any) return struck;
  }
  std::vector<std::string> names;
  for (std::size_t i = 0; i < at.contacts.size(); ++i) {
    if (at.is_struck(i)) names.push_back(failure_->name(at.contacts[i]));
  }
  failure_->fail(impacts_without_end(), std::move(names));
}

void ImpactStage::settle(EventInstant& at) {
  SettlingLimit again;  // at one instant they end anyway
  for (int round = 0; round < most_closings_at_once; ++round) {
    bool any = false;
    SettlingLimit& limit = round == 0 ? settlings_ : again;
    for (std::size_t island = 0; island < at.islands.size(); ++island) {
      any = memory_->settling.settle(at.islands.pairs(island), at, memory_->chain, limit) || any;
    }
    if (!any || !resolve(at)) return;
    at.update();
  }
}

bool ImpactStage::settle(std::span<const Index> pairs, EventInstant& at) {
  SettlingLimit alone;
  if (!memory_->settling.settle(pairs, at, memory_->chain, alone)) return false;
  if (resolve(at)) at.update();
  return true;
}

double ImpactStage::fastest_approach(std::span<const Index> pairs, const EventInstant& at) const {
  double fastest = 0.0;
  for (const Index i : pairs) {
    if (at.is_struck(i)) fastest = std::max(fastest, at.approach(i));
  }
  return fastest;
}

/// \param counts of the island at this instant before
void ImpactStage::resolve_island(std::span<const Index> pairs, ImpactOnset onset, ImpactCounts& counts,
                                 EventInstant& at) {
  const bool captured = onset == ImpactOnset::closing;
  list_touching(pairs, captured, at);
  if (!captured) leave_out_repeated(at.scales.gap_noise);
  const StrikeInput impact{.rules = rules_of(at),
                           .velocity = at.velocities(),
                           .speed_noise = at.scales.speed_noise,
                           .struck = counts.sequence,
                           .plastic = captured};
  const auto by = [&](ImpactLaw law) { return solve(law, at); };
  const Struck struck = strike(memory_->touching, impact, by);
  if (struck.outcome == Struck::Outcome::laws_differ)
    failure_->fail(laws_of_impact_differ, failure_->names(memory_->touching));
  const bool closes_slow = captured && counts.closings++ < most_closings_at_once;
  if (struck.outcome == Struck::Outcome::not_solved) {
    if (!closes_slow) fail_unsolved(*struck.problem, at);
    // Slower than the capture speed all that touches closes anyway.
    struck.problem->forget_impulses();
  }
  if (!captured && impact.rules.order == ImpactOrder::sequential) ++counts.sequence;
  memory_->note = {};
  memory_->note.cut_sequence = struck.cut_sequence;
  memory_->note.restitution_factor = struck.restitution_factor;
  apply(captured || struck.cut_sequence ? EventKind::accumulation : EventKind::impact, *struck.problem, at);
  if (closes_slow) close_captured(pairs, at);
}

/// False where there are no impulses, or none that stop what approaches.
StrikeAnswer ImpactStage::solve(ImpactLaw law, EventInstant& at) {
  IslandProblem& problem = memory_->problems.by(law);
  JointReactions& joints = at.motion.joints();
  joints.build(problem, memory_->touching, at.velocities());
  problem.set_free_velocity(at.velocities());
  const bool is_solved = joints.solve(problem, memory_->touching, at.now, memory_->chain);
  return {problem, is_solved && stops(problem)};
}

/// True if less than half is left of the approach: else impacts follow each other without end. Where bodies
/// have no room impulses grow until nothing is left against what they do: to the certificate they are an
/// answer then. Laws other than Newton's solve their own problems, one contact has its answer in closed form.
bool ImpactStage::stops(const IslandProblem& problem) {
  constexpr double most_left = 0.5;
  const ContactProblem& stated = problem.problem();
  if (&problem != &memory_->problems.by(ImpactLaw::newton) || stated.groups().size() < 2) return true;
  std::vector<double>& xi = memory_->velocities_after;
  xi.resize(problem.impulses().size());
  stated.velocities(problem.impulses(), xi);
  double approach = 0.0, left = 0.0;
  for (std::size_t row = 0; row < xi.size(); ++row) {
    if (stated.sets()[row].kind != SetKind::half_line) continue;
    approach = std::max(approach, -stated.vector()[row]);
    left = std::max(left, -xi[row]);
  }
  return left <= most_left * approach;
}

/// Lists the contacts of an impact. \param captured it is a slow one
void ImpactStage::list_touching(std::span<const Index> pairs, bool captured, const EventInstant& at) {
  ConstraintSet& touching = memory_->touching;
  touching.clear();
  memory_->places.clear();
  const double capture = captured ? capture_speed(pairs, at) : 0.0;
  bool is_listed = false;
  for (const Index i : pairs) {
    if (!at.motion.model().pairs[i].rolling)  // rolling resistance goes with its contact
      is_listed = at.is_struck(i) && (!captured || at.touches(i) || closes_soon(at.contacts[i], capture, at));
    if (!is_listed) continue;
    const bool follows_force = at.motion.joints().depends_on_joint_force(at.contacts[i]);
    if (!takes_part(at.contacts[i], impacts_of_events, follows_force)) continue;
    Constraint& contact = touching.add(at.contacts[i]);
    memory_->places.push_back(i);
    contact.of_joint.friction_bound = 0.0;
    // Before the jump of a driver it did not approach: there is nothing to give back.
    if (at.rate_jumps && at.before_at[i] != none) contact.remove_restitution();
  }
}

/// Leaves out contacts that are listed twice, with what is attached to them: one contact is solved as such.
void ImpactStage::leave_out_repeated(double gap_noise) {
  ConstraintSet& touching = memory_->touching;
  std::size_t kept = 0;
  bool leaves_out = false;
  for (std::size_t i = 0; i < touching.size(); ++i) {
    const auto is_same = [&](const Constraint& other) { return is_repeated(touching[i], other, gap_noise); };
    if (!touching[i].attached) {
      const auto end = touching.begin() + static_cast<std::ptrdiff_t>(kept);
      leaves_out = std::find_if(touching.begin(), end, is_same) != end;
    }
    if (leaves_out) continue;
    if (kept != i) touching[kept] = std::move(touching[i]);
    memory_->places[kept++] = memory_->places[i];
  }
  touching.resize(kept);
  memory_->places.resize(kept);
}

void ImpactStage::fail_unsolved(const IslandProblem& problem, const EventInstant& at) {
  const ConstraintSet& touching = memory_->touching;
  // Solved at each bound of friction in joints, which do not come to an end; or by impulses without bound.
  const std::string why = !problem.report().usable() ? std::string(to_string(problem.report().outcome))
                          : stops(problem)           ? unsettled_friction
                                                     : "no impulses stop what approaches";
  std::string what =
      "the contact problem of an impact is not solved (" + why + at.motion.model().driven() + ")";
  if (problem.report().outcome == Outcome::no_solution) what += "; " + fastest_of(touching, at.velocities());
  failure_->fail(what + hint_at_jams(rules_of(at), touching.size()), failure_->names(touching), &problem);
}

/// Which contact approaches fastest, for messages: "... approaches at 0.1 m/s, ...".
std::string ImpactStage::fastest_of(const ConstraintSet& contacts, const double* velocity) const {
  const auto slower = [&](const Constraint& a, const Constraint& b) {
    return a.normal_velocity(velocity) > b.normal_velocity(velocity);
  };
  const Constraint& fastest = *std::max_element(contacts.begin(), contacts.end(), slower);
  return failure_->name(fastest) + " approaches at " + to_text(-fastest.normal_velocity(velocity)) +
         " m/s; allowed: what impulses of all that touch can stop";
}

void ImpactStage::apply(EventKind kind, const IslandProblem& problem, EventInstant& at) {
  const GroupModel& model = at.motion.model();
  SolvedImpact impact{.kind = kind, .time = at.time, .problem = problem, .velocity = at.velocities()};
  impact.note = kind == EventKind::impact_without_collision ? ImpactNote{} : memory_->note;
  impact.energy_before = kinetic_energy_of_answering(*model.assembly, problem.constraints(), at.velocities());
  at.balance.note_before(problem, at.now.view(), *model.assembly);
  problem.map().add_velocities(at.velocities());
  at.take_velocities();
  impact.energy_after = kinetic_energy_of_answering(*model.assembly, problem.constraints(), at.velocities());
  // Before the impacts of this instant are remembered.
  if (kind == EventKind::accumulation)
    impact.accumulation_time = accumulation_.end(at.time, problem.constraints());
  const double gain = at.balance.book(impact, *model.assembly);
  at.balance.book_joints(impact, model, at.motion.joints(), at.now);
  for (std::size_t c = 0; c < problem.constraints().size(); ++c) {
    const Constraint& contact = problem.constraints()[c];
    if (contact.normals == 0) continue;
    if (problem.map().impulse(c, 0) > 0.0) accumulation_.remember(at.time, contact.key);
  }
  if (gain == 0.0 || rules_of(at).energy_gain != EnergyGain::refuse) return;
  failure_->fail(gain_is_refused("an impact", gain), failure_->names(problem.constraints()), &problem);
}

/// Projects the rest of the normal velocities and gaps of captured contacts away.
void ImpactStage::close_captured(std::span<const Index> pairs, EventInstant& at) {
  // To stop one may be to move another, in almost singular positions: then it may not be stopped. And bodies
  // that slide may have to part, however slowly, where others guide them. Nor do gaps close that are open
  // together but far from where the bodies are.
  for (const Closing closing : {Closing::with_sliding, Closing::all, Closing::pressed}) {
    list_captured(closing, pairs, at);
    if (memory_->closing.close(memory_->captured, {}, at)) return;
  }
}

void ImpactStage::list_captured(Closing closing, std::span<const Index> pairs, EventInstant& at) {
  const double fastest = closing == Closing::pressed ? at.scales.speed_noise : capture_speed(pairs, at);
  // A body that rocks and slides within the rounding of its gaps would do so for ever: what the projection
  // lifts it by, it falls again.
  const double slow = closing == Closing::with_sliding ? speed_of_rounding(pairs, at) : -1.0;
  std::vector<ActiveContact>& list = memory_->captured;
  list.clear();
  for (std::size_t i = 0; i < memory_->touching.size(); ++i) {
    const Constraint& contact = memory_->touching[i];
    if (contact.normals == 0 || contact.normal_velocity(at.velocities()) > fastest) continue;
    ActiveContact& closed = list.emplace_back();
    const bool stops = contact.rows > 1 && contact.sliding_speed(at.velocities()) <= slow;
    closed.mode = stops ? ContactMode::stick : ContactMode::slip_positive;
    closed.at = contact;
    closed.place = memory_->places[i];
  }
}

}  // namespace carom
