#pragma once

/// \file
/// The smooth motion of one component under fixed contact modes, as a problem for a flow:
///
///     dq/dt = v,   M dv/dt = f + reactions of joints and closed contacts,   dz/dt by the elements,
///     and the works of dashpots, friction, prescribed loads and moving obstacles.

#include <carom/contact/active_set.h>
#include <carom/contact/detection/detector.h>
#include <carom/contact/friction_bound_solver.h>
#include <carom/contact/friction_bounds.h>
#include <carom/contact/island_problem.h>
#include <carom/contact/solvers/solver_chain.h>
#include <carom/core/assembly.h>
#include <carom/core/dynamics/joint_constraints.h>
#include <carom/core/energy_term.h>
#include <carom/core/export.h>
#include <carom/core/numerics/bound_iteration.h>
#include <carom/integrators/event_driven/component_guards.h>
#include <carom/integrators/flow/flow.h>
#include <carom/integrators/run/event_driven.h>
#include <carom/integrators/run/work_limits.h>

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace carom {

/// Memory that components share: whole-model arrays of which an evaluation fills the component's part.
struct CAROM_API MotionWorkspace {
  explicit MotionWorkspace(const Assembly& assembly);

  State trial;                                ///< the state looked at
  Evaluation evaluation;                      ///< of it
  std::vector<double> dissipative, external;  ///< loads by cause [N, N m]
  std::vector<double> acceleration;           ///< with the reactions of closed contacts, if asked for
  std::vector<double> of_position, of_velocity, momentum;  ///< corrections; momentum: loads without reactions
  std::vector<double> multipliers;                         ///< of joints
  FrictionBoundSolver friction_bound;                      ///< of impacts with friction in joints
  std::vector<double> free;                                ///< accelerations without contacts
  std::vector<double> lengths;                             ///< Assembly::length_scales()
  std::vector<double> z_rates;
  ObstaclePlaces places;  ///< at the time of the state looked at
  EvaluationLimit limit;  ///< of evaluations
};

/// Works that are integrated along.
enum class WorkLine : std::uint8_t { dashpot, sliding, external, joint_friction };
/// Number of them; the last is integrated where joints rub only.
inline constexpr Index work_lines = 4;

/// The unknowns of one component: q, v, z, then works.
class CAROM_API SmoothMotion final : public FlowProblem {
public:
  /// All but the options must outlive it.
  SmoothMotion(const Assembly& assembly, const Detector& detector, Index component,
               const EventDriven& options, MotionWorkspace& work);

  [[nodiscard]] std::size_t size() const override { return size_; }
  void rates(double time, const double* y, double* rates) override;
  [[nodiscard]] std::span<const double> absolute_tolerances() const override { return tolerances_; }

  /// Where coordinates and velocities correspond one to one.
  [[nodiscard]] bool has_jacobian() const override { return q_size_ == v_size_; }
  /// Coordinates are the integrals of velocities.
  [[nodiscard]] std::size_t integrals() const override { return has_jacobian() ? q_size_ : 0; }
  /// The derivative of the equations of motion (smooth_motion_jacobian.cpp), with a multiplier for each row
  /// of joints and each force of a closed contact that is a constraint. Works have no rows.
  void jacobian(double time, const double* y, std::vector<RateDerivative>& out) override;

  /// Contacts that are closed.
  [[nodiscard]] ActiveSet& active() { return active_; }
  [[nodiscard]] const ActiveSet& active() const { return active_; }
  /// Everything that might touch, and friction in joints, which always does.
  [[nodiscard]] const std::vector<ContactPair>& pairs() const { return pairs_; }
  /// Which component.
  [[nodiscard]] Index component() const { return component_; }

  /// Reads the component's unknowns off a state, works 0.
  void gather(const State& state, std::span<double> y) const;
  /// Writes them into a state.
  void scatter(std::span<const double> y, State& state) const;
  /// Fills the workspace for one state, with or without the reactions of closed contacts; those of joints are
  /// in it always. False where the reactions do not exist.
  bool evaluate(double time, const double* y, bool with_reactions);
  /// Moves y onto the constraints of joints and closed contacts; the workspace holds an evaluation of y, with
  /// reactions, and is out of date afterwards if y was changed. Returns the energy taken out [J]; adds the
  /// largest displacement [m] to `shift`.
  double project(std::span<double> y, bool& changed, double& shift);
  /// Kinetic energy of the change of velocities in the last project() [J]: positive, and what it took where
  /// nothing is prescribed.
  [[nodiscard]] double projection_energy() const { return projection_energy_; }
  /// Kinetic energy of the component in the workspace's state [J].
  [[nodiscard]] double total_kinetic_energy() const;
  /// Names of the joints that change the velocities of the workspace's state most in a projection, else of
  /// the closed contacts; the workspace holds an evaluation.
  [[nodiscard]] std::vector<std::string> projected_by();
  /// Where a law of time of joints jumps in its rate: the impulse that makes joints follow, contacts aside.
  /// The workspace holds an evaluation of y, and is out of date afterwards if y was changed: where a velocity
  /// is off by more than `noise`. Adds the work of the impulse [J]; its multipliers are left in the
  /// workspace.
  bool follow_jump(std::span<double> y, double noise, double& work);

  /// Place of the first velocity in y.
  [[nodiscard]] std::size_t v_begin() const { return q_size_; }
  /// Works that are integrated: the first of the lines.
  [[nodiscard]] Index work_count() const { return work_count_; }
  /// Place of a work in y.
  [[nodiscard]] std::size_t work_place(WorkLine line) const {
    return q_size_ + v_size_ + z_size_ + static_cast<std::size_t>(line);
  }
  /// Joints of the component.
  [[nodiscard]] JointConstraints& joints() { return joints_; }
  [[nodiscard]] const JointConstraints& joints() const { return joints_; }
  /// Bodies that answer an impulse on a body: itself, or all that joints bind to it, named by the first.
  [[nodiscard]] Index mechanism(Index body) const { return assembly_->mechanism(body); }
  /// Makes the matrix of a problem from the masses and joints; the workspace holds the configuration.
  void respond(IslandProblem& problem);
  /// True if the bound of friction in a joint follows from forces.
  [[nodiscard]] bool depends_on_joint_force(const Constraint& contact) const {
    return pressure_.depends_on_joint_force(contact);
  }
  /// True if that of any in the component does.
  [[nodiscard]] bool bears_any() const { return !pressure_.empty(); }
  /// Solves the problem of an impact. Bounds of friction in joints that follow from impulses
  /// are found by repetition; it is not solved where they do not settle. \param contacts those of the problem
  bool solve(IslandProblem& cluster, std::span<Constraint> contacts, SolverChain& chain);
  /// Forces of closed contacts in place of those at hand, as the flow finds them, with bounds of friction in
  /// joints as they are; then the bounds that follow, their largest relative change, and the margins of the
  /// forces. The workspace holds an evaluation without reactions. False where there are no forces.
  bool update_bounds(std::vector<ActiveContact>& contacts, std::vector<ForceMargin>& margins,
                     BoundIteration& iteration, double& change);
  /// Multipliers of the joints in the workspace's state, contacts acting as they do; the workspace holds an
  /// evaluation with reactions.
  [[nodiscard]] std::span<const double> joint_multipliers();
  /// Kinetic energy of the group of a body in the workspace's state [J].
  [[nodiscard]] double kinetic_energy(Index body) const;
  /// The contact of a pair in the workspace's state.
  void contact(std::size_t pair, Constraint& out) const;
  /// Guards of the component's elements.
  [[nodiscard]] const ComponentGuards& guards() const { return guards_; }
  /// True if guards can be looked at along a path of coordinates (step_path.h).
  [[nodiscard]] bool guards_follow_path() const {
    return guards_.count() != 0 && guards_.all_have_motion() && has_jacobian();
  }
  /// Writes guards at y with accelerations of the component's bodies, without loads.
  void read_guards(double time, const double* y, const double* acceleration, std::vector<GuardMotion>& out);
  /// Writes them in the workspace's state, with derivatives; accelerations are those of the last evaluate().
  void read_guards(std::vector<GuardMotion>& out);
  /// Where laws of the component's elements and drivers and of obstacles jump, in ascending order of times.
  [[nodiscard]] const std::vector<Discontinuity>& breaks() const { return breaks_; }
  /// True if nothing but uniform fields acts: places are polynomials of time but for turning.
  [[nodiscard]] bool flies_freely() const {
    return only_fields_ && joints_.empty() && active_.list().empty();
  }
  /// True if the loads or obstacles depend on time.
  [[nodiscard]] bool depends_on_time() const { return depends_on_time_; }

private:
  bool add_friction_bound_reactions();
  bool press_once(BoundIteration& iteration, double& change);
  [[nodiscard]] double largest_load() const;
  // Parts of the Jacobian: changes of a contact's load, its forces as they are, and of the accelerations
  // along its rows, those of the bodies as they are.
  struct ContactChange {
    static constexpr std::size_t most = Constraint::max_columns;
    template <std::size_t N>
    using ByMove = std::array<std::array<double, N>, most>;  // by what is moved

    std::array<Index, most> columns{};
    std::size_t count = 0;
    ByMove<most> load_by_position{}, load_by_velocity{};
    ByMove<2> row_by_position{}, row_by_velocity{};
  };
  [[nodiscard]] std::size_t unknown(Index v) const {
    return q_size_ + (v - assembly_->components()[component_].v.begin);
  }
  void differentiate_internals(std::vector<RateDerivative>& out);
  void differentiate_joints(std::vector<RateDerivative>& out, Index& multiplier);
  void differentiate_contacts(std::vector<RateDerivative>& out, Index& multiplier);
  void differentiate_pressure(const ActiveContact& contact, std::vector<RateDerivative>& out);
  [[nodiscard]] ContactChange change_of(const ActiveContact& contact);

  const Assembly* assembly_;
  const Detector* detector_;
  MotionWorkspace* work_;
  Index component_;
  Index work_count_;
  std::size_t q_size_, v_size_, z_size_, size_;
  std::vector<double> tolerances_;
  std::vector<ContactPair> pairs_;
  JointConstraints joints_;
  FrictionBounds pressure_;
  ActiveSet active_;
  std::vector<LoadDerivative> derivatives_;
  std::vector<ContactChange> contact_changes_;
  std::vector<Index> row_multipliers_;  // unknowns of the Jacobian, by row of joints_; none: without force
  ComponentGuards guards_;
  std::vector<Discontinuity> breaks_;
  double projection_energy_ = 0.0;
  bool books_dissipative_ = false, books_external_ = false, depends_on_time_ = false, only_fields_ = true;
};

}  // namespace carom
