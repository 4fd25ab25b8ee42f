// Problem: which constraints take part in a step, and which components they join.

#include <carom/contact/impact_restitution.h>
#include <carom/integrators/time_stepping/step_constraints.h>

#include <algorithm>
#include <utility>

namespace carom {

StepConstraints::StepConstraints(const Assembly& assembly, const TimeStepping& options)
    : assembly_(&assembly), detector_(assembly), capture_speed_(options.capture_speed) {
  const auto count = static_cast<Index>(assembly.components().size());
  first_.resize(count + 1);
  for (Index component = 0; component < count; ++component) members_.push_back(component);
}

void StepConstraints::place_surfaces(const StepInput& in) {
  if (!detector_.has_moving_ground()) return;
  if (places_after_.time() == in.start.time) std::swap(places_, places_after_);
  detector_.place(in.start.time, places_);
  detector_.place(in.end_time, places_after_);
  detector_.demand_continuous(places_, places_after_);
}

/// A gap was opened by the step before, which this one may be a small part of.
void StepConstraints::remember(const StepInput& in, double last_step) {
  detector_.remember(in.companion.modes, std::max(in.step, last_step), lasting_);
  if (!detector_.has_static_friction()) return;
  sticking_.clear();
  for (const auto& [key, mode] : in.companion.modes) {
    if (mode == ContactMode::stick) sticking_.push_back(key);
  }
  std::sort(sticking_.begin(), sticking_.end());
}

void StepConstraints::find(const StepInput& in, Index component, const StepTrial& trial,
                           std::vector<Constraint>& out) {
  const std::size_t first = out.size();
  detector_.find(component, in.start.view(), trial.at_start, places_, &places_after_, 0.0, out, &lasting_);
  detector_.find_joint_friction(component, in.start.view(), trial.at_start, out);
  if (out.size() == first) return;
  const std::span<Constraint> found(out.data() + first, out.size() - first);
  if (detector_.has_static_friction()) {
    for (Constraint& contact : found) {
      if (!std::binary_search(sticking_.begin(), sticking_.end(), contact.key)) continue;
      contact.friction = contact.law.sticking_friction();
    }
  }
  // Friction in joints comes last.
  if (found.back().has_dry_friction()) share_impact_restitution(found, in.start.v.data(), capture_speed_);
}

void StepConstraints::find(const StepInput& in, const StepTrial& trial) {
  remember(in, trial.history.step);
  constraints_.clear();
  const auto count = static_cast<Index>(members_.size());
  for (Index component = 0; component < count; ++component) {
    first_[component] = static_cast<Index>(constraints_.size());
    find(in, component, trial, constraints_);
  }
  first_[count] = static_cast<Index>(constraints_.size());
  if (std::any_of(constraints_.begin(), constraints_.end(),
                  [this](const Constraint& constraint) { return joins_components(constraint); })) {
    return join_components();
  }
  islands_.clear();
  for (Index component = 0; component < count; ++component) {
    islands_.push_back(
        {{members_.data() + component, 1},
         {constraints_.data() + first_[component], first_[component + 1] - first_[component]}});
  }
}

Index StepConstraints::component_of(Index body) const {
  const auto& all = assembly_->components();
  const auto at = std::upper_bound(
      all.begin(), all.end(), body,
      [](Index wanted, const Component& component) { return wanted < component.bodies.end; });
  return static_cast<Index>(at - all.begin());
}

bool StepConstraints::joins_components(const Constraint& constraint) const {
  for (int b = 1; b < constraint.bodies; ++b) {
    const Index body = constraint.blocks[static_cast<std::size_t>(b)].body;
    if (component_of(body) != component_of(constraint.body())) return true;
  }
  return false;
}

/// Islands of several components; the others stand alone.
void StepConstraints::join_components() {
  const auto count = static_cast<Index>(members_.size());
  partition_.clear(count);
  partition_.arrange_constraints(std::span(constraints_), count,
                                 [this](Index body) { return component_of(body); });
  joined_ = members_;
  std::stable_sort(joined_.begin(), joined_.end(),
                   [this](Index a, Index b) { return partition_.island_of(a) < partition_.island_of(b); });
  islands_.clear();
  std::size_t next = 0;
  for (std::size_t first = 0; first < joined_.size();) {
    const Index island = partition_.island_of(joined_[first]);
    std::size_t last = first + 1;
    while (last < joined_.size() && partition_.island_of(joined_[last]) == island) ++last;
    const std::size_t begin = next;
    const auto within = [&](const Constraint& constraint) {
      return partition_.island_of(component_of(constraint.body())) == island;
    };
    while (next < constraints_.size() && within(constraints_[next])) ++next;
    islands_.push_back({{joined_.data() + first, last - first}, {constraints_.data() + begin, next - begin}});
    first = last;
  }
}

void StepConstraints::restore(const StepInput& in, const StepIsland& island, const StepTrial& trial) {
  again_.clear();
  for (const Index component : island.components) find(in, component, trial, again_);
  if (island.components.size() > 1) {
    std::stable_sort(again_.begin(), again_.end(),
                     [](const Constraint& a, const Constraint& b) { return a.key < b.key; });
    std::stable_sort(island.constraints.begin(), island.constraints.end(),
                     [](const Constraint& a, const Constraint& b) { return a.key < b.key; });
  }
  std::copy(again_.begin(), again_.end(), island.constraints.begin());
}

}  // namespace carom
