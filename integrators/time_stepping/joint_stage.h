#pragma once

/// \file
/// Joints of one component in a step: velocities that they allow at its end, positions on them, and what
/// reactions did. With the rows G0 at the start, Gm halfway and G1 at the end (docs/method.md, section 8),
///
///   v_{j+1} = v_free + M^-1 Gm^T L + K H^T P,   K = M^-1 - M^-1 A^T (A M^-1 A^T)^-1 A M^-1,   A = G0 or Gm
///   q_{j+1} = q_j advanced by h (v_j + v_{j+1})/2 + d
///
/// where every sweep corrects L by what is left of  G1 v_{j+1} + rate = 0  and the displacement d, of third
/// order in h, by what is left of  g(q_{j+1}, t_{j+1}) = 0. Where nothing touches or rubs the steps before
/// say what to begin with (untouched_joints.h).
///
/// Under ForceRule::energy_momentum, where nothing touches or rubs and no row is near to following from
/// others, Gm are mean rows (step_joint_rows.h), L is found from  g(q_{j+1}, t_{j+1}) = 0  and there is no d:
/// reactions do no work, and velocities follow (Gonzalez 1999; Betsch and Steinmann 2002).
///
/// Contact acts along its rows H at the start of the step, and so does the answer of the joints to it, along
/// their rows A = G0 there: both are one impact with W = H K H^T, the same in all sweeps. The law sees
/// velocities that the joints allow there,
///
///   gamma^+ = H (v - M^-1 A^T S^-1 (A v + a)),   S = A M^-1 A^T,   v = v_{j+1},   a the rate at the end,
///
/// which differ from H v_{j+1} by how far the joints turn within the step. With that, of contacts at one pin
/// (the ends of two bars that it joins) one follows from the other; with H v_{j+1} they would contradict each
/// other by that little, and large impulses would change from sweep to sweep. Impulses and answers do the
/// work P . (gamma^- + gamma^+)/2, and on drivers the multipliers times the mean of their rates, nothing
/// else.
///
/// That is of first order where joints turn: contact holds velocities that are not those of the end. Where
/// impacts are located the step is repeated, and contact acts along its rows halfway, with the answer along
/// A = Gm there, both against their conditions at the end (contact_turning.h, joint_answer.h); what is seen
/// above is then v_{j+1} itself.
///
/// Friction in joints is a row of the contact problem with |P| <= h times its bound. Without contacts its
/// force acts halfway, against the rate that the coordinate has at the end. Sweeps of islands, with what
/// contact does to them, are in island_joints.h.

#include <carom/contact/detection/joint_rows.h>
#include <carom/contact/friction_bounds.h>
#include <carom/contact/island_problem.h>
#include <carom/core/assembly.h>
#include <carom/core/export.h>
#include <carom/integrators/time_stepping/joint_answer.h>
#include <carom/integrators/time_stepping/joint_iterate.h>
#include <carom/integrators/time_stepping/step_input.h>
#include <carom/integrators/time_stepping/step_rule.h>
#include <carom/integrators/time_stepping/step_trial.h>
#include <carom/integrators/time_stepping/untouched_joints.h>

#include <memory>
#include <span>
#include <vector>

namespace carom {

/// The kind of touch of the bodies of an island in a step.
enum class JointsTouch : std::uint8_t {
  nothing,   ///< neither
  friction,  ///< friction in joints alone
  contact    ///< bodies, ground or stops
};

/// Where a step has gone astray: how far which body would be moved back, how far it may, and the longest way
/// of one.
struct StrayBody {
  BodyId body{};                                ///< not valid: none
  double back = 0.0, allowed = 0.0, way = 0.0;  ///< [m]
};

/// Joints of one component. Keeps memory.
class CAROM_API JointStage {
public:
  /// \param first_row of its rows among those of all components \param arrays shared by all components; must
  /// outlive it
  JointStage(const Assembly& assembly, Index component, Index first_row, JointArrays& arrays);

  /// The first guess: by the steps before where they say anything and the iteration has a use for it, else no
  /// reactions, and the positions that the present velocities lead to. \param touch of its island
  void start(const StepInput& in, const StepRule& rule, Iteration iteration, JointsTouch touch,
             StepTrial& trial);
  /// One sweep from a guess by the steps before: of a component that nothing touches.
  void sweep_guessed(const StepInput& in, const StepRule& rule, StepTrial& trial) {
    untouched_.sweep(in, rule, trial);
  }
  /// First half of a sweep: reactions without contact. \param free out: velocities that contact sees, if it
  /// did nothing, over all velocities
  void approach(const StepInput& in, const StepRule& rule, StepTrial& trial, double* free);
  /// Brings friction in joints, of a component that nothing else touches, to the iterate: it acts halfway,
  /// against the rates that coordinates have at the end. \param free velocities of approach()
  void turn_friction(std::span<Constraint> friction, const JointRows& rows, const double* free,
                     StepTrial& trial);
  /// Second half of a sweep. \param change of velocities by contact and what joints answer to it, over all
  /// velocities; null: nothing touches
  void leave(const StepInput& in, const StepRule& rule, const double* change, StepTrial& trial);
  /// Change that the sweep has made, or that another would make.
  [[nodiscard]] SweepChange change(const StepInput& in, const StepTrial& trial);
  /// True if change() is to be judged as the change that another sweep would make.
  [[nodiscard]] bool looks_ahead() const { return guessed_; }
  /// Distance of positions and velocities from obeying the joints, in units of what rounding lets them.
  [[nodiscard]] double violation(const StepInput& in, StepTrial& trial);
  /// A body that would be moved back onto the joints by more than a fifth of the longest way in the step:
  /// what the iteration has found is no motion from the start to the end. \param tolerance of the iteration,
  /// below which nothing is seen [m]
  [[nodiscard]] StrayBody find_stray(const StepInput& in, const StepTrial& trial, double tolerance) const;
  /// Velocities once more near a singular position, where the rounding of positions turns rows too much.
  void settle_velocities(StepTrial& trial);
  /// Brings the midpoint to the answer, rotations included.
  void finish(const StepInput& in, StepTrial& trial) const;
  /// Answer to contact.
  [[nodiscard]] JointAnswer& answer() { return answer_; }
  /// Rows of the joints that answer what touches them.
  [[nodiscard]] JointConstraints& answering(JointsTouch touch) {
    return touch == JointsTouch::contact ? answer_.rows() : joints_.rows.at_midpoint();
  }
  /// Bounds of friction in the joints by the forces in them.
  [[nodiscard]] FrictionBounds& friction_bounds() { return bounds_; }
  /// Makes velocities obey its condition.
  void allow_answered(double* velocity) { answer_.allow(joints_.rows.at_end(), velocity, joints_.left); }
  /// Velocities at the end as contact sees them.
  [[nodiscard]] const double* velocities_of_contact(StepTrial& trial);

  /// Impulses of the joints, with those by which they answer to contact.
  [[nodiscard]] const double* multipliers(const IslandProblem* problem);
  /// The iterate: impulses of the joints alone, the last displacement back onto them.
  [[nodiscard]] JointIterate& iterate() { return joints_; }
  [[nodiscard]] const JointIterate& iterate() const { return joints_; }
  /// Takes the step down for the guess at the next one.
  void record(JointHistory& history) const { untouched_.record(is_struck(), history); }
  /// True if anything but friction in joints takes part.
  [[nodiscard]] bool is_struck() const { return touch_ == JointsTouch::contact; }
  [[nodiscard]] StepJointRows& rows() { return joints_.rows; }
  /// The joint whose constraints the last iterate violates most. \param violation out: by how much
  [[nodiscard]] JointId worst_joint(double& violation) const;

private:
  void begin_at_start(const StepInput& in, bool mean, StepTrial& trial);

  JointIterate joints_;
  JointAnswer answer_;
  UntouchedJoints untouched_;  // iterates joints_
  JointsTouch touch_ = JointsTouch::nothing;
  bool guessed_ = false;        // untouched_ iterates the step
  std::vector<double> total_;   // L, and what contact adds
  FrictionBounds bounds_;       // of friction in the joints
  std::vector<double> breaks_;  // of drivers, ascending [s]
};

/// Joints of all components of a model. Stages share arrays.
class CAROM_API JointStages {
public:
  /// \param assembly must outlive it
  explicit JointStages(const Assembly& assembly);

  /// True if there are joints.
  [[nodiscard]] bool any() const { return rows_ > 0; }
  /// Joints of a component; null where it has none.
  [[nodiscard]] JointStage* of(Index component) const {
    return stages_.empty() ? nullptr : stages_[component].get();
  }
  /// Velocities at the end as contact of some components sees them, over all velocities.
  [[nodiscard]] const double* velocities_of_contact(std::span<const Index> components,
                                                    StepTrial& trial) const;
  /// Takes a step down for the guess at the next one. \param step its length [s]
  void record(double step, JointHistory& history) const;
  /// A step begins: joints answer contact along their rows at its start.
  void forget_paths();

private:
  const Assembly* assembly_;
  std::unique_ptr<JointArrays> arrays_;              // null without joints
  Index rows_ = 0;                                   // of all joints
  std::vector<std::unique_ptr<JointStage>> stages_;  // by component, or empty
};

}  // namespace carom
