#pragma once

/// \file
/// The factors of a contact problem of the plane: rows of constraints and inverse masses of bodies, slot by
/// slot (solvers/response_factors.h), for solvers that need no W. W would have as many numbers as the square
/// of the contacts, and exact solvers take its cube. Where joints, or a linearised step, bind bodies, these
/// answer together: then the answers of the bodies that are touched are factors, too.

#include <carom/contact/delassus.h>
#include <carom/contact/solvers/contact_problem.h>
#include <carom/core/constraint.h>
#include <carom/core/dynamics/body_response.h>
#include <carom/core/export.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace carom {

/// From constraints and responses to factors. Keeps its memory.
class CAROM_API FactorMaker {
public:
  /// A body as a slot of factors.
  struct Slot {
    Constraint::Block block;               ///< its velocities
    std::array<double, 3> inverse_mass{};  ///< by column [1/kg, 1/kg, 1/(kg m^2)]
  };

  /// Forgets the problem.
  void clear() {
    slots_.clear();
    bodies_ = Bodies::unknown;
  }
  /// Writes factors of bodies that all answer for themselves, in the plane; else false, and nothing is made.
  /// Slots are bodies in the order in which the constraints name them. Call group() of the problem
  /// afterwards. Without ratios and levers only. \param directions must outlive the factors \param some rows,
  /// of whole constraints: all of them at once, or some after the others, up to the first for which it is
  /// false \param problem in factors, of as many rows
  [[nodiscard]] bool build(std::span<const ImpulseDirection> directions, Range some, BodyResponse& response,
                           ContactProblem& problem);
  /// Writes factors of bodies of which some answer together: a slot for each body that is touched, in the
  /// order of their velocities, so that those that answer together follow one another. False, and nothing is
  /// made, where loads act that are not those of the rows (BodyResponse::take_loads()), or a constraint has
  /// more than two rows. Call group() of the problem afterwards. \param responses made by Delassus::build(),
  /// along rows as they are \param problem in factors, of as many rows
  [[nodiscard]] bool build_bound(std::span<const ImpulseDirection> directions, const Delassus& responses,
                                 const BodyResponse& response, ContactProblem& problem);
  /// The bodies; none where no factors were written.
  [[nodiscard]] std::span<const Slot> slots() const { return slots_; }
  /// True if factors were written, and all bodies answer for themselves.
  [[nodiscard]] bool answer_alone() const { return bodies_ == Bodies::alone; }
  /// x += scale M^-1 H^T P, where all bodies answer for themselves. \param x velocities of all bodies
  void add_response(std::span<const double> impulses, double* x, double scale) const;

private:
  enum class Bodies : std::uint8_t { unknown, alone, bound };
  [[nodiscard]] int slot_of(const Constraint& constraint, std::size_t body, const BodyResponse& response);
  [[nodiscard]] int add_slot(const Constraint::Block& block, const BodyResponse& response);
  [[nodiscard]] bool write_rows(Range some, BodyResponse& response, ResponseFactors& factors);
  [[nodiscard]] bool list_slots(const BodyResponse& response);
  [[nodiscard]] std::size_t slot_from(Index v) const;
  void write_bound_rows(ResponseFactors& factors) const;
  void write_answers(const Delassus& responses, ResponseFactors& factors) const;
  void write_masses(ResponseFactors& factors) const;

  std::span<const ImpulseDirection> directions_;
  std::vector<Slot> slots_;
  Bodies bodies_ = Bodies::unknown;
  std::vector<char> bound_;                              // by slot, of bodies that answer together
  std::vector<int> slot_of_body_;                        // while factors are made; no_slot elsewhere
  std::vector<std::array<int, 3>> slots_of_constraint_;  // of bodies that answer for themselves
};

}  // namespace carom
