// Problem: the direction of a lasting contact between bodies that turn is another one at the end of a step.

#include <carom/integrators/time_stepping/contact_turning.h>
#include <carom/integrators/time_stepping/kept_names.h>

#include <algorithm>
#include <cmath>

namespace carom {

namespace {

bool is_before(const Constraint& a, const Constraint& b) {
  return a.key != b.key ? a.key < b.key : a.attached < b.attached;
}

/// The constraint of the same key, attached to another one or not, in a list that is ordered by these; null
/// if there is none.
const Constraint* find_in(const ConstraintSet& list, const Constraint& contact) {
  const auto at = std::lower_bound(list.begin(), list.end(), contact, is_before);
  return at == list.end() || is_before(contact, *at) ? nullptr : &*at;
}

/// Brings a constraint to another one, but for what the sweeps make of it.
void take(const Constraint& from, Constraint& to) {
  to.take_rows(from);
  to.surface_velocity = from.surface_velocity;
  to.surface_velocity_after = from.surface_velocity_after;
  to.of_joint.friction_bound = from.of_joint.friction_bound;
}

}  // namespace

void ContactTurning::begin(std::span<const StepIsland> islands, double step, bool alone) {
  turned_.clear();
  shared_.clear();
  mechanisms_.clear();
  convergence_.begin();
  joints_->forget_paths();
  for (const StepIsland& island : islands) {
    for (const Constraint& contact : island.constraints) {
      for (int b = 0; contact.bodies > 1 && b < contact.bodies; ++b)
        shared_.push_back(contact.blocks[static_cast<std::size_t>(b)].body);
    }
  }
  std::sort(shared_.begin(), shared_.end());
  for (const StepIsland& island : islands) {
    const std::size_t before = mechanisms_.size();
    if (joints_->any()) list_mechanisms(island);
    const bool answered = mechanisms_.size() > before;
    const bool any_alone = alone && !has_joints(look_.assembly(), island.components);
    for (const Constraint& contact : island.constraints) {
      if (contact.attached) continue;  // spins
      if (!answered && (contact.key.is_of_joint() || !contact.turns(step, negligible_))) continue;
      if (any_alone && may_be_followed(contact)) continue;
      turned_.push_back(
          {SingleConstraint(contact), SingleConstraint(contact), contact.surface_velocity_after});
    }
  }
  std::sort(turned_.begin(), turned_.end(),
            [](const Turned& a, const Turned& b) { return is_before(a.start, b.start); });
  // Corners that meet do so in all of the step.
  lasting_.start(step);
  for (const Turned& turned : turned_) {
    if (!turned.start.key.is_of_joint()) lasting_.add(turned.start.key);
  }
  lasting_.finish();
}

/// Components of an island whose joints answer contact: not friction in them alone.
void ContactTurning::list_mechanisms(const StepIsland& island) {
  if (std::all_of(island.constraints.begin(), island.constraints.end(),
                  [](const Constraint& constraint) { return constraint.normals == 0; })) {
    return;
  }
  for (const Index component : island.components) {
    if (joints_->of(component) != nullptr) mechanisms_.push_back(component);
  }
}

/// True of a contact of a body that may be followed alone, in an island without joints.
bool ContactTurning::may_be_followed(const Constraint& contact) const {
  return contact.bodies == 1 && !std::binary_search(shared_.begin(), shared_.end(), contact.body());
}

/// Place of a constraint among those that turn; their number if it is none of them.
std::size_t ContactTurning::find(const Constraint& contact) const {
  const auto at = std::lower_bound(
      turned_.begin(), turned_.end(), contact,
      [](const Turned& turned, const Constraint& of) { return is_before(turned.start, of); });
  const bool found = at != turned_.end() && !is_before(contact, at->start);
  return found ? static_cast<std::size_t>(at - turned_.begin()) : turned_.size();
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
  for (const Index component : mechanisms_)
    largest = std::max(largest, joints_->of(component)->iterate().largest_displacement());
  return more * largest;
}

void ContactTurning::find_at(const State& state, const StepInput& in, double margin, ConstraintSet& out) {
  look_.find(state.view(), margin, out, nullptr, &lasting_, in.bodies());
  std::sort(out.begin(), out.end(), is_before);
}

bool ContactTurning::turn(const StepInput& in, StepTrial& trial, std::span<const StepIsland> islands,
                          double tolerance, double residual) {
  if (turned_.empty() && mechanisms_.empty()) return false;
  if (convergence_.has_converged(trial, tolerance / in.step, residual)) return false;
  end_ = trial.end;
  return turn_along(in, trial, islands);
}

void ContactTurning::predict(const StepInput& in, StepTrial& trial, std::span<const StepIsland> islands) {
  if (turned_.empty() || !mechanisms_.empty()) return;
  end_ = in.start;
  // In the plane coordinates and velocities correspond one to one.
  for (std::size_t i = 0; i < end_.q.size(); ++i) end_.q[i] += in.step * end_.v[i];
  static_cast<void>(turn_along(in, trial, islands));
  convergence_.begin_at(in.start.v);
}

/// Brings the constraints to the path from the start of the step to `end_`. True if any turns.
bool ContactTurning::turn_along(const StepInput& in, StepTrial& trial, std::span<const StepIsland> islands) {
  end_.time = in.end_time;
  middle_ = end_;
  middle_.time = in.start.time + 0.5 * in.step;
  for (std::size_t i = 0; i < middle_.q.size(); ++i) middle_.q[i] = 0.5 * (in.start.q[i] + end_.q[i]);
  bool any = false;
  for (const Index component : mechanisms_) {
    JointStage& joints = *joints_->of(component);
    any = joints.answer().follow_path(in, middle_, joints.rows(), trial) || any;
  }
  const double margin = reach(in);
  find_at(middle_, in, margin, found_.middle);
  find_at(end_, in, margin, found_.end);
  for (Turned& turned : turned_) any = turn(turned, in.start.v.data(), end_.v.data(), trial) || any;
  for (const StepIsland& island : islands) restore(island);
  return any;
}

void ContactTurning::give_up(std::span<const StepIsland> islands) {
  joints_->forget_paths();
  convergence_.begin();
  for (Turned& turned : turned_) turned.now = turned.start;
  for (const StepIsland& island : islands) restore(island);
}

void ContactTurning::restore(const StepIsland& island) const {
  for (Constraint& constraint : island.constraints) {
    const std::size_t place = find(constraint);
    if (place != turned_.size()) take(turned_[place].now, constraint);
  }
}

/// Brings a constraint to the path. True if its rows turn by more than rounding. \param v0,v1 velocities at
/// both ends \param trial with the rotations of mechanisms halfway and at the end
bool ContactTurning::turn(Turned& turned, const double* v0, const double* v1, const StepTrial& trial) const {
  SingleConstraint middle = turned.start, end = turned.start;
  if (turned.start.has_given_bound()) {
    const JointRows& joints = look_.detector().joints();
    joints.update_friction({middle_.view(), trial.at_midpoint.rotation.data()}, middle);
    joints.update_friction({end_.view(), trial.at_end.rotation.data()}, end);
  } else {
    const Constraint *const halfway = find_in(found_.middle, turned.start), *const last = find_in(
                                                                                found_.end, turned.start);
    const double same_place = look_.detector().outlines().on_ground().lengths().corner;
    if (halfway == nullptr || last == nullptr) return false;  // it has parted
    const Constraint* const on_way = become_of(turned.start, *halfway, found_.middle, same_place);
    const Constraint* const at_end = become_of(turned.start, *last, found_.end, same_place);
    if (on_way == nullptr || at_end == nullptr) return false;  // it has come to another feature
    middle.take_rows(*on_way);
    end.take_rows(*at_end);
    end.surface_velocity = at_end->surface_velocity;
  }
  bool turns = false;
  turned.now.take_rows(middle);
  turned.ground_after = end.surface_velocity;
  for (int i = 0; i < middle.rows; ++i) {
    const auto row = static_cast<std::size_t>(i);
    turned.now.surface_velocity[row] = middle.times(i, v0) - turned.start.velocity(i, v0);
    turned.now.surface_velocity_after[row] = middle.times(i, v1) - end.velocity(i, v1);
    const double made_up = turned.now.surface_velocity_after[row] - turned.ground_after[row];
    turns = turns || std::abs(made_up) > convergence_.noise();
  }
  return turns;
}

double ContactTurning::work(const IslandProblem& problem) const {
  if (turned_.empty()) return 0.0;
  double sum = 0.0;
  for (std::size_t c = 0; c < problem.constraints().size(); ++c) {
    const Constraint& contact = problem.constraints()[c];
    const std::size_t place = find(contact);
    if (place == turned_.size() || contact.normals == 0) continue;
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
