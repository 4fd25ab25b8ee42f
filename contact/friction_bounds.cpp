#include <carom/contact/friction_bounds.h>

#include <algorithm>
#include <cmath>

namespace carom {

void FrictionBounds::add(const Assembly& assembly, Index component, const JointConstraints& joints) {
  const JointTable* const table = assembly.layout()->joints();
  if (table == nullptr) return;
  const std::size_t first = rows_;
  rows_ += joints.size();
  std::vector<std::size_t> rows(table->places.size(), 0);  // first ones, by serial number
  for (std::size_t joint = 0; joint < joints.pattern().size(); ++joint) {
    const std::size_t row = joints.pattern().first_row(joint);
    rows[joints.joint(row).serial] = first + row;
  }
  for (Index k = 0; k < assembly.joint_kinds().size(); ++k) {
    const JointKind& kind = *assembly.joint_kinds()[k];
    if (kind.friction_rows() == 0) continue;
    const Range range = assembly.joints(component, k);
    for (Index slot = range.begin; slot < range.end; ++slot) {
      const JointDryFriction dry_friction = kind.dry_friction(slot);
      if (dry_friction.coefficient == 0.0) continue;
      const JointId bearing = kind.on_joint(slot);
      const JointTable::Place place = table->place(bearing.serial);
      bearings_.push_back({assembly.joint_id(k, slot).serial, table->kinds[place.kind].get(), place.slot,
                           rows[bearing.serial], dry_friction.bound, dry_friction.coefficient});
    }
  }
  std::sort(bearings_.begin(), bearings_.end(),
            [](const Bearing& a, const Bearing& b) { return a.serial < b.serial; });
}

const FrictionBounds::Bearing* FrictionBounds::find(const Constraint& contact) const {
  if (!contact.key.is_of_joint()) return nullptr;
  const Index serial = contact.key.a.serial;
  const auto at =
      std::lower_bound(bearings_.begin(), bearings_.end(), serial,
                       [](const Bearing& bearing, Index wanted) { return bearing.serial < wanted; });
  return at == bearings_.end() || at->serial != serial ? nullptr : &*at;
}

Range FrictionBounds::rows(const Constraint& contact) const {
  const Bearing* const bearing = find(contact);
  if (bearing == nullptr) return {};
  const auto first = static_cast<Index>(bearing->row);
  return {first, first + bearing->joint->rows()};
}

void FrictionBounds::take(const double* multipliers, double duration, double size) {
  multipliers_ = multipliers;
  duration_ = duration;
  largest_ = size;
  for (std::size_t row = 0; row < rows_; ++row) largest_ = std::max(largest_, std::abs(multipliers[row]));
}

double FrictionBounds::update(Constraint& contact, const JointView& at) const {
  const Bearing* const bearing = find(contact);
  if (bearing == nullptr) return 0.0;
  const JointReaction reaction = bearing->joint->reaction(at, bearing->slot, multipliers_ + bearing->row);
  const double force = std::hypot(reaction.force[0], reaction.force[1], reaction.force[2]);
  const double coefficient = bearing->coefficient / contact.of_joint.length;
  const double bound = duration_ * bearing->bound / contact.of_joint.length + coefficient * force;
  const double scale = std::max({bound, contact.of_joint.friction_bound, coefficient * largest_});
  const double change = scale > 0.0 ? std::abs(bound - contact.of_joint.friction_bound) / scale : 0.0;
  contact.of_joint.friction_bound = bound;
  return change;
}

}  // namespace carom
