// Problem: hand a large island to solvers as the rows of its constraints and the masses of its bodies.

#include <carom/contact/delassus.h>

#include <algorithm>

namespace carom {

/// Slots of the bodies of a constraint; false where one does not answer for itself in the plane.
bool Delassus::add_slots(const Constraint& constraint, const BodyResponse& response, int* slot) {
  std::fill_n(slot, ResponseFactors::most_slots, ResponseFactors::no_slot);
  for (int b = 0; b < constraint.bodies; ++b) {
    const Constraint::Block& block = constraint.blocks[static_cast<std::size_t>(b)];
    if (block.body >= slot_of_body_.size()) slot_of_body_.resize(block.body + 1, ResponseFactors::no_slot);
    int& own = slot_of_body_[block.body];
    if (own == ResponseFactors::no_slot) {
      const BodyMasses masses = response.alone(block.body);
      if (masses.mass == nullptr || masses.layout == BodyMasses::Layout::spatial_points) return false;
      const bool turns = masses.layout == BodyMasses::Layout::planar_bodies;
      own = static_cast<int>(slots_.size());
      const double inverse = 1.0 / *masses.mass;
      slots_.push_back({block, {inverse, inverse, turns ? 1.0 / *masses.inertia : 0.0}});
    }
    slot[b] = own;
  }
  return true;
}

bool Delassus::build_factors(std::span<const ImpulseDirection> directions, BodyResponse& response,
                             ContactProblem& problem) {
  constexpr std::size_t columns = ResponseFactors::columns;
  directions_ = directions;
  slots_.clear();
  factored_ = true;
  ResponseFactors& factors = problem.factors();
  slots_of_row_.resize(directions.size() * ResponseFactors::most_slots);
  int* slot = slots_of_row_.data();
  const Constraint* last = nullptr;
  for (std::size_t r = 0; r < directions.size(); ++r, slot += ResponseFactors::most_slots) {
    const Constraint& at = *directions[r].constraint;
    if (&at == last) {
      std::copy_n(slot - ResponseFactors::most_slots, ResponseFactors::most_slots, slot);
    } else {
      factored_ = at.rows <= 2 && add_slots(at, response, slot);
      if (!factored_) break;
      last = &at;
    }
    ResponseFactors::Row& row = factors.rows[r];
    row.h.fill(0.0);
    std::copy_n(slot, ResponseFactors::most_slots, row.slot.begin());
    const double* h = at.row(directions[r].row);
    for (std::size_t b = 0; b < static_cast<std::size_t>(at.bodies); ++b) {
      const int width = at.blocks[b].columns;
      std::copy_n(h, width, row.h.begin() + static_cast<std::ptrdiff_t>(columns * b));
      h += width;
    }
  }
  // Bodies are no slots until the next problem.
  for (const Slot& own : slots_) slot_of_body_[own.block.body] = ResponseFactors::no_slot;
  if (factored_) write_masses(factors);
  return factored_;
}

void Delassus::write_masses(ResponseFactors& factors) const {
  factors.inverse_mass.clear();
  for (const Slot& slot : slots_) {
    factors.inverse_mass.insert(factors.inverse_mass.end(), slot.inverse_mass.begin(),
                                slot.inverse_mass.end());
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
      double* const to = x + body.block.v;
      for (std::size_t c = 0; c < static_cast<std::size_t>(body.block.columns); ++c)
        to[c] += *h++ * body.inverse_mass[c] * impulse;
    }
  }
}

}  // namespace carom
