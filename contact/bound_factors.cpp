// Problem: let sweeps solve contacts of mechanisms, whose bodies do not answer one by one.

#include <carom/contact/bound_factors.h>
#include <carom/contact/factor_row.h>

#include <algorithm>

namespace carom {

bool BoundFactors::write(std::span<const ImpulseDirection> directions, const Delassus& responses,
                         const BodyResponse& response, ContactProblem& problem) {
  if (responses.has_other_loads() || !list_slots(directions, response)) {
    clear();
    return false;
  }
  ResponseFactors& factors = problem.factors();
  write_factor_masses(slots_, factors);
  write_rows(directions, factors);
  write_answers(responses, factors);
  return true;
}

/// Bodies in the order of their velocities. False if a constraint is not one of the plane.
bool BoundFactors::list_slots(std::span<const ImpulseDirection> directions, const BodyResponse& response) {
  constexpr int most_rows = 2;
  slots_.clear();
  const Constraint* last = nullptr;
  for (const ImpulseDirection& direction : directions) {
    const Constraint& at = *direction.constraint;
    if (at.rows > most_rows) return false;
    if (&at == last) continue;
    last = &at;
    for (std::size_t b = 0; b < static_cast<std::size_t>(at.bodies); ++b)
      slots_.push_back({at.blocks[b], {}});
  }
  std::sort(slots_.begin(), slots_.end(), [](const Delassus::Slot& one, const Delassus::Slot& other) {
    return one.block.v < other.block.v;
  });
  const auto same = [](const Delassus::Slot& one, const Delassus::Slot& other) {
    return one.block.v == other.block.v;
  };
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
std::size_t BoundFactors::slot_from(Index v) const {
  const auto at =
      std::lower_bound(slots_.begin(), slots_.end(), v,
                       [](const Delassus::Slot& slot, Index number) { return slot.block.v < number; });
  return static_cast<std::size_t>(at - slots_.begin());
}

void BoundFactors::write_rows(std::span<const ImpulseDirection> directions, ResponseFactors& factors) const {
  for (std::size_t r = 0; r < directions.size(); ++r) {
    const Constraint& at = *directions[r].constraint;
    ResponseFactors::Row& row = factors.rows[r];
    if (r > 0 && directions[r - 1].constraint == &at) {
      row.slot = factors.rows[r - 1].slot;
    } else {
      row.slot.fill(ResponseFactors::no_slot);
      for (std::size_t b = 0; b < static_cast<std::size_t>(at.bodies); ++b)
        row.slot[b] = static_cast<int>(slot_from(at.blocks[b].v));
    }
    write_factor_row(at, at.row(directions[r].row), row);
  }
}

/// Of the slots that are touched: nobody asks for the velocities of others.
void BoundFactors::write_answers(const Delassus& responses, ResponseFactors& factors) const {
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

}  // namespace carom
