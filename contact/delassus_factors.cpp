// Problem: hand a large island to solvers as the rows of its constraints and the masses of its bodies.

#include <carom/contact/delassus.h>
#include <carom/contact/factor_row.h>

namespace carom {

/// A body that has no slot yet gets one; no_slot where it does not answer for itself in the plane.
int Delassus::add_slot(const Constraint::Block& block, const BodyResponse& response) {
  const BodyMasses masses = response.alone(block.body);
  if (masses.mass == nullptr || masses.layout == BodyMasses::Layout::spatial_points) {
    return ResponseFactors::no_slot;
  }
  if (block.body >= slot_of_body_.size()) slot_of_body_.resize(block.body + 1, ResponseFactors::no_slot);
  const int slot = slot_of_body_[block.body] = static_cast<int>(slots_.size());
  slots_.push_back({block, inverse_masses(masses)});
  return slot;
}

/// Slot of a body of a constraint; no_slot where there is none, or it does not answer for itself in the
/// plane.
inline int Delassus::slot_of(const Constraint& constraint, std::size_t body, const BodyResponse& response) {
  if (static_cast<int>(body) >= constraint.bodies) return ResponseFactors::no_slot;
  const Constraint::Block& block = constraint.blocks[body];
  const bool known = block.body < slot_of_body_.size();
  const int slot = known ? slot_of_body_[block.body] : ResponseFactors::no_slot;
  return slot != ResponseFactors::no_slot ? slot : add_slot(block, response);
}

namespace {

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

}  // namespace

bool Delassus::build_factors(std::span<const ImpulseDirection> directions, Range some, BodyResponse& response,
                             ContactProblem& problem) {
  constexpr int no_slot = ResponseFactors::no_slot;
  directions_ = directions;
  ResponseFactors& factors = problem.factors();
  factored_ = true;
  if (some.begin == 0) {
    slots_.clear();
    slots_of_constraint_.clear();
  }
  for (std::size_t r = some.begin; r < some.end;) {
    const Constraint& at = *directions[r].constraint;
    // One by one: written as a list and read as one, they would have to wait for each other.
    const int first = slot_of(at, 0, response), second = slot_of(at, 1, response),
              third = slot_of(at, 2, response);
    factored_ = at.rows <= 2 && first != no_slot && (at.bodies < 2 || second != no_slot) &&
                (at.bodies < 3 || third != no_slot);
    if (!factored_) break;
    slots_of_constraint_.push_back({first, second, third});
    if (has_rows_of_two(at, directions.subspan(r))) {
      write_rows_of_two(at, {first, second, third}, &factors.rows[r]);
      r += 2;
      continue;
    }
    for (; r < some.end && directions[r].constraint == &at; ++r) {
      ResponseFactors::Row& row = factors.rows[r];
      row.slot = {first, second, third};
      write_factor_row(at, at.row(directions[r].row), row);
    }
  }
  if (factored_ && some.end < directions.size()) return true;
  // Bodies are no slots until the next problem.
  for (const Slot& own : slots_) slot_of_body_[own.block.body] = ResponseFactors::no_slot;
  if (factored_) write_factor_masses(slots_, factors);
  return factored_;
}

void Delassus::add_factored_response(std::span<const double> impulses, double* x, double scale) const {
  std::size_t constraint = 0;
  for (std::size_t r = 0; r < size(); ++r) {
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

}  // namespace carom
