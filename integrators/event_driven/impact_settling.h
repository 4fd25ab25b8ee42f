#pragma once

/// \file
/// Contacts of a pile through an impact of their neighbours, and where no forces keep them (Painleve): closed
/// ones that part slower than the capture speed although loads press them stay closed, and what slides slower
/// stops at once if forces of contact stop it soon. It is what the capture of slow impacts is to the contact
/// that bounces (docs/method.md, section 7, *Accumulation of impacts*): in a pile every impact shakes all
/// that touches, and each contact that bounces lower than the neglected height would end its bounce, and each
/// short slide, by an event of its own. Sliding of 1e-12 m/s, the rest of a larger motion, would give
/// friction a direction that jams. Friction in a joint has no impulse in an impact, and each slow one lets
/// the joint slip by a little: stopping again, it would lift what has just closed.

#include <carom/contact/active_contact.h>
#include <carom/contact/island_problem.h>
#include <carom/contact/solvers/solver_chain.h>
#include <carom/core/constraint_set.h>
#include <carom/core/export.h>
#include <carom/integrators/event_driven/event_instant.h>
#include <carom/integrators/event_driven/slow_contacts.h>

#include <algorithm>
#include <limits>
#include <span>
#include <vector>

namespace carom {

/// Settlings of a group that follow each other. Each is a way over the time that it looks ahead. Where
/// constraints that are nearly dependent leave some of what it stops, another event may undo it at once, and
/// the next one settle again, without end: after as many as would take that time, were each an eighth of it,
/// what is slow is followed as it is until time has gone on.
class SettlingLimit {
public:
  /// Remembers the settlings of another group too.
  void take(const SettlingLimit& other) { taken_until_ = std::max(taken_until_, other.taken_until_); }
  /// Whether there may be a settling at a time. \param ahead time that it looks ahead [s]
  [[nodiscard]] bool allows(double time, double ahead) const { return taken_until_ < time + ahead; }
  /// Counts a settling.
  void count(double time, double ahead) {
    constexpr double part = 0.125;
    taken_until_ = std::max(taken_until_, time) + part * ahead;
  }

private:
  double taken_until_ = -std::numeric_limits<double>::infinity();
};

/// Settles one island at a time. Keeps memory only.
class CAROM_API ImpactSettling {
public:
  /// Closes contacts of an island that were closed before the event and part slower than the capture speed,
  /// and stops those that slide slower, friction in joints included (rates of angles times an arm,
  /// Constraint::OfJoint::length), where forces of contact do so, or turn them back, within the time in which
  /// what parts at that speed comes back. Books the energy as that of accumulations. True if velocities
  /// changed; the instant is up to date then, and contacts may approach each other. \param at brought to the
  /// state after the impacts \param limit of the group
  [[nodiscard]] bool settle(std::span<const Index> pairs, EventInstant& at, SolverChain& chain,
                            SettlingLimit& limit);

private:
  [[nodiscard]] bool list_touching(std::span<const Index> pairs, const EventInstant& at);
  [[nodiscard]] bool close(std::span<const Index> pairs, EventInstant& at);
  [[nodiscard]] bool comes_to_rest(std::size_t c, const EventInstant& at) const;
  [[nodiscard]] bool list_held(const EventInstant& at);

  IslandProblem problem_{{.factored_from = factored_constraints, .factored_to = most_exact_contacts}};
  ConstraintSet touching_;
  std::vector<Index> places_;  // their pairs
  std::vector<double> ahead_;  // velocities
  std::vector<ActiveContact> held_;
  double capture_ = 0.0;  // capture speed [m/s]
  double slow_ = 0.0;     // sliding up to which is stopped, at most that [m/s]
  ContactClosing closing_;
};

}  // namespace carom
