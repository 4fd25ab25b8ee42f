#pragma once

/// \file
/// Modes of contacts by their accelerations, where forces do not tell them: forces that are not unique may be
/// at their bounds, or zero, by chance.
///
/// Solvers answer with extreme ones: friction at its bound although nothing slips, or nothing on a contact
/// that others relieve; and forces that are zero may be rounding above it although the contact parts. Taken
/// by their forces, such contacts would change their modes from event to event. Where contacts slip, forces
/// that are not unique may move bodies, and the flow has others than the answer: then a contact is decided to
/// start slipping, is stopped by the flow at once, and so on. So the modes are those in which the flow moves
/// as the answer does: by accelerations, else by forces, else with friction fixed where the answer has it at
/// its bound or none, which leaves the flow as few unknown forces as the answer has.

#include <carom/contact/active_contact.h>
#include <carom/contact/active_set.h>
#include <carom/contact/island_problem.h>
#include <carom/core/constraint.h>
#include <carom/core/export.h>
#include <carom/integrators/event_driven/slip_directions.h>

#include <cstddef>
#include <span>
#include <vector>

namespace carom {

/// Contacts of a problem of accelerations that has been answered. A view.
struct DecidedContacts {
  std::span<const Constraint> contacts;      ///< of the problem
  std::span<const std::size_t> taking_part;  ///< candidates by contact
  const double* acceleration;                ///< of all bodies
  double small;                              ///< accelerations up to this are zero [m/s^2]
};

/// A force this small against the others of its island may be rounding: constraints that follow from each
/// other, to rounding, leave forces open.
inline constexpr double clear_force = 1e-6;

/// Memory of motion_apart().
struct MotionComparison {
  std::vector<double> force, none, answered, given;  ///< by row
};

/// Largest acceleration of contacts that no force acts on but friction in joints that turn, which is given:
/// all that may move hinged bodies in flight against each other [m/s^2].
[[nodiscard]] CAROM_API double size_without_contact(const IslandProblem& problem);
/// Size against which the rounding of the accelerations that an answer leads to is no acceleration: forces
/// that nearly cancel, of a heavy body that rests on a light one, leave the light one theirs [m/s^2].
[[nodiscard]] CAROM_API double size_by_rounding(const IslandProblem& problem);
/// Opens closed candidates whose contacts part.
CAROM_API void open_where_parting(const DecidedContacts& decided, std::span<Candidate> candidates);
/// Opens candidates that stick by a force of rounding while the others carry them off along the contact: a
/// certificate is satisfied by any mode of such a force, and a flow would hold what the answer moves.
CAROM_API void open_where_carried_off(const DecidedContacts& decided, const IslandProblem& problem,
                                      std::span<Candidate> candidates);
/// Lets closed candidates stick that have no velocity of slip and get none, except where friction is
/// exhausted.
CAROM_API void stick_where_still(const DecidedContacts& decided, std::span<Candidate> candidates);
/// Takes contacts that stick for slipping ones where the answer has their friction at its bound, or none:
/// they have that friction then, and no unknown force. That they do not slip follows from the others.
CAROM_API void fix_extreme_friction(const DecidedContacts& decided, const IslandProblem& problem,
                                    std::span<Candidate> candidates);
/// True if forces that are not unique may move bodies: of several closed contacts one slips with friction.
/// \param taking_part as DecidedContacts::taking_part
[[nodiscard]] CAROM_API bool forces_may_move(std::span<const Constraint> contacts,
                                             std::span<const std::size_t> taking_part,
                                             std::span<const Candidate> candidates);
/// True if no force of closed contacts pulls, or exceeds friction, by more than rounding.
/// \param margins of these forces
[[nodiscard]] CAROM_API bool law_allows(std::span<const ActiveContact> closed,
                                        std::span<const ForceMargin> margins);
/// Gives candidates modes, and the friction of their laws. \param modes by candidate
inline void take_modes(std::span<const ContactMode> modes, std::span<Candidate> candidates) {
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    candidates[i].mode = modes[i];
    candidates[i].frictionless = candidates[i].at.law.sticking_friction() == 0.0;
  }
}
/// Largest difference of the accelerations along rows between the answer of a problem and forces of some of
/// its contacts, nothing at the others [m/s^2]. Forces that none of their constraints feels may differ by as
/// much as the forces themselves: where friction of what slips moves bodies by them, which of these forces a
/// flow has is chance. \param closed these, in the order of the problem \param set that found their forces
/// last
[[nodiscard]] CAROM_API double motion_apart(const IslandProblem& problem,
                                            std::span<const ActiveContact> closed, const ActiveSet& set,
                                            MotionComparison& memory);

}  // namespace carom
