#pragma once

/// \file
/// Books what acted on the islands of a step, one after the other, while it is at hand: loads, joints,
/// contacts, bodies that were hit within the step.

#include <carom/contact/island_problem.h>
#include <carom/core/export.h>
#include <carom/integrators/time_stepping/capped_problem.h>
#include <carom/integrators/time_stepping/contact_stage.h>
#include <carom/integrators/time_stepping/contact_turning.h>
#include <carom/integrators/time_stepping/joint_stage.h>
#include <carom/integrators/time_stepping/located_impacts.h>
#include <carom/integrators/time_stepping/step_balance.h>
#include <carom/integrators/time_stepping/step_constraints.h>
#include <carom/integrators/time_stepping/step_flights.h>
#include <carom/integrators/time_stepping/step_input.h>
#include <carom/integrators/time_stepping/step_islands.h>
#include <carom/integrators/time_stepping/step_model.h>
#include <carom/integrators/time_stepping/step_trial.h>

#include <string>

namespace carom {

/// The account of a step as its islands are made. Throws SolverError where an energy is not finite, or an
/// impact gains energy and that is refused.
class CAROM_API IslandBooks {
public:
  /// All must outlive it. \param contacts,located,joints what acted, with the island at hand
  IslandBooks(const StepModel& model, const StepConstraints& constraints, ContactStage& contacts,
              LocatedImpacts& located, JointStages& joints, StepTrial& trial);
  /// Work of contacts that turn is booked as what it is. \param turning null: nothing turns; must outlive it
  void use_turning(const ContactTurning* turning) { turning_ = turning; }

  /// Begins a step, or one that is made again. \param impacts at its start; null: none
  void begin(const StepInput& in, const StepResult* impacts);
  /// Books loads on a component, and its joints.
  void book_component(const StepInput& in, Index component);
  /// Books works and energies of components whose loads do not change, and are conservative, by the account
  /// of the trial.
  void book_constant(const StepInput& in, Range components);
  /// Books works and energies of components that nothing couples, by numbers that are given.
  void book_loads(const StepInput& in, Range components, const BlockWorks& works,
                  const StoredEnergies& potentials);
  /// Books the contacts of an island, and those of its bodies that are hit within the step.
  void book_contacts(const StepIsland& island, const StepInput& in);
  /// Books contacts of bodies that nothing couples, but for those of bodies that are hit within the step.
  void book_lone_contacts(const StepInput& in);
  /// Books impacts and contacts of those of some bodies that are hit within the step, in their order.
  void book_located(Range bodies, const StepInput& in);
  /// Writes the contact problem that was solved worst, if any is to be written: `file` becomes its path.
  void write_capped_problem(std::string& file) { capped_.write(file); }

  /// The account so far.
  [[nodiscard]] StepBalance& balance() { return balance_; }
  /// Flights of bodies that are hit within the step.
  [[nodiscard]] StepFlights& flights() { return flights_; }

private:
  void book_contact_problem(const IslandProblem& problem, const double* after, double time,
                            const StepInput& in);

  const StepModel* model_;
  const StepConstraints* constraints_;
  ContactStage* contacts_;
  LocatedImpacts* located_;
  JointStages* joints_;
  StepTrial* trial_;
  const ContactTurning* turning_ = nullptr;
  StepBalance balance_;
  CappedProblem capped_;
  StepFlights flights_;
};

}  // namespace carom
