// Problem: which constraints take part in a step, and which components they join.

#include <carom/contact/impact_restitution.h>
#include <carom/contact/rolling_resistance.h>
#include <carom/integrators/time_stepping/step_constraints.h>

#include <algorithm>
#include <utility>

namespace carom {

namespace {

/// A body that was hit where a gap closed stands on the ground to rounding: on either side of it [m].
constexpr double rounding = 1e-12;

}  // namespace

StepConstraints::StepConstraints(const Assembly& assembly, const TimeStepping& options)
    : detector_(assembly),
      capture_speed_(options.capture_speed),
      slack_(options.impacts == ImpactTimes::located ? rounding : 0.0),
      islands_(assembly) {}

void StepConstraints::place_surfaces(const StepInput& in) {
  if (!detector_.has_moving_ground()) return;
  if (places_after_.time() == in.start.time) std::swap(places_, places_after_);
  detector_.place(in.start.time, places_);
  detector_.place(in.end_time, places_after_);
  detector_.demand_continuous(places_, places_after_);
}

/// A gap was opened by the step before, which this one may be a small part of.
void StepConstraints::remember(const StepInput& in, double last_step) {
  detector_.remember(in.companion.modes, std::max(in.step, last_step), slack_, lasting_);
  if (!detector_.has_static_friction()) return;
  sticking_.clear();
  for (const auto& [key, mode] : in.companion.modes) {
    if (mode == ContactMode::stick) sticking_.push_back(key);
  }
  std::sort(sticking_.begin(), sticking_.end());
}

ContactQuery StepConstraints::query(const StepInput& in, const StepTrial& trial) const {
  const LastingContacts* const lasting = lasting_.empty() ? nullptr : &lasting_;
  return {in.start.view(), trial.at_start, places_, &places_after_, 0.0, lasting};
}

/// Contacts that stuck in the last step have their static friction.
void StepConstraints::take_sticking(std::span<Constraint> found) const {
  if (!detector_.has_static_friction()) return;
  for (Constraint& contact : found) {
    if (!std::binary_search(sticking_.begin(), sticking_.end(), contact.key)) continue;
    contact.friction = contact.law.sticking_friction();
  }
}

void StepConstraints::find_in(const StepInput& in, Range components, const StepTrial& trial,
                              std::vector<Constraint>& out) {
  const std::size_t first = out.size();
  const StateView start = in.start.view();
  detector_.find(components, query(in, trial), out);
  // Components with joints come alone.
  if (detector_.has_dry_friction() && components.size() == 1) {
    detector_.find_joint_friction(components.begin, start, trial.at_start, out);
  }
  if (out.size() == first) return;
  const std::span<Constraint> found(out.data() + first, out.size() - first);
  take_sticking(found);
  // Friction in joints comes last.
  if (found.back().has_dry_friction()) share_impact_restitution(found, in.start.v.data(), capture_speed_);
  if (resists_rolling(detector_)) add_rolling(first, out);
}

/// Rolling resistance behind each contact that has some, of the constraints from `first` on.
void StepConstraints::add_rolling(std::size_t first, std::vector<Constraint>& out) {
  with_rolling_.assign(out.begin(), out.begin() + static_cast<std::ptrdiff_t>(first));
  for (std::size_t i = first; i < out.size(); ++i) {
    with_rolling_.push_back(out[i]);
    if (out[i].type == ConstraintType::contact && out[i].law.resists_rolling()) {
      with_rolling_.push_back(rolling_resistance(out[i]));
    }
  }
  out.swap(with_rolling_);
}

void StepConstraints::find(const StepInput& in, std::span<const Range> batches, const StepTrial& trial) {
  remember(in, in.last_step);
  constraints_.clear();
  for (const Range batch : batches) find_in(in, batch, trial, constraints_);
  if (detector_.bodies_touch()) find_between(in, trial);
  islands_.find(batches, constraints_);
}

/// Contacts of bodies with each other come before the other constraints of the component of their first body:
/// friction in joints stays last.
void StepConstraints::find_between(const StepInput& in, const StepTrial& trial) {
  between_.clear();
  detector_.bodies().find(query(in, trial), search_, between_);
  if (between_.empty()) return;
  take_sticking(between_);
  if (resists_rolling(detector_)) add_rolling(0, between_);
  const auto before = [&](const Constraint& a, const Constraint& b) {
    return in.assembly.component_of(a.body()) < in.assembly.component_of(b.body());
  };
  again_.swap(constraints_);
  constraints_.resize(again_.size() + between_.size());
  std::merge(between_.begin(), between_.end(), again_.begin(), again_.end(), constraints_.begin(), before);
}

void StepConstraints::restore(const StepInput& in, const StepIsland& island, const StepTrial& trial) {
  again_.clear();
  const Index component = island.components.front();
  find_in(in, {component, component + 1}, trial, again_);
  // No iteration changes the contacts of two bodies, which come first.
  std::copy(again_.rbegin(), again_.rend(), island.constraints.rbegin());
}

}  // namespace carom
