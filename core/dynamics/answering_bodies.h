#pragma once

/// \file
/// The bodies that answer an impulse: those that it acts on, and all that joints connect to them.

#include <carom/core/assembly.h>
#include <carom/core/constraint.h>
#include <carom/core/export.h>

#include <span>

namespace carom {

/// Kinetic energy of all bodies that answer an impulse along one of some constraints [J].
/// \param velocities of the model
[[nodiscard]] CAROM_API double kinetic_energy_of_answering(const Assembly& assembly,
                                                           std::span<const Constraint> constraints,
                                                           const double* velocities);

}  // namespace carom
