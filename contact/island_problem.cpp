// Problem: state the law of contact and impact for the constraints of an island, as the sets that impulses
// lie in and the velocities that they answer to (Johansson 1999, equations 4 to 13). With
//     xi = W P + b = v^+ + e v^-   along every row,
// normal rows obey 0 <= P_n, 0 <= xi_n, P_n xi_n = 0; tangential ones |P_t| <= mu P_n, and where xi_t is not
// 0, P_t = -mu P_n sign(xi_t). Rows of limits are normal; friction in joints and rolling resistance have a
// bound of their own in place of mu P_n.

#include <carom/contact/contact_velocity.h>
#include <carom/contact/fetch_contact.h>
#include <carom/contact/free_velocity.h>
#include <carom/contact/island_problem.h>
#include <carom/contact/island_rows.h>
#include <carom/contact/solvers/planar_certificate.h>
#include <carom/core/run_error.h>

#include <algorithm>
#include <array>
#include <string>

namespace carom {

namespace {

/// Modes by constraint: those of the groups, which what is attached shares with the constraint before it.
void share_modes(std::span<const Constraint> constraints, std::span<const ContactMode> of_groups,
                 std::vector<ContactMode>& modes) {
  std::size_t group = 0;
  for (std::size_t c = 0; c < constraints.size(); ++c) {
    modes[c] = constraints[c].attached ? modes[c - 1] : of_groups[group++];
  }
}

void demand_room(std::size_t constraints, int rows) {
  if (rows <= most_dense_rows) return;
  constexpr double gigabyte = 1e9;
  const double size = static_cast<double>(sizeof(double)) * rows * rows / gigabyte;
  throw RunError("more contacts than memory allows: " + std::to_string(constraints) +
                     " constraints of one contact problem, whose " + std::to_string(rows) +
                     " rows answer to each other (W in full would take " + to_text(size) +
                     " GB); allowed: at most " + std::to_string(most_dense_rows) + " rows",
                 {});
}

/// Whether sweeps are to solve constraints of bodies that answer together: very many contacts. Few of them
/// are worth exact answers, and along a chain with friction in its joints impulses creep from row to row.
bool are_for_sweeps(std::span<const Constraint> constraints) {
  const auto in_joints = static_cast<std::size_t>(
      std::count_if(constraints.begin(), constraints.end(),
                    [](const Constraint& constraint) { return constraint.normals == 0; }));
  return in_joints < factored_constraints &&
         constraints.size() - in_joints > static_cast<std::size_t>(most_exact_contacts);
}

/// Whether their answers take no more room than the largest W in full.
bool answers_have_room(std::span<const ImpulseDirection> directions, const BodyResponse& response) {
  constexpr std::size_t most = std::size_t{most_dense_rows} * most_dense_rows;
  std::size_t numbers = 0;
  for (const ImpulseDirection& direction : directions) {
    const Constraint& at = *direction.constraint;
    for (std::size_t b = 0; b < static_cast<std::size_t>(at.bodies); ++b) {
      const Index body = at.blocks[b].body;
      if (response.alone(body).mass == nullptr) numbers += response.reach(body).size();
    }
  }
  return numbers <= most;
}

/// W in full after all: bodies do not answer for themselves. The sets stay.
/// \param sets scratch
void make_dense(std::vector<RowSet>& sets, ContactProblem& problem) {
  sets.assign(problem.sets().begin(), problem.sets().end());
  problem.reset(problem.rows());
  std::copy(sets.begin(), sets.end(), problem.sets().begin());
  problem.group();
}

}  // namespace

void IslandProblem::build(std::span<const Constraint> constraints, const double* velocity_before,
                          BodyResponse* response, const IslandStart& start) {
  const bool goes_on = start.from_answer && answer_.known && constraints_.data() == constraints.data() &&
                       constraints_.size() == constraints.size();
  constraints_ = constraints;
  answer_.known = answer_.changed_modes = false;
  answer_.keeps_equations = start.keeps_equations;
  jam_.begin();
  response_.factors.clear();
  answer_.response.clear();
  if (constraints.size() != 1 || constraints[0].rows != 2 || !problem_.is_one_planar_contact()) {
    const std::size_t groups = answer_.modes.size();
    if (goes_on) xi_ = answer_.impulse;
    build_any(velocity_before, response, start);
    if (!goes_on || xi_.size() != answer_.impulse.size() || groups != problem_.groups().size()) return;
    answer_.impulse = xi_;
    answer_.known = true;
    return;
  }
  // The hot path: one planar contact after another, so that only its numbers need to be filled in.
  const Constraint& contact = constraints[0];
  problem_.sets()[1].coefficient = contact.friction;
  restitution_[0] = contact.law.normal_restitution;
  restitution_[1] = contact.law.tangential_restitution;
  const std::array<double, 2> along = times_both_rows(contact, velocity_before);
  for (std::size_t row = 0; row < 2; ++row) {
    directions_[row].constraint = &contact;
    before_[row] = along[row] - contact.surface_velocity[row];
    answer_.impulse[row] = 0.0;
  }
  if (response == nullptr) return;
  if (response_.dense.build_of_one_contact(directions_, *response, problem_.matrix().data())) return;
  response_.dense.build(directions_, *response);
  response_.dense.write_symmetric(problem_.matrix().data());
}

void IslandProblem::build_any(const double* velocity_before, BodyResponse* response,
                              const IslandStart& start) {
  constexpr std::size_t at_a_time = 32;  // they and their rows fit into the nearest cache
  const std::span<const Constraint> constraints = constraints_;
  modes_.clear();
  const auto [rows, fits_factors] = count_rows(constraints, first_row_);
  const auto count = static_cast<std::size_t>(rows);
  directions_.resize(count);
  // A large W is not to be made before it is known whether anybody needs it.
  const bool many = !constraints.empty() && constraints.size() >= options_.factored_from &&
                    constraints.size() <= options_.factored_to;
  const bool factored = many && fits_factors;
  if (!factored) demand_room(constraints.size(), rows);
  factored ? problem_.resize_factors(rows) : problem_.reset(rows);
  before_.resize(count);
  restitution_.resize(count);
  scratch_.given.resize(factored ? count : 0);
  answer_.impulse.assign(count, 0.0);
  slides_.assign(constraints.size(), 0.0);
  if (!factored || response == nullptr) {
    write_rows({0, static_cast<Index>(constraints.size())}, velocity_before);
    if (!factored) {  // factors are still to be written
      problem_.group();
      if (start.impulses && constraints.size() > 1) start.impulses(constraints, answer_.impulse.data());
    }
    if (response != nullptr) respond(*response);
    return;
  }
  for (std::size_t first = 0; first < constraints.size(); first += at_a_time) {
    const std::size_t last = std::min(first + at_a_time, constraints.size());
    const Range some{static_cast<Index>(first), static_cast<Index>(last)};
    write_rows(some, velocity_before);
    const int row = first_row_[first], end = last < first_row_.size() ? first_row_[last] : rows;
    if (!response_.factors.build(directions_, {static_cast<Index>(row), static_cast<Index>(end)}, *response,
                                 problem_)) {
      write_rows({some.end, static_cast<Index>(constraints.size())}, velocity_before);
      forget_impulses();
      return respond(*response);
    }
    if (start.impulses)
      start.impulses(constraints.subspan(first, last - first), answer_.impulse.data() + row);
  }
  problem_.group();
}

/// Rows of some constraints, but for W.
void IslandProblem::write_rows(Range some, const double* velocity_before) {
  if (some.empty()) return;
  const std::span<const Constraint> constraints = constraints_;
  constexpr std::size_t ahead = 12;  // constraints
  const bool factored = problem_.is_factored();
  const PlanarRows all_rows{directions_.data(), problem_.sets().data(), before_.data(), restitution_.data(),
                            scratch_.given.data()};
  auto row = static_cast<std::size_t>(first_row_[some.begin]);
  for (std::size_t c = some.begin; c < some.end; ++c) {
    fetch_contact_ahead(constraints, c + ahead);
    if (factored && constraints[c].rows == 2) {  // a contact in the plane
      write_planar_contact(constraints[c], velocity_before, static_cast<int>(row), all_rows.behind(row));
      row += 2;
      continue;
    }
    if (constraints[c].attached) modes_.assign(constraints.size(), ContactMode::open);
    update_bound(c);
    for (int i = 0; i < constraints[c].rows; ++i, ++row) {
      directions_[row] = {&constraints[c], i};
      if (!constraints[c].has_given_bound()) {
        const int bounding = first_row_[c - constraints[c].attached];
        set_bounded_row(constraints[c], bounding, i, problem_.sets()[row]);
      }
      before_[row] = constraints[c].velocity(i, velocity_before);
      restitution_[row] = constraints[c].restitution(i);
      if (!factored) continue;
      const double approach = i == 0 ? constraints[c].allowed_approach : 0.0;
      scratch_.given[row] = restitution_[row] * before_[row] + approach -
                            constraints[c].surface_velocity_after[static_cast<std::size_t>(i)];
    }
  }
}

void IslandProblem::respond(BodyResponse& response) {
  if (problem_.is_factored()) {
    const auto rows = static_cast<Index>(problem_.rows());
    problem_.factors().bound.clear();
    if (response_.factors.build(directions_, {0, rows}, response, problem_)) return problem_.group();
    if (are_for_sweeps(constraints_) && answers_have_room(directions_, response)) {
      response_.dense.build(directions_, response);
      if (response_.factors.build_bound(directions_, response_.dense, response, problem_))
        return problem_.group();
    }
    demand_room(constraints_.size(), problem_.rows());
    make_dense(scratch_.sets, problem_);
  }
  const bool one = constraints_.size() == 1 && directions_.size() == 2;
  if (one && response_.dense.build_of_one_contact(directions_, response, problem_.matrix().data())) return;
  response_.dense.build(directions_, response);
  response_.dense.write_symmetric(problem_.matrix().data());
}

void IslandProblem::update_bound(std::size_t constraint) {
  const Constraint& at = constraints_[constraint];
  if (!at.has_given_bound()) return;
  RowSet& set = problem_.sets()[static_cast<std::size_t>(first_row_[constraint])];
  const double slides = slides_[constraint] * at.of_joint.friction_bound,
               bound = at.friction * at.of_joint.friction_bound;
  set = {.kind = SetKind::interval,
         .lower = slides_[constraint] != 0.0 ? slides : -bound,
         .upper = slides_[constraint] != 0.0 ? slides : bound};
}

void IslandProblem::slide(std::size_t constraint, const TangentDirection& slip) {
  const Constraint& at = constraints_[constraint];
  if (at.tangents() == 0) return;
  if (at.has_given_bound()) {
    slides_[constraint] = -slip[0] * at.friction;  // a joint has one coordinate
    update_bound(constraint);
  } else {
    for_tangents(at, [&](std::size_t k, int row) {
      RowSet& set = problem_.sets()[static_cast<std::size_t>(first_row_[constraint] + row)];
      set.kind = SetKind::proportional;
      set.coefficient = -slip[k] * at.friction;
    });
  }
  problem_.group();
}

void IslandProblem::add_velocities(double* velocity) {
  if (!problem_.is_factored() || problem_.factors().any_bound()) return map().add_velocities(velocity);
  std::vector<double>& response = answer_.response;
  if (response.empty()) problem_.factors().respond(answer_.impulse, response);
  const double* change = response.data();
  for (const FactorMaker::Slot& slot : response_.factors.slots()) {
    for (int c = 0; c < slot.block.columns; ++c) velocity[slot.block.v + static_cast<Index>(c)] += change[c];
    change += ResponseFactors::columns;
  }
}

void IslandProblem::set_free_velocity(const double* velocity_free) {
  if (problem_.is_factored()) {
    return set_free_velocity_of_slots(directions_, response_.factors.slots(), velocity_free, scratch_.given,
                                      scratch_.slot_velocity, problem_);
  }
  const RowsBefore before{before_, restitution_};
  if (set_free_velocity_of_contact(constraints_, velocity_free, before, problem_)) return;
  set_free_velocity_of_rows(constraints_, velocity_free, before, problem_);
}

void IslandProblem::set_velocity(const double* velocity) {
  set_free_velocity(velocity);
  if (problem_.is_factored()) {
    problem_.factors().respond(answer_.impulse, scratch_.slot_velocity);
    for (std::size_t row = 0; row < before_.size(); ++row) {
      problem_.vector()[row] -= problem_.factors().along(row, scratch_.slot_velocity);
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
    chain.solve(problem_, answer_, answer_.keeps_equations ? &answer_.equations : nullptr);
  }
  const bool alone = problem_.groups().size() == 1 && modes_.empty();
  if (alone && answer_.report.usable()) return answer_.report;  // nearly always
  if (options_.plastic_jams) {
    jam_.resolve({problem_, before_, restitution_, scratch_.given, answer_}, impact_.solver == nullptr,
                 chain);
  }
  if (!modes_.empty()) share_modes(constraints_, answer_.modes, modes_);
  return answer_.report;
}

void IslandProblem::set_impulses(std::span<const double> impulses) {
  std::copy(impulses.begin(), impulses.end(), answer_.impulse.begin());
  answer_.response.clear();
  xi_.resize(impulses.size());
  problem_.velocities(answer_.impulse, xi_);
  answer_.modes.resize(problem_.groups().size());
  contact_modes(problem_, answer_.impulse, xi_, answer_.modes);
  if (!modes_.empty()) share_modes(constraints_, answer_.modes, modes_);
}

void IslandProblem::forget_impulses() {
  std::fill(answer_.impulse.begin(), answer_.impulse.end(), 0.0);
  answer_.response.clear();
}

}  // namespace carom
