#include <carom/core/body_kind.h>
#include <carom/joints/binding.h>

#include <array>
#include <cmath>

namespace carom::planar {

namespace {

/// A vector turned counter-clockwise by 90 degrees.
Vec<2> turned(const Vec<2>& a) { return {-a[1], a[0]}; }

double cross(const Vec<2>& a, const Vec<2>& b) { return a[0] * b[1] - a[1] * b[0]; }

}  // namespace

LocatedBinding::Side LocatedBinding::side(BodyId body, const Vec<2>& point, double turn,
                                          const Layout& layout) {
  Side side;
  side.local = point;
  side.turn = turn;
  if (body == ground) return side;
  const BodySlot slot = layout.slot(body);
  side.q = slot.q;
  side.v = slot.v;
  side.rotation = slot.rotation;
  side.columns = static_cast<int>(slot.v_size);
  return side;
}

LocatedBinding::LocatedBinding(const Binding& binding, const Layout& layout)
    : form_(binding.form),
      from_(side(binding.from.body, binding.from.point, binding.turn_from, layout)),
      to_(side(binding.to.body, binding.to.point, binding.turn_to, layout)),
      carrier_(side(binding.carrier, Vec<2>::Zero(), binding.turn_carrier, layout)),
      axis_(binding.axis),
      offset_(binding.offset),
      moment_(binding.turn_to) {
  // The ground does not turn.
  for (Side* const side : {&from_, &to_, &carrier_}) {
    if (side->rotation == none) side->turn = 0.0;
  }
  if (carrier_.turn == 0.0) carrier_ = {};
}

Vec<2> LocatedBinding::Side::lever(const JointView& at) const {
  if (rotation == none) return Vec<2>::Zero();
  return Space<2>::rotate(at.rotation + rotation, local);
}

Vec<2> LocatedBinding::Side::position(const JointView& at, const Vec<2>& lever) const {
  if (v == none) return local;
  return Eigen::Map<const Vec<2>>(at.state.q + q) + lever;
}

Vec<2> LocatedBinding::Side::velocity(const JointView& at, const Vec<2>& lever) const {
  if (v == none) return Vec<2>::Zero();
  const Vec<2> velocity = Eigen::Map<const Vec<2>>(at.state.v + v);
  return rotation == none ? velocity : Vec<2>(velocity + spin(at) * turned(lever));
}

void LocatedBinding::pattern(JointRow& row) const {
  row.bodies = 0;
  for (const Side* const side : {&from_, &to_, &carrier_}) {
    if (side->v == none) continue;
    JointRow::Block& block = row.blocks[static_cast<std::size_t>(row.bodies++)];
    block.v = side->v;
    block.columns = side->columns;
  }
}

Vec<2> LocatedBinding::direction(const JointView& at, const Vec<2>& between) const {
  switch (form_) {
    case Binding::Form::fixed_axis:
      return axis_;
    case Binding::Form::axis_of_from:
      return from_.rotation == none ? axis_ : Space<2>::rotate(at.rotation + from_.rotation, axis_);
    case Binding::Form::distance:
      return between / between.norm();
    case Binding::Form::angles:
      break;
  }
  return Vec<2>::Zero();
}

void LocatedBinding::evaluate(const JointView& at, JointRow& row) const {
  pattern(row);
  const Vec<2> from_lever = from_.lever(at), to_lever = to_.lever(at);
  const Vec<2> between = to_.position(at, to_lever) - from_.position(at, from_lever);
  const Vec<2> apart = to_.velocity(at, to_lever) - from_.velocity(at, from_lever);
  const double from_spin = from_.spin(at), to_spin = to_.spin(at);
  const Vec<2> centripetal = from_spin * from_spin * from_lever - to_spin * to_spin * to_lever;
  const Vec<2> a = direction(at, between);
  // What turning `from` adds where the axis turns with it.
  double swing = 0.0;
  row.rate = 0.0;
  row.drift = a.dot(centripetal);
  row.gap = a.dot(between);
  if (form_ == Binding::Form::axis_of_from && from_.rotation != none) {
    const Vec<2> across = turned(a);
    swing = across.dot(between);
    row.drift += 2.0 * from_spin * across.dot(apart) - from_spin * from_spin * row.gap;
  } else if (form_ == Binding::Form::distance) {
    const double length = between.norm(), sideways = cross(a, apart);
    row.drift += sideways * sideways / length;
    row.gap = length;
  }
  for (const Side* const side : {&from_, &to_, &carrier_}) {
    if (side->turn != 0.0) row.gap += side->turn * side->angle(at);
  }
  row.gap -= offset_;
  int place = 0;
  const auto write = [&](const Side& side, double sign, const Vec<2>& lever, double turn) {
    if (side.v == none) return;
    auto& jacobian = row.blocks[static_cast<std::size_t>(place++)].jacobian;
    jacobian[0] = sign * a[0];
    jacobian[1] = sign * a[1];
    jacobian[2] = side.rotation == none ? 0.0 : sign * cross(lever, a) + turn;
  };
  write(from_, -1.0, from_lever, from_.turn + swing);
  write(to_, 1.0, to_lever, to_.turn);
  write(carrier_, 0.0, Vec<2>::Zero(), carrier_.turn);
}

void LocatedBinding::add_reaction(const JointView& at, double multiplier, JointReaction& out) const {
  const Vec<2> between = to_.position(at, to_.lever(at)) - from_.position(at, from_.lever(at));
  const Vec<2> force = multiplier * direction(at, between);
  out.force[0] += force[0];
  out.force[1] += force[1];
  out.moment += multiplier * moment_;
}

Vec<2> DescribedPlace::point(const Vec<2>& local) const {
  const std::array<double, 2> rotation{std::cos(angle), std::sin(angle)};
  return position + Space<2>::rotate(rotation.data(), local);
}

DescribedPlace described_place(const System& system, BodyId body) {
  DescribedPlace place;
  if (body == ground) return place;
  const Registry<BodyKind>& registry = system.body_kinds();
  const BodyKind& kind = registry.kind_of(body.serial);
  std::array<double, 3> q{}, v{};
  kind.initial(registry.place(body.serial).slot, q.data(), v.data());
  place.position = {q[0], q[1]};
  if (kind.has_orientation()) place.angle = q[2];
  return place;
}

void check_joint_ends(const PartCheck& check, const End<2>& from, const End<2>& to) {
  check_end(check, from, "from");
  check_end(check, to, "to");
  check.different_ends(from.body, to.body);
}

Vec<2> checked_axis(const PartCheck& check, const Vec<2>& axis, std::string_view quantity) {
  check.finite({axis.data(), 2}, quantity, "");
  const double length = axis.stableNorm();  // squares of what is far from 1 over- or underflow
  if (!(length > 0.0)) check.refuse(quantity, "(0, 0)", "an axis of any length > 0");
  return axis / length;
}

void check_turning_end(const PartCheck& check, BodyId body, std::string_view quantity) {
  if (body != ground) check.oriented_body(body, quantity);
}

}  // namespace carom::planar
