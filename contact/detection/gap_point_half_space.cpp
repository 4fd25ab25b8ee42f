#include <carom/contact/detection/gap_point_half_space.h>

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

template <int D>
std::uint64_t points_in_half_space(const PointRow& row, const Vec<D>& origin, const Vec<D>& normal,
                                   double margin) {
  std::uint64_t within = 0;
  const double* point = row.points;
  for (Index i = 0; i < row.count; ++i, point += row.stride) {
    double distance = 0.0;
    for (int d = 0; d < D; ++d) distance += normal[d] * (point[d] - origin[d]);
    within |= std::uint64_t{!(distance > margin)} << i;
  }
  return within;
}

template Gap gap_point_half_space<2>(const double*, const Vec<2>&, const Vec<2>&);
template Gap gap_point_half_space<3>(const double*, const Vec<3>&, const Vec<3>&);
template std::uint64_t points_in_half_space<2>(const PointRow&, const Vec<2>&, const Vec<2>&, double);
template std::uint64_t points_in_half_space<3>(const PointRow&, const Vec<3>&, const Vec<3>&, double);

}  // namespace carom
