#include <carom/integrators/time_stepping/slip_changes.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>

namespace carom {

namespace {

/// Modes of contacts that are looked up in the order in which they are, mostly.
class ModeLookup {
public:
  explicit ModeLookup(const ContactModes& modes) : modes_(modes) {}
  /// That of a contact, if it is known and not open.
  [[nodiscard]] std::optional<ContactMode> find(const ConstraintKey& key) {
    if (next_ >= modes_.size() || !(modes_[next_].first == key)) {
      const auto known =
          std::find_if(modes_.begin(), modes_.end(), [&](const auto& of) { return of.first == key; });
      if (known == modes_.end()) return std::nullopt;
      next_ = static_cast<std::size_t>(known - modes_.begin());
    }
    const ContactMode mode = modes_[next_++].second;
    return mode == ContactMode::open ? std::nullopt : std::optional(mode);
  }

private:
  const ContactModes& modes_;
  std::size_t next_ = 0;
};

ContactMode mode_of(double speed) {
  return speed > 0.0   ? ContactMode::slip_positive
         : speed < 0.0 ? ContactMode::slip_negative
                       : ContactMode::stick;
}

/// Speed that friction took or gave too early. \param came mode before, if known \param after mode in the
/// step \param speed_before,speed_after of sliding, at its ends
double changed_speed(std::optional<ContactMode> came, ContactMode after, double speed_before,
                     double speed_after) {
  const ContactMode before = came.value_or(mode_of(speed_before));
  if (before == after) return 0.0;
  return std::abs(before == ContactMode::stick ? speed_after : speed_before);
}

}  // namespace

SlipChanges::SlipChanges(const Assembly& assembly)
    : assembly_(&assembly), joints_(assembly), lengths_(assembly.length_scales()) {
  if (joints_.has_friction()) at_start_.rotation.resize(assembly.layout()->rotation_size());
}

double SlipChanges::largest_speed(const SlidStep& of) {
  double largest = joints_.has_friction() ? largest_in_joints(of) : 0.0;
  ModeLookup before(of.before);
  for (const ContactRecord& contact : of.report.contacts) {
    if (contact.impulse[1] == 0.0) continue;  // no friction acts
    largest = std::max(largest, changed_speed(before.find(contact.key), contact.mode,
                                              contact.velocity_before[1], contact.velocity_after[1]));
  }
  return largest;
}

/// Rates along coordinates of joints are taken along the rows at the start.
double SlipChanges::largest_in_joints(const SlidStep& of) {
  double largest = 0.0;
  ModeLookup before(of.before), in_step(of.modes);
  for (Index component = 0; component < assembly_->components().size(); ++component) {
    if (!joints_.has_friction(component)) continue;
    evaluate_positions(*assembly_, component, of.start.view(), at_start_);
    friction_.clear();
    joints_.find_friction(component, of.start.view(), at_start_, friction_);
    for (const Constraint& friction : friction_) {
      const std::optional<ContactMode> mode = in_step.find(friction.key);
      if (!mode) continue;
      const double speed =
          changed_speed(before.find(friction.key), *mode, friction.velocity(0, of.start.v.data()),
                        friction.velocity(0, of.end.v.data()));
      largest = std::max(largest, in_length(friction, speed));
    }
  }
  return largest;
}

/// Length of the smallest change of velocities, each weighted by its length, that makes a rate.
double SlipChanges::in_length(const Constraint& friction, double rate) const {
  if (rate == 0.0) return 0.0;
  double sum = 0.0;
  const double* h = friction.row(0);
  for (int b = 0; b < friction.bodies; ++b) {
    const Constraint::Block& block = friction.blocks[static_cast<std::size_t>(b)];
    for (int k = 0; k < block.columns; ++k) {
      const double by_length = *h++ / lengths_[block.v + static_cast<Index>(k)];
      sum += by_length * by_length;
    }
  }
  return sum > 0.0 ? rate / std::sqrt(sum) : 0.0;
}

}  // namespace carom
