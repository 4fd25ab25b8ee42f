#pragma once

/// \file
/// The vector b of a contact problem: velocities along the rows that a step or impact would end with if no
/// constraint acted, against those of the surfaces then, and the restitution (docs/method.md, section 2).

#include <carom/contact/delassus.h>
#include <carom/contact/solvers/contact_problem.h>
#include <carom/core/constraint.h>

#include <span>
#include <vector>

namespace carom {

/// Velocities before, and the restitution that they come back with, by row.
struct RowsBefore {
  std::span<const double> velocity;     ///< gamma^- [m/s]
  std::span<const double> restitution;  ///< e
};

/// b of a problem whose W is made. \param velocity_free of all bodies
void set_free_velocity_of_rows(std::span<const Constraint> constraints, const double* velocity_free,
                               const RowsBefore& before, ContactProblem& problem);
/// b of a problem in factors. \param given part of it without velocities of bodies at the end
/// \param scratch velocities of slots
void set_free_velocity_of_slots(std::span<const ImpulseDirection> directions,
                                std::span<const Delassus::Slot> slots, const double* velocity_free,
                                std::span<const double> given, std::vector<double>& scratch,
                                ContactProblem& problem);

}  // namespace carom
