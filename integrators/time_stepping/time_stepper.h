#pragma once

/// \file
/// The machine of the time-stepping mode. One step from t_j to t_{j+1} (Johansson 1999, section 4):
///
///   contacts     those with gap <= 0 at t_j, and of the step before those that turning has opened
///                (contact/detection/lasting_contacts.h); against the velocities of the obstacles at t_j and
///                t_{j+1}
///   guess        F_{j+1} by extrapolation
///   repeat       v_free = v_j + M^-1 h (F_j + F_{j+1})/2
///                v_{j+1} = v_free + M^-1 H^T P,  P from the contact problem
///                q_{j+1} = q_j advanced by h (v_j + v_{j+1})/2
///                F_{j+1} = F(q_{j+1}, v_{j+1}, t_{j+1})
///   until        with these loads for the guess positions and h times velocities would no longer change.
///
/// Under the rule `energy_momentum` the mean (F_j + F_{j+1})/2 is replaced by the elements' own mean loads of
/// the step, which are guessed and repeated in the same way.
///
/// Bodies with joints (docs/method.md, section 8): with the rows G of the joints, G0 at the start, Gm halfway
/// and G1 at the end,
///
///                v_{j+1} = v_free + M^-1 Gm^T L + K H^T P,   K = M^-1 - M^-1 G0^T (G0 M^-1 G0^T)^-1 G0 M^-1
///                q_{j+1} = q_j advanced by h (v_j + v_{j+1})/2 + d
///
/// where every sweep corrects L by what is left of  G1 v_{j+1} + rate = 0  and the displacement d, of third
/// order in h, by what is left of  g(q_{j+1}, t_{j+1}) = 0.
///
/// Friction in joints is a row of the contact problem with |P| <= h times its bound. Without contacts its
/// force acts halfway, against the rate that the coordinate has at the end (time_stepper_joint_contacts.cpp).

#include <carom/contact/detection/detector.h>
#include <carom/contact/friction_bound_solver.h>
#include <carom/contact/friction_bounds.h>
#include <carom/contact/island_problem.h>
#include <carom/contact/solvers/solver_chain.h>
#include <carom/core/assembly.h>
#include <carom/core/dynamics/coupling_rating.h>
#include <carom/core/dynamics/implicit_solver.h>
#include <carom/core/dynamics/joint_constraints.h>
#include <carom/core/dynamics/mixed_constraints.h>
#include <carom/core/dynamics/prescribed_joints.h>
#include <carom/core/energy_term.h>
#include <carom/core/export.h>
#include <carom/core/numerics/anderson.h>
#include <carom/core/numerics/fixed_point.h>
#include <carom/integrators/run/companion.h>
#include <carom/integrators/run/step_report.h>
#include <carom/integrators/run/stop_request.h>
#include <carom/integrators/run/time_stepping.h>
#include <carom/integrators/time_stepping/gap_projection.h>

#include <span>
#include <utility>
#include <vector>

namespace carom {

/// Demands options that can be. Throws ModelError naming the option.
CAROM_API void check_options(const TimeStepping& options);

/// Advances states of one assembly. Owns workspaces only: what a step depends on is state, companion,
/// options.
class CAROM_API TimeStepper {
public:
  /// Throws ModelError for impossible options or a contact without a law.
  /// \param stop asked between sweeps, may be null; must outlive this
  TimeStepper(const Assembly& assembly, const TimeStepping& options, const StopRequest* stop = nullptr);

  /// Makes one step of length `step` [s] whose end is called `end_time`. On success state and companion are
  /// those at its end and `report` tells what happened; on an error none of the three has changed.
  void step(State& state, Companion& companion, double step, double end_time, StepReport& report);

  /// Names of contacts.
  [[nodiscard]] const Detector& detector() const { return detector_; }

private:
  void place_obstacles(const State& state, double step, double end_time);
  void start_loads(const State& state, Companion& companion);
  void remember_contacts(const Companion& companion, double step);
  void advance_component(Index component, const State& state, const Companion& companion, double step);
  /// Sweeps until the judge is content; false if the iteration does not contract.
  [[nodiscard]] bool iterate(Index component, const State& state, const Companion& companion, double step,
                             FixedPointJudge& judge);
  /// Likewise by one iteration after the other (Iteration::automatic); throws SolverError if none contracts.
  void iterate_somehow(Index component, const State& state, const Companion& companion, double step,
                       FixedPointJudge& judge);
  /// The contacts of a component and sweeps by one iteration, whose failure leads to another one.
  [[nodiscard]] bool attempt(Iteration iteration, Index component, const State& state,
                             const Companion& companion, double step, FixedPointJudge& judge);
  [[noreturn]] void fail_all_iterations(Index component, const State& state, const Companion& companion,
                                        double step);
  void set_iteration(Iteration iteration);
  [[nodiscard]] bool automatic() const { return options_.iteration == Iteration::automatic; }
  void advance_under_constant_loads(Index component, const State& state, const Companion& companion,
                                    double step);
  void find_contacts(Index component, const State& state);
  void add_cluster(const State& state, std::size_t first, std::size_t last);
  void share_out_clusters(Index component);
  void classify_components();
  void guess_loads(Index component, const Companion& companion, double step);
  void guess_block(Index block, const Companion& companion, double step);
  void record_change(Index block, const Companion& companion);
  void open_history(Companion& companion);
  void close_history(const Companion& companion);
  void start_iteration(Index component, const State& state, double step);
  void solve_contacts(Index component, const State& state, const Companion& companion, double step);
  /// Those of a block, while others are at work on other runs. What cannot be solved gets no impulses.
  void solve_contacts(Index component, const Block& block, Index part, const State& state,
                      const Companion& companion, double step);
  /// Impulses of a cluster against the guess of the loads; false if there are none.
  [[nodiscard]] bool solve(IslandProblem& cluster, SolverChain& chain, const State& state,
                           const Companion& companion, double step);
  /// Throws SolverError unless all contacts were solved in the last of so many sweeps.
  void demand_solved(Index component, const State& state, const Companion& companion, double step,
                     int sweeps);
  /// Guesses the loads on blocks with contacts by sweeps of these blocks alone, where they are few.
  void presolve_around_contacts(Index component, const State& state, const Companion& companion, double step);
  [[nodiscard]] bool touched(Index part) const {
    return clusters_in_use_ > 0 && !block_clusters_[part].empty();
  }
  void sweep(Index component, const State& state, const Companion& companion, double step);
  void sweep(Index component, const Block& block, Index part, const State& state, const Companion& companion,
             double step);
  [[nodiscard]] bool is_streamable(Index component) const {
    return coupling_class_[component] == CouplingClass::streamable &&
           iteration_ != Iteration::linearly_implicit;
  }
  [[nodiscard]] bool jointed(Index component) const {
    return !joints_.empty() && !joints_[component].end.empty();
  }
  void prepare_joints();
  void start_joints(Index component, const State& state, double step);
  void sweep_joints(Index component, const State& state, const Companion& companion, double step);
  struct JointWork;
  static void factor_joints(JointWork& work);
  static void solve_joints(JointWork& work);
  void correct_joint_impulses(Index component);
  [[nodiscard]] bool converge_joints(Index component, const State& state, const Companion& companion,
                                     double step);
  void choose_reactions(Index component, const State& state, double step);
  void solve_joint_contacts(Index component, const State& state, double step);
  static void allow_at_start(JointWork& work, double* velocity);
  [[nodiscard]] bool strikes() const;
  void update_friction_rows(Index component);
  void add_contacts_to_joints(Index component);
  void return_to_joints(Index component, const State& state, double step);
  /// Brings rows to a configuration; a motion that is not finite there fails the step.
  static void place_rows(JointConstraints& joints, const JointView& at, const State& state, double step);
  void place_joints(Index component, const State& state, double step);
  void move(Index component, const std::vector<double>& displacement, State& state) const;
  [[nodiscard]] SweepChange joint_change(Index component, double step) const;
  [[nodiscard]] double joint_violation(Index component);
  void book_joints(Index component, const State& state, double step);
  void place_middle(Index component, const State& state, double step);
  void sweep_all(Index component, const State& state, const Companion& companion, double step);
  void follow_iterate(Index component, const State& state, double step);
  struct Works {
    double kinetic, total, dissipative, external;  // energy at the end; works of the loads, by cause [J]
  };
  [[nodiscard]] Works works(Index component, const Block& block, const State& state,
                            const Companion& companion, double step) const;
  // What there is of the loads after one sweep or two in one go, of which the first was found to be enough.
  enum class SweepsMade : std::uint8_t { total, by_cause, converged_one_early, failed };
  /// Makes the next sweep, or the next two; the judge has still to see the last.
  [[nodiscard]] SweepsMade sweep_on(Index component, const State& state, const Companion& companion,
                                    double step, int expected, FixedPointJudge& judge);
  enum class LoadsAsked : std::uint8_t { total, by_cause };
  /// Loads that the iterate leads to, by cause with works_, and if asked changes_.
  void evaluate_iterate(Index component, const State& state, const Companion& companion, double step,
                        LoadsAsked asked, bool with_changes, BlockTask first = {});
  /// A sweep, one more by its loads, and the loads that this one leads to by cause; of the first changes
  /// only.
  void sweep_fused(Index component, const State& state, const Companion& companion, double step,
                   BlockTask first);
  /// What is left to do with a block by whose loads by cause an iterate may end.
  void finish_block(Index component, const Block& block, Index part, const State& state,
                    const Companion& companion, double step);
  /// What the next sweep would change.
  [[nodiscard]] SweepChange next_change(Index component, const Block& block, double step) const;
  [[nodiscard]] SweepChange largest(const std::vector<SweepChange>& changes, Index component) const;
  [[nodiscard]] SweepChange implicit_change(Index component, double step) const;
  /// Calls f(block, its place in the component) for the blocks of a component, shared out to the threads.
  template <class F>
  void for_blocks(Index component, F&& f) const {
    const Range blocks = assembly_->components()[component].blocks;
    workers_.for_each(blocks.size(), [&](Index part) { f(assembly_->blocks()[blocks.begin + part], part); });
  }
  void improve_guess(Index component, const FixedPointJudge& judge);
  void improve_guess(const Block& block);
  void start_implicit(Index component, const State& state, const Companion& companion, double step);
  void linearise(Index component, const StateView& at, const Evaluation& evaluation, const State& state,
                 double step);
  void solve_implicit(Index component, const State& state, double step);
  void guess_implicit(Index component, const State& state, double step);
  void book_couplings(Index component, const State& state, double step);
  void project(Index component, const State& state, const Companion& companion, double step);
  void hold_velocities(Index component);
  // Of one contact problem in a step.
  struct ContactWork {
    double gain = 0.0;    // of all impulses [J]
    double scale = 0.0;   // sum of what its parts are made of [J]
    bool impact = false;  // something closed faster than the capture speed
  };
  void book_contacts(Index component, const State& state, double step);
  void record(const IslandProblem& cluster, std::size_t contact);
  void book_contact(const IslandProblem& cluster, std::size_t contact, ContactWork& sum);
  void book_gain(const IslandProblem& cluster, const ContactWork& work, const State& state, double step);
  void book_joint_friction(const IslandProblem& cluster, std::size_t contact, ContactWork& sum);
  void rate(Index component, const State& state, double step, double contraction);

  void demand_finite_loads(Index component, const StateView& at, const State& state, double step);
  void find_cause(Index component, const State& state, const Companion& companion, double step, int sweeps);
  [[noreturn]] void fail_contraction(Index component, const State& state, const Companion& companion,
                                     double step, const FixedPointJudge& judge);
  [[nodiscard]] JointId worst_joint(Index component, double& violation) const;
  [[noreturn]] static void fail_motion(const SolverError& error, const State& state, double step);
  [[noreturn]] void fail_contact(Index component, const IslandProblem& cluster, const State& state,
                                 double step);
  [[noreturn]] void fail_account(Index component, const State& state, double step);
  [[noreturn]] void fail_internal(ElementId element, const State& state, double step) const;
  [[noreturn]] void fail_linearisation(Index component, const State& state, double step, const char* why);
  [[noreturn]] void fail_projection(const Constraint& left, const State& state, double step) const;
  [[noreturn]] void refuse_gain(const IslandProblem& cluster, double gain, const State& state,
                                double step) const;

  /// The step of a component as elements see it, `f` called with it.
  template <class F>
  auto with_step(Index component, const State& state, double step, F&& f) const {
    const EvaluationContext start{*assembly_, state.view(), start_, component};
    const EvaluationContext end{*assembly_, trial_.view(), evaluation_, component};
    const EvaluationContext middle{*assembly_, midpoint_.view(), middle_evaluation_, component};
    return f(StepContext{start, end, middle, step});
  }
  [[nodiscard]] bool mean_rule() const { return options_.force_rule == ForceRule::energy_momentum; }
  /// What stands for the loads at the start in the sum (load0 + load1)/2: mean loads count twice.
  [[nodiscard]] const double* start_of_sum(const Companion& companion) const {
    return mean_rule() ? evaluation_.force.data() : companion.loads.total.data();
  }
  /// v_{j+1} changes by this times M^-1 times the change of what is iterated.
  [[nodiscard]] double impulse_weight(double step) const { return mean_rule() ? step : 0.5 * step; }

  void remember_loads(Companion& companion);
  void commit(State& state, Companion& companion, double end_time, StepReport& report);

  const Assembly* assembly_;
  TimeStepping options_;
  const StopRequest* stop_;  // may be null
  Workers workers_;
  Detector detector_;
  MassResponse masses_;
  PrescribedJoints prescribed_;
  std::vector<SolverChain> chains_;  // one for each run of a component; the first for what is not shared out

  ObstaclePlaces places_;           // of the obstacles at the start
  ObstaclePlaces places_after_;     // and at the end
  State trial_;                     // q_{j+1}, v_{j+1}, z_{j+1} of the sweep at hand
  State midpoint_;                  // halfway, where elements look at it
  Evaluation start_;                // rotation: at the start
  Evaluation middle_evaluation_;    // rotation: halfway
  Evaluation evaluation_;           // force: guess of the loads at the end (or mean loads)
  std::vector<double> loads_end_;   // loads that the guess led to; before it, at the start of the last step
  LoadHistory* history_ = nullptr;  // the companion's, during a step
  std::vector<std::uint8_t> recorded_;  // by block: its part of the last change, where that is pending
  StoredEnergies evaluated_energies_;   // of the component, potentials that it led to
  std::vector<int> sweeps_;             // by component, as many as were needed
  // Coupling of a component. Iterated: loads depend on what the step leads to. Streamable: likewise, but
  // nothing comes between a sweep of bodies and their loads, so that a block can have both at once. Constant
  // loads: no iteration.
  enum class CouplingClass : std::uint8_t { iterated, streamable, constant_loads };
  std::vector<CouplingClass> coupling_class_;  // by component
  bool swept_ = false;                         // trial_ is an iterate of the step
  std::vector<SweepChange> changes_,
      earlier_changes_;                           // by block of the component at hand; of the sweep before
  std::vector<Works> works_;                      // likewise
  std::vector<double> weights_;                   // of loads: lengths by mass
  Iteration iteration_ = Iteration::fixed_point;  // of the component at hand
  bool tentative_ = false;                        // one that may fail
  IterationMemory iterations_;                    // the companion's, after the step
  AndersonAcceleration anderson_;
  ImplicitSolver implicit_;
  bool stale_ = false;  // the matrix is to be made anew
  GapProjection projection_;
  bool guesses_ = false;            // whether any component has loads that change
  bool books_dissipative_ = false;  // whether any element does
  bool books_external_ = false;
  bool loads_need_rotations_ = false;
  bool contacts_need_rotations_ = false;
  bool start_needs_rotations_ = false;          // the one or the other
  std::vector<double> dissipative_, external_;  // loads at the end by cause, of the last iterate; or empty
  std::vector<float> rounding_;                 // what rounding cuts off v_{j+1}
  std::vector<double> dv_impulses_;  // changes of velocity by contact, empty until anything touches
  std::vector<double> free_;         // velocities without contact and joints, likewise
  std::vector<double> update_;       // changes of velocities, of the linearly implicit iteration
  std::vector<std::pair<ConstraintKey, ContactMode>> joint_friction_modes_;  // of friction in joints
  std::vector<ConstraintKey> sticking_;  // in the last step, ordered; where static friction asks
  LastingContacts lasting_;              // contacts of the last step that turning may have opened
  std::vector<Constraint> contacts_;
  std::vector<IslandProblem> clusters_;
  std::size_t clusters_in_use_ = 0;
  std::vector<Range> block_clusters_;  // by block of the component at hand, if there are any
  std::vector<std::uint8_t> settled_;  // likewise: blocks whose loads were guessed by settle_contacts()
  Surroundings upset_;                 // blocks around contacts

  // Along which rows the joints of a component push: those halfway, those at the end, or those halfway with
  // the matrix of both.
  enum class Reactions : std::uint8_t { halfway, at_end, crossed };
  // The joints of a component.
  struct JointWork {
    Reactions reactions = Reactions::halfway;
    double roundoff_growth = 1.0;  // rounding, near a singular position
    bool near_singular = false;
    JointConstraints end, mean;   // rows at the end; of the reactions
    MixedConstraints crossed;     // factors of both
    JointConstraints start;       // rows at the start, where bodies touch or rows depend on time
    bool struck = false;          // bodies touch, or are at a stop
    std::vector<double> impulse;  // L
    std::vector<double> total;    // L, and what contact adds
    FrictionBounds pressure;      // of friction in them
    FrictionBoundSolver friction_bound;
    std::vector<double> left;  // of the constraints
  };
  std::vector<JointWork> joints_;  // by component; empty without joints
  // Over all velocities or coordinates, sized if there are joints: changes of velocity by joints, by contact;
  // displacements back onto the joints; scratch; the iterate before.
  std::vector<double> reaction_, dv_contact_, displacement_, scratch_, before_q_, before_v_;
  std::vector<double> allowed_;    // v_{j+1} as contact of bodies with joints sees it
  const double* after_ = nullptr;  // v_{j+1} as contact at hand sees it
  std::vector<double> lengths_;

  EnergyFlows flows_;
  CompensatedSum coupling_work_;
  double energy_position_projection_ = 0.0;  // energy taken out by moving bodies
  double energy_velocity_projection_ = 0.0;  // and by what that changes of their velocities
  StoredEnergies stored_;
  StepReport report_;
  std::vector<CouplingRating> ratings_;    // by component, of the last time it was rated
  std::vector<double> rated_contraction_;  // contraction seen then, negative if never rated
};

}  // namespace carom
