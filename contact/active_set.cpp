// Problem: forces and corrections of contacts that are constraints.

#include <carom/contact/active_set.h>

#include <algorithm>
#include <cmath>

namespace carom {

namespace {

// A pivot below this part of the largest one is rounding: the constraint follows from the others.
constexpr double dependent = 1e-11;

}  // namespace

double ActiveContact::friction_at(const Constraint& where, const double* velocities) const {
  if (frictionless) return 0.0;
  return sticks() ? where.law.sticking_friction()
                  : where.law.sliding_friction(slip_sign() * where.tangential_velocity(velocities));
}

void ActiveSet::bind(const Assembly& assembly, JointConstraints& joints) {
  assembly_ = &assembly;
  joints_ = joints.empty() ? nullptr : &joints;
}

void ActiveSet::update(const Detector& detector, const StateView& state, const Evaluation& evaluation,
                       const GroundPlaces& places) {
  for (ActiveContact& contact : contacts_) {
    detector.contact(contact.pair, state, evaluation, places, contact.at);
    contact.friction = contact.friction_at(contact.at, state.v);
  }
}

Index ActiveSet::mechanism(const ActiveContact& contact) const {
  return joints_ == nullptr ? contact.at.body() : assembly_->mechanism(contact.at.body());
}

template <class F>
void ActiveSet::for_groups(F&& f) {
  for (std::size_t first = 0; first < contacts_.size();) {
    std::size_t last = first + 1;
    while (last < contacts_.size() && mechanism(contacts_[last]) == mechanism(contacts_[first])) ++last;
    f(first, last);
    first = last;
  }
}

int ActiveSet::row_of(const Row& row, const Constraint& at) { return row.tangent ? at.tangent_row() : 0; }

/// Rows of one group, and the products of these with what forces along their columns do.
/// \param slips whether forces of contacts that slip are turned into the cone of friction
void ActiveSet::state_equations(const Assembly& assembly, std::size_t first, std::size_t last, bool slips) {
  rows_.clear();
  for (std::size_t i = first; i < last; ++i) {
    if (!contacts_[i].at.has_dry_friction()) rows_.push_back({i, false});
    if (contacts_[i].sticks()) rows_.push_back({i, true});
  }
  directions_.clear();
  for (const Row& row : rows_) {
    const ActiveContact& contact = contacts_[row.contact];
    const double ratio = row.tangent || !slips ? 0.0 : -contact.slip_sign() * contact.friction;
    directions_.push_back({&contact.at, row_of(row, contact.at), ratio});
  }
  if (joints_ != nullptr && assembly.is_jointed(contacts_[first].at.body())) {
    JointResponse response(*joints_);
    delassus_.build(directions_, response);
  } else {
    MassResponse response(assembly);
    delassus_.build(directions_, response);
  }
}

/// Solves the equations of the group for `unknown_`.
bool ActiveSet::solve() {
  factors_.reset(rows_.size());
  delassus_.write(factors_.matrix());
  return factors_.solve(dependent, unknown_);
}

/// Friction in joints is known where it slips: a load. \param acceleration to add to
void ActiveSet::add_dry_friction(std::size_t first, std::size_t last, double* acceleration) {
  for (std::size_t i = first; i < last; ++i) {
    ActiveContact& contact = contacts_[i];
    if (!contact.at.has_dry_friction()) continue;
    contact.normal = contact.at.friction_bound;
    if (contact.sticks()) continue;
    contact.tangential = -contact.slip_sign() * contact.friction * contact.normal;
    const Range v = joints_->velocities();
    load_.resize(v.end);
    std::fill(load_.begin() + v.begin, load_.begin() + v.end, 0.0);
    contact.at.add_force(0.0, contact.tangential, load_.data());
    joints_->apply_inverse_mass(load_.data());
    joints_->project(JointLevel::change, load_.data());
    for (Index k = v.begin; k < v.end; ++k) acceleration[k] += load_[k];
  }
}

/// Forces of one group.
bool ActiveSet::react(std::size_t first, std::size_t last, double* acceleration) {
  const std::size_t n = rows_.size();
  unknown_.resize(n);
  for (std::size_t i = 0; i < n; ++i) {
    const Constraint& at = contacts_[rows_[i].contact].at;
    unknown_[i] = -at.acceleration(row_of(rows_[i], at), acceleration);
  }
  const bool solved = solve();
  const std::span<const ActiveContact> group(contacts_.data() + first, last - first);
  if (least_ && factors_.rank() < n) least_forces_.find(contacts_, group, rows_, factors_, unknown_);
  for (std::size_t k = 0; k < factors_.rank(); ++k) {
    pivots_.push_back({rows_[factors_.row(k)], rows_[factors_.column(k)]});
  }
  for (std::size_t i = 0; i < n; ++i) {
    ActiveContact& contact = contacts_[rows_[i].contact];
    if (rows_[i].tangent) {
      contact.tangential = unknown_[i];
    } else {
      contact.normal = unknown_[i];
      if (!contact.sticks()) contact.tangential = -contact.slip_sign() * contact.friction * contact.normal;
    }
  }
  delassus_.add_response(unknown_, acceleration);
  if (factors_.rank() < n) margins_.add(contacts_, first, last, rows_, factors_);
  return solved;
}

bool ActiveSet::add_reactions(const Assembly& assembly, double* acceleration) {
  bool solved = true;
  margins_.clear();
  pivots_.clear();
  for_groups([&](std::size_t first, std::size_t last) {
    state_equations(assembly, first, last, true);
    add_dry_friction(first, last, acceleration);
    solved = react(first, last, acceleration) && solved;
  });
  return solved;
}

void ActiveSet::margins(std::vector<ForceMargin>& out) {
  for (ActiveContact& contact : contacts_) contact.sets_margin = true;
  margins_.distribute(contacts_, least_);
  out.clear();
  for_groups([&](std::size_t first, std::size_t last) {
    out.push_back({first, last, margins_.least({contacts_.data() + first, last - first})});
  });
}

bool ActiveSet::corrections(const Assembly& assembly, const double* velocity, double* of_position,
                            double* of_velocity) {
  bool any = false;
  for_groups([&](std::size_t first, std::size_t last) {
    state_equations(assembly, first, last, false);
    for (const bool position : {true, false}) {
      double* const out = position ? of_position : of_velocity;
      unknown_.resize(rows_.size());
      for (std::size_t i = 0; i < rows_.size(); ++i) {
        const Constraint& at = contacts_[rows_[i].contact].at;
        const int row = row_of(rows_[i], at);
        // Sticking contacts have no place of their own: the tangent is kept on velocity level.
        unknown_[i] = position ? (rows_[i].tangent ? 0.0 : -at.gap) : -at.velocity(row, velocity);
        if (!(position && rows_[i].tangent)) unknown_[i] -= at.times(row, out);
        any = any || unknown_[i] != 0.0;
      }
      if (solve()) delassus_.add_response(unknown_, out);
    }
  });
  return any;
}

}  // namespace carom
