#pragma once

/// \file
/// One impact, in both modes and in a flight: which contacts, which law, how much restitution, how much
/// energy. What follows it (slow contacts that close, new neighbours, loads anew) is a loop of whoever
/// strikes.

#include <carom/contact/impulse_map.h>
#include <carom/contact/island_problem.h>
#include <carom/contact/solvers/impact_rules.h>
#include <carom/contact/solvers/impact_solver.h>
#include <carom/core/constraint_set.h>
#include <carom/core/export.h>
#include <carom/core/function_ref.h>
#include <carom/core/surface.h>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace carom {

/// Law of the contacts of an impact, Newton's where all are limits of joints or friction in them, which take
/// the law of the contacts. Nothing where contacts differ.
[[nodiscard]] CAROM_API std::optional<ImpactLaw> law_of_impact(std::span<const Constraint> constraints);

/// Leaves of the constraints of an impact the one that approaches fastest, those as fast up to 1e-9 of its
/// speed, and friction in joints. \param velocities of all bodies
CAROM_API void keep_fastest(ConstraintSet& constraints, const double* velocities);

/// Work of the answer of an impact, and its scale. \param problem with free velocities, which are those
/// before
[[nodiscard]] CAROM_API ImpulseWork work_of_impact(const IslandProblem& problem);

/// Scales the restitution of all constraints of an impact that gains energy by the largest factor, to 1/64 at
/// least, that does not. Returns the factor; 1, and nothing done, where there is no gain.
/// \param solve states and solves the impact of the constraints as they are; false where it is not solved,
/// which ends the search
[[nodiscard]] CAROM_API double limit_gain(const IslandProblem& problem, std::span<Constraint> constraints,
                                          FunctionRef<bool()> solve);

/// The part of the rules of an impact that depends on the mode; options say the rest (ImpactRules).
struct ImpactsOfMode {
  /// Friction in joints takes part where its bound follows joint forces, which are impulsive then; friction
  /// of a constant bound has no impulse. False: no friction in joints takes part.
  bool with_joint_friction = false;
  /// Contacts that approach no faster than the capture speed are closed, without restitution. False: it is no
  /// impact, and left to the step that follows.
  bool closes_slow = false;
};

/// Impacts of time stepping. Its step holds slow contacts, and friction in joints, by impulses of its own.
inline constexpr ImpactsOfMode impacts_of_steps{};
/// Impacts of the event-driven mode. What is not stopped at an event would be the next event.
inline constexpr ImpactsOfMode impacts_of_events{.with_joint_friction = true, .closes_slow = true};

/// True of a constraint that has impulses in impacts of a mode. \param follows_joint_force whether it is
/// friction in a joint whose bound follows joint forces
[[nodiscard]] CAROM_API bool takes_part(const Constraint& constraint, const ImpactsOfMode& of_mode,
                                        bool follows_joint_force);

/// The kind of impact that an approach begins.
enum class ImpactOnset : std::uint8_t {
  nothing,  ///< it is rounding, or left to the step
  impact,   ///< with restitution
  closing   ///< without: it is slow
};

/// The kind of impact that contacts begin which touch each other. \param fastest approach of them [m/s]
/// \param noise speeds up to this are rounding [m/s] \param capture_speed what is no faster does not rebound
/// [m/s] \param struck impacts of their sequence before: one that has begun goes on, however slow
[[nodiscard]] CAROM_API ImpactOnset onset_of(double fastest, double noise, double capture_speed, int struck,
                                             const ImpactsOfMode& of_mode);

/// An impact to be struck.
struct StrikeInput {
  const ImpactRules& rules;
  const double* velocity = nullptr;  ///< before it, of all bodies [m/s, rad/s]
  double speed_noise = 0.0;          ///< sliding up to this is rounding: static friction acts [m/s]
  int struck = 0;                    ///< impacts of the sequence before it
  /// All contacts together, by Newton's law without restitution, whatever the rules: an impact that is slow,
  /// or that ends a sequence.
  bool plastic = false;
};

/// An impact as whoever strikes states and solves it.
struct StrikeAnswer {
  IslandProblem& problem;  ///< with its answer
  bool is_solved = false;
};

/// The outcome of an impact.
struct Struck {
  enum class Outcome : std::uint8_t {
    solved,
    laws_differ,  ///< contacts of one impact have different laws
    not_solved    ///< the problem says why
  };
  IslandProblem* problem = nullptr;  ///< with its answer; null where laws differ
  Outcome outcome = Outcome::solved;
  bool cut_sequence = false;  ///< it ended the sequence, without restitution
  /// Factor of all e: less than 1 by EnergyGain::limit, 0 of contacts that jam.
  double restitution_factor = 1.0;
};

/// Solves one impact of constraints that touch each other. Velocities are left alone.
/// \param touching with their restitution; it is left with those that took part, as they did
/// \param solve states and solves the impact of `touching` as it is then, by the law that it is given
[[nodiscard]] CAROM_API Struck strike(ConstraintSet& touching, const StrikeInput& in,
                                      FunctionRef<StrikeAnswer(ImpactLaw)> solve);

/// Problems of impacts, one by Newton's law and one by others. Keeps memory only.
class ImpactProblems {
public:
  /// \param by_newton options of problems by Newton's law; problems of other laws need W in full
  explicit ImpactProblems(const IslandOptions& by_newton)
      : by_newton_(by_newton), by_other_law_({.plastic_jams = by_newton.plastic_jams}) {}
  /// The problem by a law. Valid until the next one by another law that is not Newton's.
  [[nodiscard]] IslandProblem& by(ImpactLaw law) {
    if (law == ImpactLaw::newton) return by_newton_;
    by_other_law_.use(&solver_, law);
    return by_other_law_;
  }

private:
  IslandProblem by_newton_, by_other_law_;
  ImpactSolver solver_;
};

/// Impacts at one instant: each takes energy out or hands it on, so that more than this do not happen but by
/// e = 1 in a corner.
inline constexpr int most_impacts_at_once = 10000;

/// Error text for Struck::Outcome::laws_differ.
inline constexpr const char* laws_of_impact_differ =
    "contacts of one impact have different laws of impact; allowed: one law for all that touch at an "
    "instant, "
    "or impact_rules.order sequential";

/// Error text for more than most_impacts_at_once.
[[nodiscard]] CAROM_API std::string impacts_without_end();

/// End of the error text of an impact that is not solved: an option that would solve contacts that jam, or
/// nothing.
[[nodiscard]] CAROM_API std::string hint_at_jams(const ImpactRules& rules, std::size_t constraints);

/// Error text for an impact that adds energy where that is refused. \param who the contact or contacts, as
/// "contact of a and b" \param gain [J]
[[nodiscard]] CAROM_API std::string gain_is_refused(const std::string& who, double gain);

}  // namespace carom
