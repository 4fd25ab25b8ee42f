#include <carom/contact/detection/gap_point_half_space.h>
#include <carom/contact/detection/half_space_kind.h>
#include <carom/core/vector_length.h>

namespace carom::generic {

namespace {

/// A normal turned with its half-plane; unturned, it is the same to the bit.
template <int D>
Vec<D> turned(const Vec<D>& normal, const GroundMotion& motion) {
  Vec<D> now = normal;
  now[0] = motion.cosine * normal[0] - motion.sine * normal[1];
  now[1] = motion.sine * normal[0] + motion.cosine * normal[1];
  return now;
}

template <int D>
Vec<D> point_of(const GroundMotion& motion) {
  return Eigen::Map<const Vec<D>>(motion.point.data());
}

}  // namespace

template <int D>
void HalfSpaceKind<D>::add(const HalfSpace<D>& part, const PartCheck& check) {
  check.finite({part.point.data(), D}, "point", "m");
  check.direction({part.normal.data(), D}, "normal");
  check.material(part.material);
  check.filter(part.filter);
  const double length = length_of<D>(part.normal);
  if (!(length > 0.0)) check.refuse("normal", "zero", "a direction of any length > 0");
  if constexpr (D == 2) {
    part.motion.check(check);
    check.finite(part.surface_speed, "surface_speed", "m/s");
  }
  HalfSpace<D> stored = part;
  stored.normal = part.normal / length;
  // Once more: the first division leaves an error of the size of the rounding of the length.
  stored.normal /= stored.normal.norm();
  parts_.push_back(stored);
}

template <int D>
std::unique_ptr<ShapeKind> HalfSpaceKind<D>::clone() const {
  return std::make_unique<HalfSpaceKind>(*this);
}

template <int D>
bool HalfSpaceKind<D>::moves(Index slot) const {
  if constexpr (D == 2) {
    return !parts_[slot].motion.empty();
  } else {
    return GroundShapeKind::moves(slot);
  }
}

template <int D>
double HalfSpaceKind<D>::surface_speed(Index slot) const {
  if constexpr (D == 2) {
    return parts_[slot].surface_speed;
  } else {
    return GroundShapeKind::surface_speed(slot);
  }
}

template <int D>
GroundMotion HalfSpaceKind<D>::place(Index slot, double time) const {
  if constexpr (D == 2) {
    return parts_[slot].motion.at(time, parts_[slot].point);
  } else {
    return GroundShapeKind::place(slot, time);
  }
}

template <int D>
void HalfSpaceKind<D>::discontinuity_times(Index slot, std::vector<double>& out) const {
  if constexpr (D == 2) {
    const std::vector<double>& times = parts_[slot].motion.breaks;
    out.insert(out.end(), times.begin(), times.end());
  } else {
    GroundShapeKind::discontinuity_times(slot, out);
  }
}

template <int D>
Gap HalfSpaceKind<D>::gap(Index slot, const double* point) const {
  return gap_point_half_space<D>(point, parts_[slot].point, parts_[slot].normal);
}

template <int D>
Gap HalfSpaceKind<D>::moved_gap(Index slot, const GroundMotion& motion, const double* point) const {
  return gap_point_half_space<D>(point, point_of<D>(motion), turned(parts_[slot].normal, motion));
}

template <int D>
std::uint64_t HalfSpaceKind<D>::points_within(Index slot, const PointRow& row, double margin) const {
  return points_in_half_space<D>(row, parts_[slot].point, parts_[slot].normal, margin);
}

template <int D>
std::uint64_t HalfSpaceKind<D>::points_within_moved(Index slot, const GroundMotion& motion,
                                                    const PointRow& row, double margin) const {
  return points_in_half_space<D>(row, point_of<D>(motion), turned(parts_[slot].normal, motion), margin);
}

template <int D>
void HalfSpaceKind<D>::fingerprint(Fingerprint& print) const {
  for (const HalfSpace<D>& part : parts_) {
    print.add({part.point.data(), static_cast<std::size_t>(D)});
    print.add({part.normal.data(), static_cast<std::size_t>(D)});
    print.add(std::uint64_t{part.material.serial});
    if constexpr (D == 2) {
      if (part.surface_speed != 0.0) print.add(part.surface_speed);
      // Functions cannot be hashed; that there is a motion, and its breaks, can.
      if (part.motion.empty()) continue;
      print.add("motion");
      print.add(part.motion.breaks);
    }
  }
}

PartType<GroundShapeKind> HalfSpace<2>::part_type() {
  return PartType<GroundShapeKind>::of<HalfSpaceKind<2>, HalfSpace>();
}
template <int D>
PartType<GroundShapeKind> HalfSpace<D>::part_type() {
  return PartType<GroundShapeKind>::of<HalfSpaceKind<D>, HalfSpace>();
}

template PartType<GroundShapeKind> HalfSpace<3>::part_type();
template class HalfSpaceKind<2>;
template class HalfSpaceKind<3>;

}  // namespace carom::generic
