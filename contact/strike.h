#pragma once

/// \file
/// One impact, in both modes: which law, which contacts, how much restitution, how much energy. What follows
/// it (slow contacts that close, new neighbours, loads anew) is a loop of whoever strikes.

#include <carom/contact/impulse_map.h>
#include <carom/contact/island_problem.h>
#include <carom/contact/solvers/impact_rules.h>
#include <carom/contact/solvers/impact_solver.h>
#include <carom/core/constraint.h>
#include <carom/core/export.h>
#include <carom/core/function_ref.h>
#include <carom/core/surface.h>

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace carom {

/// Law of the contacts of an impact, Newton's where all are limits of joints or friction in them, which take
/// the law of the contacts. Nothing where contacts differ.
[[nodiscard]] CAROM_API std::optional<ImpactLaw> law_of_impact(std::span<const Constraint> constraints);

/// Leaves of the constraints of an impact the one that approaches fastest, those as fast up to 1e-9 of its
/// speed, and friction in joints. \param velocities of all bodies
CAROM_API void keep_fastest(std::vector<Constraint>& constraints, const double* velocities);

/// Work of the answer of an impact, and its scale. \param problem with free velocities, which are those
/// before
[[nodiscard]] CAROM_API ImpulseWork work_of_impact(const IslandProblem& problem);

/// Scales the restitution of all constraints of an impact that gains energy by the largest factor, to 1/64 at
/// least, that does not. Returns the factor; 1, and nothing done, where there is no gain.
/// \param solve states and solves the impact of the constraints as they are; false where it is not solved,
/// which ends the search
[[nodiscard]] CAROM_API double limit_gain(const IslandProblem& problem, std::span<Constraint> constraints,
                                          FunctionRef<bool()> solve);

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

/// What became of an impact.
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

/// Error text for Struck::Outcome::laws_differ.
inline constexpr const char* laws_of_impact_differ =
    "contacts of one impact have different laws of impact; allowed: one law for all that touch at an "
    "instant, "
    "or impact_rules.order sequential";

/// Strikes impacts. Keeps memory only.
class CAROM_API Strike {
public:
  /// \param by_newton options of problems by Newton's law; problems of other laws need W in full
  explicit Strike(const IslandOptions& by_newton)
      : by_newton_(by_newton), by_other_law_({.plastic_jams = by_newton.plastic_jams}) {}

  /// Solves one impact of constraints that touch each other. Velocities are left alone. \param touching with
  /// their restitution; it is left with those that took part, as they did \param solve states and solves a
  /// problem of `touching` as it is then; false where it is not solved
  [[nodiscard]] Struck strike(std::vector<Constraint>& touching, const StrikeInput& in,
                              FunctionRef<bool(IslandProblem&)> solve);
  /// The problem by Newton's law.
  [[nodiscard]] IslandProblem& by_newton() { return by_newton_; }

private:
  IslandProblem by_newton_, by_other_law_;
  ImpactSolver solver_;
};

}  // namespace carom
