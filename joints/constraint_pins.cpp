// Problem: the rows of pins, which are most of a chain, at the cost of their arithmetic.

#include <carom/joints/constraint_part.h>

#include <algorithm>
#include <array>
#include <type_traits>

namespace carom::planar {

namespace {

/// Axes and offsets of one row of many joints: those of a joint are `stride` times its number further.
struct PinRow {
  const Vec<2>* axes;
  const double* offsets;
  Index axis_stride, offset_stride;
};

/// A point of a body by its numbers, which the compiler keeps apart: as vectors they go through memory.
struct PinPoint {
  double lever_x = 0.0, lever_y = 0.0;  // from the centre of mass, in the fixed frame
  double x, y;
};

/// \param rotation cosine and sine, null of a particle or ground \param centre null of ground
inline PinPoint pin_point(const double* rotation, const double* centre, const Vec<2>& local) {
  PinPoint at{.x = local[0], .y = local[1]};
  if (rotation != nullptr) {
    at.lever_x = rotation[0] * local[0] - rotation[1] * local[1];
    at.lever_y = rotation[1] * local[0] + rotation[0] * local[1];
  }
  if (centre != nullptr) {
    at.x = centre[0] + at.lever_x;
    at.y = centre[1] + at.lever_y;
  }
  return at;
}

/// Writes the numbers of G for a body that is pushed along (x, y); returns their end.
inline double* write_push(double x, double y, const PinPoint& at, bool turns, double* out) {
  out[0] = x;
  out[1] = y;
  if (!turns) return out + 2;
  out[2] = at.lever_x * y - at.lever_y * x + 0.0;  // no negative zero
  return out + 3;
}

}  // namespace

bool ConstraintPartTable::are_pins(Index rows) const {
  const auto is_pin = [](const Condition& of) {
    const auto& [from, to, carrier] = of.turns[0];
    const bool turn = !of.turns.uniform() || from != 0.0 || to != 0.0 || carrier != 0.0;
    return !turn && of.form.uniform() && of.form[0] == ConstraintPart::Form::fixed_axis;
  };
  constexpr Index most = 2;
  return rows > 0 && rows <= most && carrier_place_.uniform() && carrier_place_[0].v == none &&
         std::all_of(conditions_.begin(), conditions_.begin() + rows, is_pin);
}

void ConstraintPartTable::evaluate_pins(const JointView& at, Range joints, Index rows,
                                        JointNumbers out) const {
  constexpr Index usual = 2;
  rows == usual ? evaluate_pins(at, joints, std::integral_constant<Index, usual>(), out)
                : evaluate_pins(at, joints, std::integral_constant<Index, 1>(), out);
}

template <Index Rows>
void ConstraintPartTable::evaluate_pins(const JointView& at, Range joints,
                                        std::integral_constant<Index, Rows>, JointNumbers out) const {
  // Copies that no store can change.
  std::array<PinRow, Rows> pins;
  for (Index row = 0; row < Rows; ++row) {
    const Condition& of = conditions_[row];
    pins[row] = {of.axis.data(), of.offset.data(), of.axis.stride(), of.offset.stride()};
  }
  const Vec<2>*const from_points = from_point_.data(), *const to_points = to_point_.data();
  const Index from_stride = from_point_.stride(), to_stride = to_point_.stride();
  const double *const q = at.state.q, *const v = at.state.v, *const rotations = at.rotation;
  const auto number_at = [](const double* numbers, Index place) {
    return place == none ? nullptr : numbers + place;
  };
  double *gap = out.gap, *drift = out.drift, *number = out.jacobian;
  for (Index joint = joints.begin; joint < joints.end; ++joint) {
    const auto& [from, to] = places_[joint];
    const PinPoint a = pin_point(number_at(rotations, from.rotation), number_at(q, from.q),
                                 from_points[joint * from_stride]);
    const PinPoint b =
        pin_point(number_at(rotations, to.rotation), number_at(q, to.q), to_points[joint * to_stride]);
    const double between_x = b.x - a.x, between_y = b.y - a.y;
    double apart_x = 0.0, apart_y = 0.0;
    if (drift != nullptr) {
      const double from_spin = from.rotation == none ? 0.0 : v[from.v + 2];
      const double to_spin = to.rotation == none ? 0.0 : v[to.v + 2];
      apart_x = from_spin * from_spin * a.lever_x - to_spin * to_spin * b.lever_x;
      apart_y = from_spin * from_spin * a.lever_y - to_spin * to_spin * b.lever_y;
    }
    for (const PinRow& row : pins) {
      const Vec<2>& axis = row.axes[joint * row.axis_stride];
      const double x = axis[0], y = axis[1];
      *gap++ = x * between_x + y * between_y - row.offsets[joint * row.offset_stride];
      if (drift != nullptr) *drift++ = x * apart_x + y * apart_y;
      if (number == nullptr) continue;
      if (from.v != none) number = write_push(-x, -y, a, from.rotation != none, number);
      if (to.v != none) number = write_push(x, y, b, to.rotation != none, number);
    }
  }
}

}  // namespace carom::planar
