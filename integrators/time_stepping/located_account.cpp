// Problem: what the flights and impacts of a body that is hit within a step make of the account, and of loads
// that depend on velocities.

#include <carom/integrators/time_stepping/located_account.h>

#include <algorithm>

namespace carom {

StepLoads step_loads(const StepInput& in, const StepRule& rule, const StepTrial& trial) {
  const double* const end = trial.loads_guess.data();
  const double* const start = rule.is_mean() ? end : in.companion.loads.total.data();
  if (!trial.jumps.on) return {.start = start, .end = end, .is_mean = rule.is_mean()};
  return {.start = start,
          .end = end,
          .jump = trial.jumps.jump.data(),
          .correction = trial.jumps.correction.data(),
          .is_mean = rule.is_mean()};
}

Range LocatedMotion::velocities(const StepInput& in) const {
  const BodySlot slot = in.assembly.layout()->bodies()[body_];
  return {slot.v, slot.v + slot.v_size};
}

void LocatedMotion::show_end(const StepInput& in, const MotionPhase& phase, StepTrial& trial) const {
  const Range v = velocities(in);
  std::copy_n(phase.v1.begin(), v.size(), trial.end.v.begin() + v.begin);
}

double LocatedMotion::work(const StepInput& in, const StepLoads& of) const {
  StepLoads loads = of;
  loads.at_impact = is_hit();
  const Range v = velocities(in);
  double sum = 0.0;
  for (const MotionPhase& phase : phases()) {
    for (Index i = 0; i < v.size(); ++i) {
      const double load =
          loads.at(v.begin + i, phase.begin, phase.hit) + loads.at(v.begin + i, phase.end, phase.hit);
      sum += 0.25 * (phase.end - phase.begin) * in.step * load * (phase.v0[i] + phase.v1[i]);
    }
  }
  return sum;
}

void locate_under_constant_loads(Range components, const StepIsland& island, const StepInput& in,
                                 StepParts& parts) {
  LocatedImpacts& located = parts.located;
  StepTrial& trial = parts.trial;
  const GroundPlaces& places = parts.constraints.places_at_end();
  if (!located.take_up(in, components, island.constraints, places, trial)) return;
  const double* const total = in.companion.loads.total.data();
  const Range bodies = in.assembly.bodies_of(components);
  StoredEnergies before, after;
  for (LocatedMotion& motion : located.motions()) {
    const Range body{motion.body(), motion.body() + 1};
    if (body.begin < bodies.begin || body.begin >= bodies.end) continue;
    BlockWorks &works = trial.account.works.front(), then, now;
    parts.rule.works_constant(in, body, motion.velocities(in), trial, then);
    add_field_potentials(in.assembly, body, trial.end.view(), trial.at_end, before);
    located.advance(in, parts.rule, {total, total}, body, trial);
    if (motion.failed() != nullptr) {
      parts.errors(in, in.assembly.component_of(body.begin)).fail_contact(*motion.failed());
    }
    parts.rule.works_constant(in, body, motion.velocities(in), trial, now);
    add_field_potentials(in.assembly, body, trial.end.view(), trial.at_end, after);
    works.kinetic += now.kinetic - then.kinetic;
    works.total += motion.work(in, {total, total}) - then.total;
  }
  for (std::size_t i = 0; i < stored_energy_count; ++i) {
    trial.account.potentials.values[i] += after.values[i] - before.values[i];
  }
}

}  // namespace carom
