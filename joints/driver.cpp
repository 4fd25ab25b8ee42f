#include <carom/core/law_jump.h>
#include <carom/core/system.h>
#include <carom/core/time_course.h>
#include <carom/joints/driver_kind.h>

#include <cmath>
#include <limits>
#include <utility>

namespace carom {

void DriverKind::add(const Driver& part, const PartCheck& check) {
  check_coordinate(check, part.joint);
  if (!part.position) check.refuse("position", "not given", "a function of time");
  if (part.acceleration && !part.velocity) {
    check.refuse("velocity", "not given", "a function of time where there is an acceleration");
  }
  check.breaks(part.breaks, "breaks");
  if (const Index other = slot_on(part.joint); other != none) {
    check.refuse("joint", check.system().name(part.joint) + ", which " + parts_[other].name + " drives",
                 "a joint without a driver");
  }
  const Course<double> start = course(part.position, part.velocity, part.acceleration, 0.0, part.breaks);
  check.finite(start.value, "position at time 0", "");
  check.finite(start.rate, "velocity at time 0", "");
  check.finite(start.second, "acceleration at time 0", "");
  store(part, check);
}

void DriverKind::pattern(Index joint, JointRow* out) const {
  const JointTable& table = *layout_->joints();
  const JointTable::Place place = table.place(parts_[joint].part.joint.serial);
  table.kinds[place.kind]->coordinate_pattern(place.slot, *out);
}

void DriverKind::evaluate(const JointView& at, Index joint, JointRow* out) const {
  const Driver& driver = parts_[joint].part;
  *out = coordinate_row(*layout_, driver.joint, at);
  const Course<double> now =
      course(driver.position, driver.velocity, driver.acceleration, at.state.time, driver.breaks);
  if (!(std::isfinite(now.value) && std::isfinite(now.rate) && std::isfinite(now.second))) {
    const auto [what, value] = !std::isfinite(now.value)  ? std::pair("position", now.value)
                               : !std::isfinite(now.rate) ? std::pair("velocity", now.rate)
                                                          : std::pair("acceleration", now.second);
    fail_law_not_finite(parts_[joint].name, what, value, "", at.state.time);
  }
  out->gap -= now.value;
  out->rate -= now.rate;
  out->drift -= now.second;
}

LawPoint DriverKind::prescribed(Index joint, double time) const {
  const Driver& driver = parts_[joint].part;
  LawPoint point{.time = time};
  point.velocity_given = static_cast<bool>(driver.velocity);
  point.place[0] = driver.position(time);
  point.velocity[0] =
      driver.velocity ? driver.velocity(time) : TimeDifference(time, 1, driver.breaks)(driver.position);
  return point;
}

// Prescribed coordinates depend on time alone.
void DriverKind::derivatives(const JointView& at, Index joint, JointRowDerivative* out) const {
  const JointTable& table = *layout_->joints();
  const JointTable::Place place = table.place(parts_[joint].part.joint.serial);
  table.kinds[place.kind]->coordinate_derivatives(at, place.slot, *out);
}

void DriverKind::discontinuity_times(Index joint, std::vector<double>& out) const {
  const std::vector<double>& breaks = parts_[joint].part.breaks;
  out.insert(out.end(), breaks.begin(), breaks.end());
}

JointReaction DriverKind::reaction(const JointView&, Index, const double* multipliers) const {
  JointReaction reaction;
  reaction.moment = multipliers[0];
  return reaction;
}

void DriverKind::fingerprint(Fingerprint& print) const {
  for (const Stored& stored : parts_) {
    print.add(std::uint64_t{stored.part.joint.serial});
    if (!stored.part.breaks.empty()) print.add(stored.part.breaks);
  }
}

void MotorKind::add(const Motor& part, const PartCheck& check) {
  check_coordinate(check, part.joint);
  if (!part.torque) check.refuse("torque", "not given", "a function of time, coordinate and rate");
  check.breaks(part.breaks, "breaks");
  store(part, check);
}

void MotorKind::evaluate(const EvaluationContext& at, Range elements, const Loads& loads) const {
  const JointView view{at.state, at.evaluation.rotation.data()};
  for (Index i = elements.begin; i < elements.end; ++i) {
    const Motor& motor = parts_[i].part;
    const JointRow row = coordinate_row(*layout_, motor.joint, view);
    const double push = motor.torque(at.state.time, row.gap, row.times(at.state.v) + row.rate);
    row.add_transposed(push, loads.external);
  }
}

void MotorKind::discontinuity_times(Index element, std::vector<double>& out) const {
  const std::vector<double>& breaks = parts_[element].part.breaks;
  out.insert(out.end(), breaks.begin(), breaks.end());
}

void MotorKind::fingerprint(Fingerprint& print) const {
  for (const Stored& stored : parts_) {
    print.add(std::uint64_t{stored.part.joint.serial});
    if (!stored.part.breaks.empty()) print.add(stored.part.breaks);
  }
}

void StopKind::add(const Stop& part, const PartCheck& check) {
  check_coordinate(check, part.joint);
  const auto bound = [&](double value, const char* quantity, double none_given) {
    if (value != none_given) check.finite(value, quantity, "");
  };
  bound(part.lower, "lower", -std::numeric_limits<double>::infinity());
  bound(part.upper, "upper", std::numeric_limits<double>::infinity());
  if (std::isinf(part.lower) && std::isinf(part.upper)) {
    check.refuse("lower and upper", "not given", "a limit on one side or on both");
  }
  if (!(part.lower < part.upper)) {
    check.refuse("lower", to_text(part.lower), "less than upper, " + to_text(part.upper));
  }
  check.between(part.restitution, 0.0, 1.0, "restitution");
  store(part, check);
}

bool StopKind::has_limit(Index joint, Index which) const {
  return std::isfinite(which == 0 ? parts_[joint].part.lower : parts_[joint].part.upper);
}

void StopKind::limit(const JointView& at, Index joint, Index which, JointLimit& out) const {
  const Stop& stop = parts_[joint].part;
  out.row = coordinate_row(*layout_, stop.joint, at);
  out.restitution = stop.restitution;
  if (which == 0) {
    out.row.gap -= stop.lower;
    return;
  }
  out.row.gap = stop.upper - out.row.gap;
  out.row.rate = -out.row.rate;
  out.row.drift = -out.row.drift;
  for (JointRow::Block& block : out.row.blocks) {
    for (double& number : block.jacobian) number = -number;
  }
}

void StopKind::fingerprint(Fingerprint& print) const {
  for (const Stored& stored : parts_) {
    print.add(std::uint64_t{stored.part.joint.serial});
    for (const double number : {stored.part.lower, stored.part.upper, stored.part.restitution})
      print.add(number);
  }
}

PartType<JointKind> Driver::part_type() { return PartType<JointKind>::of<DriverKind, Driver>(); }
PartType<ForceKind> Motor::part_type() { return PartType<ForceKind>::of<MotorKind, Motor>(); }
PartType<JointKind> Stop::part_type() { return PartType<JointKind>::of<StopKind, Stop>(); }

}  // namespace carom
