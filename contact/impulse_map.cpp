// Problem: from impulses along the rows of constraints back to the bodies.

#include <carom/contact/impulse_map.h>

namespace carom {

void ImpulseMap::add_loads(double scale, double* load) const {
  for (std::size_t c = 0; c < constraints_.size(); ++c) {
    for (int row = 0; row < constraints_[c].rows; ++row) {
      constraints_[c].add_transposed(row, scale * impulse(c, row), load);
    }
  }
}

double ImpulseMap::surface_work(std::size_t constraint) const {
  const Constraint& at = constraints_[constraint];
  double work = 0.0;
  for (int row = 0; row < at.rows; ++row) {
    const auto i = static_cast<std::size_t>(row);
    work += impulse_work(impulse(constraint, row), at.surface_velocity[i], at.surface_velocity_after[i]);
  }
  return work;
}

}  // namespace carom
