// Problem: the direction of a lasting contact between bodies that turn is another one at the end of a step.

#include <carom/integrators/time_stepping/contact_turning.h>

#include <algorithm>
#include <cmath>

namespace carom {

namespace {

constexpr int most_tries = 20;
// Of velocities: changes as small as this are rounding.
constexpr double rounding = 1e-14;

bool is_before(const Constraint& a, const Constraint& b) { return a.key < b.key; }

/// The contact of a key in a list that is ordered by keys; null if there is none.
const Constraint* find_in(const std::vector<Constraint>& list, const Constraint& contact) {
  const auto at = std::lower_bound(list.begin(), list.end(), contact, is_before);
  return at == list.end() || at->key != contact.key ? nullptr : &*at;
}

}  // namespace

void ContactTurning::begin(std::span<const StepIsland> islands, bool alone) {
  turned_.clear();
  shared_.clear();
  tries_ = 0;
  change_ = std::numeric_limits<double>::infinity();
  for (const StepIsland& island : islands) {
    for (const Constraint& contact : island.constraints) {
      for (int b = 0; contact.bodies > 1 && b < contact.bodies; ++b)
        shared_.push_back(contact.blocks[static_cast<std::size_t>(b)].body);
    }
  }
  std::sort(shared_.begin(), shared_.end());
  for (const StepIsland& island : islands) {
    for (const Constraint& contact : island.constraints) {
      if (contact.type != ConstraintType::contact || !contact.turns()) continue;
      if (alone && may_be_followed(contact)) continue;
      turned_.push_back({contact, contact.surface_velocity_after});
    }
  }
  std::sort(turned_.begin(), turned_.end(),
            [](const Turned& a, const Turned& b) { return is_before(a.start, b.start); });
}

/// True of a contact of a body that may be followed alone.
bool ContactTurning::may_be_followed(const Constraint& contact) const {
  return contact.bodies == 1 && !look_.assembly().is_jointed(contact.body()) &&
         !std::binary_search(shared_.begin(), shared_.end(), contact.body());
}

/// Place of a contact among those that turn; their number if it is none of them.
std::size_t ContactTurning::find(const Constraint& contact) const {
  const auto at = std::lower_bound(
      turned_.begin(), turned_.end(), contact,
      [](const Turned& turned, const Constraint& of) { return is_before(turned.start, of); });
  const bool found =
      contact.type == ConstraintType::contact && at != turned_.end() && at->start.key == contact.key;
  return found ? static_cast<std::size_t>(at - turned_.begin()) : turned_.size();
}

bool ContactTurning::has_converged(const StepTrial& trial) {
  const std::vector<double>& v = trial.end.v;
  double size = 0.0;
  for (std::size_t i = 0; i < v.size(); ++i) size = std::max(size, lengths_[i] * std::abs(v[i]));
  // At rest velocities are rounding of those that impulses take away.
  for (std::size_t i = 0; i < trial.dv_impulses.size(); ++i)
    size = std::max(size, lengths_[i] * std::abs(trial.dv_impulses[i]));
  noise_ = rounding * size;
  if (tries_ > 0) {
    double change = 0.0;
    for (std::size_t i = 0; i < v.size(); ++i)
      change = std::max(change, lengths_[i] * std::abs(v[i] - last_[i]));
    if (change <= noise_ || !(change < change_) || tries_ == most_tries) return true;
    change_ = change;
  }
  last_.assign(v.begin(), v.end());
  ++tries_;
  return false;
}

/// Gaps that contacts which last may have within the step [m].
double ContactTurning::reach(const StepInput& in) const {
  constexpr double more = 2.0;
  double largest = 0.0;
  for (const Turned& turned : turned_) {
    const Constraint& at = turned.start;
    const double opens =
        in.step * (std::abs(at.normal_velocity(in.start.v.data())) + in.step * std::abs(at.drift[0]));
    largest = std::max(largest, std::max(at.gap, 0.0) + opens);
  }
  return more * largest;
}

void ContactTurning::find_at(const State& state, double margin, std::vector<Constraint>& out) {
  look_.find(state.view(), margin, out);
  std::sort(out.begin(), out.end(), is_before);
}

bool ContactTurning::turn(const StepInput& in, const StepTrial& trial, std::span<const StepIsland> islands) {
  if (turned_.empty() || has_converged(trial)) return false;
  middle_ = trial.end;
  middle_.time = in.start.time + 0.5 * in.step;
  // In the plane coordinates and velocities correspond one to one.
  for (std::size_t i = 0; i < middle_.q.size(); ++i) middle_.q[i] = 0.5 * (in.start.q[i] + trial.end.q[i]);
  const double margin = reach(in);
  find_at(middle_, margin, at_middle_);
  middle_.q = trial.end.q;
  middle_.time = in.end_time;
  find_at(middle_, margin, at_end_);
  const double *const v0 = in.start.v.data(), *const v1 = trial.end.v.data();
  bool any = false;
  for (const StepIsland& island : islands) {
    for (Constraint& contact : island.constraints) any = turn(contact, v0, v1) || any;
  }
  return any;
}

/// True if the rows of a contact turn by more than rounding. \param v0,v1 velocities at both ends
bool ContactTurning::turn(Constraint& contact, const double* v0, const double* v1) {
  const std::size_t place = find(contact);
  if (place == turned_.size()) return false;
  Turned& turned = turned_[place];
  const Constraint *const middle = find_in(at_middle_, contact), *const end = find_in(at_end_, contact);
  if (middle == nullptr || end == nullptr) return false;  // it has come to another feature, or parted
  bool turns = false;
  contact.jacobian = middle->jacobian;
  turned.ground_after = end->surface_velocity;
  for (int i = 0; i < contact.rows; ++i) {
    const auto row = static_cast<std::size_t>(i);
    contact.surface_velocity[row] = middle->times(i, v0) - turned.start.velocity(i, v0);
    contact.surface_velocity_after[row] = middle->times(i, v1) - end->velocity(i, v1);
    const double made_up = contact.surface_velocity_after[row] - turned.ground_after[row];
    turns = turns || std::abs(made_up) > noise_;
  }
  return turns;
}

double ContactTurning::work(const IslandProblem& problem) const {
  if (tries_ == 0) return 0.0;
  double sum = 0.0;
  for (std::size_t c = 0; c < problem.constraints().size(); ++c) {
    const Constraint& contact = problem.constraints()[c];
    const std::size_t place = find(contact);
    if (place == turned_.size()) continue;
    const Turned& turned = turned_[place];
    for (int i = 0; i < contact.rows; ++i) {
      const auto row = static_cast<std::size_t>(i);
      const double made_up = contact.surface_velocity[row] - turned.start.surface_velocity[row] +
                             contact.surface_velocity_after[row] - turned.ground_after[row];
      sum += 0.5 * problem.map().impulse(c, i) * made_up;
    }
  }
  return sum;
}

}  // namespace carom
