// Problem: hand a large island to solvers as the rows of its constraints and the masses of its bodies.

#include <carom/contact/delassus.h>

#include <algorithm>

namespace carom {

/// Slots of the bodies of a constraint; false where one does not answer for itself in the plane.
bool Delassus::add_slots(const Constraint& constraint, const BodyResponse& response) {
  for (int b = 0; b < constraint.bodies; ++b) {
    const Constraint::Block& block = constraint.blocks[static_cast<std::size_t>(b)];
    if (block.body >= slot_of_body_.size()) slot_of_body_.resize(block.body + 1, ResponseFactors::no_slot);
    int& slot = slot_of_body_[block.body];
    if (slot != ResponseFactors::no_slot) continue;
    const BodyMasses masses = response.alone(block.body);
    if (masses.mass == nullptr || masses.layout == BodyMasses::Layout::spatial_points) return false;
    const bool turns = masses.layout == BodyMasses::Layout::planar_bodies;
    slot = static_cast<int>(slots_.size());
    const double inverse = 1.0 / *masses.mass;
    slots_.push_back({block.v, block.columns, {inverse, inverse, turns ? 1.0 / *masses.inertia : 0.0}});
  }
  return true;
}

bool Delassus::build_factors(std::span<const ImpulseDirection> directions, BodyResponse& response) {
  directions_ = directions;
  slots_.clear();
  factored_ = true;
  const Constraint* last = nullptr;
  for (const ImpulseDirection& direction : directions) {
    if (direction.constraint == last) continue;
    last = direction.constraint;
    factored_ = last->rows <= 2 && add_slots(*last, response);
    if (!factored_) break;
  }
  slots_of_row_.assign(directions.size() * ResponseFactors::most_slots, ResponseFactors::no_slot);
  int* slot = slots_of_row_.data();
  for (const ImpulseDirection& direction : directions) {
    if (!factored_) break;
    const Constraint& at = *direction.constraint;
    for (std::size_t b = 0; b < static_cast<std::size_t>(at.bodies); ++b)
      slot[b] = slot_of_body_[at.blocks[b].body];
    slot += ResponseFactors::most_slots;
  }
  // Bodies are no slots until the next problem.
  for (const ImpulseDirection& direction : directions) {
    for (std::size_t b = 0; b < static_cast<std::size_t>(direction.constraint->bodies); ++b) {
      const Index body = direction.constraint->blocks[b].body;
      if (body < slot_of_body_.size()) slot_of_body_[body] = ResponseFactors::no_slot;
    }
  }
  return factored_;
}

void Delassus::write_factors(ContactProblem& problem) const {
  constexpr std::size_t columns = ResponseFactors::columns;
  ResponseFactors& factors = problem.factors();
  factors.inverse_mass.resize(columns * slots_.size());
  for (std::size_t slot = 0; slot < slots_.size(); ++slot) {
    const auto& inverse = slots_[slot].inverse_mass;
    std::copy(inverse.begin(), inverse.end(),
              factors.inverse_mass.begin() + static_cast<std::ptrdiff_t>(columns * slot));
  }
  for (std::size_t r = 0; r < size(); ++r) {
    const Constraint& at = *directions_[r].constraint;
    const double* h = at.row(directions_[r].row);
    ResponseFactors::Row& row = factors.rows[r];
    std::copy_n(slots_of_row_.begin() + static_cast<std::ptrdiff_t>(r * row.slot.size()), row.slot.size(),
                row.slot.begin());
    for (std::size_t b = 0; b < static_cast<std::size_t>(at.bodies); ++b) {
      const int width = at.blocks[b].columns;
      std::copy_n(h, width, row.h.begin() + static_cast<std::ptrdiff_t>(columns * b));
      h += width;
    }
  }
}

void Delassus::add_factored_response(std::span<const double> impulses, double* x, double scale) const {
  const int* slot = slots_of_row_.data();
  for (std::size_t r = 0; r < size(); ++r, slot += ResponseFactors::most_slots) {
    const Constraint& at = *directions_[r].constraint;
    const double* h = at.row(directions_[r].row);
    const double impulse = scale * impulses[r];
    for (std::size_t b = 0; b < static_cast<std::size_t>(at.bodies); ++b) {
      const Slot& body = slots_[static_cast<std::size_t>(slot[b])];
      double* const to = x + body.v;
      for (std::size_t c = 0; c < static_cast<std::size_t>(body.columns); ++c)
        to[c] += *h++ * body.inverse_mass[c] * impulse;
    }
  }
}

}  // namespace carom
