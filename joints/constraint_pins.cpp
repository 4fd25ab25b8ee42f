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

/// Writes the numbers of G for a body that is pushed along `along`; returns their end.
inline double* write_push(const Vec<2>& along, const Vec<2>& lever, bool turns, double* out) {
  out[0] = along[0];
  out[1] = along[1];
  if (!turns) return out + 2;
  out[2] = lever[0] * along[1] - lever[1] * along[0] + 0.0;  // no negative zero
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
  const JointView view = at;
  double *gap = out.gap, *drift = out.drift, *number = out.jacobian;
  for (Index joint = joints.begin; joint < joints.end; ++joint) {
    const auto [from, to] = places_[joint];
    const Vec<2>&from_point = from_points[joint * from_stride], &to_point = to_points[joint * to_stride];
    const Vec<2> from_lever = from.lever(view, from_point), to_lever = to.lever(view, to_point);
    const Vec<2> between =
        to.position(view, to_point, to_lever) - from.position(view, from_point, from_lever);
    std::array<Vec<2>, Rows> axes;
    for (Index row = 0; row < Rows; ++row) {
      axes[row] = pins[row].axes[joint * pins[row].axis_stride];
      *gap++ = axes[row].dot(between) - pins[row].offsets[joint * pins[row].offset_stride];
    }
    if (drift != nullptr) {
      const double from_spin = from.spin(view), to_spin = to.spin(view);
      const Vec<2> apart = from_spin * from_spin * from_lever - to_spin * to_spin * to_lever;
      for (const Vec<2>& axis : axes) *drift++ = axis.dot(apart);
    }
    if (number == nullptr) continue;
    for (const Vec<2>& axis : axes) {
      if (from.v != none) number = write_push(-axis, from_lever, from.rotation != none, number);
      if (to.v != none) number = write_push(axis, to_lever, to.rotation != none, number);
    }
  }
}

}  // namespace carom::planar
