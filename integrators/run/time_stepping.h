#pragma once

/// \file
/// Options of the time-stepping mode (Johansson 1999, section 4).

#include <carom/contact/solvers/impact_rules.h>
#include <carom/contact/solvers/sweep_budget.h>
#include <carom/core/export.h>
#include <carom/integrators/run/overlap_rules.h>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace carom {

/// How the impulse of the force elements over a step is computed from the states at its ends. Both rules are
/// of second order.
enum class ForceRule : std::uint8_t {
  /// h times the mean of the forces at both ends (Johansson 1999, section 4). Conserves linear momentum;
  /// energy too where forces are linear in the coordinates, else with a bounded error of order h^2.
  trapezoidal,
  /// Mean forces whose work is exactly the change of the potentials, at mean levers (docs/method.md,
  /// section 6). Conserves energy, linear and angular momentum of springs to round-off, and of mechanisms
  /// while nothing touches or rubs: reactions of joints do no work then, positions obey the joints, and
  /// velocities do so to order h^2 (Gonzalez 1999; Betsch and Steinmann 2002). Elements without a mean force
  /// are evaluated at the middle of the step. Rigid bodies turn by 2 atan(h w/2).
  energy_momentum
};

/// When within a step bodies are hit by shapes on ground.
enum class ImpactTimes : std::uint8_t {
  /// At the start of the next step: a gap that closes within a step is violated at its end (Johansson 1999,
  /// section 4). Of first order across impacts.
  at_step_start,
  /// When the gap closes: a body flies there, is hit, and flies on, what it is coupled to follows within the
  /// same implicit step; where bodies touch each other or joints bind them, the step ends there, and another
  /// one begins with the impact. Of second order across isolated impacts (docs/two_modes.md).
  located
};

/// How the implicit equations of a step are solved. All iterations converge to the same step.
enum class Iteration : std::uint8_t {
  fixed_point,  ///< sweeps from loads to motion to loads; contract for roughly h^2 k/m and h d/m below a few
  anderson,     ///< sweeps with Anderson acceleration: contract faster, and for slightly stiffer elements
  /// Newton's method with the derivatives of the elements, kept while it contracts well: a sparse linear
  /// problem in every sweep, with the rows of the joints. For elements that are too stiff for the others.
  /// Allocates.
  linearly_implicit,
  /// The fixed-point iteration; within a step, for a component in which it fails, Anderson's, then the
  /// linearly implicit one; for several components that contact joins, the latter at once. After three such
  /// steps in a row the steps of a component begin with the one that solved the last, and every 32 steps with
  /// the fixed-point iteration again. StepReport::iteration is the one that solved a step.
  automatic
};

/// Number of iterations that can end a step: all but `automatic`, which stands behind them.
inline constexpr std::size_t iteration_count = 3;

/// Names: "at_step_start", "located".
[[nodiscard]] CAROM_API std::string_view to_string(ImpactTimes times);
/// Names: "trapezoidal", "energy_momentum".
[[nodiscard]] CAROM_API std::string_view to_string(ForceRule rule);
/// Names: "fixed-point", "Anderson", "linearly implicit", "automatic".
[[nodiscard]] CAROM_API std::string_view to_string(Iteration iteration);

/// Steps of varying length. Each step is computed once as a whole and once as two halves; the halves are
/// kept, and the difference gives the error. Where sliding ends, turns round or begins within a half, the
/// sliding speed that friction takes or gives too early bounds it too (docs/method.md, section 6). Impacts
/// are excepted: where the whole step and the halves have different contacts the halves are kept, and
/// StepReport::control says so; with the same impacts in both if they differ by no more than the tolerance.
/// So are those in which sliding changes, or something is hit, in a step that is the smallest. Impacts
/// at_step_start are up to a step late, of which no error tells.
struct StepControl {
  double tolerance = 1e-6;  ///< > 0, largest error of positions and of h times velocities in a step [m]
  double smallest = 1e-7;   ///< > 0, where the error would ask for less the step fails [s]
  double largest = 1e-1;    ///< >= smallest, no step is longer [s]
};

/// Forces of elements by the implicit trapezoidal rule with a fixed-point iteration, contacts detected at the
/// start of a step, the contact law in every step of a lasting contact (kept where turning opens it:
/// docs/method.md). docs/two_modes.md has a table of
/// these options.
struct TimeStepping {
  double step = 1e-3;  ///< h > 0 [s]

  /// The iteration ends when another sweep would change positions, and h times velocities, by less than this
  /// (angles times the radius of gyration). At 0 it goes on until the change no longer decreases. Gaps up to
  /// this count as closed (1e-12 at 0): scale it with the unit of length, or with bodies much smaller than
  /// 1 mm [m].
  double tolerance = 1e-12;
  int max_sweeps = 200;  ///< sweeps after which an iteration is given up, >= 2

  /// A contact that closes faster than this is booked as an impact, otherwise as lasting contact. It decides
  /// on terms of the energy ledger, and whether friction in joints that depends on their force takes the
  /// restitution of the contact; and where impacts are located, which end: a contact that closes more slowly
  /// does not rebound (e = 0), if loads bring it back within 1,000 steps; where they are not, how far
  /// contacts that pushed in the step before may be open and last: this times the step. On nothing else of
  /// the motion [m/s]. Of a limit of an angle: its rate times the arm k_a k_b/sqrt(k_a^2 + k_b^2), radii of
  /// gyration, up to a power of two.
  double capture_speed = 1e-2;
  ImpactRules impact_rules{};  ///< impacts of several contacts, and those that would add energy

  ImpactTimes impacts = ImpactTimes::at_step_start;  ///< when within a step bodies are hit
  /// Of impacts that are located: the most of one body in one step, >= 1, and as many slow ones. After them
  /// contacts that close do not rebound (ImpactNote::cut_sequence), and after as many of these act to the end
  /// of the step; so the step ends although bounces may accumulate in it. ContactCounts::cut_sequences counts
  /// what is cut.
  int most_impacts = 10;

  ForceRule force_rule = ForceRule::trapezoidal;  ///< impulse of the force elements
  /// Solution of the implicit equations of a step. One that is named is used alone: where it fails, so does
  /// the step.
  Iteration iteration = Iteration::automatic;
  /// Move bodies out of shapes on ground, and apart, at the end of each step, by the smallest displacement in
  /// the mass norm: contacts that took part in the step end with gaps >= 0 up to rounding. A contact that
  /// closes within the step is detected at its end and takes part in the next. Bodies with joints move along
  /// their joints. The change of the potential energy is booked as `projection`.
  bool project_gaps = false;
  OverlapRules overlaps{};  ///< bodies that stand in something at the start, or are fast enough to pass it
  /// Adapt the length of steps, beginning with `step`; fixed if not given.
  std::optional<StepControl> control{};

  /// Number of threads that share the work on large components (at least twice BlockTable::block_size
  /// bodies),
  /// >= 1. The result is the same bit for bit for any number. More than one need a library built with oneTBB,
  /// and laws that may be called from several threads at once.
  int threads = 1;

  /// An existing directory where the contact problem of a SolverError is written to a file, whose name is in
  /// the message (docs/contact_problems.md); and of answers that are accepted at the cap of their sweeps the
  /// problem, if none before had a larger residual (StepReport::capped_problem). Empty: nothing is written.
  std::string failure_directory{};

  /// Of contact problems of many constraints (from factored_constraints on, contact/island_problem.h), which
  /// sweeps solve: how exact, and at which cost. Where the sweeps end above `residual` but below `accepted`
  /// the step goes on, and its contacts have the outcome accepted_at_cap; `accepted` = 0 makes that an error.
  SweepBudget contact_budget{};
};

}  // namespace carom
