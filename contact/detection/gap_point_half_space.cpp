#include <carom/contact/detection/gap_point_half_space.h>
#include <carom/core/numerics/pair.h>

#include <cstddef>

namespace carom {

template <int D>
Gap gap_point_half_space(const double* point, const Vec<D>& origin, const Vec<D>& normal) {
  Gap gap;
  for (int i = 0; i < D; ++i) {
    gap.distance += normal[i] * (point[i] - origin[i]);
    gap.normal[static_cast<std::size_t>(i)] = normal[i];
  }
  return gap;
}

// All points are looked at, without a branch, two by two.
template <int D>
bool any_point_in_half_space(const PointRow& row, const Vec<D>& origin, const Vec<D>& normal, double margin) {
  using Found = decltype(Pair{} <= Pair{});
  Found found{};
  const double* point = row.points;
  const auto look = [&](const double* a, const double* b) {
    Pair distance{};
    for (int d = 0; d < D; ++d) distance += both(normal[d]) * (Pair{a[d], b[d]} - both(origin[d]));
    found |= distance <= both(margin);
  };
  Index i = 0;
  for (; i + 1 < row.count; i += 2, point += std::size_t{2} * row.stride) look(point, point + row.stride);
  if (i < row.count) look(point, point);
  return (found[0] | found[1]) != 0;
}

template Gap gap_point_half_space<2>(const double*, const Vec<2>&, const Vec<2>&);
template Gap gap_point_half_space<3>(const double*, const Vec<3>&, const Vec<3>&);
template bool any_point_in_half_space<2>(const PointRow&, const Vec<2>&, const Vec<2>&, double);
template bool any_point_in_half_space<3>(const PointRow&, const Vec<3>&, const Vec<3>&, double);

}  // namespace carom
