#pragma once

/// \file
/// The contact problem of one island: the constraints that share bodies, directly or through what binds or
/// couples these, and the velocities before and without impulses, as
///     W = H B H^T,   b = H v_free + E H v^-,   v^+ = v_free + B H^T P,
/// B the response of the bodies (contact/delassus.h); to b in normal direction Constraint::allowed_approach
/// is added.

#include <carom/contact/delassus.h>
#include <carom/contact/impulse_map.h>
#include <carom/contact/island_response.h>
#include <carom/contact/plastic_jams.h>
#include <carom/contact/solvers/contact_problem.h>
#include <carom/contact/solvers/impact_solver.h>
#include <carom/contact/solvers/newton_polish.h>
#include <carom/contact/solvers/solver_chain.h>
#include <carom/contact/tangent_direction.h>
#include <carom/core/constraint.h>
#include <carom/core/export.h>
#include <carom/core/function_ref.h>

#include <cstddef>
#include <limits>
#include <span>
#include <vector>

namespace carom {

/// Constraints from which on an island that may do so leaves W in factors. The exact solvers are slower from
/// about five contacts on; up to here they are worth their answers of rounding. Those of 20 contacts take a
/// millisecond, and are asked where sweeps do not end (large_problem_solver.h).
inline constexpr std::size_t factored_constraints = 12;

/// Ways of solving an island other than its law to rounding; none of them unless asked for.
struct IslandOptions {
  /// Constraints from which on W stays in factors, and sweeps solve it (nonlinear_cg_solver.h), where these
  /// belong to several bodies of the plane that answer for themselves. Answers are only as exact then as the
  /// budget of the sweeps says.
  std::size_t factored_from = std::numeric_limits<std::size_t>::max();
  /// Constraints up to which it does so: few enough that the exact solvers go on where sweeps do not end, if
  /// answers have to be exact.
  std::size_t factored_to = std::numeric_limits<std::size_t>::max();
  /// Contacts that jam, and have no answer or one that adds energy by impulses without measure, are solved
  /// with e = 0 (plastic_jams.h).
  bool plastic_jams = false;
  /// Impulses that are not unique are to be basic ones (ContactSolution::basic): modes are read off them.
  bool basic_impulses = false;
};

/// Where the solvers of an island start from.
struct IslandStart {
  /// Writes impulses by row of some constraints, one behind the other; asked for all of several constraints.
  /// Nothing: they start from zero.
  FunctionRef<void(std::span<const Constraint> constraints, double* impulses)> impulses{};
  /// They start from the answer to the last problem instead, in its modes: if its constraints stood where
  /// these do, are several, and have as many rows.
  bool from_answer = false;
  /// Factors that solve the problem are kept for the next one that starts from its answer: some n^2 numbers
  /// for n rows.
  bool keeps_equations = false;
};

/// An answer, and what solved it.
struct IslandAnswer : ContactSolution {
  ModeEquations equations;       ///< of its modes; none if none were kept
  bool keeps_equations = false;  ///< whether they are kept
};

/// Problem, matrix and answer of an island. Reuse it: its memory is kept.
class CAROM_API IslandProblem {
public:
  explicit IslandProblem(const IslandOptions& options = {}) : options_(options) {
    answer_.basic = options.basic_impulses;
  }
  /// Takes constraints, and the velocities v^- of all bodies before the step or impact. The answer before is
  /// forgotten, unless solvers are to start from it; respond() is next, unless a response is given. build()
  /// and respond() throw SolverError for more constraints than W in full has room for. \param response makes
  /// W at once: of a large island for some constraints at a time, while these are in a near cache, which does
  /// not hold all \param start of the solvers
  void build(std::span<const Constraint> constraints, const double* velocity_before,
             BodyResponse* response = nullptr, const IslandStart& start = {});
  /// Makes W. Of a response that is only nearly symmetric W takes one half; that is good enough for
  /// set_velocity().
  void respond(BodyResponse& response);
  /// Takes note of another OfJoint::friction_bound of a constraint; of one without a given bound: nothing.
  void update_bound(std::size_t constraint);
  /// Makes a contact, friction in a joint, or rolling resistance slip whatever its tangential velocity:
  /// P_t = -mu slip P_n along each tangential row, with the normal impulse, or given bound, that bounds P_t.
  /// A limit stays as it is. \param slip direction, not zero
  void slide(std::size_t constraint, const TangentDirection& slip);
  /// Solves by a law of impact other than Newton's from now on: b is that of an impact. Null: by Newton's.
  void use(ImpactSolver* solver, ImpactLaw law) { impact_ = {solver, law}; }
  /// Makes b from the velocities that the step would end with if no constraint acted, against those of the
  /// surfaces then (Constraint::velocity_after).
  void set_free_velocity(const double* velocity_free);
  /// Makes b from the velocities that the step ends with under the present impulses, against those of the
  /// surfaces then (Constraint::velocity_after). If these impulses are an answer, they remain one.
  void set_velocity(const double* velocity);
  /// Solves; the answer before, if there is one since build(), is where solvers start from. Where no solver
  /// has an answer, or one of impulses without measure, and plastic jams are allowed, all e are 0 from here
  /// to the next build().
  [[nodiscard]] const ContactReport& solve(SolverChain& chain);
  /// Replaces the answer, and its modes, by another solution of the problem.
  void set_impulses(std::span<const double> impulses);
  /// Sets all impulses to zero.
  void forget_impulses();

  /// The problem.
  [[nodiscard]] const ContactProblem& problem() const { return problem_; }
  /// The constraints, in the order of build().
  [[nodiscard]] std::span<const Constraint> constraints() const { return constraints_; }
  /// Rows of the constraints, in the order of build().
  [[nodiscard]] std::span<const ImpulseDirection> directions() const { return directions_; }
  /// Velocities gamma^- of all rows [m/s].
  [[nodiscard]] std::span<const double> before() const { return before_; }
  /// Impulses of all rows [N s].
  [[nodiscard]] std::span<const double> impulses() const { return answer_.impulse; }
  /// Modes of the constraints.
  [[nodiscard]] std::span<const ContactMode> modes() const {
    return modes_.empty() ? answer_.modes : std::span<const ContactMode>(modes_);
  }
  /// True if the last answer has other modes than the one before it since build().
  [[nodiscard]] bool changed_modes() const { return answer_.changed_modes; }
  /// Factor of all e in the last answer: 1, or 0 of a plastic jam.
  [[nodiscard]] double restitution_factor() const { return jam_.found() ? 0.0 : 1.0; }
  /// Report of the last answer.
  [[nodiscard]] const ContactReport& report() const { return answer_.report; }
  /// Place of row 0 of a constraint, the others behind it.
  [[nodiscard]] int first_row(std::size_t constraint) const { return first_row_[constraint]; }
  /// Adds to velocities what the impulses of the last answer change, as map() does; faster where W is left in
  /// factors. \param velocity of all bodies
  void add_velocities(double* velocity);
  /// The way back of the last answer. Valid until the problem changes.
  [[nodiscard]] ImpulseMap map() const {
    return {constraints_, first_row_, response_, before_, answer_.impulse};
  }

private:
  void build_any(const double* velocity_before, BodyResponse* response, const IslandStart& start);
  void write_rows(Range constraints, const double* velocity_before);

  // Solver of impacts by another law.
  struct ImpactChoice {
    ImpactSolver* solver = nullptr;
    ImpactLaw law = ImpactLaw::newton;
  };
  // Scratch of a problem in factors.
  struct FactorScratch {
    std::vector<RowSet> sets;           // while W is made in full
    std::vector<double> slot_velocity;  // of bodies
    std::vector<double> given;          // part of b without velocities of bodies at the end
  };

  IslandOptions options_;
  PlasticJam jam_;
  std::span<const Constraint> constraints_;
  std::vector<ImpulseDirection> directions_;
  IslandResponse response_;
  ContactProblem problem_;
  IslandAnswer answer_;
  ImpactChoice impact_;
  std::vector<ContactMode> modes_;  // by constraint; empty where none is attached to another
  std::vector<int> first_row_;
  FactorScratch scratch_;
  std::vector<double> slides_;  // by constraint: where the bound is given -mu slip of slide(), or 0
  std::vector<double> before_, restitution_, xi_;
};

}  // namespace carom
