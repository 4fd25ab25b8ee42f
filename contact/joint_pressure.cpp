#include <carom/contact/joint_pressure.h>

#include <algorithm>
#include <cmath>

namespace carom {

JointPressure::JointPressure(const Assembly& assembly, Index island, const IslandJoints& joints) {
  const JointTable* const table = assembly.layout()->joints();
  for (Index k = 0; k < assembly.joint_kinds().size(); ++k) {
    const JointKind& kind = *assembly.joint_kinds()[k];
    if (!kind.rubs()) continue;
    const Range range = assembly.joints(island, k);
    for (Index slot = range.begin; slot < range.end; ++slot) {
      const JointRub rub = kind.rub(slot);
      if (rub.coefficient == 0.0) continue;
      const JointId bearing = kind.on_joint(slot);
      const JointTable::Place place = table->place(bearing.serial);
      std::size_t row = 0;
      while (joints.joint(row) != bearing) ++row;
      bearings_.push_back({assembly.joint_id(k, slot).serial, table->kinds[place.kind].get(), place.slot, row,
                           rub.bound, rub.coefficient});
    }
  }
}

const JointPressure::Bearing* JointPressure::find(const Contact& contact) const {
  if (!contact.rubs()) return nullptr;
  const auto at = std::find_if(bearings_.begin(), bearings_.end(), [&](const Bearing& bearing) {
    return bearing.serial == contact.key.of.serial;
  });
  return at == bearings_.end() ? nullptr : &*at;
}

double JointPressure::press(Contact& contact, const JointView& at, const double* multipliers,
                            double duration) const {
  const Bearing* const bearing = find(contact);
  if (bearing == nullptr) return 0.0;
  const JointReaction reaction = bearing->joint->reaction(at, bearing->slot, multipliers + bearing->row);
  const double force = std::hypot(reaction.force[0], reaction.force[1], reaction.force[2]);
  const double pressed = duration * bearing->bound + bearing->coefficient * force;
  const double largest = std::max(pressed, contact.pressed);
  const double change = largest > 0.0 ? std::abs(pressed - contact.pressed) / largest : 0.0;
  contact.pressed = pressed;
  return change;
}

}  // namespace carom
