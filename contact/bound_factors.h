#pragma once

/// \file
/// Factors of a contact problem some of whose bodies answer together: those that joints bind, or a linearised
/// step. Sweeps then need the answers of the bodies that are touched, and no W: it would have as many numbers
/// as the square of the contacts, and exact solvers take its cube.

#include <carom/contact/delassus.h>
#include <carom/contact/solvers/contact_problem.h>
#include <carom/core/dynamics/body_response.h>
#include <carom/core/export.h>

#include <cstddef>
#include <span>
#include <vector>

namespace carom {

/// From responses to factors. Keeps its memory.
class CAROM_API BoundFactors {
public:
  /// Forgets the problem.
  void clear() { slots_.clear(); }
  /// Writes factors of a problem of the plane: a slot for each body that is touched, in the order of their
  /// velocities, so that those that answer together follow one another. False, and nothing is made, where
  /// loads act that are not those of the rows (BodyResponse::take_loads()), or a constraint has more than two
  /// rows. Call group() afterwards. \param responses made by Delassus::build(), along rows as they are
  /// \param problem in factors, of as many rows
  [[nodiscard]] bool write(std::span<const ImpulseDirection> directions, const Delassus& responses,
                           const BodyResponse& response, ContactProblem& problem);
  /// The bodies; none where no factors were written.
  [[nodiscard]] std::span<const Delassus::Slot> slots() const { return slots_; }

private:
  [[nodiscard]] bool list_slots(std::span<const ImpulseDirection> directions, const BodyResponse& response);
  [[nodiscard]] std::size_t slot_from(Index v) const;
  void write_rows(std::span<const ImpulseDirection> directions, ResponseFactors& factors) const;
  void write_answers(const Delassus& responses, ResponseFactors& factors) const;

  std::vector<Delassus::Slot> slots_;
  std::vector<char> bound_;  // by slot
};

}  // namespace carom
