#pragma once

/// \file
/// Motion of one body through a step in which shapes on ground hit it (TimeStepping::impacts): it flies to
/// the instant at which a gap closes, is hit there, and flies on. Every flight is a step of the rule by
/// itself, under the part of the loads that falls into it: loads vary linearly between the ends of the step.
/// So the impulse of the loads over the step is the same as without impacts, and momentum is passed on in
/// full.

#include <carom/contact/detection/detector.h>
#include <carom/contact/island_problem.h>
#include <carom/core/export.h>
#include <carom/integrators/time_stepping/step_input.h>
#include <carom/integrators/time_stepping/step_rule.h>
#include <carom/integrators/time_stepping/step_trial.h>

#include <array>
#include <span>
#include <vector>

namespace carom {

/// Loads over a step, arrays over all velocities [N, N m]: linear between its ends, or mean loads, the same
/// all along. Where impacts make loads jump, since these depend on velocities, `jump` is by how much, and
/// `correction` the sum of (1 - 2 t) J over the jumps J at the shares t: half of it belongs to the mean of
/// loads that are linear, a mean load has it already.
struct StepLoads {
  const double* start;                 ///< F0, or the mean loads
  const double* end;                   ///< F1, or these
  const double* jump = nullptr;        ///< J; null: none
  const double* correction = nullptr;  ///< null: none
  bool is_mean = false;                ///< loads are mean loads
  /// The body at hand is hit: its loads jump when it is. Those of any other are spread over the step.
  bool at_impact = false;

  /// One of them at a share of the step. Over the step the mean of a load is the same, however it jumps.
  /// \param hit share at which it jumps, if that is behind: else above 1
  [[nodiscard]] double at(Index i, double share, double hit) const {
    const double even = start[i] + share * (end[i] - start[i]);
    if (jump == nullptr) return even;
    const double mean = is_mean ? end[i] : 0.5 * (start[i] + end[i] + correction[i]);
    if (!at_impact) return is_mean ? mean : even + 0.5 * correction[i];
    // Before the impacts J and half of that of which the mean is too much are still to come.
    const double slope = is_mean ? 0.0 : end[i] - start[i] - jump[i];
    const double before = is_mean ? mean - 0.5 * (jump[i] + correction[i]) : start[i];
    if (!(hit < 1.0)) return before + share * slope;
    const double left = mean - before - 0.5 * slope;  // of the impulse over the step
    return before + share * slope + left / (1.0 - hit);
  }
};

/// The loads that the guess of a trial leads along.
[[nodiscard]] CAROM_API StepLoads step_loads(const StepInput& in, const StepRule& rule,
                                             const StepTrial& trial);

/// Part of a step of one body: a flight, or an impact, which takes no time. Times are shares of the step.
struct MotionPhase {
  double begin = 0.0, end = 0.0;  ///< equal: an impact
  double hit = 2.0;               ///< share of the first impact before it; above 1: none
  /// Work of contacts by the turning of their directions, an error of the step [J].
  double turning_work = 0.0;
  std::array<double, 7> q{};            ///< coordinates at its begin
  std::array<double, 6> v0{}, v1{};     ///< velocities at its begin, at its end
  std::vector<Constraint> constraints;  ///< contacts that take part
  IslandProblem problem;                ///< theirs, if there are any

  /// True of an impact.
  [[nodiscard]] bool is_impact() const { return begin == end; }
};

/// A step that bodies are moved through.
struct LocatedStep {
  const StepInput& in;
  const StepRule& rule;
  const Detector& detector;
  StepLoads loads;
  int most_impacts;      ///< of one body that are fast, >= 1
  double capture_speed;  ///< a contact that closes more slowly does not rebound [m/s]
  bool refuse_jams;      ///< contacts that jam are an error
  StepTrial& trial;
};

/// The motion of one body. Keeps memory.
class CAROM_API LocatedMotion {
public:
  /// Looks at another body, none of whose contacts is shared with others. \param contacts that take part from
  /// the start of the step on \param struck whether one of them is closed by an impact
  void begin(Index body, std::span<const Constraint> contacts, bool struck);
  /// The body.
  [[nodiscard]] Index body() const { return body_; }
  /// Moves it through the step: writes its numbers in `trial.end` and what rounding cuts off. After the last
  /// impact that is allowed, contacts that close act to the end of the step as in any other (Johansson 1999,
  /// section 4). False if a contact problem is not solved: failed().
  bool advance(const LocatedStep& step);
  /// The problem that was not solved; null if none.
  [[nodiscard]] const IslandProblem* failed() const { return failed_; }
  /// Phases of the last advance(), in their order.
  [[nodiscard]] std::span<const MotionPhase> phases() const { return {phases_.data(), used_}; }
  /// Its velocities among all.
  [[nodiscard]] Range velocities(const StepInput& in) const;
  /// Makes its velocities at the end of a phase those of the trial.
  void show_end(const StepInput& in, const MotionPhase& phase, StepTrial& trial) const;
  /// True if an impact is among the phases.
  [[nodiscard]] bool is_hit() const { return hit_ <= 1.0; }
  /// Work of loads over the flights [J].
  [[nodiscard]] double work(const StepInput& in, const StepLoads& loads) const;
  /// Its solvers.
  [[nodiscard]] SolverChain& chain() { return chain_; }

private:
  // The step, and the body in it.
  struct At : LocatedStep {
    BodySlot slot;
    const BodyKind& kind;
  };
  // A contact that closes in a flight.
  struct Closing {
    ConstraintKey key;
    double gap, rate;  // at the end of the flight [m, m/s]
    double share;      // when it closes
    bool fast;         // faster than the capture speed
  };
  [[nodiscard]] bool move(const At& at);
  MotionPhase& add_phase(const At& at, double begin, double end);
  [[nodiscard]] bool fly(const At& at, MotionPhase& flight);
  [[nodiscard]] bool strike(const At& at, double share, bool fast);
  [[nodiscard]] bool fly_once(const At& at, MotionPhase& flight);
  [[nodiscard]] bool solve(const At& at, MotionPhase& phase);
  void turn(const At& at, MotionPhase& flight);
  void book_turning(MotionPhase& flight) const;
  void sweep(const At& at, const MotionPhase& flight, double share) const;
  static void rotate(const At& at);
  void observe(const At& at, double share, double margin, bool to_end);
  void take_closed(std::vector<Constraint>& out) const;
  [[nodiscard]] bool find_closing(const At& at, const MotionPhase& flight);
  void locate(const At& at, const MotionPhase& flight, Closing& closing);

  Index body_ = none;
  bool struck_ = false;
  std::vector<Constraint> start_, found_;
  struct {
    std::vector<Constraint> begin, middle, end;
  } of_flight_;                        // its contacts then
  std::vector<ConstraintKey> closed_;  // contacts that take part in what comes next
  std::vector<Closing> closing_;       // in the flight at hand, the first first
  std::vector<MotionPhase> phases_;
  std::size_t used_ = 0;
  double hit_ = 2.0;  // share of the first impact; above 1: none
  GroundPlaces places_, places_at_end_;
  SolverChain chain_;
  const IslandProblem* failed_ = nullptr;
};

}  // namespace carom
