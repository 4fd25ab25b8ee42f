// Problem: say which element's loads keep a component from going on.

#include <carom/core/dynamics/coupling_rating.h>
#include <carom/integrators/event_driven/clock_group.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace carom {

/// Fails, naming the element and its bodies, if the loads of one are not finite at the state of the last
/// evaluation.
void ClockGroup::demand_finite_loads() {
  const MotionWorkspace& work = work_->motion;
  const Index component = motion_.component();
  const ElementId cause = find_non_finite(*assembly_, component, work.trial.view(), work.evaluation);
  if (!cause.valid()) return;
  const System& system = assembly_->system();
  std::vector<std::string> parts{system.name(cause)};
  const auto place = system.force_kinds().place(cause.serial);
  std::vector<BodyId> ends;
  system.force_kinds().entries()[place.entry].kind->ends(place.slot, ends);
  if (ends.empty()) ends.push_back(assembly_->layout()->id(assembly_->components()[component].bodies.begin));
  for (const BodyId body : ends) {
    if (body != ground) parts.push_back(system.name(body));
  }
  fail("the loads are not finite", std::move(parts));
}

void ClockGroup::fail_loads() {
  demand_finite_loads();
  fail("the loads are not finite", {});
}

void ClockGroup::fail_flow(const SolverError& error) {
  // The last evaluation of the flow need not be where it failed: a law of time shows itself at the end of the
  // step that was tried, or behind it, up to some thousand roundings of time.
  demand_finite_loads();
  const double end = error.failure().time + error.failure().step;
  const double rounding = std::numeric_limits<double>::epsilon() * std::max(1.0, std::abs(end));
  constexpr double farthest = 4096.0;
  for (double ahead = 0.0; ahead <= farthest; ahead = std::max(1.0, 2.0 * ahead)) {
    (void)motion_.evaluate(end + ahead * rounding, y_.data(), false);
    demand_finite_loads();
  }
  fail(error.what(), error.failure().parts);
}

}  // namespace carom
