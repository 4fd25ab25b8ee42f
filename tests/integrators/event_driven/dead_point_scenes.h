#pragma once

// Random mechanisms that start at a dead point, or at a position like any other, with dry friction:
// slider-cranks of bodies, of particles on rods, on a floor, and crosshead cranks, in any direction of the
// plane.

#include "tests/random.h"

#include <carom/carom.h>

#include <cmath>
#include <cstdint>
#include <numbers>
#include <utility>

namespace dead_point_scenes {

using namespace carom;
using namespace carom::planar;
using carom_test::Random;

struct Scene {
  System system;
  BodyId crank, slider;
};

/// What moves the crank.
enum class Drive : std::uint8_t { nothing, torque, ramp, motor, driver, late_driver };
inline constexpr unsigned drives = 6;

/// Grows one scene.
class Maker {
public:
  explicit Maker(std::uint64_t seed) : random_(seed) {}

  Scene make() {
    tilt_ = random_.below(2) == 0 ? 0.0 : random_.uniform(-3.0, 3.0);
    radius_ = random_.uniform(0.05, 0.2);
    rod_ = radius_ * random_.uniform(1.3, 5.0);
    const unsigned place = random_.below(5);
    angle_ = place < 2 ? 0.0 : place < 4 ? std::numbers::pi : random_.uniform(0.3, 2.8);
    spin_ = random_.below(3) == 0 ? random_.uniform(-8.0, 8.0) : 0.0;
    const auto drive = static_cast<Drive>(random_.below(drives));
    if (drive >= Drive::driver) spin_ = 0.0;
    const bool weighs = random_.below(2) == 0 || (drive == Drive::nothing && spin_ == 0.0);
    if (weighs) system_.add(Gravity{{0.0, -9.81}});
    add_bodies();
    add_friction(weighs);
    add_drive(drive);
    return {std::move(system_), crank_, slider_};
  }

private:
  /// A vector of the mechanism, whose guide is along its x axis, in the plane.
  [[nodiscard]] Vec<2> turned(double x, double y) const {
    return {std::cos(tilt_) * x - std::sin(tilt_) * y, std::sin(tilt_) * x + std::cos(tilt_) * y};
  }

  /// Crank, rod and slider, in line at a dead point.
  void add_bodies() {
    const double c = std::cos(angle_), s = angle_ == std::numbers::pi ? 0.0 : std::sin(angle_);
    const double slope = -std::asin(radius_ * s / rod_);
    const double rod_spin = -radius_ * c * spin_ / (rod_ * std::cos(slope));
    const double at = radius_ * c + rod_ * std::cos(slope);
    const double speed = -radius_ * s * spin_ - rod_ * std::sin(slope) * rod_spin;
    crank_ = system_.add(RigidBody{.mass = rod(random_.uniform(0.3, 2.0), radius_),
                                   .position = turned(0.5 * radius_ * c, 0.5 * radius_ * s),
                                   .angle = tilt_ + angle_,
                                   .velocity = turned(-0.5 * radius_ * s * spin_, 0.5 * radius_ * c * spin_),
                                   .spin = spin_},
                         "crank");
    pin_ = system_.add(Revolute{.from = ground, .to = {crank_, {-0.5 * radius_, 0.0}}, .zero_angle = 0.0});
    const Vec<2> end(0.5 * radius_, 0.0);
    const Vec<2> place = turned(at, 0.0), velocity = turned(speed, 0.0);
    if (random_.below(3) == 0) {
      slider_ = system_.add(Particle{random_.uniform(0.2, 2.0), place, velocity}, "slider");
      system_.add(Rod{.from = {crank_, end}, .to = slider_});
      guide_ = system_.add(PointOnLine{.from = ground, .to = slider_, .axis = turned(1.0, 0.0)});
      return;
    }
    slider_ = system_.add(RigidBody{.mass = box(random_.uniform(0.2, 2.0), 0.1, 0.06),
                                    .position = place,
                                    .angle = tilt_,
                                    .velocity = velocity},
                          "slider");
    const double half = 0.5 * rod_;
    const BodyId link = system_.add(
        RigidBody{
            .mass = rod(random_.uniform(0.3, 2.0), rod_),
            .position = turned(at - half * std::cos(slope), -half * std::sin(slope)),
            .angle = tilt_ + slope,
            .velocity = turned(speed + half * std::sin(slope) * rod_spin, -half * std::cos(slope) * rod_spin),
            .spin = rod_spin},
        "rod");
    system_.add(Revolute{.from = {crank_, end}, .to = {link, {-half, 0.0}}});
    wrist_ = system_.add(Revolute{.from = {link, {half, 0.0}}, .to = slider_});
    guide_ = system_.add(Prismatic{.from = ground, .to = slider_, .axis = turned(1.0, 0.0)});
  }

  /// Friction in the guide, and perhaps in a pin.
  void add_friction(bool weighs) {
    const double static_factor = random_.below(3) == 0 ? random_.uniform(1.0, 1.5) : 1.0;
    if (random_.below(2) == 0) {
      system_.add(JointFriction{.joint = guide_,
                                .bound = random_.uniform(0.05, weighs ? 2.0 : 0.5),
                                .static_factor = static_factor});
    } else {
      system_.add(JointFriction{
          .joint = guide_, .coefficient = random_.uniform(0.02, 0.3), .static_factor = static_factor});
    }
    if (random_.below(3) == 0)
      system_.add(JointFriction{.joint = pin_, .bound = random_.uniform(0.001, 0.02)});
    if (wrist_.valid() && random_.below(3) == 0)
      system_.add(JointFriction{.joint = wrist_, .bound = random_.uniform(0.001, 0.02)});
  }

  void add_drive(Drive drive) {
    const double sign = random_.below(2) == 0 ? 1.0 : -1.0, size = sign * random_.uniform(0.3, 1.5);
    const double start = tilt_ + angle_;
    switch (drive) {
      case Drive::nothing:
        return;
      case Drive::torque:
        system_.add(AppliedTorque{.on = crank_, .torque = [size](double) { return size; }});
        return;
      case Drive::ramp:
        system_.add(AppliedTorque{.on = crank_, .torque = [size](double t) { return 4.0 * size * t; }});
        return;
      case Drive::motor:
        system_.add(Motor{.joint = pin_,
                          .torque = [size](double, double, double rate) { return size - 0.05 * rate; }});
        return;
      case Drive::driver:
        system_.add(Driver{.joint = pin_, .position = [=](double t) { return start + 4.0 * size * t * t; }});
        return;
      case Drive::late_driver:
        system_.add(
            Driver{.joint = pin_, .position = [=](double t) { return start + 9.0 * size * t * t * t; }});
    }
  }

  Random random_;
  System system_;
  double tilt_ = 0.0, radius_ = 0.0, rod_ = 0.0, angle_ = 0.0, spin_ = 0.0;
  BodyId crank_, slider_;
  JointId pin_, guide_, wrist_;
};

inline Scene random_scene(std::uint64_t seed) { return Maker(seed).make(); }

}  // namespace dead_point_scenes
