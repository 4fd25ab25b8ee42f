#pragma once

/// \file
/// SolverErrors of a run itself, told from those that a function of the user throws.

#include <carom/core/errors.h>
#include <carom/core/export.h>

namespace carom {

/// A computation of a run that did not succeed. Stages that know another way (a stronger iteration, a shorter
/// step, an event) catch this error and no other: whatever a law, an element or a shape of the user throws
/// ends the call, a SolverError of another simulation included. Users get it as the SolverError that it is
/// (Simulation::step()).
class CAROM_API RunError : public SolverError {
public:
  using SolverError::SolverError;
};

}  // namespace carom
