#pragma once

/// \file
/// The account of a step: works of what acted, energies at the end, records of contacts and joints. It is the
/// result of the step, which its caller commits.

#include <carom/contact/island_problem.h>
#include <carom/contact/lone_contacts.h>
#include <carom/contact/separation.h>
#include <carom/core/energy_ledger.h>
#include <carom/core/energy_term.h>
#include <carom/core/export.h>
#include <carom/core/function_ref.h>
#include <carom/core/numerics/compensated_sum.h>
#include <carom/core/numerics/fetch_ahead.h>
#include <carom/integrators/run/companion.h>
#include <carom/integrators/run/contact_history.h>
#include <carom/integrators/run/iteration_memory.h>
#include <carom/integrators/run/step_report.h>
#include <carom/integrators/run/time_stepping.h>
#include <carom/integrators/time_stepping/joint_stage.h>
#include <carom/integrators/time_stepping/step_input.h>
#include <carom/integrators/time_stepping/step_rule.h>
#include <carom/integrators/time_stepping/step_trial.h>

#include <cstddef>
#include <span>
#include <vector>

namespace carom {

/// Counts and extremes of the contacts of a step.
struct ContactTally {
  int impacts = 0;              ///< ContactRecord::impact
  int several_solutions = 0;    ///< contacts of problems of that outcome
  int forces_not_unique = 0;    ///< contacts of problems of that outcome
  double deepest_gap = 0.0;     ///< the most negative [m]
  double worst_residual = 0.0;  ///< the largest certificate

  /// Adds the counts of other contacts, and takes in their extremes.
  void add(const ContactTally& other);
};

/// Result of a step, beside the trial.
struct StepResult {
  EnergyFlows flows;                  ///< energy that left, by cause [J]
  StoredEnergies stored;              ///< at the end [J]
  StepReport report;                  ///< of the step
  ContactHistory contacts;            ///< of large islands
  ContactTally tally;                 ///< of the contacts in the report
  int cut_sequences = 0;              ///< sequences of impacts at the start that their limit ended
  int scaled_impacts = 0;             ///< impacts at the start of the step whose restitution was scaled
  int plastic_jams = 0;               ///< contact problems solved with e = 0, since they had no answer
  ContactModes contact_modes;         ///< of contacts up to the end of the step
  ContactModes joint_friction_modes;  ///< of friction in joints
  /// Records of the step so far, the first in the report. Those behind them are of an earlier step, and leave
  /// it when this one is finished: to clear a record costs as much as to write it.
  std::size_t recorded = 0;

  /// Records of the contacts of the step.
  [[nodiscard]] std::span<ContactRecord> records() { return std::span(report.contacts).first(recorded); }
  [[nodiscard]] std::span<const ContactRecord> records() const {
    return std::span(report.contacts).first(recorded);
  }
  /// Appends a record, every field of which is to be written.
  [[nodiscard]] ContactRecord& next_record() {
    if (recorded == report.contacts.size()) report.contacts.emplace_back();
    return report.contacts[recorded++];
  }
  /// Asks for the memory of a record that comes `ahead` records later.
  void fetch_records(std::size_t ahead) const { fetch_ahead(std::span(report.contacts), recorded + ahead); }
};

/// Adds up a step, component by component. Keeps memory.
class CAROM_API StepBalance {
public:
  explicit StepBalance(const Assembly& assembly, const TimeStepping& options)
      : assembly_(&assembly), capture_speed_(options.capture_speed) {}

  /// Begins a step, in which no ground shape jumps.
  void begin(const StepInput& in);
  /// Impulses that are booked from now on have jumps of the velocities of ground shapes in them: they act
  /// behind them, against the velocities that they lead to. \param jumps must outlive their use
  void use_jumps(std::span<const GroundJump> jumps) { jumps_ = jumps; }
  /// Books what elements did: works and energies of the last iterate. False if one is not finite.
  [[nodiscard]] bool book_couplings(const StepInput& in, Index component, const StepTrial& trial);
  /// Books works and energies of bodies whose loads do not change, and are conservative. False if the sum of
  /// the stored energies is not finite.
  [[nodiscard]] bool book_loads(const BlockWorks& works, const StoredEnergies& potentials);
  /// Books the work of reactions and of the way back onto the joints; records their impulses.
  void book_joints(const StepInput& in, Index component, JointStage& joints, const IslandProblem* contact,
                   StepTrial& trial);
  /// Books the impulses of a contact problem. Returns the energy that an impact gained [J], else 0.
  /// \param after velocities at the end as contact sees them \param time when that is [s]
  double book_contacts(const IslandProblem& problem, const double* after, double time, const StepInput& in,
                       const StepTrial& trial);
  /// Books the impulses of contacts that are alone on their bodies, at the end of the step. \param after
  /// velocities at the end as contact sees them \param leaves_out bodies whose contacts are not booked;
  /// empty: none
  void book_lone(const LoneContacts& contacts, const double* after, const StepInput& in,
                 const StepTrial& trial, FunctionRef<bool(Index body)> leaves_out = {});
  /// Books the impulses of an impact at the start of the step. Returns the energy that it gained [J], else 0.
  /// \param after velocities behind the impact, as contact sees them
  double book_impact(const IslandProblem& problem, const double* after, const ImpactNote& note,
                     const StepInput& in, const StepTrial& trial);
  /// Marks the records booked last as those of an impact beyond the limit of impacts. \param records how many
  void tell_cut(std::size_t records);
  /// Adds what impacts at the start of the step did.
  void add(const StepResult& impacts);
  /// Result so far.
  [[nodiscard]] StepResult& result() { return result_; }
  /// Books work of contacts that is an error of the step: it was booked as work of moving ground. \param work
  /// [J]
  void book_turning(double work);
  /// Books that bodies were moved out of ground shapes. \param before potentials of their component before
  /// that \param after potentials of their component after that
  void book_projection(const Separation& result, const StoredEnergies& before, const StoredEnergies& after);
  /// Books a change of kinetic energy by bringing velocities back onto joints. \param lost [J]
  void book_velocity_projection(double lost);

  /// The report so far.
  [[nodiscard]] StepReport& report() { return result_.report; }
  /// Closes the account.
  [[nodiscard]] StepResult& finish(const StepInput& in);
  /// After finish(): energy gained beyond all that loads, contact and the start of the step explain, where it
  /// is a multiple of that: then the end that was found is none [J]; else 0.
  [[nodiscard]] double unexplained_gain(const StepInput& in) const;

private:
  void book_joint_friction(const IslandProblem& problem, std::size_t contact, const double* after,
                           const StepTrial& trial, ImpulseWork& sum);
  void book_rolling(const IslandProblem& problem, std::size_t contact, const double* after,
                    const StepInput& in, ImpulseWork& sum);
  double book_gain(std::span<const Constraint> contacts, const double* b, const double* impulse,
                   const ImpulseWork& work, bool impact, const StepTrial& trial);
  void tally(const IslandProblem& problem, int contacts);

  const Assembly* assembly_;
  double capture_speed_;
  StepResult result_;
  std::span<const GroundJump> jumps_;
  std::vector<double> rates_;  // by row of joints
  CompensatedSum coupling_work_;
  double energy_position_projection_ = 0.0;  // energy taken out by moving bodies [J]
  double energy_velocity_projection_ = 0.0;  // and by what that changes of their velocities [J]
};

/// Memory of how the components of a step were iterated, for the next step.
struct StepMemory {
  std::span<const int> sweeps;          ///< by component, as many as were needed
  IterationMemory iterations;           ///< with which the next step begins
  const JointStages* joints = nullptr;  ///< of the model
  bool guesses = false;                 ///< whether any component has loads that change
  bool mean = false;                    ///< loads are mean loads of the step
};

/// Makes the end of a step the state, and takes its result over.
CAROM_API void commit(const StepInput& in, StepMemory& memory, StepTrial& trial, StepResult& result,
                      State& state, Companion& companion, StepReport& report);

}  // namespace carom
