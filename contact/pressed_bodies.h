#pragma once

/// \file
/// Obstacles whose motion leaves bodies no room, for errors of both modes.

#include <carom/contact/island_problem.h>
#include <carom/core/export.h>
#include <carom/core/system.h>

#include <string>

namespace carom {

/// Text that an error adds of a contact problem without an answer: the obstacles in it that move along the
/// normal of a contact, and the remedies; empty where none moves so.
[[nodiscard]] CAROM_API std::string pressed_by(const System& system, const IslandProblem& problem);

}  // namespace carom
