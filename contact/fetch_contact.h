#pragma once

/// \file
/// Memory of constraints that are soon to be read or written.

#include <carom/core/constraint.h>
#include <carom/core/numerics/fetch_ahead.h>

#include <cstddef>
#include <span>

namespace carom {

/// Asks for the memory of a constraint, as fetch_ahead(), but for columns of the Jacobian that no contact of
/// two bodies in the plane has: a fourth of it.
inline void fetch_contact_ahead(std::span<const Constraint> list, std::size_t place) {
  constexpr std::size_t columns = 6, rows = 2;  // of such a contact
  constexpr std::size_t end = offsetof(Constraint, jacobian) + rows * columns * sizeof(double);
  fetch_ahead(list, place, 0, end);
  fetch_ahead(list, place, offsetof(Constraint, key));
}

}  // namespace carom
