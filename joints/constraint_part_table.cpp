#include <carom/joints/condition_derivatives.h>
#include <carom/joints/constraint_part_table.h>

#include <algorithm>
#include <array>
#include <string>

namespace carom::planar {

namespace {

double cross(const Vec<2>& a, const Vec<2>& b) { return a[0] * b[1] - a[1] * b[0]; }

/// Writes the numbers of G for a body that is pushed along `along`; returns their end.
template <class Place>
double* write_block(const Place& place, const Vec<2>& along, const Vec<2>& lever, double turn, double* out) {
  if (place.v == none) return out;
  *out++ = along[0];
  *out++ = along[1];
  if (place.rotation != none) *out++ = cross(lever, along) + turn;
  return out;
}

}  // namespace

/// The ends of a joint at one configuration.
struct ConstraintPartTable::Geometry {
  const Places& places;
  const Place& carrier;
  Vec<2> from_lever, to_lever;
  Vec<2> between;  // the ends, d
  Vec<2> apart;    // dd/dt
  Vec<2> drift;    // d2d/dt2 where nothing accelerates
  double from_spin;
};

void ConstraintPartTable::add(std::span<const ConstraintPart> constraints) {
  const ConstraintPart& first = constraints.front();
  conditions_.resize(constraints.size());
  for (const BodyId body : {first.from.body, first.to.body}) token_ = std::max(token_, body.token);
  ends_.push_back({first.from.body.serial, first.to.body.serial});
  carrier_.push_back(first.carrier.serial);
  // The points are those of a condition that looks at them.
  const auto looks = [](const ConstraintPart& constraint) {
    return constraint.form != ConstraintPart::Form::angles;
  };
  const auto pointed = std::find_if(constraints.begin(), constraints.end(), looks);
  const ConstraintPart& points = pointed == constraints.end() ? first : *pointed;
  from_point_.push_back(points.from.point);
  to_point_.push_back(points.to.point);
  for (std::size_t i = 0; i < constraints.size(); ++i) {
    const ConstraintPart& constraint = constraints[i];
    conditions_[i].form.push_back(constraint.form);
    conditions_[i].axis.push_back(constraint.axis);
    conditions_[i].turns.push_back({constraint.turn_from, constraint.turn_to, constraint.turn_carrier});
    conditions_[i].offset.push_back(constraint.offset);
  }
}

void ConstraintPartTable::erase(Index joint) {
  ends_.erase(ends_.begin() + joint);
  carrier_.erase(joint);
  from_point_.erase(joint);
  to_point_.erase(joint);
  for (Condition& condition : conditions_) {
    condition.form.erase(joint);
    condition.axis.erase(joint);
    condition.turns.erase(joint);
    condition.offset.erase(joint);
  }
}

ConstraintPart ConstraintPartTable::constraint(Index joint, Index which) const {
  const Condition& condition = conditions_[which];
  const Turns& turns = condition.turns[joint];
  ConstraintPart constraint;
  constraint.form = condition.form[joint];
  constraint.from = End<2>(id(ends_[joint].from));
  constraint.to = End<2>(id(ends_[joint].to));
  if (constraint.form != ConstraintPart::Form::angles) {
    constraint.from.point = from_point_[joint];
    constraint.to.point = to_point_[joint];
  }
  constraint.axis = condition.axis[joint];
  constraint.turn_from = turns.from;
  constraint.turn_to = turns.to;
  constraint.carrier = id(carrier_[joint]);
  constraint.turn_carrier = turns.carrier;
  constraint.offset = condition.offset[joint];
  return constraint;
}

ConstraintPartTable ConstraintPartTable::arranged(std::span<const Index> order, const Layout& layout) const {
  const auto place_of = [&](BodyId body) {
    if (body == ground) return Place{};
    const BodySlot slot = layout.slot(body);
    return Place{slot.q, slot.v, slot.rotation};
  };
  ConstraintPartTable table;
  table.ends_.reserve(order.size());
  table.places_.reserve(order.size());
  std::vector<ConstraintPart> constraints(conditions_.size());
  for (const Index joint : order) {
    bool carried = false;
    for (Index which = 0; which < constraints.size(); ++which) {
      constraints[which] = constraint(joint, which);
      carried = carried || constraints[which].turn_carrier != 0.0;
    }
    table.add(constraints);
    table.places_.push_back({place_of(constraints[0].from.body), place_of(constraints[0].to.body)});
    const Place carrier = carried ? place_of(constraints[0].carrier) : Place{};
    table.carrier_place_.push_back(carrier.rotation == none ? Place{} : carrier);
  }
  table.token_ = token_;
  table.from_point_.shrink();
  table.to_point_.shrink();
  for (Condition& condition : table.conditions_) condition.offset.shrink();
  return table;
}

void ConstraintPartTable::ends(Index joint, std::vector<BodyId>& out) const {
  out.push_back(id(ends_[joint].from));
  out.push_back(id(ends_[joint].to));
  if (carrier_[joint] != ground.serial) out.push_back(id(carrier_[joint]));
}

void ConstraintPartTable::fingerprint(Fingerprint& print) const {
  for (Index joint = 0; joint < size(); ++joint) {
    for (Index which = 0; which < conditions_.size(); ++which) {
      const ConstraintPart of = constraint(joint, which);
      add_to(print, of.from);
      add_to(print, of.to);
      print.add(std::uint64_t{of.carrier.serial});
      print.add({of.axis.data(), 2});
      for (const double number : {of.turn_from, of.turn_to, of.turn_carrier, of.offset}) print.add(number);
    }
  }
}

inline Vec<2> ConstraintPartTable::Place::lever(const JointView& at, const Vec<2>& local) const {
  if (rotation == none) return Vec<2>::Zero();
  return Space<2>::rotate(at.rotation + rotation, local);
}

inline Vec<2> ConstraintPartTable::Place::position(const JointView& at, const Vec<2>& local,
                                                   const Vec<2>& lever) const {
  if (v == none) return local;
  return Eigen::Map<const Vec<2>>(at.state.q + q) + lever;
}

inline Vec<2> ConstraintPartTable::Place::velocity(const JointView& at, const Vec<2>& lever) const {
  if (v == none) return Vec<2>::Zero();
  const Vec<2> velocity = Eigen::Map<const Vec<2>>(at.state.v + v);
  return rotation == none ? velocity : Vec<2>(velocity + spin(at) * turned(lever));
}

/// Without the motion, which drifts alone need, the last three are void.
template <bool WithMotion>
inline ConstraintPartTable::Geometry ConstraintPartTable::geometry(const JointView& at, Index joint) const {
  const auto& [from, to] = places_[joint];
  const Vec<2>& from_point = from_point_[joint];
  const Vec<2>& to_point = to_point_[joint];
  const Vec<2> from_lever = from.lever(at, from_point), to_lever = to.lever(at, to_point);
  const double from_spin = WithMotion ? from.spin(at) : 0.0, to_spin = WithMotion ? to.spin(at) : 0.0;
  return {places_[joint],
          carrier_place_[joint],
          from_lever,
          to_lever,
          to.position(at, to_point, to_lever) - from.position(at, from_point, from_lever),
          to.velocity(at, to_lever) - from.velocity(at, from_lever),
          from_spin * from_spin * from_lever - to_spin * to_spin * to_lever,
          from_spin};
}

inline Vec<2> ConstraintPartTable::direction(const JointView& at, const Geometry& geometry,
                                             const Condition& condition, Index joint) const {
  const Index rotation = geometry.places.from.rotation;
  switch (condition.form[joint]) {
    case ConstraintPart::Form::fixed_axis:
      return condition.axis[joint];
    case ConstraintPart::Form::axis_of_from:
      if (rotation == none) return condition.axis[joint];
      return Space<2>::rotate(at.rotation + rotation, condition.axis[joint]);
    case ConstraintPart::Form::distance:
      return geometry.between / geometry.between.norm();
    case ConstraintPart::Form::angles:
      break;
  }
  return Vec<2>::Zero();
}

/// Writes a row, its numbers of G only if there is a place for them; returns the end of these.
template <bool WithDrift>
inline double* ConstraintPartTable::write(const JointView& at, const Geometry& geometry,
                                          const Condition& condition, Index joint, double& gap, double& drift,
                                          double* jacobian) const {
  const auto& [from, to] = geometry.places;
  const Place& carrier = geometry.carrier;
  const Vec<2>& between = geometry.between;
  const Vec<2> a = direction(at, geometry, condition, joint);
  const ConstraintPart::Form form = condition.form[joint];
  // Part of turning `from` where the axis turns with it.
  double swing = 0.0;
  drift = WithDrift ? a.dot(geometry.drift) : 0.0;
  gap = a.dot(between);
  if (form == ConstraintPart::Form::axis_of_from && from.rotation != none) {
    const Vec<2> across = turned(a);
    const double spin = geometry.from_spin;
    swing = across.dot(between);
    if constexpr (WithDrift) drift += 2.0 * spin * across.dot(geometry.apart) - spin * spin * gap;
  } else if (form == ConstraintPart::Form::distance) {
    const double length = between.norm();
    gap = length;
    if constexpr (WithDrift) {
      const double sideways = cross(a, geometry.apart);
      drift += sideways * sideways / length;
    }
  }
  const Turns& turns = condition.turns[joint];
  if (turns.from != 0.0) gap += turns.from * from.angle(at);
  if (turns.to != 0.0) gap += turns.to * to.angle(at);
  if (turns.carrier != 0.0) gap += turns.carrier * carrier.angle(at);
  gap -= condition.offset[joint];
  if (jacobian == nullptr) return nullptr;
  jacobian = write_block(from, -a, geometry.from_lever, turns.from + swing, jacobian);
  jacobian = write_block(to, a, geometry.to_lever, turns.to, jacobian);
  return write_block(carrier, Vec<2>::Zero(), Vec<2>::Zero(), turns.carrier, jacobian);
}

void ConstraintPartTable::derivatives(const JointView& at, Index joint, Index which,
                                      JointRowDerivative& out) const {
  out = {};
  const Condition& condition = conditions_[which];
  const ConstraintPart::Form form = condition.form[joint];
  if (form == ConstraintPart::Form::angles) return;
  const Geometry ends = geometry(at, joint);
  const bool swings = form == ConstraintPart::Form::axis_of_from && ends.places.from.rotation != none;
  std::array<EndMotion, std::size_t{6}> motions;
  std::size_t count = 0;
  const auto add = [&](const Place& place, double sign, const Vec<2>& lever, bool turns_axis) {
    if (place.v == none) return;
    for (int i = 0; i < place.columns(); ++i) {
      const double rate = at.state.v[place.v + static_cast<Index>(i)];
      if (i < 2) {
        motions[count++] = {sign * Vec<2>::Unit(i), Vec<2>::Zero(), rate, 0.0};
      } else {
        motions[count++] = {sign * turned(lever), -sign * lever, rate, turns_axis ? 1.0 : 0.0};
      }
    }
  };
  add(ends.places.from, -1.0, ends.from_lever, swings);
  add(ends.places.to, 1.0, ends.to_lever, false);
  const ConditionGeometry here{direction(at, ends, condition, joint), ends.between, ends.apart, ends.drift,
                               swings ? ends.from_spin : 0.0};
  if (form == ConstraintPart::Form::distance) {
    differentiate_distance(here, std::span(motions).first(count), out);
  } else {
    differentiate_line(here, swings, std::span(motions).first(count), out);
  }
}

void ConstraintPartTable::pattern(Index joint, JointRow& row) const {
  row.bodies = 0;
  const auto& [from, to] = places_[joint];
  for (const Place& place : {from, to, carrier_place_[joint]}) {
    if (place.v == none) continue;
    JointRow::Block& block = row.blocks[static_cast<std::size_t>(row.bodies++)];
    block.v = place.v;
    block.columns = place.columns();
  }
}

void ConstraintPartTable::evaluate(const JointView& at, Index joint, Index which, JointRow& row) const {
  pattern(joint, row);
  std::array<double, std::size_t{JointRow::max_bodies * JointRow::max_columns}> numbers{};
  row.rate = 0.0;
  write<true>(at, geometry(at, joint), conditions_[which], joint, row.gap, row.drift, numbers.data());
  const double* number = numbers.data();
  for (JointRow::Block& block : std::span(row.blocks).first(static_cast<std::size_t>(row.bodies))) {
    std::copy_n(number, block.columns, block.jacobian.begin());
    number += block.columns;
  }
}

void ConstraintPartTable::evaluate(const JointView& at, Range joints, Index rows, JointNumbers out) const {
  if (out.rate != nullptr) std::fill_n(out.rate, joints.size() * rows, 0.0);
  if (are_pins(rows)) return evaluate_pins(at, joints, rows, out);
  out.drift != nullptr ? evaluate_rows<true>(at, joints, rows, out)
                       : evaluate_rows<false>(at, joints, rows, out);
}

template <bool WithDrift>
void ConstraintPartTable::evaluate_rows(const JointView& at, Range joints, Index rows,
                                        JointNumbers out) const {
  double unwanted = 0.0;
  for (Index joint = joints.begin; joint < joints.end; ++joint) {
    const Geometry ends = geometry<WithDrift>(at, joint);
    for (Index row = 0; row < rows; ++row, ++out.gap) {
      double& drift = WithDrift ? *out.drift++ : unwanted;
      out.jacobian = write<WithDrift>(at, ends, conditions_[row], joint, *out.gap, drift, out.jacobian);
    }
  }
}

JointPlaces ConstraintPartTable::places(const JointView& at, Index joint) const {
  const auto& [from, to] = places_[joint];
  const Vec<2>& from_point = from_point_[joint];
  const Vec<2>& to_point = to_point_[joint];
  const Vec<2> a = from.position(at, from_point, from.lever(at, from_point));
  const Vec<2> b = to.position(at, to_point, to.lever(at, to_point));
  return {.from = {a[0], a[1], 0.0}, .to = {b[0], b[1], 0.0}};
}

JointReaction ConstraintPartTable::reaction(const JointView& at, Index joint, Index rows,
                                            const double* multipliers) const {
  JointReaction reaction;
  const Geometry ends = geometry(at, joint);
  for (Index row = 0; row < rows; ++row) {
    const Vec<2> force = multipliers[row] * direction(at, ends, conditions_[row], joint);
    reaction.force[0] += force[0];
    reaction.force[1] += force[1];
    reaction.moment += multipliers[row] * conditions_[row].turns[joint].to;
  }
  return reaction;
}

}  // namespace carom::planar
