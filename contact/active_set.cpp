// Problem: forces and corrections of contacts that are constraints.

#include <carom/contact/active_set.h>
#include <carom/contact/detection/rolling_resistance.h>

#include <algorithm>
#include <cmath>

namespace carom {

namespace {

/// W_ii of bodies that answer for themselves, without friction: what a row is made of [1/kg].
double own_response(const ImpulseDirection& direction, const BodyResponse& response) {
  const Constraint& at = *direction.constraint;
  const double* number = at.row(direction.row);
  double sum = 0.0;
  for (std::size_t b = 0; b < static_cast<std::size_t>(at.bodies); ++b) {
    const Constraint::Block& block = at.blocks[b];
    const BodyMasses masses = response.alone(block.body);
    if (masses.mass == nullptr) return 0.0;
    const int turning = masses.inertia == nullptr ? block.columns : block.columns - 1;
    for (int k = 0; k < block.columns; ++k, ++number)
      sum += *number * *number / (k < turning ? *masses.mass : *masses.inertia);
  }
  return sum;
}

}  // namespace

double ActiveContact::friction_at(const Constraint& where, const double* velocities) const {
  if (frictionless) return 0.0;
  if (sticks()) return where.law.sticking_friction();
  if (!where.law.falls_with_speed()) return where.law.friction;
  return where.law.sliding_friction(velocity_along(where, slip_direction(), velocities));
}

void ActiveSet::bind(const Assembly& assembly, ComponentsResponse& response) {
  assembly_ = &assembly;
  response_ = response.no_joints() ? nullptr : &response;
}

void ActiveSet::update(const Detector& detector, const StateView& state, const Evaluation& evaluation,
                       const GroundPlaces& places) {
  const Constraint* last = nullptr;
  for (ActiveContact& contact : contacts_) {
    if (contact.pair.rolling) {
      write_rolling_resistance(*last, motion_of(detector, contact.pair, places), contact.at);
    } else if (contact.feature != none) {
      follow(detector, contact.pair, contact.feature, state, evaluation, places, contact.at);
    } else {
      detector.contact(contact.pair, state, evaluation, places, contact.at);
    }
    contact.friction = contact.friction_at(contact.at, state.v);
    last = &contact.at;
  }
}

Index ActiveSet::mechanism(Index body) const {
  return response_ == nullptr ? body : assembly_->mechanism(body);
}

/// Finds which contacts are of mechanisms that touch each other; false if none do.
bool ActiveSet::find_islands() {
  // Rows of a joint are of one mechanism.
  const auto may_join = [](const ActiveContact& contact) {
    return contact.at.bodies > 1 && !contact.at.key.is_of_joint();
  };
  if (std::none_of(contacts_.begin(), contacts_.end(), may_join)) return false;
  std::vector<JoinedNodes>& joined = memory_->joined;
  joined.clear();
  Index nodes = 0;
  for (const ActiveContact& contact : contacts_) {
    const Index first = mechanism(contact.at.body());
    const Index second = may_join(contact) ? mechanism(contact.at.blocks[1].body) : first;
    joined.push_back({first, second});
    nodes = std::max({nodes, first + 1, second + 1});
  }
  memory_->last.resize(contacts_.size());
  for (const Range& island : memory_->islands.arrange(joined, nodes)) {
    const std::span<const Index> members =
        memory_->islands.order().subspan(island.begin, island.end - island.begin);
    for (const Index contact : members) memory_->last[contact] = members.back();
  }
  return true;
}

/// Calls f(first, last) for the contacts of each island; where those of one stand among others, of several
/// islands together.
template <class F>
void ActiveSet::for_groups(F&& f) {
  if (contacts_.size() == 1) return f(0, 1);
  const bool islands = find_islands();
  for (std::size_t first = 0; first < contacts_.size();) {
    std::size_t last = first + 1;
    if (islands) {
      for (std::size_t i = first; i < last; ++i) last = std::max(last, std::size_t{memory_->last[i]} + 1);
    } else {
      const Index of_first = mechanism(contacts_[first].at.body());
      while (last < contacts_.size() && mechanism(contacts_[last].at.body()) == of_first) ++last;
    }
    f(first, last);
    first = last;
  }
}

bool ActiveSet::answers_with_joints(std::size_t first, std::size_t last) const {
  if (response_ == nullptr) return false;
  for (std::size_t i = first; i < last; ++i) {
    const Constraint& at = contacts_[i].at;
    for (int b = 0; b < at.bodies; ++b) {
      if (assembly_->is_jointed(at.blocks[static_cast<std::size_t>(b)].body)) return true;
    }
  }
  return false;
}

int ActiveSet::row_of(const Row& row, const Constraint& at) { return row.tangent ? at.tangent_row() : 0; }

/// Moment of the rolling resistance of a contact by its normal force: 0 where the spin is held, or none is.
double ActiveSet::lever(std::size_t contact) const {
  if (contact + 1 >= contacts_.size() || !contacts_[contact + 1].at.attached) return 0.0;
  const ActiveContact& rolling = contacts_[contact + 1];
  return rolling.friction_ratio(0) * rolling.at.of_joint.length;  // it has one row, along the spin
}

/// Rows of one group, and the products of these with what forces along their columns do.
/// \param slips whether forces of contacts that slip are turned into the cone of friction
void ActiveSet::state_equations(const Assembly& assembly, std::size_t first, std::size_t last, bool slips) {
  std::vector<Row>& rows = memory_->rows;
  std::vector<ImpulseDirection>& directions = memory_->directions;
  rows.clear();
  rows.reserve(2 * (last - first));
  for (std::size_t i = first; i < last; ++i) {
    if (contacts_[i].at.normals > 0) rows.push_back({i, false});
    if (contacts_[i].sticks()) rows.push_back({i, true});
  }
  directions.clear();
  directions.reserve(rows.size());
  for (const Row& row : rows) {
    const ActiveContact& contact = contacts_[row.contact];
    const bool turned = !row.tangent && slips;
    TangentDirection::Numbers ratios{};
    if (turned) for_tangents(contact.at, [&](std::size_t k, int) { ratios[k] = contact.friction_ratio(k); });
    directions.push_back({&contact.at, row_of(row, contact.at), ratios, turned ? lever(row.contact) : 0.0});
  }
  memory_->exponents.clear();
  if (answers_with_joints(first, last)) {
    memory_->delassus.build(directions, *response_);
    return;
  }
  MassResponse response(assembly);
  memory_->delassus.build(directions, response);
  const auto is_of_two = [](const ImpulseDirection& direction) { return direction.constraint->bodies > 1; };
  if (std::none_of(directions.begin(), directions.end(), is_of_two)) return;
  for (const ImpulseDirection& direction : directions) {
    const double own = own_response(direction, response);
    if (!(own > 0.0 && std::isfinite(own))) return memory_->exponents.clear();
    memory_->exponents.push_back(std::ilogb(own));
  }
}

/// Scales rows of heavy bodies, which answer little, to those of light ones: a row is to be told from
/// rounding by what it is made of itself. By powers of two, so that nothing is rounded, and coarse ones, so
/// that rows of like masses stay as they are. \param matrix_too else of the unknowns alone
void ActiveSet::scale_rows(bool matrix_too) {
  constexpr int coarse = 16;  // in powers of two
  std::vector<int>& exponents = memory_->exponents;
  if (exponents.empty()) return;
  const int most = *std::max_element(exponents.begin(), exponents.end());
  const std::size_t n = exponents.size();
  for (std::size_t i = 0; i < n; ++i) {
    const int up = (most - exponents[i]) / coarse * coarse;
    if (up == 0) continue;
    memory_->unknown[i] = std::ldexp(memory_->unknown[i], up);
    if (!matrix_too) continue;
    double* const row = memory_->factors.matrix() + i * n;
    for (std::size_t j = 0; j < n; ++j) row[j] = std::ldexp(row[j], up);
  }
}

/// Solves the equations of the group for the unknowns. \param again they have been solved for other ones: by
/// the same factors, with the same bits
bool ActiveSet::solve(bool again) {
  const std::size_t n = memory_->rows.size();
  if (!again) {
    memory_->factors.reset(n);
    memory_->delassus.write(memory_->factors.matrix());
  }
  if (n > 1) scale_rows(!again);
  return again ? memory_->factors.solve_again(memory_->unknown)
               : memory_->factors.solve(dependent, memory_->unknown);
}

/// Takes out of the accelerations what rounding of the equations has left in the rows. The response of a
/// heavy body is lost in that of a light one beside it, and forces are wrong by that, up to the ratio of
/// masses times rounding; what corrects it is too small to be added to the forces. \param size of the
/// accelerations along the rows without contact
void ActiveSet::refine(double size, double* acceleration) {
  constexpr int most = 3;
  constexpr double rounding = 1e-12;
  std::vector<double>& unknown = memory_->unknown;
  for (int i = 0; i < most; ++i) {
    double largest = 0.0;
    for (std::size_t row = 0; row < unknown.size(); ++row) {
      const Constraint& at = contacts_[memory_->rows[row].contact].at;
      unknown[row] = -at.acceleration(row_of(memory_->rows[row], at), acceleration);
      largest = std::max(largest, std::abs(unknown[row]));
    }
    if (largest <= rounding * size || !solve(true)) return;
    memory_->delassus.add_response(unknown, acceleration);
  }
}

/// Friction in joints is known where it slips: a load. \param acceleration to add to
void ActiveSet::add_dry_friction(std::size_t first, std::size_t last, double* acceleration) {
  for (std::size_t i = first; i < last; ++i) {
    ActiveContact& contact = contacts_[i];
    if (!contact.at.has_given_bound()) continue;
    contact.normal = contact.at.of_joint.friction_bound;
    if (contact.sticks()) continue;
    contact.set_sliding_friction();
    JointConstraints& joints = *response_->joints_of(contact.at.body());
    const Range v = joints.velocities();
    std::vector<double>& load = memory_->load;
    load.resize(v.end);
    std::fill(load.begin() + v.begin, load.begin() + v.end, 0.0);
    contact.add_force(load.data());
    joints.apply_inverse_mass(load.data());
    joints.project(JointLevel::change, load.data());
    for (Index k = v.begin; k < v.end; ++k) acceleration[k] += load[k];
  }
}

/// Forces of one group.
bool ActiveSet::react(std::size_t first, std::size_t last, double* acceleration) {
  const std::vector<Row>& rows = memory_->rows;
  const FullPivoting& factors = memory_->factors;
  std::vector<double>& unknown = memory_->unknown;
  const std::size_t n = rows.size();
  unknown.resize(n);
  double size = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    const Constraint& at = contacts_[rows[i].contact].at;
    unknown[i] = -at.acceleration(row_of(rows[i], at), acceleration);
    size = std::max(size, std::abs(unknown[i]));
  }
  const bool solved = solve(false);
  const std::span<const ActiveContact> group(contacts_.data() + first, last - first);
  if (least_ && factors.rank() < n) memory_->least_forces.find(contacts_, group, rows, factors, unknown);
  for (std::size_t k = 0; k < factors.rank(); ++k) {
    memory_->pivots.push_back({rows[factors.row(k)], rows[factors.column(k)]});
  }
  for (std::size_t i = 0; i < n; ++i) {
    ActiveContact& contact = contacts_[rows[i].contact];
    (rows[i].tangent ? contact.tangential[0] : contact.normal) = unknown[i];
  }
  for (std::size_t i = first; i < last; ++i) {
    ActiveContact& contact = contacts_[i];
    contact.normal = contacts_[i - contact.at.attached].normal;
    if (!contact.sticks()) contact.set_sliding_friction();
  }
  memory_->delassus.add_response(unknown, acceleration);
  if (factors.rank() < n) memory_->margins.add(first, last, rows, factors);
  // Where rows depend on others, what is left in them is not of rounding.
  if (solved && n > 1 && factors.rank() == n) refine(size, acceleration);
  return solved;
}

bool ActiveSet::add_reactions(const Assembly& assembly, double* acceleration) {
  bool solved = true;
  memory_->margins.clear();
  memory_->pivots.clear();
  memory_->pivots.reserve(2 * contacts_.size());
  for_groups([&](std::size_t first, std::size_t last) {
    state_equations(assembly, first, last, true);
    if (response_ != nullptr) add_dry_friction(first, last, acceleration);
    solved = react(first, last, acceleration) && solved;
  });
  return solved;
}

void ActiveSet::margins(std::vector<ForceMargin>& out) {
  out.clear();
  if (contacts_.empty()) return;  // no reactions were asked for; null vectors are those of other contacts
  for (ActiveContact& contact : contacts_) contact.sets_margin = true;
  memory_->margins.distribute(contacts_, least_);
  for_groups([&](std::size_t first, std::size_t last) {
    out.push_back({first, last, memory_->margins.least({contacts_.data() + first, last - first})});
  });
}

bool ActiveSet::corrections(const Assembly& assembly, const double* velocity, double* of_position,
                            double* of_velocity) {
  const std::vector<Row>& rows = memory_->rows;
  std::vector<double>& unknown = memory_->unknown;
  bool any = false;
  for_groups([&](std::size_t first, std::size_t last) {
    state_equations(assembly, first, last, false);
    bool solved = false;
    for (const bool position : {true, false}) {
      double* const out = position ? of_position : of_velocity;
      unknown.resize(rows.size());
      for (std::size_t i = 0; i < rows.size(); ++i) {
        const Constraint& at = contacts_[rows[i].contact].at;
        const int row = row_of(rows[i], at);
        // Sticking contacts have no place of their own: the tangent is kept on velocity level.
        unknown[i] = position ? (rows[i].tangent ? 0.0 : -at.gap) : -at.velocity(row, velocity);
        if (!(position && rows[i].tangent)) unknown[i] -= at.times(row, out);
        any = any || unknown[i] != 0.0;
      }
      solved = solve(solved);
      if (solved) memory_->delassus.add_response(unknown, out);
    }
  });
  return any;
}

}  // namespace carom
