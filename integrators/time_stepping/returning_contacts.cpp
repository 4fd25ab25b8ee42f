// Problem: a contact must not hold what stiff couplings throw off and draw back within one step.

#include <carom/integrators/time_stepping/returning_contacts.h>

#include <algorithm>
#include <array>

namespace carom {

namespace {

constexpr double noise = 1e-12;  // of the velocities and their changes that a velocity is the sum of

/// Velocity along the normal at the start of a step; 0 where it is rounding, or none.
double opening(const Constraint& at, const StepInput& in) {
  const double* const v = in.start.v.data();
  const double velocity = at.normal_velocity(v);
  return velocity > noise * at.speed(0, v) ? velocity : 0.0;
}

/// Changes of the velocity along a normal, each body by itself [m/s].
struct ChangeByLoads {
  double total = 0.0;   ///< by the loads of the step
  double within = 0.0;  ///< by what they change within it
};

ChangeByLoads change_by_loads(const Constraint& at, const StepInput& in, const StepRule& rule,
                              const StepTrial& trial) {
  const double *const first = rule.start_of_sum(in, trial), *const last = trial.loads_guess.data();
  const double* const before = in.companion.loads.total.data();
  std::array<double, 6> total{}, within{};  // of one body, in the plane or in space
  ChangeByLoads sum;
  const double* row = at.row(0);
  for (std::size_t b = 0; b < static_cast<std::size_t>(at.bodies); ++b) {
    const Constraint::Block& block = at.blocks[b];
    const auto columns = static_cast<Index>(block.columns);
    for (Index k = 0; k < columns; ++k) {
      const Index v = block.v + k;
      total[k] = 0.5 * in.step * (first[v] + last[v]);
      within[k] = rule.impulse_weight(in.step) * (last[v] - before[v]);
    }
    const BodySlot body = in.assembly.layout()->bodies()[block.body];
    const BodyKind& kind = *in.assembly.body_kinds()[body.kind];
    kind.apply_inverse_mass({body.slot, body.slot + 1}, total.data(), total.data());
    kind.apply_inverse_mass({body.slot, body.slot + 1}, within.data(), within.data());
    for (Index k = 0; k < columns; ++k, ++row) {
      sum.total += *row * total[k];
      sum.within += *row * within[k];
    }
  }
  return sum;
}

/// True if the loads stop and turn round what opens, beyond what the law lets come back: strained or stiff.
bool returns(const Constraint& at, const StepInput& in, const StepRule& rule, double lasting_speed,
             const StepTrial& trial) {
  const double speed = opening(at, in);
  if (!((1.0 - at.law.normal_restitution) * speed > at.allowed_approach)) return false;
  const ChangeByLoads change = change_by_loads(at, in, rule, trial);
  // A contact that rests opens by the rounding of the change that its impulse took back.
  if (!(speed > -noise * change.total)) return false;
  if (!(change.total < -(1.0 + at.law.normal_restitution) * speed)) return false;
  return speed > lasting_speed || change.within < -speed;
}

}  // namespace

bool any_returns(const StepInput& in, std::span<const IslandProblem> problems, const StepRule& rule,
                 double lasting_speed, const StepTrial& trial) {
  return std::any_of(problems.begin(), problems.end(), [&](const IslandProblem& problem) {
    const std::span<const Constraint> constraints = problem.constraints();
    for (std::size_t c = 0; c < constraints.size(); ++c) {
      if (!(problem.map().impulse(c, 0) > 0.0)) continue;
      if (returns(constraints[c], in, rule, lasting_speed, trial)) return true;
    }
    return false;
  });
}

void allow_return(const StepInput& in, std::span<Constraint> constraints) {
  for (Constraint& at : constraints) {
    const double left = (1.0 - at.law.normal_restitution) * opening(at, in);
    at.allowed_approach = std::max(at.allowed_approach, left);
  }
}

}  // namespace carom
