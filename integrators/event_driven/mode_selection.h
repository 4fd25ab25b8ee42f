#pragma once

/// \file
/// Modes of all contacts of a clock group after its impacts: which candidates there are, which of them an
/// event has just ended, and what follows where no forces keep them (Painleve). ModeDecision solves.

#include <carom/contact/solvers/solver_chain.h>
#include <carom/core/export.h>
#include <carom/integrators/event_driven/event.h>
#include <carom/integrators/event_driven/event_instant.h>
#include <carom/integrators/event_driven/group_failure.h>
#include <carom/integrators/event_driven/impact_stage.h>
#include <carom/integrators/event_driven/impact_without_collision.h>
#include <carom/integrators/event_driven/mode_decision.h>
#include <carom/integrators/event_driven/unbounded_forces.h>

#include <span>
#include <string>
#include <vector>

namespace carom {

/// Memory of the selection, shared by clock groups.
struct ModeMemory {
  ModeDecision decision;
  ImpactWithoutCollision impact;
  std::vector<Candidate> candidates;  ///< of one island
  std::vector<ForceMargin> margins;
  std::vector<char> is_active;  ///< by pair, after the selection
};

/// The selection of modes of one clock group.
class CAROM_API ModeSelection {
public:
  /// All must outlive it.
  ModeSelection(const GroupFailure& failure, ImpactStage& impacts, UnboundedForces& unbounded,
                ModeMemory& memory, SolverChain& chain)
      : failure_(&failure), impacts_(&impacts), unbounded_(&unbounded), memory_(&memory), chain_(&chain) {}

  /// Begins with a new motion.
  void start();
  /// Notes which contacts an event ends. \param contacts closed ones, with their forces and margins at the
  /// event \param noise of the force that came to its end [N]
  void note(const Event& event, ActiveSet& active, double noise);
  /// Takes what another selection noted of an event at a time [s] too.
  void take(const ModeSelection& other, double time);
  /// Forgets which contacts the event ended: impacts changed the motion.
  void forget_ends();
  /// Selects the modes of all that touches into the active set of the motion, and records the changes.
  void select(EventInstant& at);

private:
  // A sticking contact whose friction is exhausted, and the friction then.
  struct ExhaustedFriction {
    ContactPair pair;
    double force;
    double noise;  // of it
  };

  static void take_coming_feature(const EventInstant& at, Candidate& candidate);
  void collect_candidates(std::span<const Index> pairs, const EventInstant& at);
  [[nodiscard]] bool select_island(std::span<const Index> pairs, EventInstant& at);
  [[nodiscard]] bool strike(std::span<const Index> pairs, EventInstant& at);
  [[nodiscard]] Decision decide_by_limit(Decision decision, EventInstant& at);
  [[nodiscard]] Decision decide(EventInstant& at);
  [[nodiscard]] Decision decide_by_excess(std::span<const Index> pairs, EventInstant& at);
  [[nodiscard]] Decision decide_candidates(std::span<const Index> pairs, EventInstant& at);
  [[nodiscard]] bool any_slides() const;
  [[nodiscard]] bool has_unbounded_force() const;
  [[noreturn]] void fail_unkept(const EventInstant& at) const;
  void close_candidates(ActiveSet& active) const;
  static void note_motions(const Constraint& contact, const EventInstant& at, EventRecord& event);
  void record_choice(EventInstant& at) const;
  void record_changes(EventInstant& at) const;

  const GroupFailure* failure_;
  ImpactStage* impacts_;
  UnboundedForces* unbounded_;
  ModeMemory* memory_;
  SolverChain* chain_;
  std::vector<ExhaustedFriction> exhausted_;
  std::vector<ContactPair> releasing_;  // forces that came to their end, each as often as it did
  double ended_at_ = 0.0;               // time of the latest of both [s]
  ContactPair stopped_;                 // has just stopped slipping
};

}  // namespace carom
