#pragma once

/// \file
/// Options of the time-stepping mode (Johansson 1999, section 4).

#include <carom/core/export.h>

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace carom {

/// How the impulse of the couplings over a step follows from the states at its ends. Both are of second
/// order.
enum class ForceRule : std::uint8_t {
  /// h times the mean of the forces at both ends (Johansson 1999, section 4). Keeps linear momentum; energy
  /// where forces are linear in the coordinates, else with a bounded error of order h^2.
  trapezoidal,
  /// Mean forces that change potentials by exactly their work, at mean levers (docs/method.md, section 6).
  /// Keeps energy, linear and angular momentum of springs at round-off. Elements without a mean force of
  /// their own are taken halfway. Rigid bodies turn by 2 atan(h w/2).
  energy_momentum
};

/// How the end of a step, which is given implicitly, is found. All end at the same step.
enum class Iteration : std::uint8_t {
  fixed_point,  ///< sweeps from loads to motion to loads; contract for roughly h^2 k/m and h d/m below a few
  anderson,  ///< the same, each guess combined from the last sweeps: contracts faster, and a little further
  /// Newton's method with the elements' derivatives, frozen while it contracts well: a sparse linear problem
  /// in every sweep. For couplings too stiff for the others. Allocates. Not where there are joints.
  linearly_implicit
};

/// Names: "trapezoidal", "energy_momentum"; "fixed-point", "Anderson", "linearly implicit".
[[nodiscard]] CAROM_API std::string_view to_string(ForceRule rule);
[[nodiscard]] CAROM_API std::string_view to_string(Iteration iteration);  ///< likewise

/// Steps of varying length, by the difference between one step and two halves of it, of which the halves are
/// kept. An impact is no part of it: where one step and the halves meet different contacts, or contacts in
/// different modes, their difference says nothing of the smooth motion; the step is kept as it is and
/// reported (StepReport::control).
struct StepControl {
  double tolerance = 1e-6;  ///< > 0, largest error of positions and of h times velocities in a step [m]
  double smallest = 1e-7;   ///< > 0, where the error would ask for less the step fails [s]
  double largest = 1e-1;    ///< >= smallest, no step is longer [s]
};

/// Coupling forces by the implicit trapezoidal rule through a fixed-point iteration,
/// contacts found at the start of a step, their law in every step of a lasting contact.
struct TimeStepping {
  double step = 1e-3;  ///< h > 0 [s]

  /// The iteration ends when another sweep would change positions, and h times velocities, by less than this
  /// (angles weighed with the radius of gyration). At 0 it goes on until the change stops shrinking [m].
  double tolerance = 1e-12;
  int max_sweeps = 200;  ///< sweeps after which the iteration is given up

  /// A contact that closes faster than this is booked as an impact, otherwise as lasting contact. It decides
  /// about lines of the energy ledger only, never about the motion [m/s].
  double capture_speed = 1e-2;
  /// Refuse, with a SolverError, a step in which contact adds energy (possible where e_n and e_t differ).
  bool refuse_energy_gain = false;

  ForceRule force_rule = ForceRule::trapezoidal;  ///< impulse of the couplings
  Iteration iteration = Iteration::fixed_point;   ///< way to the end of a step
  /// Move bodies out of obstacles at the end of each step, along the smallest displacement in the sense of
  /// their masses: contacts that took part in the step end at gaps >= 0 but for rounding. One that was struck
  /// within the step is noticed at its end and takes part in the next. What a displacement changes of the
  /// potential energy is booked as `projection`. Not for bodies in an island with joints.
  bool project_gaps = false;
  /// Adapt the length of steps, beginning with `step`; fixed if not given.
  std::optional<StepControl> control{};

  /// Threads that share out the work on large islands (at least twice Assembly::block_size bodies). The same
  /// bits come out for any number. More than one need a library built with oneTBB, and laws that may be
  /// called from several threads at once.
  int threads = 1;

  /// An existing directory where the contact problem of a SolverError is written to a file
  /// (docs/contact_problems.md), whose name the message tells. Empty: nothing is written.
  std::string failure_directory{};
};

}  // namespace carom
