#pragma once

/// \file
/// The vector b of a contact problem: velocities along the rows that a step or impact would end with if no
/// constraint acted, against those of the surfaces then, and the restitution (docs/method.md, section 2).

#include <carom/contact/contact_velocity.h>
#include <carom/contact/delassus.h>
#include <carom/contact/factor_maker.h>
#include <carom/contact/solvers/contact_problem.h>
#include <carom/core/constraint.h>

#include <array>
#include <span>
#include <vector>

namespace carom {

/// Velocities before, and the restitution that they come back with, by row.
struct RowsBefore {
  std::span<const double> velocity;     ///< gamma^- [m/s]
  std::span<const double> restitution;  ///< e
};

/// b of the rows of a contact in the plane. \param velocity_free of all bodies \param gamma velocities along
/// the rows before \param e what restitution they come back with
[[nodiscard]] inline std::array<double, 2> vector_of_contact(const Constraint& contact,
                                                             const double* velocity_free, const double* gamma,
                                                             const double* e) {
  const std::array<double, 2> along = times_both_rows(contact, velocity_free);
  std::array<double, 2> b{along[0] - contact.surface_velocity_after[0] + e[0] * gamma[0],
                          along[1] - contact.surface_velocity_after[1] + e[1] * gamma[1]};
  if (contact.allowed_approach > 0.0) b[0] += contact.allowed_approach;
  return b;
}

/// b of one contact in the plane, both of whose rows can be moved: the usual problem. False of any other.
/// \param velocity_free of all bodies
[[nodiscard]] inline bool set_free_velocity_of_contact(std::span<const Constraint> constraints,
                                                       const double* velocity_free, const RowsBefore& before,
                                                       ContactProblem& problem) {
  const bool is_one = constraints.size() == 1 && constraints.front().rows == 2;
  if (!is_one || problem.diagonal(0) == 0.0 || problem.diagonal(1) == 0.0) return false;
  const std::array<double, 2> b = vector_of_contact(constraints.front(), velocity_free,
                                                    before.velocity.data(), before.restitution.data());
  problem.vector()[0] = b[0];
  problem.vector()[1] = b[1];
  return true;
}
/// b of a problem whose W is made. \param velocity_free of all bodies
void set_free_velocity_of_rows(std::span<const Constraint> constraints, const double* velocity_free,
                               const RowsBefore& before, ContactProblem& problem);
/// b of a problem in factors. \param given part of it without velocities of bodies at the end
/// \param scratch velocities of slots
void set_free_velocity_of_slots(std::span<const ImpulseDirection> directions,
                                std::span<const FactorMaker::Slot> slots, const double* velocity_free,
                                std::span<const double> given, std::vector<double>& scratch,
                                ContactProblem& problem);

}  // namespace carom
