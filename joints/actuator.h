#pragma once

/// \file
/// Actuators: forces and torques between two ends by laws of time and motion.

#include <carom/core/force_element.h>
#include <carom/joints/line_of_action.h>

#include <functional>
#include <string>
#include <vector>

namespace carom {

namespace generic {

/// Linear actuator between two ends: pushes them apart along the line between them with f(t, l, dl/dt), l
/// their distance. Its work is external work. Where the ends coincide there is no direction and no force.
template <int D>
struct LinearActuator {
  static constexpr Role role = Role::force;
  static constexpr int dimension = D;
  static constexpr std::string_view label = "linear actuator";

  End<D> from{};  ///< required
  End<D> to{};    ///< required
  /// f, positive where it pushes apart [N] (required).
  std::function<double(double time, double length, double rate)> force{};

  /// The bodies it joins.
  [[nodiscard]] std::vector<BodyId> bodies() const { return {from.body, to.body}; }
  /// Throws ModelError for ends or a law that cannot be. The law is tried at time 0 with the length and rate
  /// that the bodies are described with, unless the length is 0.
  void check(const PartCheck& check) const {
    check_end(check, from, "from");
    check_end(check, to, "to");
    check.different_ends(from.body, to.body);
    if (!force) check.refuse("force", "not given", "a function of time, length and rate");
    const auto start = LineOfAction<D>::described(check.system(), from, to);
    if (start.length == 0.0) return;
    check.finite(
        force(0.0, start.length, start.rate),
        "force at time 0, length " + to_text(start.length) + " m, rate " + to_text(start.rate) + " m/s", "N");
  }
  /// Books the loads.
  void loads(const ElementView<D>& at, ElementLoads<D>& out) const {
    const LineOfAction<D> line(at, from, to);
    if (line.length == 0.0) return;
    const Vec<D> push = force(at.time(), line.length, line.rate) * line.direction;
    out.external(from, -push);
    out.external(to, push);
  }
  /// Adds the ends (a function cannot be hashed).
  void fingerprint(Fingerprint& print) const {
    add_to(print, from);
    add_to(print, to);
  }
};

}  // namespace generic

namespace planar {

using LinearActuator = generic::LinearActuator<2>;

/// Rotary actuator between two rigid bodies, or one and the ground: the torque m(t, a, da/dt) on `to`, the
/// opposite on `from`, with a the angle of `to` relative to `from`, turns counted. Its work is external work.
struct RotaryActuator {
  static constexpr Role role = Role::force;
  static constexpr int dimension = 2;
  static constexpr std::string_view label = "rotary actuator";

  BodyId from{};  ///< a rigid body or ground (required)
  BodyId to{};    ///< a rigid body or ground (required)
  /// m, counter-clockwise on `to` [N m] (required).
  std::function<double(double time, double angle, double rate)> torque{};

  /// The bodies it joins.
  [[nodiscard]] std::vector<BodyId> bodies() const { return {from, to}; }
  /// Throws ModelError for bodies or a law that cannot be. The law is tried at time 0 with the angle and rate
  /// that the bodies are described with.
  void check(const PartCheck& check) const {
    check_angular_ends(check, from, to);
    if (!torque) check.refuse("torque", "not given", "a function of time, angle and rate");
    const RelativeAngle start(check.system(), from, to);
    check.finite(
        torque(0.0, start.angle, start.rate),
        "torque at time 0, angle " + to_text(start.angle) + " rad, rate " + to_text(start.rate) + " rad/s",
        "N m");
  }
  /// Books the loads.
  void loads(const ElementView<2>& at, ElementLoads<2>& out) const {
    const RelativeAngle relative(at, from, to);
    const double turn = torque(at.time(), relative.angle, relative.rate);
    out.external_torque(from, -turn);
    out.external_torque(to, turn);
  }
  /// Adds nothing that the bodies' identities do not tell (a function cannot be hashed).
  void fingerprint(Fingerprint&) const {}
};

}  // namespace planar

namespace spatial {
using LinearActuator = generic::LinearActuator<3>;
}

}  // namespace carom
