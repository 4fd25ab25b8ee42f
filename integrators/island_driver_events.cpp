// Problem: what happens at an event: impacts until nothing approaches, then the modes of all that touches.

#include <carom/integrators/failure_file.h>
#include <carom/integrators/island_driver.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace carom {

namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();

// Gaps this small against the coordinates are rounding of sums of a few terms.
constexpr double gap_rounding = 256.0 * epsilon;

// Velocities this small against those before an impact are zero: answers of contact problems are certified to
// 1e-12. So are those well below the tolerance, which would start phases that end at once.
constexpr double speed_rounding = 1e-12;

// Impacts of one instant: each takes energy out or hands it on, so that more than this do not happen but by
// e = 1 in a corner.
constexpr int most_impacts_at_once = 10000;

/// Line of the account for the work of an impact along a row of a contact.
EnergyFlow line_of(EventKind kind, int row) {
  if (kind == EventKind::accumulation) return EnergyFlow::accumulation;
  if (kind == EventKind::impact_without_collision) return EnergyFlow::impact_without_collision;
  return row == 0 ? EnergyFlow::impact_normal : EnergyFlow::impact_tangential;
}

}  // namespace

void IslandDriver::set_scales() {
  const Range q = assembly_->islands()[motion_.island()].q, v = assembly_->islands()[motion_.island()].v;
  const MotionWorkspace& work = work_->motion;
  double size = 1.0;
  for (Index i = q.begin; i < q.end; ++i) size = std::max(size, std::abs(work.trial.q[i]));
  gap_noise_ = gap_rounding * size;
  velocity_scale_ = force_scale_ = 0.0;
  for (Index i = v.begin; i < v.end; ++i) {
    velocity_scale_ = std::max(velocity_scale_, std::abs(work.trial.v[i]) * work.lengths[i]);
    force_scale_ = std::max(force_scale_, std::abs(work.momentum[i]) / work.lengths[i]);
  }
  for (const Contact& contact : work_->contacts) {
    velocity_scale_ = std::max(velocity_scale_, std::abs(contact.obstacle_velocity[0]));
    velocity_scale_ = std::max(velocity_scale_, std::abs(contact.obstacle_velocity[1]));
  }
}

double IslandDriver::speed_noise() const {
  return speed_rounding * velocity_scale_ + 0.1 * options_.absolute_tolerance;
}

/// Brings the contacts of all pairs to the state in the workspace.
void IslandDriver::locate_contacts() {
  std::vector<Contact>& contacts = work_->contacts;
  contacts.resize(motion_.pairs().size());
  for (std::size_t i = 0; i < contacts.size(); ++i) motion_.contact(i, contacts[i]);
}

bool IslandDriver::touches(std::size_t pair) const {
  return closed_at_[pair] != 0 ||
         work_->contacts[pair].gap <= (fresh_ ? options_.gap_tolerance : 4.0 * gap_noise_);
}

void IslandDriver::begin_phase(DriverNews& news) {
  motion_.evaluate(time_, y_.data(), false);
  locate_contacts();
  set_scales();
  before_ = motion_.closed().list();
  std::fill(closed_at_.begin(), closed_at_.end(), char{0});
  for (const ClosedContact& contact : before_) {
    const auto at = std::find(motion_.pairs().begin(), motion_.pairs().end(), contact.pair);
    closed_at_[static_cast<std::size_t>(at - motion_.pairs().begin())] = 1;
  }
  const bool struck = resolve_impacts(news);
  if (struck) {
    // What stopped moves again, and loads may depend on velocities.
    stopped_ = {};
    breaking_.clear();
    lifting_.clear();
    motion_.evaluate(time_, y_.data(), false);
    locate_contacts();
  }
  decide_modes(news);
  tell_changes(news);
  stopped_ = {};
  fresh_ = false;

  if (!motion_.evaluate(time_, y_.data(), true))
    fail("the forces of closed contacts contradict each other", {});
  if (settle(news)) motion_.evaluate(time_, y_.data(), true);
  in_phase_ = true;
  resting_ = at_rest();
  if (resting_) return;
  if (!watch(time_, y_.data(), start_)) fail("the loads are not finite", {});
  // A method of many steps is not helped by the length that the last step had.
  const bool one_step =
      options_.method == FlowMethod::explicit_runge_kutta || options_.method == FlowMethod::one_step;
  flow_->start(time_, y_, one_step ? step_ : 0.0);
}

/// Impacts at this instant, body by body, until nothing that touches approaches. True if there was one.
bool IslandDriver::resolve_impacts(DriverNews& news) {
  const auto& pairs = motion_.pairs();
  bool struck = false;
  for (int round = 0; round < most_impacts_at_once; ++round) {
    bool any = false;
    for (std::size_t first = 0; first < pairs.size();) {
      std::size_t last = first;
      double fastest = 0.0;
      for (; last < pairs.size() && pairs[last].body == pairs[first].body; ++last) {
        if (!touches(last)) continue;
        fastest = std::max(fastest, -work_->contacts[last].velocity(0, work_->motion.trial.v.data()));
      }
      if (fastest > speed_noise()) {
        resolve_body(first, last, fastest, news);
        any = struck = true;
      }
      first = last;
    }
    if (!any) return struck;
  }
  std::vector<std::string> names;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (touches(i)) names.push_back(finder_->name(work_->contacts[i].key));
  }
  fail("impacts at one instant do not come to an end", std::move(names));
}

void IslandDriver::resolve_body(std::size_t first, std::size_t last, double fastest, DriverNews& news) {
  double* const velocity = work_->motion.trial.v.data();
  std::vector<Contact>& touching = work_->touching;
  touching.clear();
  for (std::size_t i = first; i < last; ++i) {
    if (!touches(i)) continue;
    Contact& contact = touching.emplace_back(work_->contacts[i]);
    contact.friction = contact.law.friction_at(contact.sliding_speed(velocity));
  }
  const bool captured = fastest <= options_.capture_speed;
  if (captured) take_captured(first, last);
  const double energy_before = motion_.kinetic_energy(touching.front().body);
  ContactCluster& cluster = work_->cluster;
  cluster.build(*assembly_, touching, velocity);
  cluster.set_free_velocity(velocity);
  const bool solved = cluster.solve(work_->chain).usable();
  // Slower than the capture speed all that touches closes anyway.
  if (!solved && captured) cluster.forget_impulses();
  if (!solved && !captured) {
    std::vector<std::string> names;
    for (const Contact& contact : touching) names.push_back(finder_->name(contact.key));
    fail("the contact problem of an impact is not solved (" +
             std::string(to_string(cluster.report().outcome)) + ")",
         std::move(names), &cluster);
  }
  cluster.apply(velocity);
  const Range v = assembly_->islands()[motion_.island()].v;
  std::copy(velocity + v.begin, velocity + v.end,
            y_.begin() + static_cast<std::ptrdiff_t>(motion_.v_begin()));
  book_impact(captured ? EventKind::accumulation : EventKind::impact, energy_before, news);
  if (captured) close_captured(news);
}

/// Adds contacts that are about to close too, and takes the restitution out of all.
void IslandDriver::take_captured(std::size_t first, std::size_t last) {
  const MotionWorkspace& work = work_->motion;
  const double limit = options_.capture_speed * options_.capture_speed;
  for (std::size_t i = first; i < last; ++i) {
    if (touches(i)) continue;
    const Contact& contact = work_->contacts[i];
    const double speed = contact.velocity(0, work.trial.v.data());
    const double fall = contact.acceleration(0, work.acceleration.data());
    if (fall < 0.0 && speed * speed - 2.0 * contact.gap * fall <= limit) work_->touching.push_back(contact);
  }
  for (Contact& contact : work_->touching) {
    contact.law.normal_restitution = contact.law.tangential_restitution = 0.0;
  }
}

/// Takes what is left of the normal velocities and gaps of captured contacts.
void IslandDriver::close_captured(DriverNews& news) {
  MotionWorkspace& work = work_->motion;
  std::vector<ClosedContact>& list = capture_.list();
  list.clear();
  const double* const velocity = work.trial.v.data();
  // A body that rocks and slides within the rounding of its gaps would do so for ever: what the projection
  // lifts it by, it falls again.
  double fall = 0.0;
  for (const Contact& contact : work_->touching) {
    fall = std::max(fall, std::abs(contact.acceleration(0, work.acceleration.data())));
  }
  const double rounding = std::sqrt(2.0 * 4.0 * gap_noise_ * fall);
  for (const Contact& contact : work_->touching) {
    if (contact.velocity(0, velocity) > options_.capture_speed) continue;
    ClosedContact& closed = list.emplace_back();
    const bool stops = contact.sliding_speed(velocity) <= rounding;
    closed.mode = stops ? ContactMode::stick : ContactMode::slip_positive;
    closed.at = contact;
  }
  motion_.closed().list().swap(list);
  bool changed = false;
  news.flows[EnergyFlow::accumulation] += motion_.project(y_, changed, news.shift);
  motion_.closed().list().swap(list);
  if (!changed) return;
  motion_.evaluate(time_, y_.data(), false);
  locate_contacts();
}

void IslandDriver::book_impact(EventKind kind, double energy_before, DriverNews& news) {
  const ContactCluster& cluster = work_->cluster;
  const MotionWorkspace& work = work_->motion;
  double gain = 0.0, scale = 0.0;
  const double energy_after = motion_.kinetic_energy(cluster.contacts().front().body);
  // Before those of this instant are remembered.
  const double pile_up =
      kind == EventKind::accumulation ? accumulation_time() : std::numeric_limits<double>::quiet_NaN();
  for (std::size_t c = 0; c < cluster.contacts().size(); ++c) {
    const Contact& contact = cluster.contacts()[c];
    EventRecord& event = tell(kind, contact, news);
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
      news.flows[line_of(kind, row)] -= gained;
      news.flows[EnergyFlow::external] += impulse * contact.obstacle_velocity[at];
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
  constexpr double rounding = 1e-13;  // of the sum of works
  if (!(gain > rounding * scale)) return;
  news.energy_gain += gain;
  if (!options_.refuse_energy_gain) return;
  std::vector<std::string> names;
  for (const Contact& contact : cluster.contacts()) names.push_back(finder_->name(contact.key));
  fail("an impact adds " + to_text(gain) + " J, which refuse_energy_gain forbids", std::move(names),
       &cluster);
}

void IslandDriver::decide_modes(DriverNews& news) {
  constexpr int most_rounds = 100;  // impacts without collision change what is to be decided
  const auto& pairs = motion_.pairs();
  std::vector<ClosedContact>& list = motion_.closed().list();
  list.clear();
  for (std::size_t first = 0; first < pairs.size();) {
    std::size_t last = first + 1;
    while (last < pairs.size() && pairs[last].body == pairs[first].body) ++last;
    int rounds = 0;
    while (!decide_body(first, last, news)) {
      if (++rounds < most_rounds) continue;
      fail("impacts without collision do not come to an end", {finder_->name(work_->contacts[first].key)});
    }
    first = last;
  }
  std::fill(closed_at_.begin(), closed_at_.end(), char{0});
  for (const ClosedContact& contact : list) {
    const auto at = std::find(pairs.begin(), pairs.end(), contact.pair);
    closed_at_[static_cast<std::size_t>(at - pairs.begin())] = 1;
  }
}

void IslandDriver::collect_candidates(std::size_t first, std::size_t last) {
  std::vector<Candidate>& candidates = work_->candidates;
  candidates.clear();
  const double* const velocity = work_->motion.trial.v.data();
  for (std::size_t i = first; i < last; ++i) {
    const Contact& contact = work_->contacts[i];
    if (!touches(i) || contact.velocity(0, velocity) > speed_noise()) continue;
    Candidate& candidate = candidates.emplace_back();
    candidate.pair = motion_.pairs()[i];
    candidate.at = contact;
    const double slip = contact.rows == 2 ? contact.velocity(1, velocity) : 0.0;
    candidate.slip = std::abs(slip) > speed_noise() && candidate.pair != stopped_ ? slip : 0.0;
    candidate.slippery = contact.law.sticking_friction() == 0.0;
    const auto same = [&](const auto& other) { return other.pair == candidate.pair; };
    const auto before = std::find_if(before_.begin(), before_.end(), same);
    if (before != before_.end()) candidate.present = before->mode;
    const auto breaking = std::find_if(breaking_.begin(), breaking_.end(), same);
    if (breaking != breaking_.end()) {
      candidate.breaks = true;
      candidate.push = breaking->push;
    }
    candidate.lifts = std::find(lifting_.begin(), lifting_.end(), candidate.pair) != lifting_.end();
  }
}

/// False if an impact without collision happened: then everything is to be decided anew.
bool IslandDriver::decide_body(std::size_t first, std::size_t last, DriverNews& news) {
  collect_candidates(first, last);
  std::vector<Candidate>& candidates = work_->candidates;
  if (candidates.empty()) return true;
  const Decision decision =
      work_->decision.decide(*assembly_, candidates, work_->motion.acceleration.data(), work_->chain);
  if (decision == Decision::impossible) {
    impact_without_collision(news);
    return false;
  }
  if (decision == Decision::failed) {
    std::vector<std::string> names;
    for (const Candidate& candidate : candidates) names.push_back(finder_->name(candidate.at.key));
    fail("the contact problem of the accelerations is not solved", std::move(names),
         &work_->decision.cluster());
  }
  if (decision == Decision::several) tell_choice(EventKind::several_accelerations, news);
  for (const Candidate& candidate : candidates) {
    if (candidate.mode == ContactMode::open) continue;
    ClosedContact& closed = motion_.closed().list().emplace_back();
    closed.pair = candidate.pair;
    closed.mode = candidate.mode;
    closed.slippery = candidate.slippery;
    closed.at = candidate.at;
  }
  return true;
}

void IslandDriver::tell_choice(EventKind kind, DriverNews& news) {
  const ContactReport& report = work_->decision.cluster().report();
  for (const Candidate& candidate : work_->candidates) {
    if (!(candidate.stiffness <= 0.0)) continue;
    EventRecord& event = tell(kind, candidate.at, news);
    event.stiffness = candidate.stiffness;
    event.free_acceleration = candidate.free_acceleration;
    event.mode = candidate.mode;
    event.outcome = report.outcome;
    event.residual = report.residual;
    event.solver = report.solver;
  }
}

/// The limit of an impact at vanishing speed: of its answers with impulses the one that takes most energy.
void IslandDriver::impact_without_collision(DriverNews& news) {
  std::vector<Candidate>& candidates = work_->candidates;
  double* const velocity = work_->motion.trial.v.data();
  std::vector<Contact>& touching = work_->touching;
  touching.clear();
  std::vector<std::string> names;
  for (const Candidate& candidate : candidates) {
    touching.push_back(candidate.at);
    names.push_back(finder_->name(candidate.at.key));
  }
  ContactCluster& cluster = work_->cluster;
  cluster.build(*assembly_, touching, velocity);
  cluster.set_free_velocity(velocity);
  if (!cluster.solve(work_->chain).usable() ||
      solutions_.enumerate(cluster.problem()) == Outcome::not_solved) {
    fail("no forces keep the contact and the impact without collision is not solved", std::move(names),
         &cluster);
  }
  std::vector<double> restitution;
  for (const Contact& contact : touching) {
    restitution.push_back(contact.law.normal_restitution);
    restitution.push_back(contact.law.tangential_restitution);
  }
  std::size_t best = solutions_.size();
  double most = -std::numeric_limits<double>::infinity();
  for (std::size_t s = 0; s < solutions_.size(); ++s) {
    const auto impulse = solutions_.impulse(s);
    double size = 0.0, loss = 0.0;
    for (std::size_t row = 0; row < impulse.size(); ++row) {
      const double after = solutions_.velocity(s)[row] - restitution[row] * cluster.before()[row];
      size = std::max(size, std::abs(impulse[row]));
      loss -= 0.5 * impulse[row] * (cluster.before()[row] + after);
    }
    if (size == 0.0 || !(loss > most)) continue;
    most = loss;
    best = s;
  }
  if (best == solutions_.size()) {
    fail("no forces keep the contact, and no impact without collision does", std::move(names), &cluster);
  }
  cluster.set_impulses(solutions_.impulse(best));
  const double energy_before = motion_.kinetic_energy(touching.front().body);
  cluster.apply(velocity);
  const Range v = assembly_->islands()[motion_.island()].v;
  std::copy(velocity + v.begin, velocity + v.end,
            y_.begin() + static_cast<std::ptrdiff_t>(motion_.v_begin()));
  const std::size_t told = news.events.size();
  book_impact(EventKind::impact_without_collision, energy_before, news);
  for (std::size_t i = told; i < news.events.size(); ++i) {
    news.events[i].stiffness = candidates[i - told].stiffness;
    news.events[i].free_acceleration = candidates[i - told].free_acceleration;
  }
  stopped_ = {};
  motion_.evaluate(time_, y_.data(), false);
  locate_contacts();
  resolve_impacts(news);
}

/// Tells which contacts changed their mode.
void IslandDriver::tell_changes(DriverNews& news) {
  const auto& now = motion_.closed().list();
  const auto find = [](const std::vector<ClosedContact>& list, const ContactPair& pair) {
    return std::find_if(list.begin(), list.end(), [&](const ClosedContact& at) { return at.pair == pair; });
  };
  const double* const velocity = work_->motion.trial.v.data();
  const auto change = [&](EventKind kind, const Contact& contact, ContactMode mode) {
    EventRecord& event = tell(kind, contact, news);
    for (int row = 0; row < contact.rows; ++row) {
      event.velocity_before[static_cast<std::size_t>(row)] =
          event.velocity_after[static_cast<std::size_t>(row)] = contact.velocity(row, velocity);
    }
    event.energy_before = event.energy_after = motion_.kinetic_energy(contact.body);
    event.mode = mode;
  };
  for (const ClosedContact& contact : before_) {
    if (find(now, contact.pair) == now.end()) change(EventKind::lift_off, contact.at, ContactMode::open);
  }
  for (const ClosedContact& contact : now) {
    const auto before = find(before_, contact.pair);
    if (before == before_.end()) {
      change(EventKind::closing, contact.at, contact.mode);
    } else if (before->mode != contact.mode && !contact.slippery) {
      change(contact.sticks() ? EventKind::stick : EventKind::slip, contact.at, contact.mode);
    }
  }
}

EventRecord& IslandDriver::tell(EventKind kind, const Contact& contact, DriverNews& news) {
  ++news.counts[static_cast<std::size_t>(kind)];
  EventRecord& event = news.events.emplace_back();
  event.time = time_;
  event.kind = kind;
  if (contact.body == none) return event;
  event.contact = contact.key;
  event.body = assembly_->layout()->id(contact.body);
  event.obstacle = {contact.key.against.serial, assembly_->system().token()};
  return event;
}

void IslandDriver::count_event() {
  constexpr std::int64_t window = 1000;
  if (++counted_ < window) return;
  const double allowed = static_cast<double>(window) / options_.event_limit;
  if (time_ - window_start_ < allowed) {
    const std::size_t pair =
        next_.guard == Guard::gap ? next_.which
        : motion_.closed().list().empty()
            ? 0
            : static_cast<std::size_t>(std::find(motion_.pairs().begin(), motion_.pairs().end(),
                                                 motion_.closed().list().front().pair) -
                                       motion_.pairs().begin());
    locate_contacts();
    fail("more than " + to_text(options_.event_limit) + " events per second (event_limit)",
         {finder_->name(work_->contacts[pair].key)});
  }
  counted_ = 0;
  window_start_ = time_;
}

void IslandDriver::remember_impact(const ContactKey& contact) {
  if (!last_impacts_.empty() && last_impacts_.back().time == time_ && last_impacts_.back().contact == contact)
    return;
  if (last_impacts_.size() == remembered) last_impacts_.erase(last_impacts_.begin());
  last_impacts_.push_back({time_, contact});
}

/// Where the pattern of contacts repeats (by one to four impacts) and its intervals shrink in a settled ratio
/// r, the sum of all that would follow the last interval D is D r/(1 - r).
double IslandDriver::accumulation_time() const {
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

void IslandDriver::fail(const std::string& what, std::vector<std::string> parts,
                        const ContactCluster* cluster) const {
  std::string message = "event-driven at t = " + to_text(time_) + " s: " + what;
  if (parts.empty()) {
    const Index body = assembly_->islands()[motion_.island()].bodies.begin;
    parts.push_back(assembly_->system().name(assembly_->layout()->id(body)));
    message += "; island of " + parts.front();
  } else {
    message += ":";
    for (const std::string& part : parts) message += " " + part + (part == parts.back() ? "" : ",");
  }
  SolverFailure failure;
  failure.time = looked_at_;
  failure.step = time_ - looked_at_;
  failure.parts = std::move(parts);
  if (cluster != nullptr) {
    failure.residual = cluster->report().residual;
    failure.problem = std::make_shared<const ContactProblem>(cluster->problem());
    message += write_failure(options_.failure_directory, failure, message);
  }
  throw SolverError(message, std::move(failure));
}

}  // namespace carom
