// Problem: no passage of a guard through zero is missed, and none is made of rounding.

#include <carom/integrators/event_driven/guard_search.h>

#include <carom/core/numerics/fall_search.h>
#include <carom/core/numerics/never.h>

#include <algorithm>
#include <cmath>

namespace carom {

namespace {

QuantityLook quantity_of(const GuardSample& sample, std::size_t guard, double sign) {
  const GuardMotion& at = sample.guards[guard];
  return {sample.time, {sign * at.value, sign * at.first, sign * at.second}, at.sixth};
}

}  // namespace

void GuardSearch::update(const std::vector<GuardMotion>& guards, double noise) {
  for (std::size_t i = 0; i < guards.size(); ++i) {
    if (std::abs(guards[i].value) > noise) sides_[i] = std::copysign(1.0, guards[i].value);
  }
}

bool GuardSearch::passes_at_once(const Passage& passage, const GuardMotion& start, double rounding) const {
  return sides_[passage.guard] == passage.sign && passage.sign * start.value <= rounding &&
         passage.sign * start.first <= 0.0;
}

GuardSearch::Passage GuardSearch::first(const GroupGuards& guards, const GuardSample& start,
                                        const GuardSample& end, GuardSamples& samples, GuardSampler& sampler,
                                        double noise, double until) const {
  // Bisections of a guard without derivatives: its samples are as many as longest_step lets them be.
  constexpr int deepest_of_values = 5;
  Passage passage;
  for (std::size_t i = 0; i < guards.count(); ++i) {
    const auto fall = [&](double sign) {
      FallRule rule;
      rule.derivatives = guards.has_motion(i) ? 2 : 0;
      rule.raise = rule.fine = noise;
      if (!guards.has_motion(i)) rule.deepest = deepest_of_values;
      QuantityOf guard([&](double time) { return quantity_of(samples.at(time, sampler), i, sign); });
      return FallSearch(guard, rule, std::min(until, passage.time))
          .first(quantity_of(start, i, sign), quantity_of(end, i, sign));
    };
    if (sides_[i] != 0.0) {
      const double time = fall(sides_[i]);
      if (time < passage.time) passage = {time, i, sides_[i]};
      continue;
    }
    // From an unknown side: out of the noise on one side, then on the other.
    const double below = fall(1.0), above = fall(-1.0);
    const double later = std::max(below, above);
    if (later < passage.time) passage = {later, i, below < above ? -1.0 : 1.0};
  }
  if (!(passage.time < until)) passage.time = never;
  return passage;
}

}  // namespace carom
