// Problem: obstacles that move, where they are and what that makes of a contact.

#include <carom/contact/detection/detector.h>
#include <carom/contact/detection/prescribed_motion.h>
#include <carom/core/law_jump.h>

#include <array>
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace carom {

GroundMotion Detector::motion(const Obstacle& obstacle, double time) const {
  const GroundMotion motion = obstacle.kind->place(obstacle.slot, time);
  const NonFiniteMotion bad = find_non_finite(motion);
  if (bad.quantity == nullptr) return motion;
  const System& system = assembly_->system();
  SolverFailure failure;
  failure.time = time;
  failure.parts.push_back(system.name(ObstacleId{obstacle.serial, system.token()}));
  const std::string message = failure.parts.front() + ": " + bad.quantity +
                              " of its motion at t = " + to_text(time) + " s is " + to_text(bad.value) + " " +
                              bad.unit + "; allowed: a finite number";
  throw SolverError(message, std::move(failure));
}

void Detector::place(double time, ObstaclePlaces& places) const {
  if (places.time_ == time && places.motions_.size() == moving_) return;
  places.time_ = std::numeric_limits<double>::quiet_NaN();  // for as long as it takes
  places.motions_.clear();
  if (moving_ > 0) {
    for (const Obstacle& obstacle : obstacles_) {
      if (obstacle.moving != none) places.motions_.push_back(motion(obstacle, time));
    }
  }
  places.time_ = time;
}

void Detector::demand_continuous(const ObstaclePlaces& before, const ObstaclePlaces& after) const {
  const auto point_of = [](const GroundMotion& motion, double time) {
    return LawPoint{time,        motion.point,          motion.velocity,  motion.angle,
                    motion.spin, motion.velocity_given, motion.spin_given};
  };
  for (const Obstacle& obstacle : obstacles_) {
    if (obstacle.moving == none) continue;
    const LawPoint from = point_of(before.motions_[obstacle.moving], before.time_),
                   to = point_of(after.motions_[obstacle.moving], after.time_);
    if (looks_smooth(from, to)) continue;
    auto law = [&](double time) { return point_of(obstacle.kind->place(obstacle.slot, time), time); };
    const ObstacleId id{obstacle.serial, assembly_->system().token()};
    if (const auto jump = find_jump(law, from, to)) {
      fail_jump(assembly_->system().name(id), jump->of_angle ? "angle" : "displacement",
                jump->of_angle ? "rad" : "m", *jump);
    }
    if (const auto rate = find_false_rate(law, from, to)) {
      fail_rate(assembly_->system().name(id), rate->of_angle ? "spin" : "velocity",
                rate->of_angle ? "angle" : "displacement", rate->of_angle ? "rad/s" : "m/s", *rate);
    }
  }
}

std::vector<Discontinuity> Detector::breaks() const {
  std::vector<Discontinuity> all;
  std::vector<double> times;
  for (const Obstacle& obstacle : obstacles_) {
    times.clear();
    obstacle.kind->discontinuity_times(obstacle.slot, times);
    const ObstacleId id{obstacle.serial, assembly_->system().token()};
    for (const double time : times) all.push_back({.time = time, .obstacle = id});
  }
  return all;
}

void Detector::fill_motion(const BodySlot& body, double radius, const Vec<2>& arm, const StateView& state,
                           const GroundMotion& motion, const GroundMotion* after, Constraint& contact) {
  // docs/method.md, section 1: C the centre of the feature, o the obstacle's point, w its spin, r = C - o.
  const Vec<2> n = Eigen::Map<const Vec<2>>(contact.row(0)), t = Eigen::Map<const Vec<2>>(contact.row(1));
  const Vec<2> centre = Eigen::Map<const Vec<2>>(state.q + body.q) + arm;
  const auto vec = [](const std::array<double, 3>& numbers) { return Vec<2>(numbers[0], numbers[1]); };
  const Vec<2> r = centre - vec(motion.point), velocity = vec(motion.velocity);
  const double w = motion.spin, along = t.dot(r), above = n.dot(r);
  contact.surface_velocity = {n.dot(velocity) + w * along, t.dot(velocity) - w * (above - radius), 0.0};
  contact.surface_velocity_after = contact.surface_velocity;

  Vec<2> relative = Eigen::Map<const Vec<2>>(state.v + body.v) - velocity;
  if (body.rotation != none) relative += Space<2>::lever_velocity(state.v + body.v + 2, arm);
  const Vec<2> acceleration = vec(motion.acceleration);
  contact.drift[0] -=
      n.dot(acceleration) + 2.0 * w * t.dot(relative) + motion.angular_acceleration * along + w * w * above;
  contact.drift[1] += -t.dot(acceleration) + 2.0 * w * n.dot(relative) +
                      motion.angular_acceleration * (above - radius) - w * w * along;
  if (after == nullptr) return;

  // The place that is touched goes with the obstacle: its arm turns from the one angle to the other.
  const std::array<double, 2> turn{after->cosine * motion.cosine + after->sine * motion.sine,
                                   after->sine * motion.cosine - after->cosine * motion.sine};
  const Vec<2> end =
      vec(after->velocity) +
      Space<2>::lever_velocity(&after->spin, Space<2>::rotate(turn.data(), Vec<2>(r - radius * n)));
  contact.surface_velocity_after = {n.dot(end), t.dot(end), 0.0};
}

}  // namespace carom
