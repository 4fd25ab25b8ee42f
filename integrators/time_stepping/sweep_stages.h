#pragma once

/// \file
/// Stages of a sweep over one component, and of the one sweep of bodies under constant loads, as functions of
/// some bodies. In which order stages and bodies come is the schedule's (sweep_schedule.h).

#include <carom/core/assembly.h>
#include <carom/integrators/time_stepping/contact_stage.h>
#include <carom/integrators/time_stepping/located_impacts.h>
#include <carom/integrators/time_stepping/step_input.h>
#include <carom/integrators/time_stepping/step_rule.h>
#include <carom/integrators/time_stepping/step_trial.h>

#include <algorithm>
#include <cstddef>
#include <span>

namespace carom {

/// A sweep: from the guess at the loads to bodies, to the loads that these lead to, to the next guess.
struct SweepStages {
  const StepInput& in;
  const StepRule& rule;
  Index component;
  ContactStage& contacts;
  StepTrial& trial;
  bool jointed = false;               ///< joints change velocities of all its bodies
  LocatedImpacts* located = nullptr;  ///< bodies that are hit within the step; null: none

  /// Bodies of the component.
  [[nodiscard]] Range bodies() const { return in.assembly.components()[component].bodies; }
  /// Blocks of the component.
  [[nodiscard]] Range blocks() const { return in.assembly.components()[component].blocks; }
  /// True if contact may make its loads differ from what the steps before lead to expect.
  [[nodiscard]] bool contact_upsets(const Block& block, Index part) const {
    return contacts.touches(part) || (located != nullptr && located->contains_any(block.bodies));
  }
  /// Loads at the end by those of the steps before.
  void guess(Index part) const { trial.guess_loads(in, blocks().begin + part); }
  /// Impulses of what touches a block.
  void react(const Block& block, Index part) const { contacts.solve_block(in, rule, block, part, trial); }
  /// Velocities and positions of its bodies.
  void move(const Block& block, Index part) const {
    rule.move(in, block.bodies, jointed || contacts.touches(part), trial);
    if (located == nullptr || located->empty()) return;
    located->advance(in, rule, step_loads(in, rule, trial), block.bodies, trial);
  }
  /// Change that the next sweep would make.
  [[nodiscard]] SweepChange change(const Block& block) const {
    return rule.next_change(in, block.bodies, trial);
  }
  /// The loads that the guess led to become the guess.
  void improve(const Block& block) const { trial.take_loads(block.v); }
  /// Completes loads that were evaluated by cause, and takes note of their works.
  void finish(const Block& block, Index part) const {
    trial.loads_end.finish(block.v);
    trial.account.works[part] = rule.works(in, block, trial);
  }
};

/// The step of consecutive components whose loads are those at its start, of which none is dissipative or
/// external: nothing is to be iterated.
struct ConstantStages {
  const StepInput& in;
  const StepRule& rule;
  Range components;
  const ContactStage& contacts;  ///< with all impulses
  StepTrial& trial;
  bool locates = false;  ///< bodies may be hit within the step: they move on before their account

  /// The bodies.
  [[nodiscard]] Range bodies() const { return in.assembly.bodies_of(components); }
  /// Loads at the end, where those of others change.
  void load(Range v) const {
    const double* const loads = in.companion.loads.total.data();
    std::copy(loads + v.begin, loads + v.end, trial.loads_end.total.data() + v.begin);
  }
  /// Velocities and positions, as if nothing touched; then again of the bodies that impulses have changed.
  void move(Range some) const {
    const std::span<const Index> struck = contacts.struck(some);
    const bool all = struck.size() == some.size();
    rule.move_constant(in, some, all, trial);
    if (all) return;
    for (const Index body : struck) rule.move_constant(in, {body, body + 1}, true, trial);
  }
  /// Works of the loads, energies at the end.
  void finish(Range some, Range v, Index part) const {
    rule.works_constant(in, some, v, trial, trial.account.works[part]);
    if (components.size() == 1) return;
    trial.account.of_fields[part] = {};
    add_field_potentials(in.assembly, some, trial.end.view(), trial.at_end, trial.account.of_fields[part]);
  }
  /// Sums the potentials of all parts.
  void close() const {
    StoredEnergies& sum = trial.account.potentials;
    if (components.size() == 1) {
      return add_potentials(in.assembly, components.begin, trial.end.view(), trial.at_end, sum);
    }
    for (const StoredEnergies& part : trial.account.of_fields) {
      for (std::size_t i = 0; i < stored_energy_count; ++i) sum.values[i] += part.values[i];
    }
  }
};

}  // namespace carom
