#pragma once

/// \file
/// Report of a step, and statistics of all steps so far.

#include <carom/contact/solvers/contact_solver.h>
#include <carom/contact/solvers/solver_chain.h>
#include <carom/core/constraint.h>
#include <carom/core/contact_frame.h>
#include <carom/core/ids.h>
#include <carom/core/joint_kind.h>
#include <carom/core/model_finding.h>
#include <carom/integrators/run/event_log.h>
#include <carom/integrators/run/impact_note.h>
#include <carom/integrators/run/time_stepping.h>

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace carom {

/// Place of a contact: what touches, where, and when it was detected. Numbers of a contact by direction are
/// along the normal first, then along the tangents of its frame; ContactFrame::vector_of() makes them a
/// vector in the fixed frame.
struct ContactPlace : ContactFrame {
  ConstraintKey key;    ///< identity
  BodyId body;          ///< the body; of two bodies that of `a` of the key
  ObstacleId obstacle;  ///< the shape on ground that `body` touches; not valid: none
  BodyId other;         ///< the body that `body` touches; not valid: none
  double gap = 0.0;     ///< when it was detected; > 0 of a lasting contact opened by turning [m]
};

/// One contact that took part in a step. The impulse acts on `body`, its opposite on what that touches.
struct ContactRecord : ContactPlace, ImpactNote {
  double time = 0.0;                        ///< end of the step; of an impact within it when that was [s]
  std::array<double, 3> velocity_before{};  ///< gamma^- [m/s]
  std::array<double, 3> velocity_after{};   ///< gamma^+ [m/s]
  std::array<double, 3> impulse{};          ///< P [N s]
  std::array<double, 3> work{};             ///< P (gamma^- + gamma^+)/2, by direction [J]
  ContactMode mode = ContactMode::open;     ///< of the mean velocities
  bool impact = false;                      ///< closed faster than the capture speed
  bool worst = false;                       ///< of an answer at the cap: its residual is that of this contact
  Outcome outcome = Outcome::not_solved;    ///< number of solutions of its problem, if known
  double residual = 0.0;                    ///< certificate of its problem
  std::string_view solver{};                ///< solver whose answer was used
};

/// Impulse of a joint over a step of time stepping, whose mean force is the impulse divided by the length of
/// the step; or in an impact of the event-driven mode.
struct JointImpulse {
  JointId joint;          ///< identity
  JointReaction impulse;  ///< on its body `to` [N s, N m s], in the middle of the step or at the impact
  double time = 0.0;      ///< end of the step, or time of the impact [s]
};

/// Report of step control (TimeStepping::control). The step was kept as two halves, and the other numbers of
/// the report are of both; contacts are those of the first half, then of the second.
struct ControlReport {
  double error = 0.0;          ///< estimated error of the step [m]; 0 across an impact
  int rejected = 0;            ///< lengths that were tried before and rejected
  bool across_impact = false;  ///< the error could not be estimated because of contact
  double next_step = 0.0;      ///< length that will be tried next [s]; 0 without step control
};

/// Iteration of a step over its loads.
struct IterationReport {
  /// Which solved the step; where components differ the one farthest from the fixed-point iteration, in the
  /// order of the enumeration.
  Iteration iteration = Iteration::fixed_point;
  int fallbacks = 0;     ///< iterations that were given up for another one, summed over components
  int sweeps = 0;        ///< of the iteration that solved the step, the most over all components
  int local_sweeps = 0;  ///< sweeps before, of the bodies near contacts only; the most over all components
  double contraction = 0.0;    ///< ratio of successive changes, the largest over components (0: none seen)
  ElementId worst_coupling{};  ///< force element that limits the contraction most; invalid if none
  double worst_coupling_rate = 0.0;  ///< its estimate (h^2/4)|M^-1 K| + (h/2)|M^-1 C|
};

/// Numbers of a step.
struct StepNumbers : IterationReport {
  double time = 0.0;  ///< at its end [s]
  double step = 0.0;  ///< its length [s]
  /// Energy that the impulses of contacts, limits and friction in joints added, summed over the contact
  /// problems that gained: in impacts by the law, in lasting contact by an error of the step [J].
  double energy_gain = 0.0;
  double lasting_gain = 0.0;  ///< part of it in lasting contact (docs/energy.md) [J]
  int steps_made = 1;         ///< in its phases, by what they took: one of half of the bodies is half of one
  double projected = 0.0;     ///< largest displacement by which a body was moved out of shapes [m]
  ControlReport control;      ///< of step control
};

/// The last accepted step.
struct StepReport : StepNumbers {
  std::vector<ContactRecord> contacts;  ///< contacts that took part, in the order of their bodies
  /// Impulses of all joints, including their reactions to contact; by component, then by kind. In the
  /// event-driven mode those of impacts: impact after impact, without joints that have no impulse.
  std::vector<JointImpulse> joint_impulses;
  /// Findings of System::check() in the model, and joints that it left open (core/dynamics/joint_closure.h),
  /// at the start or the last edit; the same in every step.
  std::vector<ModelFinding> findings;
  /// File of the contact problem with the largest residual that was accepted at the cap of its sweeps, where
  /// TimeStepping::failure_directory is given and none before was worse; where it could not be written, why.
  std::string capped_problem;
};

/// Steps since the start, and how they were solved.
struct StepStatistics {
  std::int64_t steps = 0;            ///< accepted steps
  std::int64_t sweeps = 0;           ///< sum over steps of StepReport::sweeps
  int most_sweeps = 0;               ///< the most in one step
  double largest_contraction = 0.0;  ///< the largest StepReport::contraction
  /// Steps by StepReport::iteration: fixed-point, Anderson, linearly implicit.
  std::array<std::int64_t, iteration_count> steps_by_iteration{};
  std::int64_t fallbacks = 0;             ///< sum over steps of StepReport::fallbacks
  std::int64_t rejected_steps = 0;        ///< lengths that step control rejected
  std::int64_t steps_across_impacts = 0;  ///< steps whose error could not be estimated because of contact
};

/// Contacts since the start.
struct ContactCounts {
  std::int64_t impacts = 0;            ///< contacts that closed faster than the capture speed
  std::int64_t contact_steps = 0;      ///< contacts that took part in steps
  std::int64_t several_solutions = 0;  ///< of contact problems with more than one end velocity
  std::int64_t forces_not_unique = 0;  ///< contact problems with more than one set of impulses
  std::int64_t energy_gains = 0;       ///< steps in which impacts added energy
  double energy_gained = 0.0;          ///< sum of those gains [J]
  std::int64_t lasting_gains = 0;      ///< steps in which lasting contact added energy
  double lasting_gained = 0.0;         ///< sum of those gains [J]
  /// Sequential impacts that ImpactRules::sequence_limit ended, impacts beyond TimeStepping::most_impacts,
  /// and steps, or parts of them, in which closings were not located any more (TimeStepping::impacts).
  std::int64_t cut_sequences = 0;
  std::int64_t scaled_impacts = 0;  ///< impacts whose restitution EnergyGain::limit scaled
  std::int64_t plastic_jams = 0;    ///< contact problems without an answer, solved with e = 0
  double deepest_gap = 0.0;         ///< the most negative gap found [m]
  double worst_residual = 0.0;      ///< the largest certificate of a contact problem
  /// Steps in which contact problems were solved, by the largest certificate of these: up to each of
  /// certified_residuals and above the one before it, then those above all.
  std::array<std::int64_t, certified_residuals.size() + 1> certified_steps{};

  /// Counts a step whose contact problems have certificates up to `residual`.
  CAROM_API void count_step(double residual);
  /// Share of these steps whose certificates are known to be at most `residual`, by the largest of
  /// certified_residuals that is not larger; 1 if there are none.
  [[nodiscard]] CAROM_API double certified_share(double residual) const;
};

/// Counts and extremes since the start.
struct Statistics : StepStatistics, ContactCounts {
  EventCounts events{};               ///< of the event-driven mode, by kind
  std::int64_t flow_steps = 0;        ///< steps of the event-driven integrators, all components
  std::int64_t flow_evaluations = 0;  ///< rates evaluated by the event-driven integrators, all components
  std::int64_t flow_restarts = 0;     ///< restarts of the event-driven integrators, all components
};

}  // namespace carom
