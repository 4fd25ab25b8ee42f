// Problem: from impulses along the rows of constraints back to the bodies.

#include <carom/contact/impulse_map.h>

#include <algorithm>
#include <limits>
#include <vector>

namespace carom {

void ImpulseMap::add_loads(double scale, double* load) const {
  for (std::size_t c = 0; c < constraints_.size(); ++c) {
    for (int row = 0; row < constraints_[c].rows; ++row) {
      constraints_[c].add_transposed(row, scale * impulse(c, row), load);
    }
  }
}

/// From the velocities that a unit impulse along each normal gives the bodies of its contact.
double ImpulseMap::mass_ratio() const {
  if (response_->factors.answer_alone()) return 1.0;
  std::vector<double> unit(impulses_.size(), 0.0), velocity(response_->dense.reach_end());
  double least = std::numeric_limits<double>::infinity(), most = 0.0;
  for (std::size_t c = 0; c < constraints_.size(); ++c) {
    const Constraint& at = constraints_[c];
    if (at.normals == 0) continue;
    std::fill(velocity.begin(), velocity.end(), 0.0);
    unit[place(c, 0)] = 1.0;
    response_->dense.add_response(unit, velocity.data());
    unit[place(c, 0)] = 0.0;
    for (std::size_t b = 0; b < static_cast<std::size_t>(at.bodies); ++b) {
      double own = 0.0;
      for (int k = 0; k < at.blocks[b].columns; ++k)
        own = std::max(own, std::abs(velocity[at.blocks[b].v + static_cast<Index>(k)]));
      if (!(own > 0.0)) continue;
      least = std::min(least, own);
      most = std::max(most, own);
    }
  }
  return most > 0.0 ? most / least : 1.0;
}

}  // namespace carom
