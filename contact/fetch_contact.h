#pragma once

/// \file
/// Memory of constraints that are soon to be read or written.

#include <carom/core/constraint.h>
#include <carom/core/numerics/fetch_ahead.h>

#include <cstddef>
#include <span>

namespace carom {

/// Asks for the memory of a constraint, as fetch_ahead(), and for that of the rows of one whose turn comes
/// sooner, since they can be found only where it is at hand.
inline void fetch_contact_ahead(std::span<const Constraint> list, std::size_t place) {
  constexpr std::size_t sooner = 6;      // constraints
  constexpr std::size_t of_two = 6 * 2;  // numbers of a contact of two bodies in the plane
  fetch_ahead(list, place);
  if (place < sooner || place - sooner >= list.size()) return;
  const double* const rows = list[place - sooner].row(0);
  fetch_ahead_of_many(list.size_bytes(), rows, of_two * sizeof(double));
}

}  // namespace carom
