// Problem: state the law of contact for the constraints of an island.

#include <carom/contact/island_problem.h>
#include <carom/contact/solvers/contact_mode.h>

#include <algorithm>
#include <cmath>

namespace carom {

namespace {

// Whether a problem has the form of one planar contact, so that only its numbers need to be filled in.
bool is_one_planar_contact(const ContactProblem& problem) {
  return problem.rows() == 2 && problem.groups().size() == 1 &&
         problem.sets()[0].kind == SetKind::half_line && problem.sets()[1].kind == SetKind::bounded_interval;
}

/// Velocity along a row that joints hold fast, without rounding: of what moves around it, or has moved
/// before [m/s]. Seldom asked.
[[gnu::noinline]] double along_held_row(const Constraint& constraint, int row, const double* velocity_free,
                                        double number) {
  constexpr double rounding = 1e-9, least = 1e-10;
  return std::abs(number) <= rounding * constraint.speed(row, velocity_free) + least ? 0.0 : number;
}

/// Whether the constraints are many and share several bodies in the plane.
bool may_be_factored(std::span<const Constraint> constraints, std::size_t from) {
  if (constraints.size() < from || constraints.empty()) return false;
  const Index first = constraints.front().body();
  const auto planar = [](const Constraint& at) { return at.rows <= 2 && at.type != ConstraintType::rolling; };
  const auto other = [&](const Constraint& at) { return at.bodies > 1 || at.body() != first; };
  return std::all_of(constraints.begin(), constraints.end(), planar) &&
         std::any_of(constraints.begin(), constraints.end(), other);
}

/// Modes by constraint: those of the groups, which rolling resistance shares with its contact.
void share_modes(std::span<const Constraint> constraints, std::span<const ContactMode> of_groups,
                 std::vector<ContactMode>& modes) {
  std::size_t group = 0;
  for (std::size_t c = 0; c < constraints.size(); ++c) {
    const bool rolling = constraints[c].type == ConstraintType::rolling;
    modes[c] = rolling ? modes[c - 1] : of_groups[group++];
  }
}

}  // namespace

void IslandProblem::build(std::span<const Constraint> constraints, const double* velocity_before) {
  constraints_ = constraints;
  answer_.known = answer_.changed_modes = false;
  if (constraints.size() == 1 && constraints[0].rows == 2 && is_one_planar_contact(problem_)) {
    return take_one_planar(constraints[0], velocity_before);
  }
  build_any(velocity_before);
}

void IslandProblem::build_any(const double* velocity_before) {
  const std::span<const Constraint> constraints = constraints_;
  directions_.clear();
  first_row_.clear();
  modes_.clear();
  int rows = 0;
  for (const Constraint& constraint : constraints) {
    first_row_.push_back(rows);
    rows += constraint.rows;
  }
  const auto count = static_cast<std::size_t>(rows);
  // A large W is not to be made before it is known whether anybody needs it.
  may_be_factored(constraints, factors_from_) ? problem_.reset_factors(rows, 0) : problem_.reset(rows);
  before_.resize(count);
  restitution_.resize(count);
  answer_.impulse.assign(count, 0.0);
  slides_.assign(constraints.size(), 0.0);
  std::size_t row = 0;
  for (std::size_t c = 0; c < constraints.size(); ++c) {
    for (int i = 0; i < constraints[c].rows; ++i, ++row) {
      directions_.push_back({&constraints[c], i});
      set_row(c, i);
      before_[row] = constraints[c].velocity(i, velocity_before);
      restitution_[row] = constraints[c].restitution(i);
    }
  }
  problem_.group();
}

/// The hot path: one planar contact after another, so that only its numbers need to be filled in.
void IslandProblem::take_one_planar(const Constraint& contact, const double* velocity_before) {
  problem_.sets()[1].coefficient = contact.friction;
  restitution_[0] = contact.law.normal_restitution;
  restitution_[1] = contact.law.tangential_restitution;
  for (int i = 0; i < 2; ++i) {
    const auto row = static_cast<std::size_t>(i);
    directions_[row].constraint = &contact;
    before_[row] = contact.velocity(i, velocity_before);
    answer_.impulse[row] = 0.0;
  }
}

/// The set that impulses along a row lie in.
void IslandProblem::set_row(std::size_t constraint, int row) {
  const Constraint& at = constraints_[constraint];
  RowSet& set = problem_.sets()[static_cast<std::size_t>(first_row_[constraint] + row)];
  if (at.type == ConstraintType::rolling) {
    // Behind the rows of its contact, whose normal row bounds it.
    set.kind = SetKind::bounded_interval;
    set.bound = first_row_[constraint - 1];
    set.coefficient = at.friction;
    return modes_.assign(constraints_.size(), ContactMode::open);
  }
  if (at.has_dry_friction()) return update_bound(constraint);
  if (row == 0) {
    set.kind = SetKind::half_line;
    return;
  }
  set.kind = at.rows == 2 ? SetKind::bounded_interval : SetKind::bounded_disc;
  set.bound = first_row_[constraint];
  set.coefficient = at.friction;
}

void IslandProblem::respond(BodyResponse& response) {
  if (may_be_factored(constraints_, factors_from_) && delassus_.build_factors(directions_, response)) {
    delassus_.write_factors(problem_);
    return problem_.group();
  }
  if (problem_.is_factored()) problem_ = problem_.dense();
  delassus_.build(directions_, response);
  delassus_.write_symmetric(problem_.matrix().data());
}

void IslandProblem::update_bound(std::size_t constraint) {
  const Constraint& at = constraints_[constraint];
  if (at.type == ConstraintType::rolling) return;
  RowSet& set = problem_.sets()[static_cast<std::size_t>(first_row_[constraint])];
  const double slides = slides_[constraint] * at.friction_bound, bound = at.friction * at.friction_bound;
  set.kind = SetKind::interval;
  set.lower = slides_[constraint] != 0.0 ? slides : -bound;
  set.upper = slides_[constraint] != 0.0 ? slides : bound;
}

void IslandProblem::slide(std::size_t constraint, double ratio) {
  if (constraints_[constraint].has_dry_friction()) {
    slides_[constraint] = ratio;
    update_bound(constraint);
  } else {
    RowSet& set = problem_.sets()[static_cast<std::size_t>(first_row_[constraint] + 1)];
    set.kind = SetKind::proportional;
    set.coefficient = ratio;
  }
  problem_.group();
}

void IslandProblem::set_free_velocity(const double* velocity_free) {
  const auto b = problem_.vector();
  std::size_t row = 0;
  for (const Constraint& constraint : constraints_) {
    for (int i = 0; i < constraint.rows; ++i, ++row) {
      double number = constraint.velocity_after(i, velocity_free) + restitution_[row] * before_[row];
      if (i == 0 && constraint.allowed_approach > 0.0) number += constraint.allowed_approach;
      const bool held = problem_.diagonal(static_cast<int>(row)) == 0.0;
      if (held) number = along_held_row(constraint, i, velocity_free, number);
      b[row] = number;
    }
  }
}

void IslandProblem::set_velocity(const double* velocity) {
  set_free_velocity(velocity);
  if (problem_.is_factored()) {
    problem_.factors().respond(answer_.impulse, slot_velocity_);
    for (std::size_t row = 0; row < before_.size(); ++row) {
      problem_.vector()[row] -= problem_.factors().along(row, slot_velocity_);
    }
    return;
  }
  for (int row = 0; row < problem_.rows(); ++row) {
    for (int column = 0; column < problem_.rows(); ++column) {
      problem_.vector()[static_cast<std::size_t>(row)] -=
          problem_.w(row, column) * answer_.impulse[static_cast<std::size_t>(column)];
    }
  }
}

const ContactReport& IslandProblem::solve(SolverChain& chain) {
  if (impact_.solver != nullptr) {
    impact_.solver->solve(impact_.law, problem_, restitution_, chain, answer_);
  } else {
    chain.solve(problem_, answer_);
  }
  if (!modes_.empty()) share_modes(constraints_, answer_.modes, modes_);
  return answer_.report;
}

void IslandProblem::start_from(std::span<const double> impulses) {
  if (problem_.is_factored()) std::copy(impulses.begin(), impulses.end(), answer_.impulse.begin());
}

void IslandProblem::set_impulses(std::span<const double> impulses) {
  std::copy(impulses.begin(), impulses.end(), answer_.impulse.begin());
  xi_.resize(impulses.size());
  problem_.velocities(answer_.impulse, xi_);
  for (std::size_t group = 0; group < answer_.modes.size(); ++group) {
    answer_.modes[group] = contact_mode(problem_, problem_.groups()[group], answer_.impulse, xi_);
  }
  if (!modes_.empty()) share_modes(constraints_, answer_.modes, modes_);
}

void IslandProblem::forget_impulses() { std::fill(answer_.impulse.begin(), answer_.impulse.end(), 0.0); }

}  // namespace carom
