#pragma once

/// \file
/// Modes of rolling resistance, which is there where its contact stays closed: held, or rolling with its
/// moment at the bound; and the quantity that rolling and slip make Painleve's.

#include <carom/contact/island_problem.h>
#include <carom/contact/solvers/contact_mode.h>
#include <carom/contact/tangent_direction.h>
#include <carom/core/export.h>
#include <carom/integrators/event_driven/slip_directions.h>

#include <cstddef>
#include <span>

namespace carom {

/// Mode of a rolling resistance by an answer: held unless its moment is at its bound and the relative spin
/// changes. \param c its constraint in the problem \param contact mode of its contact \param slip direction
/// along the spin that it is taken to have, zero: may be held \param force by row
[[nodiscard]] CAROM_API ContactMode mode_of_rolling(const IslandProblem& problem, std::size_t c,
                                                    ContactMode contact, const TangentDirection& slip,
                                                    std::span<const double> force);
/// Opens the rolling resistance of candidates that open; closes that of those that stay: it is held, unless
/// it rolls already.
CAROM_API void follow_contacts(const SlipDirections& slips, std::span<Candidate> candidates);
/// Writes W_nn - s mu W_nt, with the moment of what rolls, and the acceleration without contact into the
/// candidates of a problem. \param taking_part candidates by constraint of the problem
CAROM_API void name_cause(const IslandProblem& problem, std::span<const std::size_t> taking_part,
                          const SlipDirections& slips, std::span<Candidate> candidates);

}  // namespace carom
