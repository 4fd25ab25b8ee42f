// Problem: all stages of an event see the same state.

#include <carom/contact/detection/rolling_resistance.h>
#include <carom/integrators/event_driven/event_instant.h>

#include <algorithm>
#include <limits>

namespace carom {

EventInstant::EventInstant(SmoothMotion& group, InstantMemory& memory, double at_time, std::span<double> y_in,
                           EventBalance& books)
    : motion(group),
      time(at_time),
      y(y_in),
      now(memory.now),
      acceleration_before(memory.acceleration_before),
      contacts(memory.contacts),
      before(memory.before),
      before_at(memory.before_at),
      islands(memory.islands),
      stopped(memory.stopped),
      balance(books) {
  stopped.clear();
  // Who asks has contact pairs.
  if (!motion.model().pairs.empty()) acceleration_before.resize(now.acceleration.size());
}

void EventInstant::update() {
  motion.sample(time, y.data(), Forces::without_contact, now);
  contacts.resize(motion.model().pairs.size());
  const GroupModel& model = motion.model();
  const double within = near();
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    if (model.pairs[i].rolling) {
      write_rolling_resistance(contacts[i - 1], motion_of(*model.detector, model.pairs[i], now.places),
                               contacts[i]);
      continue;
    }
    motion.contact_if_near(i, now, within, contacts[i]);
    const Index bound = model.bound_of(i);
    if (bound == none || contacts[i].gap > within || model.bounds[bound].rounding > 0.0) continue;
    if (!motion.regions(model.pairs[i], now).may_touch()) {
      contacts[i].gap = std::numeric_limits<double>::infinity();
    }
  }
}

double EventInstant::near() const { return std::max(near_gap(*motion.model().options), longest_shift()); }

void EventInstant::find_touch_gap(bool starts) {
  const double known = near();
  touch_gap = starts ? motion.model().options->gap_tolerance : 4.0 * scales.gap_noise;
  // Far from the origin gaps are rounded to more than their tolerance.
  if (near() > known) update();
}

void EventInstant::take_accelerations_before() {
  if (motion.model().pairs.empty()) return;
  motion.model().unknowns.for_velocities([&](Range v, std::size_t) {
    std::copy(now.acceleration.begin() + v.begin, now.acceleration.begin() + v.end,
              acceleration_before.begin() + v.begin);
  });
}

void EventInstant::take_contacts_before() {
  before = motion.active().list();
  before_at.assign(motion.model().pairs.size(), none);
  for (Index i = 0; i < before.size(); ++i) before_at[before[i].place] = i;
}

double EventInstant::longest_shift() const {
  constexpr double moved = 4.0;
  return moved * std::max(motion.model().options->gap_tolerance, touch_gap);
}

void EventInstant::find_islands() {
  const double near = longest_shift();
  const auto is_near = [&](std::size_t pair) {
    return before_at[pair] != none || contacts[pair].gap <= near;
  };
  islands.find(motion.model(), is_near);
}

void EventInstant::take_velocities() {
  for (const auto& part : motion.model().parts()) {
    const Range v = part.ranges.v;
    std::copy(now.state.v.begin() + v.begin, now.state.v.begin() + v.end, y.data() + part.v);
  }
}

double largest_acceleration(std::span<const Constraint> constraints, const EventInstant& at) {
  double largest = 0.0;
  for (const Constraint& constraint : constraints) {
    if (constraint.normals == 0) continue;
    for (int row = 0; row < constraint.rows; ++row)
      largest = std::max(largest, std::abs(constraint.acceleration(row, at.now.acceleration.data())));
  }
  return largest;
}

bool solve_ahead(double time, std::span<Constraint> constraints, EventInstant& at, std::vector<double>& ahead,
                 IslandProblem& problem, SolverChain& chain) {
  for (Constraint& constraint : constraints) {
    for (std::size_t row = 0; row < Constraint::max_rows; ++row)
      constraint.surface_velocity_after[row] =
          constraint.surface_velocity[row] - time * constraint.drift[row];
  }
  ahead.assign(at.now.state.v.begin(), at.now.state.v.end());
  at.motion.model().unknowns.for_velocities([&](Range v, std::size_t) {
    for (Index i = v.begin; i < v.end; ++i) ahead[i] += time * at.now.acceleration[i];
  });
  at.motion.joints().build(problem, constraints, at.velocities());
  problem.set_free_velocity(ahead.data());
  return problem.solve(chain).usable();
}

}  // namespace carom
