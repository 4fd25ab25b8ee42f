// Problem: hand a large island to solvers as the rows of its constraints and the masses of its bodies.

#include <carom/contact/factor_maker.h>
#include <carom/contact/solvers/response_factors.h>

#include <algorithm>

namespace carom {

namespace {

constexpr int no_slot = ResponseFactors::no_slot;

/// Writes the numbers of a row: blocks of three, the last of which a body without spin does not have.
/// \param h the row of the constraint
void write_row(const Constraint& at, const double* h, ResponseFactors::Row& row) {
  constexpr int of_planar_body = ResponseFactors::columns;
  double* to = row.h.data();
  row.h = {};
  for (int b = 0; b < at.bodies; ++b, to += of_planar_body) {
    const bool turns = at.blocks[static_cast<std::size_t>(b)].columns == of_planar_body;
    to[0] = h[0];
    to[1] = h[1];
    if (turns) to[2] = h[2];
    h += turns ? 3 : 2;
  }
}

/// Both rows of a contact between two bodies that turn, the usual case in a pile.
void write_rows_of_two(const Constraint& at, const std::array<int, 3>& slots, ResponseFactors::Row* rows) {
  constexpr std::size_t width = 2 * ResponseFactors::columns;
  const double* h = at.row(0);
  for (ResponseFactors::Row* row = rows; row < rows + 2; ++row, h += width) {
    row->slot = slots;
    for (std::size_t k = 0; k < width; ++k) row->h[k] = h[k];
    for (std::size_t k = width; k < row->h.size(); ++k) row->h[k] = 0.0;
  }
}

/// Whether a constraint has such rows, and directions begin with both of them.
bool has_rows_of_two(const Constraint& at, std::span<const ImpulseDirection> directions) {
  constexpr int of_planar_body = ResponseFactors::columns;
  return at.bodies == 2 && at.rows == 2 && at.blocks[0].columns == of_planar_body &&
         at.blocks[1].columns == of_planar_body && directions.size() > 1 && directions[0].row == 0 &&
         directions[1].row == 1 && directions[1].constraint == &at;
}

/// Inverse masses of a body of the plane, that of its spin 0 where it does not turn.
std::array<double, 3> inverse_masses(const BodyMasses& of) {
  const double inverse = 1.0 / *of.mass;
  const bool turns = of.layout == BodyMasses::Layout::planar_bodies;
  return {inverse, inverse, turns ? 1.0 / *of.inertia : 0.0};
}

}  // namespace

/// A body that has no slot yet gets one; no_slot where it does not answer for itself in the plane.
int FactorMaker::add_slot(const Constraint::Block& block, const BodyResponse& response) {
  const BodyMasses masses = response.alone(block.body);
  if (masses.mass == nullptr || masses.layout == BodyMasses::Layout::spatial_points) return no_slot;
  if (block.body >= slot_of_body_.size()) slot_of_body_.resize(block.body + 1, no_slot);
  const int slot = slot_of_body_[block.body] = static_cast<int>(slots_.size());
  slots_.push_back({block, inverse_masses(masses)});
  return slot;
}

/// Slot of a body of a constraint; no_slot where there is none, or it does not answer for itself in the
/// plane.
inline int FactorMaker::slot_of(const Constraint& constraint, std::size_t body,
                                const BodyResponse& response) {
  if (static_cast<int>(body) >= constraint.bodies) return no_slot;
  const Constraint::Block& block = constraint.blocks[body];
  const bool known = block.body < slot_of_body_.size();
  const int slot = known ? slot_of_body_[block.body] : no_slot;
  return slot != no_slot ? slot : add_slot(block, response);
}

/// Rows of bodies that answer for themselves; false at the first of another one.
bool FactorMaker::write_rows(Range some, BodyResponse& response, ResponseFactors& factors) {
  for (std::size_t r = some.begin; r < some.end;) {
    const Constraint& at = *directions_[r].constraint;
    // One by one: written as a list and read as one, they would have to wait for each other.
    const int first = slot_of(at, 0, response), second = slot_of(at, 1, response),
              third = slot_of(at, 2, response);
    const bool fits = at.rows <= 2 && first != no_slot && (at.bodies < 2 || second != no_slot) &&
                      (at.bodies < 3 || third != no_slot);
    if (!fits) return false;
    slots_of_constraint_.push_back({first, second, third});
    if (has_rows_of_two(at, directions_.subspan(r))) {
      write_rows_of_two(at, {first, second, third}, &factors.rows[r]);
      r += 2;
      continue;
    }
    for (; r < some.end && directions_[r].constraint == &at; ++r) {
      ResponseFactors::Row& row = factors.rows[r];
      row.slot = {first, second, third};
      write_row(at, at.row(directions_[r].row), row);
    }
  }
  return true;
}

bool FactorMaker::build(std::span<const ImpulseDirection> directions, Range some, BodyResponse& response,
                        ContactProblem& problem) {
  directions_ = directions;
  if (some.begin == 0) {
    clear();
    slots_of_constraint_.clear();
  }
  const bool fits = write_rows(some, response, problem.factors());
  if (fits && some.end < directions.size()) return true;
  // Bodies are no slots until the next problem.
  for (const Slot& own : slots_) slot_of_body_[own.block.body] = no_slot;
  if (!fits) {
    clear();
    return false;
  }
  bodies_ = Bodies::alone;
  write_masses(problem.factors());
  return true;
}

void FactorMaker::add_response(std::span<const double> impulses, double* x, double scale) const {
  std::size_t constraint = 0;
  for (std::size_t r = 0; r < directions_.size(); ++r) {
    const Constraint& at = *directions_[r].constraint;
    if (r > 0 && directions_[r - 1].constraint != &at) ++constraint;
    const std::array<int, 3>& slot = slots_of_constraint_[constraint];
    const double* h = at.row(directions_[r].row);
    const double impulse = scale * impulses[r];
    for (std::size_t b = 0; b < static_cast<std::size_t>(at.bodies); ++b) {
      const Slot& body = slots_[static_cast<std::size_t>(slot[b])];
      double* const to = x + body.block.v;
      for (std::size_t c = 0; c < static_cast<std::size_t>(body.block.columns); ++c)
        to[c] += *h++ * body.inverse_mass[c] * impulse;
    }
  }
}

bool FactorMaker::build_bound(std::span<const ImpulseDirection> directions, const Delassus& responses,
                              const BodyResponse& response, ContactProblem& problem) {
  directions_ = directions;
  clear();
  if (responses.has_other_loads() || !list_slots(response)) {
    clear();
    return false;
  }
  bodies_ = Bodies::bound;
  ResponseFactors& factors = problem.factors();
  write_masses(factors);
  write_bound_rows(factors);
  write_answers(responses, factors);
  return true;
}

/// Bodies in the order of their velocities. False if a constraint is not one of the plane.
bool FactorMaker::list_slots(const BodyResponse& response) {
  constexpr int most_rows = 2;
  const Constraint* last = nullptr;
  for (const ImpulseDirection& direction : directions_) {
    const Constraint& at = *direction.constraint;
    if (at.rows > most_rows) return false;
    if (&at == last) continue;
    last = &at;
    for (std::size_t b = 0; b < static_cast<std::size_t>(at.bodies); ++b)
      slots_.push_back({at.blocks[b], {}});
  }
  std::sort(slots_.begin(), slots_.end(),
            [](const Slot& one, const Slot& other) { return one.block.v < other.block.v; });
  const auto same = [](const Slot& one, const Slot& other) { return one.block.v == other.block.v; };
  slots_.erase(std::unique(slots_.begin(), slots_.end(), same), slots_.end());
  bound_.assign(slots_.size(), 0);
  for (std::size_t slot = 0; slot < slots_.size(); ++slot) {
    const BodyMasses masses = response.alone(slots_[slot].block.body);
    if (masses.mass == nullptr) {
      bound_[slot] = 1;
      continue;
    }
    if (masses.layout == BodyMasses::Layout::spatial_points) return false;
    slots_[slot].inverse_mass = inverse_masses(masses);
  }
  return true;
}

/// The first slot whose velocities do not begin before `v`.
std::size_t FactorMaker::slot_from(Index v) const {
  const auto at = std::lower_bound(slots_.begin(), slots_.end(), v,
                                   [](const Slot& slot, Index number) { return slot.block.v < number; });
  return static_cast<std::size_t>(at - slots_.begin());
}

void FactorMaker::write_bound_rows(ResponseFactors& factors) const {
  for (std::size_t r = 0; r < directions_.size(); ++r) {
    const Constraint& at = *directions_[r].constraint;
    ResponseFactors::Row& row = factors.rows[r];
    if (r > 0 && directions_[r - 1].constraint == &at) {
      row.slot = factors.rows[r - 1].slot;
    } else {
      row.slot.fill(no_slot);
      for (std::size_t b = 0; b < static_cast<std::size_t>(at.bodies); ++b)
        row.slot[b] = static_cast<int>(slot_from(at.blocks[b].v));
    }
    write_row(at, at.row(directions_[r].row), row);
  }
}

/// Of the slots that are touched: nobody asks for the velocities of others.
void FactorMaker::write_answers(const Delassus& responses, ResponseFactors& factors) const {
  constexpr std::size_t columns = ResponseFactors::columns;
  ResponseFactors::Bound& bound = factors.bound;
  bound.clear();
  bound.slots = bound_;
  bound.first.reserve(responses.size() + 1);
  for (std::size_t row = 0; row < responses.size(); ++row) {
    bound.first.push_back(bound.answers.size());
    responses.for_reaches(row, [&](Range v, const double* answer) {
      const std::size_t first = slot_from(v.begin), end = slot_from(v.end);
      if (first == end || bound_[first] == 0) return;
      bound.answers.push_back({first, end - first, bound.numbers.size()});
      for (std::size_t slot = first; slot < end; ++slot) {
        const Constraint::Block& block = slots_[slot].block;
        const double* const own = answer + (block.v - v.begin);
        for (std::size_t k = 0; k < columns; ++k)
          bound.numbers.push_back(k < static_cast<std::size_t>(block.columns) ? own[k] : 0.0);
      }
    });
  }
  bound.first.push_back(bound.answers.size());
}

void FactorMaker::write_masses(ResponseFactors& factors) const {
  factors.inverse_mass.clear();
  for (const Slot& slot : slots_) {
    factors.inverse_mass.insert(factors.inverse_mass.end(), slot.inverse_mass.begin(),
                                slot.inverse_mass.end());
  }
}

}  // namespace carom
