#include <carom/contact/detection/half_space.h>

namespace carom::generic {

namespace {

template <int D>
Gap gap_from(const Vec<D>& origin, const Vec<D>& normal, const double* point) {
  Gap gap;
  for (int i = 0; i < D; ++i) {
    gap.distance += normal[i] * (point[i] - origin[i]);
    gap.normal[static_cast<std::size_t>(i)] = normal[i];
  }
  return gap;
}

template <int D>
bool any_from(const Vec<D>& origin, const Vec<D>& normal, const double* points, Index stride, Index count,
              double margin) {
  bool any = false;
  for (Index i = 0; i < count; ++i, points += stride) {
    double distance = 0.0;
    for (int d = 0; d < D; ++d) distance += normal[d] * (points[d] - origin[d]);
    any |= distance <= margin;
  }
  return any;
}

/// A normal turned with its obstacle; unturned, it is the same to the bit.
template <int D>
Vec<D> turned(const Vec<D>& normal, const ObstacleMotion& motion) {
  Vec<D> now = normal;
  now[0] = motion.cosine * normal[0] - motion.sine * normal[1];
  now[1] = motion.sine * normal[0] + motion.cosine * normal[1];
  return now;
}

template <int D>
Vec<D> point_of(const ObstacleMotion& motion) {
  return Eigen::Map<const Vec<D>>(motion.point.data());
}

}  // namespace

template <int D>
void HalfSpaceKind<D>::add(const HalfSpace<D>& part, const PartCheck& check) {
  check.finite({part.point.data(), D}, "point", "m");
  check.direction({part.normal.data(), D}, "normal");
  check.material(part.material);
  const double length = part.normal.stableNorm();
  if (!(length > 0.0)) check.refuse("normal", "zero", "a direction of any length > 0");
  if constexpr (D == 2) part.motion.check(check);
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
bool HalfSpaceKind<D>::moves(Index slot) const {
  if constexpr (D == 2) {
    return !parts_[slot].motion.empty();
  } else {
    return ObstacleKind::moves(slot);
  }
}

template <int D>
ObstacleMotion HalfSpaceKind<D>::place(Index slot, double time) const {
  if constexpr (D == 2) {
    return parts_[slot].motion.at(time, parts_[slot].point);
  } else {
    return ObstacleKind::place(slot, time);
  }
}

template <int D>
void HalfSpaceKind<D>::breaks(Index slot, std::vector<double>& out) const {
  if constexpr (D == 2) {
    const std::vector<double>& times = parts_[slot].motion.breaks;
    out.insert(out.end(), times.begin(), times.end());
  } else {
    ObstacleKind::breaks(slot, out);
  }
}

template <int D>
Gap HalfSpaceKind<D>::gap(Index slot, const double* point) const {
  return gap_from(parts_[slot].point, parts_[slot].normal, point);
}

template <int D>
Gap HalfSpaceKind<D>::moved_gap(Index slot, const ObstacleMotion& motion, const double* point) const {
  return gap_from(point_of<D>(motion), turned(parts_[slot].normal, motion), point);
}

template <int D>
bool HalfSpaceKind<D>::any_within(Index slot, const double* points, Index stride, Index count,
                                  double margin) const {
  return any_from(parts_[slot].point, parts_[slot].normal, points, stride, count, margin);
}

template <int D>
bool HalfSpaceKind<D>::any_within_moved(Index slot, const ObstacleMotion& motion, const double* points,
                                        Index stride, Index count, double margin) const {
  return any_from(point_of<D>(motion), turned(parts_[slot].normal, motion), points, stride, count, margin);
}

template <int D>
void HalfSpaceKind<D>::fingerprint(Fingerprint& print) const {
  for (const HalfSpace<D>& part : parts_) {
    print.add({part.point.data(), static_cast<std::size_t>(D)});
    print.add({part.normal.data(), static_cast<std::size_t>(D)});
    print.add(std::uint64_t{part.material.serial});
    if constexpr (D == 2) {
      // Functions cannot be hashed; that there is a motion, and its breaks, can.
      if (part.motion.empty()) continue;
      print.add("motion");
      print.add(part.motion.breaks);
    }
  }
}

template class HalfSpaceKind<2>;
template class HalfSpaceKind<3>;

}  // namespace carom::generic
