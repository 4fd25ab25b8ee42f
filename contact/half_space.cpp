#include <carom/contact/half_space.h>

namespace carom::generic {

template <int D>
void HalfSpaceKind<D>::add(const HalfSpace<D>& part, const PartCheck& check) {
  check.finite({part.point.data(), D}, "point", "m");
  check.finite({part.normal.data(), D}, "normal", "");
  check.material(part.material);
  const double length = part.normal.stableNorm();
  if (!(length > 0.0)) check.refuse("normal", "zero", "a direction of any length > 0");
  HalfSpace<D> stored = part;
  stored.normal = part.normal / length;
  // Once more: the first division leaves an error of the size of the rounding of the length.
  stored.normal /= stored.normal.norm();
  parts_.push_back(stored);
}

template <int D>
std::unique_ptr<ObstacleKind> HalfSpaceKind<D>::clone() const {
  return std::make_unique<HalfSpaceKind>(*this);
}

template <int D>
Gap HalfSpaceKind<D>::gap(Index slot, const double* point) const {
  const HalfSpace<D>& part = parts_[slot];
  Gap gap;
  for (int i = 0; i < D; ++i) {
    gap.distance += part.normal[i] * (point[i] - part.point[i]);
    gap.normal[static_cast<std::size_t>(i)] = part.normal[i];
  }
  return gap;
}

template <int D>
bool HalfSpaceKind<D>::any_within(Index slot, const double* points, Index stride, Index count,
                                  double margin) const {
  const HalfSpace<D>& part = parts_[slot];
  bool any = false;
  for (Index i = 0; i < count; ++i, points += stride) {
    double distance = 0.0;
    for (int d = 0; d < D; ++d) distance += part.normal[d] * (points[d] - part.point[d]);
    any |= distance <= margin;
  }
  return any;
}

template <int D>
void HalfSpaceKind<D>::fingerprint(Fingerprint& print) const {
  for (const HalfSpace<D>& part : parts_) {
    print.add({part.point.data(), static_cast<std::size_t>(D)});
    print.add({part.normal.data(), static_cast<std::size_t>(D)});
    print.add(std::uint64_t{part.material.serial});
  }
}

template class HalfSpaceKind<2>;
template class HalfSpaceKind<3>;

}  // namespace carom::generic
