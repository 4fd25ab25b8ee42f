#pragma once

/// \file
/// Simulations of several bodies that touch each other, in both modes.

#include "validation/report.h"

namespace validation {

/// Adds velocities behind Newton's cradle under both laws of impact, forces in stacks and in a pyramid.
void add_runs_of_several_bodies(Page& page);

}  // namespace validation
