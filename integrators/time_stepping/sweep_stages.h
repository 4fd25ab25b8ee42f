#pragma once

/// \file
/// Stages of a sweep over one component, as functions of a block of bodies. In which order stages and blocks
/// come is the schedule's (sweep_schedule.h).

#include <carom/core/assembly.h>
#include <carom/integrators/time_stepping/contact_stage.h>
#include <carom/integrators/time_stepping/step_input.h>
#include <carom/integrators/time_stepping/step_rule.h>
#include <carom/integrators/time_stepping/step_trial.h>

namespace carom {

/// A sweep: from the guess at the loads to bodies, to the loads that these lead to, to the next guess.
struct SweepStages {
  const StepInput& in;
  const StepRule& rule;
  Index component;
  ContactStage& contacts;
  StepTrial& trial;
  bool jointed = false;  ///< joints change velocities of all its bodies

  /// Blocks of the component.
  [[nodiscard]] Range blocks() const { return in.assembly.components()[component].blocks; }
  /// Loads at the end by those of the steps before.
  void guess(Index part) const { trial.guess_loads(in, blocks().begin + part); }
  /// Impulses of what touches a block.
  void react(const Block& block, Index part) const { contacts.solve_block(in, rule, block, part, trial); }
  /// Velocities and positions of its bodies.
  void move(const Block& block, Index part) const {
    rule.move(in, component, block.bodies, jointed || contacts.touches(part), trial);
  }
  /// Change that the next sweep would make.
  [[nodiscard]] SweepChange change(const Block& block) const {
    return rule.next_change(in, component, block.bodies, trial);
  }
  /// The loads that the guess led to become the guess.
  void improve(const Block& block) const { trial.take_loads(block.v); }
  /// Completes loads that were evaluated by cause, and takes note of their works.
  void finish(const Block& block, Index part) const {
    trial.loads_end.finish(block.v);
    trial.account.works[part] = rule.works(in, component, block, trial);
  }
};

}  // namespace carom
