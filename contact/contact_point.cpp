#include <carom/contact/contact_point.h>

#include <algorithm>

namespace carom {

PointOfContact point_of_contact(const Constraint& at, const double* centre) {
  PointOfContact out;
  if (at.type != ConstraintType::contact) return out;
  const auto dimension = static_cast<std::size_t>(at.rows);
  std::copy_n(at.row(0), dimension, out.normal.begin());
  std::copy_n(centre, dimension, out.point.begin());
  if (dimension != 2 || at.blocks[0].columns != 3) return out;
  for (std::size_t i = 0; i < 2; ++i)
    out.point[i] += at.row(0)[2] * at.row(1)[i] - at.row(1)[2] * at.row(0)[i];
  return out;
}

}  // namespace carom
