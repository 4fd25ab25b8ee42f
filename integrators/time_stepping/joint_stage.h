#pragma once

/// \file
/// Joints of one component in a step: velocities that they allow at its end, positions on them, and what
/// reactions did. With the rows G0 at the start, Gm halfway and G1 at the end (docs/method.md, section 8),
///
///   v_{j+1} = v_free + M^-1 Gm^T L + K H^T P,   K = M^-1 - M^-1 G0^T (G0 M^-1 G0^T)^-1 G0 M^-1
///   q_{j+1} = q_j advanced by h (v_j + v_{j+1})/2 + d
///
/// where every sweep corrects L by what is left of  G1 v_{j+1} + rate = 0  and the displacement d, of third
/// order in h, by what is left of  g(q_{j+1}, t_{j+1}) = 0. The first iterate is guessed by the steps before.
/// Rows are those of the iterate before; without contact the iterate is the answer when its own rows leave
/// nothing but rounding of both conditions, and its Gm^T L is the impulse that led to it.
///
/// Contact acts along its rows H at the start of the step, and so does the answer of the joints to it, along
/// their rows G0 there: both are one impact with W = H K H^T, the same in all sweeps. The law sees velocities
/// that the joints allow there,
///
///   gamma^+ = H (v - M^-1 G0^T S^-1 (G0 v + rate)),   S = G0 M^-1 G0^T,   v = v_{j+1},   rate at the end,
///
/// which differ from H v_{j+1} by how far the joints turn within the step. With that, of contacts at one pin
/// (the ends of two bars that it joins) one follows from the other; with H v_{j+1} they would contradict each
/// other by that little, and large impulses would change from sweep to sweep. Impulses and answers do the
/// work P . (gamma^- + gamma^+)/2, and on drivers the multipliers times the mean of their rates, nothing
/// else.
///
/// Friction in joints is a row of the contact problem with |P| <= h times its bound. Without contacts its
/// force acts halfway, against the rate that the coordinate has at the end.

#include <carom/contact/detection/detector.h>
#include <carom/contact/friction_bound_solver.h>
#include <carom/contact/friction_bounds.h>
#include <carom/contact/island_problem.h>
#include <carom/core/assembly.h>
#include <carom/core/export.h>
#include <carom/integrators/time_stepping/step_input.h>
#include <carom/integrators/time_stepping/step_joint_rows.h>
#include <carom/integrators/time_stepping/step_rule.h>
#include <carom/integrators/time_stepping/step_trial.h>

#include <memory>
#include <span>
#include <vector>

namespace carom {

/// Arrays over all velocities or coordinates of a model with joints; a component uses its part.
struct JointArrays {
  explicit JointArrays(const Assembly& assembly);

  std::vector<double> dv_joints;           ///< changes of velocity by reactions
  std::vector<double> dv_contact;          ///< by contact
  std::vector<double> displacement;        ///< back onto the joints
  std::vector<double> scratch;             ///< between two lines
  std::vector<double> before_q, before_v;  ///< the iterate before
  std::vector<double> allowed;             ///< v_{j+1} as contact of bodies with joints sees it
  std::vector<double> lengths;             ///< Assembly::length_scales()
};

/// Friction of the island that is bound by forces of joints, and how its problem is solved.
struct JointContacts {
  const Detector& detector;
  std::span<Constraint> constraints;  ///< of the island
  IslandProblem* problem = nullptr;   ///< null where nothing touches or rubs
  SolverChain& chain;
  bool stale_matrix = false;  ///< another stage has made its own W
};

/// Joints of one component. Keeps memory.
class CAROM_API JointStage {
public:
  /// \param first_row of its rows among those of all components \param arrays shared by all components; must
  /// outlive it
  JointStage(const Assembly& assembly, Index component, Index first_row, JointArrays& arrays);

  /// The first iterate, under the loads of the guess: by the steps before where there were any and it is
  /// wanted, else without reactions, where the present velocities lead to. Bounds of friction in joints
  /// become those of impulses.
  void start(const StepInput& in, const StepRule& rule, bool guesses, JointContacts& contacts,
             StepTrial& trial);
  /// One sweep. False if the contact problem is not solved.
  [[nodiscard]] bool sweep(const StepInput& in, const StepRule& rule, JointContacts& contacts,
                           StepTrial& trial);
  /// Change that another sweep would make where nothing touches or rubs and the joints are obeyed; else that
  /// the sweep has made.
  [[nodiscard]] SweepChange change(const StepInput& in, const JointContacts& contacts,
                                   const StepTrial& trial);
  /// Distance of the iterate from obeying the joints, in units of what rounding lets it.
  [[nodiscard]] double violation() const { return violation_; }
  /// Velocities once more near a singular position, where the rounding of positions turns rows too much.
  void settle_velocities(const StepInput& in, StepTrial& trial);
  /// Velocities that the joints allow where bodies have been moved to. Returns the kinetic energy lost [J].
  double project_velocities(StepTrial& trial);
  /// Makes velocities obey the joints with the rows at the start and the rates at the end.
  void allow_at_start(double* velocity);
  /// Velocities at the end as contact sees them.
  [[nodiscard]] const double* velocities_of_contact(StepTrial& trial);

  /// Impulses of the joints, with those by which they answer to contact.
  [[nodiscard]] const double* multipliers(const IslandProblem* problem);
  /// Impulses of the joints alone, of the last sweep.
  [[nodiscard]] const std::vector<double>& reactions() const { return impulse_; }
  /// The last displacement back onto the joints, over all velocities.
  [[nodiscard]] const std::vector<double>& displacement() const { return arrays_->displacement; }
  /// Work of the impulses L along the mean velocities [J].
  [[nodiscard]] double work_of_reactions(const StepTrial& trial);
  /// Takes the step down for the guess at the next one.
  void record(JointHistory& history) const;
  /// True if anything but friction in joints takes part.
  [[nodiscard]] bool is_struck() const { return struck_; }
  [[nodiscard]] StepJointRows& rows() { return rows_; }
  [[nodiscard]] const StepJointRows& rows() const { return rows_; }
  /// The joint whose constraints the last iterate violates most. \param violation out: by how much
  [[nodiscard]] JointId worst_joint(double& violation) const;

private:
  [[nodiscard]] bool guess(const StepInput& in);
  void find_free_velocities(const StepInput& in, const StepRule& rule, StepTrial& trial) const;
  void move_bodies(const StepInput& in, const StepRule& rule, StepTrial& trial) const;
  void judge(const StepTrial& trial);
  void drop_dependent();
  void move_by_start(const StepInput& in, StepTrial& trial);
  void return_near_singular(const StepInput& in, StepTrial& trial);
  [[nodiscard]] bool needs_factors(const JointContacts& contacts) const;
  void correct_impulses(const StepTrial& trial);
  [[nodiscard]] bool react_to_contact(const StepInput& in, JointContacts& contacts, StepTrial& trial);
  void update_friction_rows(JointContacts& contacts, StepTrial& trial);
  void return_to_joints(const StepInput& in, bool touches, StepTrial& trial);
  void move(const std::vector<double>& displacement, State& state) const;
  void clear(std::vector<double>& numbers) const;

  const Assembly* assembly_;
  Index component_, first_row_;
  JointArrays* arrays_;
  StepJointRows rows_;
  bool struck_ = false, guessed_ = false;
  int sweeps_ = 0;               // of the step
  double violation_ = 0.0;       // of the iterate
  std::vector<double> impulse_;  // L
  std::vector<double> total_;    // L, and what contact adds
  std::vector<double> left_;     // of the constraints
  FrictionBounds bounds_;        // of friction in them
  FrictionBoundSolver bound_solver_;
};

/// Joints of all components of a model. Stages share arrays.
class CAROM_API JointStages {
public:
  explicit JointStages(const Assembly& assembly);

  /// Those of a component; null where there are none.
  [[nodiscard]] JointStage* of(Index component) const {
    return stages_.empty() ? nullptr : stages_[component].get();
  }
  /// Takes a step down for the guess at the next one. \param step its length [s]
  void record(double step, JointHistory& history) const;

private:
  std::unique_ptr<JointArrays> arrays_;              // null without joints
  Index rows_ = 0;                                   // of all joints
  std::vector<std::unique_ptr<JointStage>> stages_;  // by component, or empty
};

}  // namespace carom
