#pragma once

/// \file
/// One component from event to event (docs/method.md, section 7):
///
///     flow until an event > impacts, until nothing approaches > modes from accelerations > flow on.
///
/// A component goes at its own pace: it makes steps as long as its flow likes and is looked at in between.

#include <carom/contact/detection/detector.h>
#include <carom/contact/island_problem.h>
#include <carom/core/assembly.h>
#include <carom/core/energy_term.h>
#include <carom/core/export.h>
#include <carom/core/numerics/step_polynomial.h>
#include <carom/integrators/event_driven/guard_search.h>
#include <carom/integrators/event_driven/mode_decision.h>
#include <carom/integrators/event_driven/smooth_motion.h>
#include <carom/integrators/event_driven/step_looks.h>
#include <carom/integrators/event_driven/step_path.h>
#include <carom/integrators/flow/flow_pool.h>
#include <carom/integrators/run/event_log.h>
#include <carom/integrators/run/step_report.h>
#include <carom/integrators/run/work_limits.h>

#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace carom {

/// What components share: memory and solvers.
struct CAROM_API DriverWorkspace {
  /// \param stop asked within the work, may be null
  DriverWorkspace(const Assembly& assembly, const EventDriven& options, const StopRequest* stop)
      : motion(assembly), flows(options.method, options.relative_tolerance) {
    motion.limit = EvaluationLimit(options.evaluation_limit, stop);
  }

  /// For one component at a time.
  MotionWorkspace motion;
  FlowPool flows;  ///< a component has one in its turn, and between turns if it cannot do without
  SolverChain chain;
  IslandProblem cluster;
  ModeDecision decision;
  std::vector<Constraint> contacts;  // of all pairs of a component
  std::vector<Constraint> touching;  // of one body
  std::vector<Constraint> captured;
  std::vector<Candidate> candidates;  // of one body
  std::vector<ForceMargin> margins;
  std::vector<double> y, free;
  StepLooks looks;        // into the step at hand,
  StepLooks guard_looks;  // of guards along its path
};

/// What left the energy of components, and what is to be told, since it was last emptied.
struct EventBalance {
  EnergyFlows flows;
  std::vector<EventRecord> events;
  EventCounts counts{};
  std::vector<JointImpulse> joint_impulses;  ///< of impacts
  double energy_gain = 0.0;                  ///< by impacts [J]
  double shift = 0.0;                        ///< largest displacement by projection [m]
};

/// Modes by contact.
using ContactModes = std::vector<std::pair<ConstraintKey, ContactMode>>;

/// Drives one component. Its memory is its own but for the workspace.
class CAROM_API ClockGroup {
public:
  ClockGroup(const Assembly& assembly, const Detector& detector, const EventDriven& options, Index component,
             DriverWorkspace& work);

  /// Throws ModelError where a contact is deeper in an obstacle than gap_tolerance: no start.
  void demand_start(const State& state);
  /// Starts at a state; throws as demand_start(). \param present modes of contacts before, if known, by key
  void start(const State& state, const ContactModes& present);
  /// Goes on to a time, not before the present; events at that very time included. Throws SolverError: the
  /// driver must then be started anew.
  void advance(double target, EventBalance& balance);
  /// Writes the component's part of the state at the time last advanced to, and the modes of closed contacts.
  void write(State& state, ContactModes& modes) const;
  /// Reaction of a joint of the component at the time last advanced to.
  [[nodiscard]] JointReaction reaction(const JointKind& kind, Index slot, JointId joint);

private:
  // What is found: nothing, an end of a gap, of a force, of slipping; a kink of loads; a break of a law;
  // forces without bound; that the flow is to start anew; or that the step passed over loads.
  enum class Guard : std::uint8_t { nothing, gap, force, slip, kink, law, painleve, restart, leap };
  struct Found {
    double time;
    Guard guard = Guard::nothing;
    std::size_t which = 0;  // pair, body that touches, closed contact, or guard of an element
    double sign = 1.0;      // of the guard before
  };
  // What is watched over a step: values at its start and at its end, and between them where asked.
  struct Watch {
    std::vector<StepPolynomial::End> gaps;    // by pair
    std::vector<double> gap_curvature_bound;  // by pair: bound of the sixth derivative by turning [m/s^6]
    StepLook seen;                            // all else
    PathEnd path;                             // where there are guards
    std::vector<double> noises;               // rounding of the margins
  };
  class Looker;
  class PathLooker;

  // A sticking contact whose friction is exhausted, and the friction then.
  struct Break {
    ContactPair pair;
    double push;
    double noise;  // of it
  };

  // Smooth phases.
  void output_at(double projected, double target, EventBalance& balance);
  void output_within_step(double target, EventBalance& balance);
  void borrow_flow();
  void leave_flow();
  void take_step();
  [[nodiscard]] double longest_step() const;
  bool sample_guards(double time, const double* y, Watch& out);
  [[nodiscard]] Found find_event();
  [[nodiscard]] Found predict_event();
  void see(StepLook& out);
  void sample(double time);
  void predict_gaps(Found& found);
  void predict_forces(StepLooker& looker, Found& found);
  void predict_guards(StepLooker& looker, Found& found);
  [[nodiscard]] double level(std::size_t pair) const;
  [[nodiscard]] double slip_level(std::size_t closed) const;
  [[nodiscard]] double force_level(std::size_t body) const;
  [[nodiscard]] double guard_noise() const;
  // Remainder of the quantity of an event after a landing.
  struct Rest {
    double value, rate, noise;
    bool has_rate;
  };
  [[nodiscard]] Rest rest_of(const Found& rough);
  [[nodiscard]] Found locate_event(const Found& rough);
  [[nodiscard]] Found first_of(const Found& rough, const Found& found);
  [[nodiscard]] bool leaps_over_loads(double until);
  [[nodiscard]] bool lands_off_path(const Found& found);
  [[nodiscard]] double allowed_off_path(std::size_t i, double coordinate) const;
  [[nodiscard]] bool stands_still(const Found& found) const;
  void go_to_event(EventBalance& balance);
  void accept_step(EventBalance& balance);
  double project(std::span<double> y, bool& changed, EventBalance& balance);
  bool project_onto_constraints(EventBalance& balance);
  void project_with_contact_stuck(EventBalance& balance);
  [[nodiscard]] bool at_rest();

  // Events.
  void begin_phase(EventBalance& balance);
  void project_known_contacts(EventBalance& balance);
  void set_scales();
  void locate_contacts();
  bool resolve_impacts(EventBalance& balance);
  void resolve_body(std::size_t first, std::size_t last, double fastest, EventBalance& balance);
  void take_captured(std::size_t first, std::size_t last);
  void close_captured(EventBalance& balance);
  void book_impact(EventKind kind, double energy_before, EventBalance& balance);
  void decide_modes(EventBalance& balance);
  bool decide_body(std::size_t first, std::size_t last, EventBalance& balance);
  void collect_candidates(std::size_t first, std::size_t last);
  [[nodiscard]] bool find_unbounded_force();
  [[nodiscard]] Decision decide_candidates(std::size_t first, std::size_t last);
  [[nodiscard]] bool has_unbounded_force() const;
  [[nodiscard]] std::size_t most_dissipative_solution();
  void impact_without_collision(EventBalance& balance);
  void record_changes(EventBalance& balance);
  void record_choice(EventKind kind, EventBalance& balance);
  EventRecord& record(EventKind kind, const Constraint& contact, EventBalance& balance);
  [[nodiscard]] bool touches(std::size_t pair) const;
  [[nodiscard]] double speed_noise() const;
  // Bounds of the work (clock_group_limits.cpp).
  void go_to(double target, EventBalance& balance);
  void demand_time(double target) const;
  void count_step();
  void count_event();
  [[nodiscard]] std::vector<std::string> parts_of_event();
  void record_joints(EventBalance& balance);
  void list_impulses(EventBalance& balance);
  void remember_impact(const ConstraintKey& contact);
  [[nodiscard]] double accumulation_time() const;

  [[nodiscard]] std::string record_approach(const std::vector<Constraint>& contacts,
                                            const double* velocity) const;
  void demand_finite_loads();
  [[noreturn]] void fail_loads();
  [[noreturn]] void fail_flow(const SolverError& error);
  [[noreturn]] void fail(const std::string& what, std::vector<std::string> parts,
                         const IslandProblem* cluster = nullptr) const;

  // Forces that have outgrown all others by this are infinite nearby: W_nn - s mu W_nt has fallen to the
  // inverse part of what it was.
  static constexpr double without_bound = 1e3;

  const Assembly* assembly_;
  const Detector* detector_;
  EventDriven options_;
  DriverWorkspace* work_;
  SmoothMotion motion_;
  FlowPool::Loan flow_;  // null at rest, and where `left_` is all there is to know of the motion
  FlowStep left_;
  bool is_recorded_ = false;  // `left_` is the step of the flow

  double time_ = 0.0;                           // up to which the component is decided
  std::vector<double> y_;                       // at time_
  double output_time_ = 0.0;                    // time last advanced to
  std::vector<double> output_state_;            // y then
  std::array<double, work_lines> delivered_{};  // works told so far
  double output_projection_ = 0.0;              // of what was last looked at [J]
  bool fresh_ = true;                           // start_gap_ counts as touching
  bool pending_ = false;                        // the flow's last step is ahead of time_
  bool in_phase_ = false;                       // modes are decided and the flow has started
  bool resting_ = false;
  bool jumped_ = false;  // the rate of a driver just did
  Found next_{};         // event in the pending step
  Watch start_, end_;
  GuardSearch guards_;
  std::vector<GuardMotion> guards_now_;
  double step_ = 0.0;                // to try first in the next phase
  double landed_at_ = 0.0;           // where the event was found,
  std::vector<double> landed_;       // and y there
  std::vector<char> is_active_;      // by pair
  std::vector<char> passed_over_;    // by pair: false alarms within the step,
  std::vector<char> forces_passed_;  // and by body that touches
  double velocity_scale_ = 0.0;      // of the component at the start of the phase [m/s]
  double force_scale_ = 0.0;         // [N]
  double gap_noise_ = 0.0;           // rounding of gaps [m]
  std::vector<Break> breaking_;
  std::vector<ContactPair> releasing_;
  double gave_way_at_ = 0.0;                   // time of both [s]
  ContactPair stopped_;                        // has just stopped slipping
  std::vector<ContactPair> unbounded_forces_;  // their forces have outgrown all bounds,
  std::string unbounded_force_;                // as the flow told
  std::vector<ActiveContact> before_;          // closed before the event,
  std::vector<Index> before_at_;               // by pair: which of them, `none` if open
  ActiveSet capture_;
  SolutionList solutions_;

  struct Impact {
    double time;
    ConstraintKey contact;
  };
  static constexpr std::size_t remembered = 16;
  std::vector<Impact> last_impacts_;  // the latest, in time
  RateLimit events_{1000}, steps_{10'000};
};

}  // namespace carom
