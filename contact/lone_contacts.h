#pragma once

/// \file
/// Contacts in the plane, each the only one of its body and against ground: problems of two rows that have
/// nothing in common. They are solved from their numbers, one after the other, with the formulas of
/// IslandProblem and the same bits, but without what a problem of any size keeps.

#include <carom/contact/solvers/chain_statistics.h>
#include <carom/contact/solvers/regular_counts.h>
#include <carom/contact/solvers/single_contact.h>
#include <carom/core/constraint.h>
#include <carom/core/dynamics/body_response.h>
#include <carom/core/export.h>

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace carom {

/// A contact that is alone, solved. Numbers by row: normal, tangential.
struct LoneAnswer {
  std::array<double, 2> before{};        ///< gamma^- [m/s]
  std::array<double, 2> b{};             ///< of its problem [m/s]
  std::array<double, 2> impulse{};       ///< P [N s]
  double residual = 0.0;                 ///< certificate
  ContactMode mode = ContactMode::open;  ///< by the rule of contact_mode.h
};

/// Velocities of all bodies, around contacts that are alone.
struct LoneVelocities {
  const double* before;  ///< v^-
  const double* free;    ///< without impulses, at the end
  double* change;        ///< by impulses, to be added to
};

/// Solves them. Keeps its memory.
class CAROM_API LoneContacts {
public:
  /// Forgets the contacts.
  void clear() { constraints_ = {}; }
  /// Takes constraints and solves them. False, and none is taken and nothing changed, where one of them is no
  /// contact of two rows with friction, is not alone on its body, acts on one that does not turn in the
  /// plane, or is not regular (solve_regular_contact()). \param constraints of ascending bodies; must outlive
  /// the answers \param masses of the bodies
  [[nodiscard]] bool solve(std::span<const Constraint> constraints, const MassResponse& masses,
                           const LoneVelocities& velocity);
  /// The contacts.
  [[nodiscard]] std::span<const Constraint> constraints() const { return constraints_; }
  /// Answers of the contacts, in the order of constraints().
  [[nodiscard]] std::span<const LoneAnswer> answers() const {
    return std::span(answers_).first(constraints_.size());
  }
  /// Adds what was counted since the last call.
  void add_statistics(ChainStatistics& sum) {
    if (counts_.problems > 0) counts_.add_to(sum);
    counts_ = {};
  }
  /// Forgets what was counted.
  void forget_statistics() { counts_ = {}; }

private:
  using Response = std::array<double, 6>;  // M^-1 H^T: of each row three
  [[nodiscard]] static bool state(const Constraint& at, const BodyMasses& masses,
                                  const LoneVelocities& velocity, LoneAnswer& answer, Response& response,
                                  PlanarContact& problem);
  [[nodiscard]] static bool solve(const PlanarContact& problem, LoneAnswer& answer, RegularCounts& counts);

  std::span<const Constraint> constraints_;
  std::vector<LoneAnswer> answers_;
  std::vector<Response> responses_;
  std::vector<PlanarContact> problems_;
  RegularCounts counts_;
};

}  // namespace carom
