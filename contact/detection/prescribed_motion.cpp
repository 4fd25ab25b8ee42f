#include <carom/contact/detection/prescribed_motion.h>
#include <carom/core/time_course.h>

#include <cmath>
#include <string>

namespace carom {

NonFiniteMotion find_non_finite(const GroundMotion& motion) {
  // A difference from itself is 0 of finite numbers only, and so is a sum of such.
  double nothing = (motion.angle - motion.angle) + (motion.spin - motion.spin) +
                   (motion.angular_acceleration - motion.angular_acceleration);
  for (const auto* const numbers : {&motion.point, &motion.velocity, &motion.acceleration}) {
    for (const double value : *numbers) nothing += value - value;
  }
  if (nothing == 0.0) return {};
  for (const double value : motion.point) {
    if (!std::isfinite(value)) return {"position", value, "m"};
  }
  if (!std::isfinite(motion.angle)) return {"angle", motion.angle, "rad"};
  for (const double value : motion.velocity) {
    if (!std::isfinite(value)) return {"velocity", value, "m/s"};
  }
  if (!std::isfinite(motion.spin)) return {"spin", motion.spin, "rad/s"};
  for (const double value : motion.acceleration) {
    if (!std::isfinite(value)) return {"acceleration", value, "m/s^2"};
  }
  if (!std::isfinite(motion.angular_acceleration)) {
    return {"angular acceleration", motion.angular_acceleration, "rad/s^2"};
  }
  return {};
}

namespace planar {

GroundMotion PrescribedMotion::at(double time, const Vec<2>& point) const {
  GroundMotion motion;
  motion.point = {point[0], point[1], 0.0};
  motion.velocity_given = static_cast<bool>(velocity);
  motion.spin_given = static_cast<bool>(spin);
  if (displacement) {
    const Course<Vec<2>> way = course(displacement, velocity, acceleration, time, breaks);
    for (int i = 0; i < 2; ++i) {
      const auto at = static_cast<std::size_t>(i);
      motion.point[at] += way.value[i];
      motion.velocity[at] = way.rate[i];
      motion.acceleration[at] = way.second[i];
    }
  }
  if (angle) {
    const Course<double> turn = course(angle, spin, angular_acceleration, time, breaks);
    motion.angle = turn.value;
    motion.cosine = std::cos(turn.value);
    motion.sine = std::sin(turn.value);
    motion.spin = turn.rate;
    motion.angular_acceleration = turn.second;
  }
  return motion;
}

void PrescribedMotion::check(const PartCheck& check) const {
  const auto demand = [&](bool given, const char* name, bool base, const char* base_name) {
    if (given && !base) {
      const std::string quantity = std::string("motion.") + base_name;
      check.refuse(quantity, std::string("not given, but motion.") + name + " is",
                   "functions with the one that they are rates of");
    }
  };
  demand(static_cast<bool>(velocity), "velocity", static_cast<bool>(displacement), "displacement");
  demand(static_cast<bool>(acceleration), "acceleration", static_cast<bool>(displacement), "displacement");
  demand(static_cast<bool>(spin), "spin", static_cast<bool>(angle), "angle");
  demand(static_cast<bool>(angular_acceleration), "angular_acceleration", static_cast<bool>(angle), "angle");
  check.breaks(breaks, "motion.breaks");
  if (empty()) {
    if (!breaks.empty()) {
      check.refuse("motion.breaks", "given without a motion", "breaks of a displacement or an angle");
    }
    return;
  }
  const NonFiniteMotion bad = find_non_finite(at(0.0, Vec<2>::Zero()));
  if (bad.quantity == nullptr) return;
  check.finite(bad.value, std::string(bad.quantity) + " of its motion at time 0", bad.unit);
}

}  // namespace planar

}  // namespace carom
