// Problem: the rows of pins, which are most of a chain, at the cost of their arithmetic.

#include <carom/core/numerics/pair.h>
#include <carom/joints/constraint_part_table.h>

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

  [[nodiscard]] Pair axis(Index joint) const { return load_pair(axes[joint * axis_stride].data()); }
  [[nodiscard]] double offset(Index joint) const { return offsets[joint * offset_stride]; }
};

// Of what does not turn, and of ground, which is the origin.
constexpr std::array<double, 2> no_rotation{1.0, 0.0}, origin{};
constexpr Pair zero{};

/// A point of a body by its numbers, which the compiler keeps apart: as vectors they go through memory.
struct PinPoint {
  double lever_x, lever_y;  // from the centre of mass, in the fixed frame
  double x, y;
};

/// \param rotation cosine and sine
inline PinPoint pin_point(const double* rotation, const double* centre, const Vec<2>& local) {
  const double lever_x = rotation[0] * local[0] - rotation[1] * local[1];
  const double lever_y = rotation[1] * local[0] + rotation[0] * local[1];
  return {lever_x, lever_y, centre[0] + lever_x, centre[1] + lever_y};
}

/// Numbers of one or both rows. \tparam Rows 1 or 2
template <Index Rows>
inline double* write_rows(Pair of_rows, double* out) {
  if constexpr (Rows == 2) {
    store_pair(out, of_rows);
  } else {
    *out = of_rows[0];
  }
  return out + Rows;
}

/// Writes the numbers of a row of G for a body that is pushed along it; returns their end.
inline double* write_push(Pair along, double spin, bool turns, double* out) {
  store_pair(out, along);
  if (!turns) return out + 2;
  out[2] = spin;
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
  const auto number_at = [](const double* numbers, Index place, const std::array<double, 2>& else_these) {
    return place == none ? else_these.data() : numbers + place;
  };
  const PinRow &one = pins.front(), &other = pins.back();
  double *gap = out.gap, *drift = out.drift, *number = out.jacobian;
  for (Index joint = joints.begin; joint < joints.end; ++joint) {
    const auto &from = places_[joint].from, &to = places_[joint].to;  // clang 14 captures no bindings
    const PinPoint a = pin_point(number_at(rotations, from.rotation, no_rotation),
                                 number_at(q, from.q, origin), from_points[joint * from_stride]);
    const PinPoint b = pin_point(number_at(rotations, to.rotation, no_rotation), number_at(q, to.q, origin),
                                 to_points[joint * to_stride]);
    // Of both rows at once.
    const Pair first = one.axis(joint), second = other.axis(joint);
    const Pair x = firsts(first, second), y = seconds(first, second);
    const Pair offset{one.offset(joint), other.offset(joint)};
    gap = write_rows<Rows>(x * both(b.x - a.x) + y * both(b.y - a.y) - offset, gap);
    if (drift != nullptr) {
      const double from_spin = from.rotation == none ? 0.0 : v[from.v + 2];
      const double to_spin = to.rotation == none ? 0.0 : v[to.v + 2];
      const double apart_x = from_spin * from_spin * a.lever_x - to_spin * to_spin * b.lever_x;
      const double apart_y = from_spin * from_spin * a.lever_y - to_spin * to_spin * b.lever_y;
      drift = write_rows<Rows>(x * both(apart_x) + y * both(apart_y), drift);
    }
    if (number == nullptr) continue;
    const Pair from_turn = both(a.lever_x) * -y - both(a.lever_y) * -x + zero;  // no negative zero
    const Pair to_turn = both(b.lever_x) * y - both(b.lever_y) * x + zero;
    const auto write_row = [&](Pair axis, double from_spin, double to_spin) {
      if (from.v != none) number = write_push(-axis, from_spin, from.rotation != none, number);
      if (to.v != none) number = write_push(axis, to_spin, to.rotation != none, number);
    };
    write_row(first, from_turn[0], to_turn[0]);
    if constexpr (Rows == 2) write_row(second, from_turn[1], to_turn[1]);
  }
}

}  // namespace carom::planar
