#pragma once

/// \file
/// Rows of constraints, and masses of bodies, as factors of a contact problem have them
/// (solvers/response_factors.h).

#include <carom/contact/delassus.h>
#include <carom/contact/solvers/response_factors.h>
#include <carom/core/constraint.h>
#include <carom/core/dynamics/body_response.h>

#include <array>
#include <cstddef>
#include <span>

namespace carom {

/// Writes the numbers of a row: blocks of three, the last of which a body without spin does not have.
/// \param h the row of the constraint
inline void write_factor_row(const Constraint& at, const double* h, ResponseFactors::Row& row) {
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

/// Inverse masses of a body of the plane, that of its spin 0 where it does not turn.
[[nodiscard]] inline std::array<double, 3> inverse_masses(const BodyMasses& of) {
  const double inverse = 1.0 / *of.mass;
  const bool turns = of.layout == BodyMasses::Layout::planar_bodies;
  return {inverse, inverse, turns ? 1.0 / *of.inertia : 0.0};
}

/// Writes inverse masses of bodies, slot by slot.
inline void write_factor_masses(std::span<const Delassus::Slot> slots, ResponseFactors& factors) {
  factors.inverse_mass.clear();
  for (const Delassus::Slot& slot : slots) {
    factors.inverse_mass.insert(factors.inverse_mass.end(), slot.inverse_mass.begin(),
                                slot.inverse_mass.end());
  }
}

}  // namespace carom
